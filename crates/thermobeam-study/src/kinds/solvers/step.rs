//! One step by the fixed point, and the factors by which it should contract.

use crate::kinds::prelude::*;
use crate::run::{RunError, driver::Driver, run_to};
use thermobeam::{
    error::StepFailure,
    one_step::{Problem, Stepping},
    scheme::EULER_CRANK_NICOLSON,
    solve::{Settings, Solver, Stopping},
};

/// Increment at which the iteration counts as converged: large against round-off, so that the last
/// ratio is a contraction.
const TOLERANCE: f64 = 1e-10;

/// A step by the fixed point: the prediction, and the result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedPointStep {
    /// The time step.
    pub dt: f64,
    /// Predicted factor of the contact; infinite if its operator is not definite.
    pub alpha: f64,
    /// Predicted factor of the coupling between rotation and displacement; infinite if its operator
    /// is not definite.
    pub gamma: f64,
    /// Whether the increment fell below the tolerance.
    pub converged: bool,
    /// Iterations done.
    pub iterations: usize,
    /// Ratio of the last two increments, if there were two; infinite if the iterates overflowed or
    /// the operator was not definite.
    pub contraction: Option<f64>,
}

impl FixedPointStep {
    /// The first step of the problem, with at most `max_iterations` iterations.
    ///
    /// * `n_value`: mean axial force for the predicted factors.
    ///
    /// # Errors
    /// [`CaseFailure`] if the solver refuses the problem or the time is up; divergence of the
    /// iteration is a result.
    pub(super) fn run(
        problem: &Problem,
        dt: f64,
        n_value: f64,
        max_iterations: usize,
    ) -> Result<Self, CaseFailure> {
        let stopping = Stopping::Converged {
            tolerance: TOLERANCE,
            max_iterations,
        };
        let stepping = by_fixed_point(dt, stopping);
        let mut driver = Driver::new(problem.clone(), stepping)?;
        let mut reached = (0, None);
        let outcome = run_to(&mut driver, dt, |_, report| {
            reached = (report.iterations, report.contraction);
        });
        let failure = match outcome {
            Ok(()) => None,
            Err(RunError::Step(error)) => Some(error.failure),
            Err(other) => return Err(other.into()),
        };
        let converged = failure.is_none();
        let (iterations, contraction) = match failure {
            None => reached,
            Some(
                StepFailure::Diverged {
                    iterations,
                    contraction,
                    ..
                }
                | StepFailure::IterationLimit {
                    iterations,
                    contraction,
                    ..
                },
            ) => (iterations, Some(contraction)),
            Some(StepFailure::NonFinite { iterations, .. }) => (iterations, Some(f64::INFINITY)),
            Some(_) => (0, Some(f64::INFINITY)),
        };
        let [alpha, gamma] = factors(problem, dt, n_value);
        Ok(Self {
            dt,
            alpha,
            gamma,
            converged,
            iterations,
            contraction,
        })
    }
}

/// Steps of the paper's algorithm, without loads.
pub(super) fn by_fixed_point(dt: f64, stopping: Stopping) -> Stepping {
    Stepping {
        scheme: EULER_CRANK_NICOLSON,
        settings: Settings {
            solver: Solver::FixedPoint,
            stopping,
            ..Settings::default()
        },
        dt,
        loaded: false,
    }
}

/// The factors α of the contact and γ of the coupling, for a step with the mean axial force
/// `n_value`; infinite if the operator is not definite.
pub(super) fn factors(problem: &Problem, dt: f64, n_value: f64) -> [f64; 2] {
    let case = problem.case(EULER_CRANK_NICOLSON, dt);
    [
        case.contact_contraction(n_value),
        case.coupling_contraction(n_value),
    ]
}
