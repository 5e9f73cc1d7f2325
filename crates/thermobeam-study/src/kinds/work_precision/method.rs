//! The methods compared, and one run of each.

use crate::error::evaluator::{Evaluator, combine};
use crate::run::family::{OnMesh, Spent};
use convergence_study::study::CaseFailure;
use convergence_study::text::number::max_or_nan;
use thermobeam::scheme::{EULER_CRANK_NICOLSON, MIDPOINT, Scheme};
use thermobeam::solve::{Level, Settings, Solver};

/// A way to the solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Method {
    /// Name in study files, tables and figures.
    pub name: &'static str,
    /// The time scheme.
    pub scheme: Scheme,
    /// How a step is solved.
    pub solver: Solver,
    /// Two runs, with dt and dt/2, combined to `2 u_{dt/2} - u_dt`.
    pub extrapolated: bool,
}

/// All methods; a new one is a row.
pub const METHODS: [Method; 4] = [
    Method { name: "fixed-point", scheme: EULER_CRANK_NICOLSON, solver: Solver::FixedPoint, extrapolated: false },
    Method { name: "euler-crank-nicolson", scheme: EULER_CRANK_NICOLSON, solver: Solver::Newton, extrapolated: false },
    Method { name: "richardson", scheme: EULER_CRANK_NICOLSON, solver: Solver::Newton, extrapolated: true },
    Method { name: "midpoint", scheme: MIDPOINT, solver: Solver::Newton, extrapolated: false },
];

/// A run: largest errors over the times of observation, and its cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// In the order of [`crate::error::evaluator::ErrorMeasure::ALL`].
    pub errors: [f64; 3],
    /// The cost, without the measuring.
    pub spent: Spent,
}

impl Method {
    /// Steps of unit size per step of the coarse run: 3 where a second run goes beside it with half the step.
    pub fn runs(&self) -> f64 {
        if self.extrapolated { 3.0 } else { 1.0 }
    }

    /// Runs `steps` steps, measured at `observations` equidistant times, of which `steps` must be a multiple.
    ///
    /// # Errors
    /// [`CaseFailure`] with the solver's own words.
    pub fn run(
        &self,
        on: &OnMesh<'_>,
        evaluator: &mut Evaluator<'_>,
        [steps, observations]: [usize; 2],
        tolerance: f64,
    ) -> Result<Measurement, CaseFailure> {
        let settings = Settings { solver: self.solver, tolerance, max_iterations: 1000, ..Settings::default() };
        let mut run = on.start(self.scheme, settings, steps)?;
        let mut half = if self.extrapolated { Some(on.start(self.scheme, settings, 2 * steps)?) } else { None };
        let mut errors = [0.0_f64; 3];
        for index in 0..observations {
            run.advance(steps / observations)?;
            let extrapolated: Option<Level> = match &mut half {
                None => None,
                Some(half) => {
                    half.advance(2 * steps / observations)?;
                    Some(combine(half.level(), run.level(), 2.0))
                }
            };
            let t = run.t();
            let found = match &extrapolated {
                Some(level) => evaluator.measure(level, index, t),
                None => evaluator.measure(run.level(), index, t),
            };
            for (worst, error) in errors.iter_mut().zip(found) {
                *worst = max_or_nan(*worst, error);
            }
        }
        let mut spent = run.spent();
        if let Some(half) = half {
            spent += half.spent();
        }
        Ok(Measurement { errors, spent })
    }
}
