//! What an error costs, by method: error over node-steps and solves.
//!
//! Every method runs over the same grid of elements and steps; its errors are those of the [`yardstick`](crate::error::yardstick),
//! the largest over equidistant times of observation that all runs share. From the grid follow the fitted [`law::Law`],
//! the best path dt(h), the cost of an error E, and who is cheapest at 1e-2 ... 1e-8. Costs are counted, not timed, so
//! that a report is the same on every machine and at every time; [`WorkPrecision::timed`] has the seconds.
//!
//! ```toml
//! [work-precision]
//! solution = "midpoint-coupled.toml"   # a convergence study beside this one; or scene = "...", with t_end and
//!                                      # reference = [elements, steps]; or vibration = [0, 1], with zeta and t_end
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

mod input;
pub mod law;
#[cfg(feature = "ode-library")]
mod library;
pub mod method;
mod report;
mod timed;

use crate::error::yardstick::{Quantity, Reference, Yardstick};
use crate::kinds::Study;
use crate::kinds::untyped::{Case, Measured};
use crate::run::family::Family;
use convergence_study::study::CaseFailure;
use convergence_study::study::Header;
use convergence_study::study::outcome::Outcome;
use law::GridPoint;
use method::{METHODS, Measurement, Method};
use std::sync::OnceLock;
pub use timed::Timed;

/// Name of the kind.
pub const WORK_PRECISION: &str = "work-precision";

/// A claim that one method is so many times cheaper than another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advantage {
    /// The error is measured in this quantity.
    pub quantity: Quantity,
    /// The error.
    pub error: f64,
    /// The cheaper method.
    pub of: Method,
    /// The dearer one.
    pub over: Method,
    /// At least so many times.
    pub times: f64,
}

/// A study of this kind.
pub struct WorkPrecision {
    header: Header,
    family: Family,
    /// Elements and steps of the reference, where there is no exact solution.
    reference: Option<[usize; 2]>,
    computed: OnceLock<Result<Reference, CaseFailure>>,
    elements: Vec<usize>,
    steps: Vec<usize>,
    tolerance: f64,
    misfit: f64,
    advantages: Vec<Advantage>,
}

impl WorkPrecision {
    /// Equidistant times at which the error is measured.
    fn observations(&self) -> usize {
        self.steps[0]
    }

    fn reference(&self) -> Result<Option<&Reference>, CaseFailure> {
        let Some([elements, steps]) = self.reference else { return Ok(None) };
        // Computed once, by whichever thread comes first; the result is the same.
        let computed =
            self.computed.get_or_init(|| Reference::compute(&self.family, elements, steps, self.observations()));
        computed.as_ref().map(Some).map_err(Clone::clone)
    }

    fn grid(&self) -> Vec<(Method, usize)> {
        METHODS.iter().flat_map(|method| self.elements.iter().map(|&elements| (*method, elements))).collect()
    }

    /// All runs of a method on a mesh, one for each number of steps.
    fn measure(&self, method: &Method, elements: usize) -> Result<Vec<Measurement>, CaseFailure> {
        let on = self.family.on(elements)?;
        let mut yardstick = Yardstick::new(&self.family, &on, self.reference()?)?;
        let mut run = |&steps: &usize| method.run(&on, &mut yardstick, [steps, self.observations()], self.tolerance);
        self.steps.iter().map(&mut run).collect()
    }

    /// The grid of one method in one quantity; NaN where a run failed.
    fn points(&self, method: &Method, quantity: Quantity, results: &[Result<Measured, CaseFailure>]) -> Vec<GridPoint> {
        let mut points = vec![];
        for ((other, elements), result) in self.grid().into_iter().zip(results) {
            if other != *method {
                continue;
            }
            for &steps in &self.steps {
                let value = |name: &str| {
                    result.as_ref().map_or(f64::NAN, |measured| measured.value(&format!("{name} {steps}")))
                };
                points.push(GridPoint {
                    elements,
                    steps,
                    error: value(quantity.name()),
                    node_steps: value("node-steps"),
                    node_solves: value("node-solves"),
                });
            }
        }
        points
    }
}

impl Study for WorkPrecision {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let steps: usize = self.steps.iter().sum();
        let case = |(method, elements): (Method, usize)| {
            // The fixed point needs several iterations where Newton's method needs one pass.
            let passes = if method.solver == thermobeam::solve::Solver::FixedPoint { 8.0 } else { 1.0 };
            let cost = (elements * steps) as f64 * method.runs() * passes;
            Case { label: format!("{}, n = {elements}", method.name), cost }
        };
        self.grid().into_iter().map(case).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        let (method, elements) = self.grid()[index];
        let mut measured = Measured::default();
        for (steps, run) in self.steps.iter().zip(self.measure(&method, elements)?) {
            for (quantity, error) in Quantity::ALL.into_iter().zip(run.errors) {
                measured.push(format!("{} {steps}", quantity.name()), error);
            }
            measured.push(format!("node-steps {steps}"), run.spent.node_steps);
            measured.push(format!("node-solves {steps}"), run.spent.node_solves);
        }
        Ok(measured)
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        report::conclude(self, results)
    }
}
