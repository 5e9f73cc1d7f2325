//! The tables `[[case]]` of a study, and the ways in which their runs end.

use convergence_study::file::{Choices, Refusal};

use crate::run::RunError;
use thermobeam::error::{StepError, StepFailure};

/// The cases of tables `[[case]]`, each with a unique name.
pub(crate) fn named_cases<T, C>(
    tables: Vec<T>,
    new: impl Fn(T) -> Result<C, Refusal>,
    name: impl Fn(&C) -> &str,
) -> Result<Vec<C>, Refusal> {
    let cases = Refusal::of_each("case", tables, new)?;
    for (place, case) in cases.iter().enumerate() {
        let mut earlier = cases[..place].iter();
        if earlier.any(|earlier| name(earlier) == name(case)) {
            let found = format!("a second \"{}\"", name(case));
            let allowed = "a name that no other case has";
            return Err(Refusal::new(format!("case[{place}].name"), found, allowed));
        }
    }
    if cases.is_empty() {
        return Err(Refusal::written("case", "at least one table [[case]]"));
    }
    Ok(cases)
}

impl Choices for End {
    type Value = Self;

    fn all() -> Vec<(&'static str, Self)> {
        Self::ALL.to_vec()
    }
}

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
    /// After its last step, with a balance of the energy that is open: a study of the energy claims
    /// it.
    Unbalanced,
}

impl End {
    /// Those of a run that a step has ended.
    pub const FAILURES: [End; 3] = [End::Indefinite, End::IterationLimit, End::NotFinite];

    /// All ends, with their names in study files and reports.
    pub const ALL: [(&str, End); 5] = [
        ("answer", End::Answer),
        ("indefinite", End::Indefinite),
        ("iteration-limit", End::IterationLimit),
        ("not-finite", End::NotFinite),
        ("unbalanced", End::Unbalanced),
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
            // An entry of the matrix is too large then: that says nothing of its sign.
            StepFailure::Indefinite { pivot, .. } if !pivot.is_finite() => Ok(End::NotFinite),
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
