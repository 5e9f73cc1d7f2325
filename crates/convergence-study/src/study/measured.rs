//! A number that a study found, and everything that is said of it.
//!
//! Check, cell of a table, entry of the baseline, completion and headline are `views` of one list
//! of [`Measured`]: a number is stated once.

use super::must::Must;

/// How a number is written in its table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Shown {
    /// With so many digits after the point.
    Fixed(usize),
    /// With so many digits after the first.
    Scientific(usize),
    /// By these words.
    Words(String),
}

/// How the baseline guards a number.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Recorded {
    /// Its name, which no other guarded number of the study has.
    pub(crate) name: String,
    /// Relative change tolerated.
    pub(crate) tolerance: f64,
}

/// A number that a study found.
///
/// ```
/// use convergence_study::{Must, measured};
///
/// let drift = measured("n = 64", "drift of the energy", 3e-13)
///     .must_be(Must::AtMost(1e-12))
///     .recorded("drift", 1e-2);
/// assert_eq!((drift.text(), drift.holds()), ("3.00e-13".to_owned(), Some(true)));
/// // No claim is met by a number that is missing.
/// assert_eq!(measured("", "drift", None).must_be(Must::AtMost(1.0)).holds(), Some(false));
/// ```
#[derive(Debug, Clone, PartialEq)]
#[must_use = "a number counts in the sheet that holds it"]
pub struct Measured {
    /// The run, time or level, which is a row of its table; empty for the study as a whole.
    pub case: String,
    /// The other run of a ratio or a difference: either may be the cause of a failure.
    pub against: Option<String>,
    /// What it is: a column of its table.
    pub name: String,
    /// The number; `None` if there is none, which is a dash and meets no claim.
    pub value: Option<f64>,
    /// How it is written.
    pub(crate) shown: Shown,
    /// Whether it stands in no table.
    pub(crate) is_hidden: bool,
    /// What it must be; without a claim it is information.
    pub claim: Option<Must>,
    /// The claim in a sentence, in place of the name and what the number must be.
    pub(crate) statement: Option<String>,
    /// How the baseline guards it, if it does.
    pub(crate) record: Option<Recorded>,
}

/// A number of a case, written with three digits, without a claim.
pub fn measured(
    case: impl Into<String>,
    name: impl Into<String>,
    value: impl Into<Option<f64>>,
) -> Measured {
    Measured {
        case: case.into(),
        against: None,
        name: name.into(),
        value: value.into(),
        shown: Shown::Scientific(2),
        is_hidden: false,
        claim: None,
        statement: None,
        record: None,
    }
}

impl Measured {
    /// Written with so many digits after the point.
    pub fn fixed(self, digits: usize) -> Self {
        let shown = Shown::Fixed(digits);
        Self { shown, ..self }
    }

    /// Written with so many digits after the first.
    pub fn scientific(self, digits: usize) -> Self {
        let shown = Shown::Scientific(digits);
        Self { shown, ..self }
    }

    /// Written by these words.
    pub fn words(self, words: impl Into<String>) -> Self {
        let shown = Shown::Words(words.into());
        Self { shown, ..self }
    }

    /// In no table.
    pub fn hidden(self) -> Self {
        let is_hidden = true;
        Self { is_hidden, ..self }
    }

    /// Compared with another run.
    pub fn against(self, case: impl Into<String>) -> Self {
        let against = Some(case.into());
        Self { against, ..self }
    }

    /// It must be this.
    pub fn must_be(self, claim: impl Into<Option<Must>>) -> Self {
        let claim = claim.into();
        Self { claim, ..self }
    }

    /// Its claim in a sentence, such as that of a file.
    pub fn stated(self, statement: impl Into<String>) -> Self {
        let statement = Some(statement.into());
        Self { statement, ..self }
    }

    /// The baseline guards it under `case: name`.
    ///
    /// * `tolerance`: relative change tolerated.
    pub fn recorded(self, name: &str, tolerance: f64) -> Self {
        let name = self.in_case(name);
        self.recorded_as(name, tolerance)
    }

    /// The baseline guards it under a name without the case.
    ///
    /// * `tolerance`: relative change tolerated.
    pub fn recorded_as(self, name: impl Into<String>, tolerance: f64) -> Self {
        let name = name.into();
        let record = Some(Recorded { name, tolerance });
        Self { record, ..self }
    }

    /// As it is written; a dash if it is missing.
    pub fn text(&self) -> String {
        match (&self.shown, self.value) {
            (Shown::Words(words), _) => words.clone(),
            (_, None) => "-".to_owned(),
            (Shown::Fixed(digits), Some(value)) => format!("{value:.digits$}"),
            (Shown::Scientific(digits), Some(value)) => format!("{value:.digits$e}"),
        }
    }

    /// Whether it is what it must be; `None` without a claim.
    pub fn holds(&self) -> Option<bool> {
        let claim = self.claim?;
        Some(self.value.is_some_and(|value| claim.holds(value)))
    }

    /// Whether there is a number, which is NaN or infinite.
    pub(super) fn is_broken(&self) -> bool {
        self.value.is_some_and(|value| !value.is_finite())
    }

    /// Names of those that are NaN or infinite, for
    /// [`Check::completion`](super::Check::completion).
    pub fn not_finite(numbers: &[Self]) -> Vec<String> {
        let broken = numbers.iter().filter(|one| one.is_broken());
        broken.map(|one| one.name.clone()).collect()
    }

    /// `case: name`; the name alone for the study as a whole.
    pub(crate) fn in_case(&self, name: &str) -> String {
        match self.case.as_str() {
            "" => name.to_owned(),
            case => format!("{case}: {name}"),
        }
    }
}

/// Numbers that belong together: a table with a row for each case, unless all are hidden.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sheet {
    /// What the table shows.
    pub title: String,
    /// What a case is: the head of the first column.
    pub first: String,
    /// The numbers, in the order of rows and columns.
    pub measured: Vec<Measured>,
}

impl Sheet {
    /// * `first`: what a case is.
    pub fn new(
        title: impl Into<String>,
        first: impl Into<String>,
        measured: impl IntoIterator<Item = Measured>,
    ) -> Self {
        Self {
            title: title.into(),
            first: first.into(),
            measured: measured.into_iter().collect(),
        }
    }

    /// Numbers that stand in no table.
    pub fn untabled(measured: impl IntoIterator<Item = Measured>) -> Self {
        let measured = measured.into_iter().map(Measured::hidden);
        Self::new("", "", measured)
    }
}
