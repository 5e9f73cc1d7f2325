//! One step by the fixed point, and the factors predicted for it.

use convergence_study::study::CaseFailure;
use thermobeam::contraction::{contact_contraction, coupling_contraction};
use thermobeam::error::StepFailure;
use thermobeam::scheme::EULER_CRANK_NICOLSON;
use thermobeam::simulation::{Problem, Stepping};
use thermobeam::solve::{Settings, Solver};

use crate::run::driver::{Driver, RunError};

/// How a step by the fixed point ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedPointStep {
    /// Whether the increment fell below the tolerance.
    pub converged: bool,
    /// Iterations done.
    pub iterations: usize,
    /// Ratio of the last two increments, where there were two; infinite where the iterates overflowed or the operator
    /// was not definite.
    pub contraction: Option<f64>,
}

impl FixedPointStep {
    /// The first step of the problem, with at most so many iterations, to an increment below `tolerance`.
    ///
    /// # Errors
    /// [`CaseFailure`] where the solver refuses the problem or time is up; that the iteration fails is a result.
    pub(super) fn run(problem: &Problem, dt: f64, tolerance: f64, iterations: usize) -> Result<Self, CaseFailure> {
        let settings =
            Settings { solver: Solver::FixedPoint, tolerance, max_iterations: iterations, ..Settings::default() };
        let stepping = Stepping { scheme: EULER_CRANK_NICOLSON, settings, dt, loaded: false };
        let error = match Driver::new(problem.clone(), stepping)?.advance(|_, _| ()) {
            Ok(report) => {
                return Ok(Self { converged: true, iterations: report.iterations, contraction: report.contraction });
            }
            Err(RunError::Step(error)) => error,
            Err(other) => return Err(other.into()),
        };
        let (iterations, contraction) = match error.failure {
            StepFailure::Diverged { iterations, contraction, .. }
            | StepFailure::IterationLimit { iterations, contraction, .. } => (iterations, contraction),
            StepFailure::NonFinite { iterations, .. } => (iterations, f64::INFINITY),
            StepFailure::Indefinite { .. } => (0, f64::INFINITY),
        };
        Ok(Self { converged: false, iterations, contraction: Some(contraction) })
    }
}

/// The factors α of the contact and γ of the coupling, for a step with the mean axial force `n_value`; infinite where the
/// operator is not definite.
pub(super) fn factors(problem: &Problem, dt: f64, n_value: f64) -> [f64; 2] {
    let lengths: Vec<f64> = problem.mesh.lengths().collect();
    let (beam, scheme) = (&problem.beam, &EULER_CRANK_NICOLSON);
    let contact = |obstacles| contact_contraction(beam, &obstacles, &lengths, scheme, dt, n_value);
    [problem.obstacles.map_or(0.0, contact), coupling_contraction(beam, &lengths, scheme, dt, n_value)]
}
