//! How a run ends.

use thermobeam::dg;
use thermobeam::error::StepFailure;

use crate::run::driver::RunError;

/// How a run ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// After its last step.
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

    /// The end of a run at a step that failed.
    pub fn of(failure: &StepFailure) -> Self {
        match failure {
            StepFailure::Indefinite { .. } => End::Indefinite,
            StepFailure::Diverged { .. } | StepFailure::IterationLimit { .. } => End::IterationLimit,
            StepFailure::NonFinite { .. } => End::NotFinite,
        }
    }

    /// The same by the scheme of any order; `None` for failures to find a contact event, which one-step schemes do not have.
    fn of_any_order(failure: &dg::StepFailure) -> Option<Self> {
        match failure {
            dg::StepFailure::Indefinite { .. } => Some(End::Indefinite),
            dg::StepFailure::Diverged { .. } | dg::StepFailure::IterationLimit { .. } => Some(End::IterationLimit),
            dg::StepFailure::NonFinite { .. } => Some(End::NotFinite),
            _ => None,
        }
    }

    /// The end of a run that a step ended; `None` for other ends.
    pub(crate) fn of_run(failure: &RunError) -> Option<Self> {
        match failure {
            RunError::Step(error) => Some(Self::of(&error.failure)),
            RunError::DgStep(error) => Self::of_any_order(&error.failure),
            _ => None,
        }
    }

    /// Its name in study files and reports.
    pub fn name(self) -> &'static str {
        match self {
            End::Answer => "answer",
            End::Indefinite => "indefinite",
            End::IterationLimit => "iteration-limit",
            End::NotFinite => "not-finite",
        }
    }
}
