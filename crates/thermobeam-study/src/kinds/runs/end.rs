//! How a run ends: with an answer, or at a step that fails.

use crate::kinds::prelude::*;

/// How a run ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum End {
    /// After its last step.
    #[default]
    Answer,
    /// At a step whose operator is not definite.
    Indefinite,
    /// At a step whose iteration diverges or needs too many iterations.
    IterationLimit,
    /// At a step with numbers that are not finite.
    NotFinite,
}

impl End {
    /// All ends, with their names in study files and reports.
    pub const ALL: [(&str, End); 4] = [
        ("answer", End::Answer),
        ("indefinite", End::Indefinite),
        ("iteration-limit", End::IterationLimit),
        ("not-finite", End::NotFinite),
    ];

    /// The end of a run.
    ///
    /// # Errors
    /// The failure, if it is not a failed step of a one-step scheme.
    pub(crate) fn of(failure: Option<&RunError>) -> Result<Self, RunError> {
        let Some(run) = failure else {
            return Ok(End::Answer);
        };
        let RunError::Step(StepError { failure, .. }) = run else {
            return Err(run.clone());
        };
        match failure {
            StepFailure::Indefinite { .. } => Ok(End::Indefinite),
            StepFailure::Diverged { .. } | StepFailure::IterationLimit { .. } => {
                Ok(End::IterationLimit)
            }
            StepFailure::NonFinite { .. } => Ok(End::NotFinite),
            _ => Err(run.clone()),
        }
    }

    /// Its name in study files and reports.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].0
    }
}
