//! The work for an error by method, measured: no law is fitted and nothing is extrapolated.
//!
//! A study lists runs of each method, and targets: errors of u(1, t) and in the norm of Theorem
//! 3.4. The cost of a target is the work of the cheapest run whose error is not larger; a method
//! without such a run does not reach it. A ratio is one of optimal runs: the neighbours of each
//! listed run, `neighbours.rs`, are made as well, and none may reach a target for less. Each target
//! names the methods that reach it, from the dearest to the cheapest, and claims how many times
//! dearer each of them is than the next one. Errors are the largest over equidistant times, common
//! to all runs. Work is counted, not timed, so that a report is the same on every machine;
//! `cargo xtask bench` takes the seconds of the listed runs.
//!
//! ```toml
//! [work-precision]
//! solution = "midpoint-coupled.toml"   # a convergence study beside this one; or scene = "...", with t_end and
//!                                      # two tables [[reference]]; or vibration = [0, 1], with zeta and t_end
//! observations = 16                    # times at which errors are measured
//!
//! [[reference]]                        # two runs by dG that agree within a tenth of the smallest targets
//! nodes = [0.0, 1.0]
//! runs = [36, 4, 0.003]                # degree p, degree q, largest step
//!
//! [[runs]]
//! method = "midpoint"                  # fixed-point, fixed-point-once, euler-crank-nicolson, richardson, midpoint
//! grading = 1.5                        # optional: nodes 1 - (1 - i/n)^1.5, small elements at the free end
//! runs = [[16, 128], [32, 256]]        # elements and steps, a multiple of the observations; at most 1e6 element-steps
//!                                      # in the quick tier, 1e7 in the full one
//! [[runs]]
//! method = "dg"
//! nodes = [0.0, 0.9, 1.0]
//! runs = [[12, 2, 0.02]]               # degree p, degree q, largest step
//!
//! [[target]]
//! norm = "tip"                         # or theorem-3.4
//! error = 1e-3
//! methods = ["euler-crank-nicolson", "midpoint", "dg"]   # all that reach it, the dearest first
//! times = [10, 1.5]                    # at least so many times dearer than the next one
//! ```

pub mod compared;
mod file;
mod judge;
pub mod method;
mod neighbours;

use std::sync::OnceLock;

use crate::kinds::prelude::*;
use crate::{
    error::{ErrorMeasure, Errors, Evaluator, polynomials::Polynomials},
    run::family::Family,
};
use method::{Audience, Clock, Degrees, Measurement, NamedMethod, Resolution, Trial, no_clock};
use thermobeam::{dg, solve::Solver};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "work-precision",
    schema: schema::<file::WorkPrecisionFile>,
    read: WorkPrecision::read_study,
    why: "Every method pays for a smaller error with more work. At each error that two methods both reach, the ratio of their work \
          is measured. High orders pay little more for ten digits than for five.",
    judged: "Work is counted, not timed. The ratios must be at least those claimed, and every method that reaches a target must be \
             compared. Of each run the neighbours are made, an eighth coarser in h or dt, or a degree lower: none may be cheaper.",
    failure: "A method has become more expensive for the same error, it does not reach an error any more, or a listed run is not \
              the cheapest.",
};

/// A reference is so many times better than the smallest target.
const BETTER: f64 = 10.0;

/// An error, and the claimed order of the methods that reach it.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// The measure of the error.
    pub measure: ErrorMeasure,
    /// The error.
    pub error: f64,
    /// The methods that reach it, the dearest first.
    pub methods: Vec<NamedMethod>,
    /// Least ratio of the work of each method to that of the next one.
    pub times: Vec<f64>,
}

/// A study of this kind.
pub struct WorkPrecision {
    family: Family,
    observations: usize,
    /// Runs by dG that serve as reference; none for an exact solution.
    reference: Option<[Trial; 2]>,
    /// The reference, computed once by the first thread that needs it, and the distance of the two
    /// runs.
    computed: OnceLock<Result<(Polynomials, Errors), CaseFailure>>,
    trials: Vec<Trial>,
    targets: Vec<Target>,
}

impl WorkPrecision {
    /// The methods of the study, in the order of the table.
    pub(crate) fn methods(&self) -> impl Iterator<Item = NamedMethod> {
        method::METHODS
            .into_iter()
            .filter(|method| self.trials.iter().any(|trial| trial.method == *method))
    }

    /// Whether a run is in the file; the others are neighbours.
    fn is_listed(&self, trial: &Trial) -> bool {
        self.trials.contains(trial)
    }

    /// The listed runs.
    pub fn trials(&self) -> &[Trial] {
        &self.trials
    }

    /// The targets.
    pub fn targets(&self) -> &[Target] {
        &self.targets
    }

    fn polynomials(&self, trial: &Trial) -> Result<Polynomials, CaseFailure> {
        let Resolution::Dg { mesh, degrees } = &trial.resolution else {
            return Err(CaseFailure::new("a reference is a run by dG"));
        };
        let mut levels = vec![];
        let audience = Audience::Levels(&mut levels);
        let (space, _) = degrees.run(&self.family, mesh, self.observations, audience, no_clock)?;
        Ok(Polynomials::new(space, levels))
    }

    /// The reference and the distance of its two runs; `None` if there is an exact solution.
    ///
    /// # Errors
    /// [`CaseFailure`] of a run that does not finish.
    fn reference(&self) -> Result<Option<&(Polynomials, Errors)>, CaseFailure> {
        let Some([one, other]) = &self.reference else {
            return Ok(None);
        };
        let computed = self.computed.get_or_init(|| {
            let best = self.polynomials(one)?;
            let distance = best.distance(&self.polynomials(other)?);
            Ok((best, distance))
        });
        computed.as_ref().map(Some).map_err(Clone::clone)
    }

    /// The reference, if its runs agree well enough for the targets of the study.
    fn agreed(&self) -> Result<Option<&Polynomials>, CaseFailure> {
        let Some((reference, distance)) = self.reference()? else {
            return Ok(None);
        };
        for target in &self.targets {
            let apart = distance.of(target.measure);
            let allowed = target.error / BETTER;
            if !(apart <= allowed) {
                return Err(CaseFailure::new(format!(
                    "the two references are {apart:.1e} apart in {}, allowed {allowed:.1e}",
                    target.measure.name()
                )));
            }
        }
        Ok(Some(reference))
    }

    /// Makes a run and measures its errors.
    ///
    /// # Errors
    /// [`CaseFailure`] of a run that does not finish.
    pub fn measure(&self, trial: &Trial, clock: Clock) -> Result<Measurement, CaseFailure> {
        let reference = self.agreed()?;
        match &trial.resolution {
            Resolution::OneStep(scheme, grid) => {
                let on = self.family.on_nodes(grid.mesh()?);
                let space = dg::Space::new(grid.mesh()?, 1)?;
                let evaluator = Evaluator::new(&self.family, &space, reference)?;
                let times = [grid.steps, self.observations];
                scheme.run(&on, Some(evaluator), times, clock)
            }
            Resolution::Dg { mesh, degrees } => {
                let audience = Audience::Errors(reference);
                let run = degrees.run(&self.family, mesh, self.observations, audience, clock)?;
                Ok(run.1)
            }
        }
    }

    /// Makes a run without looking at it: for the seconds of short runs, which looking would
    /// lengthen.
    ///
    /// # Errors
    /// [`CaseFailure`] of a run that does not finish.
    pub fn seconds(&self, trial: &Trial, clock: Clock) -> Result<f64, CaseFailure> {
        let measurement = match &trial.resolution {
            Resolution::OneStep(scheme, grid) => {
                let on = self.family.on_nodes(grid.mesh()?);
                scheme.run(&on, None, [grid.steps, 1], clock)?
            }
            Resolution::Dg { mesh, degrees } => {
                let run = degrees.run(&self.family, mesh, 1, Audience::Nobody, clock)?;
                run.1
            }
        };
        Ok(measurement.seconds)
    }
}

impl Trial {
    /// The work of a run in node-solves, roughly.
    fn cost(&self, t_end: f64) -> f64 {
        match &self.resolution {
            Resolution::OneStep(scheme, grid) => {
                // The fixed point factorises in each of several iterations.
                let passes = if scheme.solver == Solver::FixedPoint {
                    8.0
                } else {
                    1.0
                };
                (grid.elements * grid.steps) as f64 * scheme.runs() * passes
            }
            Resolution::Dg { mesh, degrees } => {
                let Degrees { p, q, dt } = *degrees;
                60.0 * (mesh.elements() * p * (q + 1)) as f64 * t_end / dt
            }
        }
    }
}

impl Kind for WorkPrecision {
    type Data = Trial;
    type Found = Measurement;

    fn cases(&self) -> Vec<Case<Trial>> {
        let near = self
            .trials
            .iter()
            .flat_map(|trial| trial.neighbours(self.observations));
        let mut cases: Vec<Case<Trial>> = vec![];
        for trial in self.trials.iter().cloned().chain(near) {
            if cases.iter().any(|case| case.data == trial) {
                continue;
            }
            let label = format!("{}, {}", trial.method.name, trial.resolution);
            let cost = trial.cost(self.family.t_end);
            let parts = self.family.parts().on(trial.resolution.is_uniform());
            let parts = match &trial.resolution {
                Resolution::OneStep(by, _) => parts.by(by.scheme, by.solver),
                Resolution::Dg { .. } => parts.by_dg(),
            };
            cases.push(Case::new(label, cost, trial).described(&parts));
        }
        cases
    }

    fn run(&self, trial: &Trial) -> Result<Measurement, CaseFailure> {
        let measurement = self.measure(trial, no_clock);
        // A neighbour may be too coarse for its solver.
        if self.is_listed(trial) {
            return measurement;
        }
        self.agreed()?;
        Ok(measurement.unwrap_or(Measurement::UNFINISHED))
    }

    fn judge(&self, ran: &[Ran<Trial, Measurement>]) -> Outcome {
        judge::judge(self, ran)
    }
}
