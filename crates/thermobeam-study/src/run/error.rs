//! Why a run ends before its time, by whatever method.

use convergence_study::run::time_limit::TimeUp;
use thermobeam::error::{SetupError, StepError};
use thermobeam::mesh::MeshError;
use thiserror::Error;

/// Why a problem was not stepped to its end.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RunError {
    /// The solver refuses the problem.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A step failed.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A step raised the energy, broke its balance, or led to a state that is not finite.
    #[error("step {step} (from t = {t}, length {dt:e}): {unsound}")]
    Unsound {
        /// Number of the step, counted from 1.
        step: usize,
        /// The time at which it started.
        t: f64,
        /// Its length.
        dt: f64,
        /// What it did.
        unsound: Unsound,
    },
    /// The time limit of the case was reached.
    #[error(transparent)]
    TimeUp(#[from] TimeUp),
}

impl RunError {
    /// Of step number `step`, which ended at `t`.
    pub(super) fn unsound(step: usize, t: f64, dt: f64, unsound: Unsound) -> Self {
        Self::Unsound { step, t: t - dt, dt, unsound }
    }
}

impl From<MeshError> for RunError {
    fn from(error: MeshError) -> Self {
        Self::Setup(error.into())
    }
}

/// Why the numbers of a run mean nothing, although every step of it was done.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Unsound {
    /// The energy is infinite or NaN.
    #[error("the energy is {0}: {EXPECTED}")]
    NotFinite(f64),
    /// The energy rose by this.
    #[error("the energy rose by {0:.3e} in a step, where no exactly solved step raises it: {EXPECTED}")]
    Rise(f64),
    /// The balance of the energy is violated by this.
    #[error(
        "the balance of the energy is violated by {0:.3e} in a step, where every exactly solved step keeps it: {EXPECTED}"
    )]
    Imbalance(f64),
}

const EXPECTED: &str =
    "expected coefficients of less extreme size, or a smaller tolerance; the numbers of this run mean nothing";
