//! The cost of an error by method: error over node-steps and solves.
//!
//! Every one-step method runs over the same grid of elements and steps; dG(q) runs with the degrees and steps listed in the file.
//! Errors are those of the [`evaluator`](mod@crate::error), the largest over equidistant times of observation common to all
//! runs; those of dG use its values at the nodes of a mesh finer than all others. A grid gives the fitted law ([`law`]), the best
//! path dt(h), and the cost of an error E; for dG the cheapest run with that error counts. Costs are counted, not timed, so that a
//! report is the same on every machine at any time; [`timing`](crate::timing) measures seconds.
//!
//! ```toml
//! [work-precision]
//! solution = "midpoint-coupled.toml"   # a convergence study beside this one; or scene = "...", with t_end and
//!                                      # two tables [[reference]] of runs of any order that must agree within
//!                                      # agreement = 1e-6; or vibration = [0, 1], with zeta and t_end
//! elements = [8, 16, 32, 64]
//! steps = [32, 64, 128, 256]           # multiples of the first, which is the number of observations
//! dg = [[12, 2, 0.02], [14, 3, 0.01]]  # degree p, degree q, largest step; optional
//! diagonal = "midpoint"                # optional, for a scene: this method and dG alone, each number of elements with one
//!                                      # of steps, both twice the ones before; u(1, t) alone, against a finer run of dG
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

use std::sync::OnceLock;

use crate::error::reference::{FINER, Traced, fine_mesh};
use crate::error::{ErrorMeasure, Evaluator};
use crate::kinds::prelude::*;
use crate::kinds::settings;
use crate::kinds::tables::Discretisation;
use crate::run::dg::nodal;
use method::{Degrees, GRADED, METHODS, Measurement, NamedMethod, OneStep, REFERENCE, worst};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "work-precision",
    read: reader::<WorkPrecision>,
    why: "Every method pays for a smaller error with more work. The law e^2 = (C_h h^p)^2 + (C_t dt^q)^2 of each one-step method gives \
          its cheapest path, and its cost for any error: a power of it. High orders pay little more for ten digits than for five.",
    judged: "Costs are counted, not timed. The laws must fit what was measured, and the advantage claimed must be there.",
    failure: "A method has become more expensive for the same error, or its order is not what the law says.",
    settings: settings::of_cost,
};

/// Times of observation if only u(1, t) is measured.
const OBSERVED: usize = 250;

/// A claim that one method is `times` times cheaper than another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advantage {
    /// The quantity in which the error is measured.
    pub quantity: ErrorMeasure,
    /// The error.
    pub error: f64,
    /// The cheaper method.
    pub of: NamedMethod,
    /// The more expensive method.
    pub over: NamedMethod,
    /// Minimum ratio of the costs.
    pub times: f64,
}

/// A study of this kind.
pub struct WorkPrecision {
    family: Family,
    answer: Yardstick,
    elements: Vec<usize>,
    steps: Vec<usize>,
    dg: Vec<Degrees>,
    /// The only one-step method, with one number of steps for each mesh.
    diagonal: Option<NamedMethod>,
    tolerance: f64,
    misfit: f64,
    advantages: Vec<Advantage>,
}

impl Advantage {
    /// The compared cost: node-steps (0), or node-solves (1) if dG takes part, since its steps are of a different kind.
    fn unit(&self) -> usize {
        usize::from(self.of.one_step.is_none() || self.over.one_step.is_none())
    }
}

type Computed<T> = OnceLock<Result<T, CaseFailure>>;

/// The reference for errors. References to be computed are computed once, by the first thread that needs them.
enum Yardstick {
    /// The exact solution.
    Exact,
    /// A scene by two discretisations of any order, and their largest allowed distance in the norm of Theorem 3.4.
    Agreed {
        scene: Box<Scene>,
        by: Box<[Discretisation; 2]>,
        agreement: f64,
        computed: Computed<Traced>,
    },
    /// u(1, t) at the times of observation, by dG.
    Tip(Computed<Vec<f64>>),
}

/// Runs of a method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Runs {
    /// A one-step method on a mesh with this number of elements: one run for each number of steps.
    OnMesh(NamedMethod, OneStep, usize),
    /// One run by dG.
    Dg(Degrees),
}

impl WorkPrecision {
    /// Equidistant times at which the error is measured.
    fn observations(&self) -> usize {
        if self.diagonal.is_some() {
            OBSERVED
        } else {
            self.steps[0]
        }
    }

    /// The measured quantities.
    pub fn quantities(&self) -> &'static [ErrorMeasure] {
        if self.diagonal.is_some() {
            &[ErrorMeasure::Tip]
        } else {
            &ErrorMeasure::ALL
        }
    }

    pub(crate) fn methods(&self) -> impl Iterator<Item = NamedMethod> {
        METHODS.into_iter().filter(|method| match method.one_step {
            None => !self.dg.is_empty(),
            Some(_) => self.diagonal.is_none_or(|only| only == *method),
        })
    }

    /// Steps of the runs on a mesh.
    pub(crate) fn steps_on(&self, elements: usize) -> &[usize] {
        match self
            .elements
            .iter()
            .position(|&n| n == elements)
            .filter(|_| self.diagonal.is_some())
        {
            Some(place) => &self.steps[place..=place],
            None => &self.steps,
        }
    }

    pub(crate) fn runs(&self) -> impl Iterator<Item = Runs> {
        self.methods().flat_map(|method| -> Vec<Runs> {
            match method.one_step {
                Some(scheme) => self
                    .elements
                    .iter()
                    .map(|&n| Runs::OnMesh(method, scheme, n))
                    .collect(),
                None => self.dg.iter().copied().map(Runs::Dg).collect(),
            }
        })
    }

    fn agreed(
        &self,
        scene: &Scene,
        by: &[Discretisation; 2],
        agreement: f64,
    ) -> Result<Traced, CaseFailure> {
        let finest = self.elements.last().copied().unwrap_or(1);
        let run = |how: &Discretisation| {
            Traced::compute(
                &how.of(scene, self.family.t_end)?,
                fine_mesh(scene, finest)?,
                self.observations(),
            )
        };
        let (one, other) = (run(&by[0])?, run(&by[1])?);
        let apart = one.distance(&other);
        if apart <= agreement {
            return Ok(one);
        }
        Err(CaseFailure::new(format!(
            "the two references are {apart:.1e} apart, allowed {agreement:e}"
        )))
    }

    fn exact_tip(&self) -> Result<Vec<f64>, CaseFailure> {
        let mut tip = vec![];
        REFERENCE.run(
            &self.family,
            &GRADED,
            self.observations(),
            &mut |space, level, _| {
                tip.extend(nodal(space, level, &[1.0]).u);
            },
        )?;
        Ok(tip)
    }

    /// Measures levels on a mesh.
    fn evaluator(&self, on: &OnMesh<'_>) -> Result<Evaluator<'_>, CaseFailure> {
        let reference = match &self.answer {
            Yardstick::Tip(computed) => {
                let tip = computed
                    .get_or_init(|| self.exact_tip())
                    .as_ref()
                    .map_err(Clone::clone)?;
                return Ok(Evaluator::of_tip(tip));
            }
            Yardstick::Agreed {
                scene,
                by,
                agreement,
                computed,
            } => {
                let computed = computed.get_or_init(|| self.agreed(scene, by, *agreement));
                Some(computed.as_ref().map_err(Clone::clone)?)
            }
            Yardstick::Exact => None,
        };
        Evaluator::new(&self.family, on, reference)
    }

    pub(crate) fn measure(&self, runs: Runs) -> Result<Vec<Measurement>, CaseFailure> {
        let times = self.observations();
        match runs {
            Runs::OnMesh(_, scheme, elements) => {
                let on = self.family.on(elements)?;
                let mut evaluator = self.evaluator(&on)?;
                let mut run = |&steps: &usize| {
                    scheme.run(&on, &mut evaluator, [steps, times], self.tolerance)
                };
                self.steps_on(elements).iter().map(&mut run).collect()
            }
            Runs::Dg(degrees) => {
                let finest = self.elements.last().copied().unwrap_or(1);
                let on = self.family.on(if self.diagonal.is_some() {
                    1
                } else {
                    FINER * finest
                })?;
                let (mut evaluator, mut errors) = (self.evaluator(&on)?, [0.0; 3]);
                let spent =
                    degrees.run(&self.family, &GRADED, times, &mut |space, level, index| {
                        let level_on = nodal(space, level, on.mesh().nodes());
                        let [_, nodal, tip] = evaluator.measure(&level_on, index, level.t);
                        errors = worst(errors, [nodal, nodal, tip]);
                    })?;
                Ok(vec![Measurement { errors, spent }])
            }
        }
    }
}

impl Kind for WorkPrecision {
    type Data = Runs;
    /// One measurement for each number of steps; only the counted cost is judged, not the seconds.
    type Found = Vec<Measurement>;

    fn cases(&self) -> Vec<Case<Runs>> {
        let case = |data: Runs| match data {
            Runs::Dg(degrees) => {
                let Degrees { p, q, dt } = degrees;
                let cost = 60.0 * (p * (q + 1)) as f64 * self.family.t_end / dt;
                Case::new(format!("dg, {degrees}"), cost, data)
            }
            Runs::OnMesh(method, scheme, elements) => {
                let steps: usize = self.steps_on(elements).iter().sum();
                // The fixed point needs several iterations where Newton's method needs one pass.
                let passes = if scheme.solver == Solver::FixedPoint {
                    8.0
                } else {
                    1.0
                };
                let cost = (elements * steps) as f64 * scheme.runs() * passes;
                Case::new(format!("{}, n = {elements}", method.name), cost, data)
            }
        };
        self.runs().map(case).collect()
    }

    fn run(&self, runs: &Runs) -> Result<Vec<Measurement>, CaseFailure> {
        self.measure(*runs)
    }

    fn judge(&self, ran: &[Ran<Runs, Vec<Measurement>>]) -> Outcome {
        judge::judge(self, ran)
    }
}
