//! What an error costs, by method: error over node-steps and solves.
//!
//! Every method runs over the same grid of elements and steps; its errors are those of the [`evaluator`](crate::error::evaluator),
//! the largest over equidistant times of observation that all runs share. From the grid follow the fitted [`law::Law`],
//! the best path dt(h), the cost of an error E, and who is cheapest at 1e-2 ... 1e-8. Costs are counted, not timed, so
//! that a report is the same on every machine and at every time; [`WorkPrecision::timed`] measures the seconds.
//!
//! ```toml
//! [work-precision]
//! solution = "midpoint-coupled.toml"   # a convergence study beside this one; or scene = "...", with t_end and
//!                                      # two tables [[reference]] of runs of any order that must agree within
//!                                      # agreement = 1e-6; or vibration = [0, 1], with zeta and t_end
//! elements = [8, 16, 32, 64]
//! steps = [32, 64, 128, 256]           # multiples of the first, which is the number of observations
//! tolerance = 1e-11                    # of the solver; optional
//! misfit = 0.15                        # root mean square of log e about the law that is allowed; optional
//!
//! [[advantage]]
//! norm = "superclose"                  # theorem-3.4, superclose, tip
//! error = 1e-6
//! of = "midpoint"
//! over = "euler-crank-nicolson"
//! times = 100
//! ```

mod file;
mod judge;
pub mod law;
pub mod method;
mod timed;

use std::sync::OnceLock;

use convergence_study::study::{Case, CaseFailure, Header, Kind, KindRow, Outcome, Ran, reader};
use thermobeam::solve::Solver;

use crate::error::evaluator::{ErrorMeasure, Evaluator};
use crate::error::reference::{Reference, fine_mesh};
use crate::kinds::tables::Discretisation;
use crate::run::family::Family;
use crate::scene::Scene;
use method::{METHODS, Measurement, Method};
pub use timed::Timed;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "work-precision",
    read: reader::<WorkPrecision>,
    why: "Every method pays for a smaller error with more node-steps. The law e^2 = (C_h h^p)^2 + (C_t dt^q)^2 of each gives its \
          cheapest path, and its cost for any error.",
    judged: "Costs are counted, not timed. The laws must fit what was measured, and the advantage claimed must be there.",
    failure: "A method has become more expensive for the same error, or its order is not what the law says.",
};

/// A claim that one method is so many times cheaper than another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advantage {
    /// The error is measured in this quantity.
    pub quantity: ErrorMeasure,
    /// The error.
    pub error: f64,
    /// The cheaper method.
    pub of: Method,
    /// The more expensive one.
    pub over: Method,
    /// At least so many times.
    pub times: f64,
}

/// A study of this kind.
pub struct WorkPrecision {
    header: Header,
    family: Family,
    /// What stands for the exact solution where there is none.
    reference: Option<AnyOrder>,
    computed: OnceLock<Result<Reference, CaseFailure>>,
    elements: Vec<usize>,
    steps: Vec<usize>,
    tolerance: f64,
    misfit: f64,
    advantages: Vec<Advantage>,
}

/// A scene by two discretisations of any order.
struct AnyOrder {
    scene: Scene,
    by: [Discretisation; 2],
    /// How far they may be apart, in the norm of Theorem 3.4.
    agreement: f64,
}

/// A method on a mesh: one run for each number of steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MethodOnMesh {
    /// The method.
    pub method: Method,
    /// Elements of the mesh.
    pub elements: usize,
}

impl WorkPrecision {
    /// Equidistant times at which the error is measured.
    fn observations(&self) -> usize {
        self.steps[0]
    }

    fn reference(&self) -> Result<Option<&Reference>, CaseFailure> {
        let Some(reference) = &self.reference else { return Ok(None) };
        // Computed once, by whichever thread comes first; the result is the same.
        let computed = self.computed.get_or_init(|| self.agreed(reference));
        computed.as_ref().map(Some).map_err(Clone::clone)
    }

    fn agreed(&self, AnyOrder { scene, by, agreement }: &AnyOrder) -> Result<Reference, CaseFailure> {
        let finest = self.elements.last().copied().unwrap_or(1);
        let run = |how: &Discretisation| {
            Reference::compute(scene, how, fine_mesh(scene, finest)?, self.family.t_end, self.observations(), 0)
        };
        let (one, other) = (run(&by[0])?, run(&by[1])?);
        let apart = one.distance(&other);
        if apart <= *agreement {
            return Ok(one);
        }
        Err(CaseFailure { reason: format!("the two references are {apart:.1e} apart, allowed {agreement:e}") })
    }

    fn meshes(&self) -> impl Iterator<Item = MethodOnMesh> {
        METHODS.iter().flat_map(|&method| self.elements.iter().map(move |&elements| MethodOnMesh { method, elements }))
    }

    /// All runs of a method on a mesh, one for each number of steps.
    fn measure(&self, MethodOnMesh { method, elements }: MethodOnMesh) -> Result<Vec<Measurement>, CaseFailure> {
        let on = self.family.on(elements)?;
        let mut evaluator = Evaluator::new(&self.family, &on, self.reference()?)?;
        let mut run = |&steps: &usize| method.run(&on, &mut evaluator, [steps, self.observations()], self.tolerance);
        self.steps.iter().map(&mut run).collect()
    }
}

impl Kind for WorkPrecision {
    type Data = MethodOnMesh;
    /// One for each number of steps; of their cost only what is counted is judged, not the seconds.
    type Found = Vec<Measurement>;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<MethodOnMesh>> {
        let steps: usize = self.steps.iter().sum();
        let case = |data: MethodOnMesh| {
            let MethodOnMesh { method, elements } = data;
            // The fixed point needs several iterations where Newton's method needs one pass.
            let passes = if method.solver == Solver::FixedPoint { 8.0 } else { 1.0 };
            let cost = (elements * steps) as f64 * method.runs() * passes;
            Case { label: format!("{}, n = {elements}", method.name), cost, data }
        };
        self.meshes().map(case).collect()
    }

    fn run(&self, on: &MethodOnMesh) -> Result<Vec<Measurement>, CaseFailure> {
        self.measure(*on)
    }

    fn judge(&self, ran: &[Ran<MethodOnMesh, Vec<Measurement>>]) -> Outcome {
        judge::judge(self, ran)
    }
}
