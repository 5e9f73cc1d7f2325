//! What a caller chooses of a table, and the choices that a refusal offers.

use std::fmt::{self, Display, Formatter};

use serde::Deserialize;

use crate::input::advice::{Argument, ArgumentValue, Setting, Surface};
use convergence_judge::verdict::Of;

/// Lines of a text, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct LineRange {
    pub(super) first: usize,
    pub(super) last: usize,
}

impl LineRange {
    pub(super) fn has(self, line: usize) -> bool {
        (self.first..=self.last).contains(&line)
    }

    /// The lines up to another one.
    pub(super) fn with(self, line: usize) -> Self {
        Self {
            first: self.first.min(line),
            last: self.last.max(line),
        }
    }
}

impl std::str::FromStr for LineRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text.split_once('-').unwrap_or((text, text));
        match (ends.0.trim().parse(), ends.1.trim().parse()) {
            (Ok(first), Ok(last)) if 0 < first && first <= last => Ok(Self { first, last }),
            _ => Err("expected the first and the last line, from 1, as in 3-9".to_owned()),
        }
    }
}

impl TryFrom<String> for LineRange {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl Display for LineRange {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}-{}", self.first, self.last)
    }
}

/// Which columns of a table to use; by default their names decide, and arithmetic.
///
/// A column is named as in the table, with or without its unit, or by its number from 1.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Choice {
    /// The column of the step, or of the count or level that gives it.
    pub step: Option<String>,
    /// The columns of errors.
    pub columns: Option<Vec<String>>,
    /// Columns of values, which tend to a limit that is not zero.
    pub values: Vec<String>,
    /// Names for all columns, instead of those in the table.
    pub names: Option<Vec<String>>,
    /// The lines of the tables; all without one.
    pub lines: Vec<LineRange>,
    /// Columns with an order claimed by name: none of them can be the step, or be set aside.
    #[serde(skip)]
    pub claimed: Vec<String>,
    /// Dimension D > 0 of what a count counts: h = count^(-1/D).
    pub dim: Option<f64>,
    /// Ratio R > 1 of the steps of consecutive levels: h = R^(-level).
    pub ratio: Option<f64>,
    /// Whether errors fall by a factor for each unit of a count or a degree n: h = exp(-n).
    #[serde(skip)]
    pub by_unit: bool,
    /// Rows with equal steps are samples, which make errors in this way.
    #[serde(skip)]
    pub samples: Option<Of>,
}

/// A choice that reads a table which was refused.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Offer {
    /// The choice that was made, changed.
    pub(crate) choice: Choice,
    /// What tells it from other offers, or when it is right; may be empty.
    pub(crate) comment: &'static str,
}

impl Choice {
    /// This choice, changed.
    ///
    /// * `comment`: when it is right; may be empty.
    pub(super) fn offer(&self, comment: &'static str, change: impl FnOnce(&mut Self)) -> Offer {
        let mut choice = self.clone();
        change(&mut choice);
        Offer { choice, comment }
    }

    /// What is chosen about the reading.
    pub fn settings(&self) -> Vec<Setting> {
        let lines: Vec<String> = self.lines.iter().map(LineRange::to_string).collect();
        let values = [
            (
                Argument::Names,
                self.names.as_deref().and_then(ArgumentValue::names),
            ),
            (Argument::Step, self.step.clone().map(ArgumentValue::Name)),
            (Argument::Dim, self.dim.map(ArgumentValue::Number)),
            (Argument::Ratio, self.ratio.map(ArgumentValue::Number)),
            (
                Argument::Columns,
                self.columns.as_deref().and_then(ArgumentValue::names),
            ),
            (Argument::Values, ArgumentValue::names(&self.values)),
            (Argument::Lines, ArgumentValue::names(&lines)),
        ];
        let mut settings = vec![];
        for (argument, value) in values {
            settings.extend(value.map(|value| Setting { argument, value }));
        }
        settings
    }
}

impl Offer {
    /// The line of a message with the call and the comment; `None` if the surface has no such call.
    pub(crate) fn line(&self, surface: &dyn Surface) -> Option<String> {
        let call = surface.call(&self.choice.settings())?;
        Some(match self.comment {
            "" => format!("\n  {call}"),
            comment => format!("\n  {call}  # {comment}"),
        })
    }
}
