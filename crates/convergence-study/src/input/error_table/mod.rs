//! Convergence rates of any code: a table of step sizes and errors, judged by the rule of
//! [`verdict`](crate::judge::verdict).
//!
//! ```text
//! # comments above the table are skipped
//! h,     L2,      H1
//! 0.1,   1.01e-3, 2.12e-2
//! 0.05,  2.51e-4, 1.03e-2
//! 0.025, 6.26e-5, 5.20e-3
//! ```
//!
//! Every number of the text is accounted for. A column is judged unless its name, or arithmetic
//! that can be checked, says that it is something else: nothing is left out because its numbers look
//! wrong, for a lost order looks just like that. Reading has three stages, of which none knows the
//! next:
//!
//! 1. Grids: rows of cells below names (`text`, `heads`), names with their numbers (`pairs`), or a
//!    row for each variable (`turned`), in a text without markup (`cleaned`, `markup`).
//! 2. Parts: a text is cut where another table may begin (`parts`), a grid in columns (`columns`) by
//!    those of groups and where a step returns (`groups`).
//! 3. Columns: which one is the step (`step`), and what the others hold (`contents`).
//!
//! [`RateTable::reading`] says in a line how a table was read, [`RateTable::doubts`] why none of it
//! should pass (`failed_run`, `doubt`), and lines that belong to no table are counted (`outside`). A
//! level without a result is NaN, and its column fails.

mod cleaned;
mod columns;
mod contents;
mod digits;
mod doubt;
mod failed_run;
mod families;
mod frame;
mod grid;
mod groups;
mod heads;
mod limits;
mod line;
mod markup;
pub(crate) mod names;
mod number;
mod original;
mod outside;
mod pairs;
mod parameters;
mod parts;
mod reader;
mod roles;
mod stated;
mod step;
mod text;
mod turned;

use std::io;
use std::path::Path;

use serde::Deserialize;

use super::advice::{Argument, ArgumentValue, Setting, Surface};
use crate::input::{self, InputError};

pub use digits::Column;
pub use doubt::Doubt;
pub use frame::{FrameCell, FrameColumn};
use original::Original;
pub use parameters::Parameter;
pub(crate) use parameters::is_degree;

/// A table of errors that was read.
///
/// ```
/// use convergence_study::{Choice, Claim, Floor, RateTable};
///
/// let text = "h, L2, rate\n0.1, 1.01e-3, -\n0.05, 2.51e-4, 2.01\n0.025, 6.26e-5, 2.00\n";
/// let table = RateTable::parse_with(text, "errors.csv", &Choice::default())?;
/// let column = table.column("L2").expect("its name");
/// let rate = column.judge(&Claim::new(2.0, 0.25), Floor::NONE);
/// assert!(rate.verdict.is_pass(), "{}", rate.reason);
/// assert_eq!(table.not_errors[0].column, "rate");
/// # Ok::<(), convergence_study::InputError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RateTable {
    /// The step: the name of its column, `cells^(-1/2)` if the column counts, `2^(-level)` if it
    /// numbers the levels.
    pub step: String,
    /// The errors.
    pub columns: Vec<Column>,
    /// The columns chosen as values.
    pub values: Vec<Column>,
    /// Columns that are not errors.
    pub not_errors: Vec<NotError>,
    /// How the table was read: the step, errors, values, and what was left out with the reason.
    pub reading: String,
    /// Whether numbers, not names, identified the step.
    pub is_guessed: bool,
    /// Numbers that all its rows share, such as the degree of the elements.
    pub parameters: Vec<Parameter>,
    /// Why none of its columns should pass.
    pub doubts: Vec<Doubt>,
}

/// A column that is not an error.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NotError {
    /// Its name.
    pub column: String,
    /// Why it is not an error.
    pub because: String,
    /// Whether arithmetic shows this, and not the name of the column alone.
    pub is_checked: bool,
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
    /// Columns with an order claimed by name: none of them can be the step.
    #[serde(skip)]
    pub claimed: Vec<String>,
    /// Dimension D > 0 of what a count counts: h = count^(-1/D).
    pub dim: Option<f64>,
    /// Ratio R > 1 of the steps of consecutive levels: h = R^(-level).
    pub ratio: Option<f64>,
}

/// A choice that reads a table which was refused.
#[derive(Debug, Clone, PartialEq)]
pub struct Offer {
    /// The choice that was made, changed.
    pub choice: Choice,
    /// What tells it from other offers, or when it is right; may be empty.
    pub comment: &'static str,
}

impl RateTable {
    /// Reads a file, with the columns that `choice` selects; `-` is standard input.
    ///
    /// # Errors
    /// [`InputError`] with line, column and the name of the table's column; also for a choice of
    /// missing columns.
    pub fn read_with(path: impl AsRef<Path>, choice: &Choice) -> Result<Self, InputError> {
        let (text, file_name) = text_and_name(path.as_ref())?;
        Self::parse_with(&text, &file_name, choice)
    }

    /// Reads a table from `text`; messages name `file_name`.
    ///
    /// # Errors
    /// As [`RateTable::read_with`], except for the file; also for several tables.
    pub fn parse_with(text: &str, file_name: &str, choice: &Choice) -> Result<Self, InputError> {
        roles::read(Original::of_text(&cleaned::plain(text), file_name), choice)
    }

    /// Reads all tables of a file, each with its heading, which is empty for an only one; `-` is
    /// standard input.
    ///
    /// # Errors
    /// As [`RateTable::read_with`].
    pub fn read_all_with(
        path: impl AsRef<Path>,
        choice: &Choice,
    ) -> Result<Vec<(String, Self)>, InputError> {
        let (text, file_name) = text_and_name(path.as_ref())?;
        Self::parse_all_with(&text, &file_name, choice)
    }

    /// Reads all tables of `text`; messages name `file_name`.
    ///
    /// What stands between some rows, but not between all, parts a text: a heading, a ruler, names
    /// that come again, a blank line. So does a step that returns, and a column such as `p` or
    /// `method`: two tables that are read as one could pass where one of them fails.
    ///
    /// # Errors
    /// As [`RateTable::parse_with`], about the first table that cannot be read, if another choice
    /// reads it or the text has no other; otherwise it is a doubt of the first table that can.
    pub fn parse_all_with(
        text: &str,
        file_name: &str,
        choice: &Choice,
    ) -> Result<Vec<(String, Self)>, InputError> {
        let text = cleaned::plain(text);
        let mut tables = roles::read_all(Original::of_text(&text, file_name), choice)?;
        if let [(heading, _)] = &mut tables[..] {
            heading.clear();
        }
        Ok(tables)
    }

    /// The column of errors of this name, with or without its unit.
    pub fn column(&self, name: &str) -> Option<&Column> {
        let names = self.columns.iter().map(|column| column.name.as_str());
        self.columns.get(names::position(names, name)?)
    }
}

/// The text of a file, and its name in messages.
fn text_and_name(path: &Path) -> Result<(String, String), InputError> {
    const STANDARD_INPUT: &str = "standard input";
    if path == Path::new("-") {
        let text = input::read_from(STANDARD_INPUT, io::stdin().lock())?;
        return Ok((text, STANDARD_INPUT.to_owned()));
    }
    Ok((input::read_text(path)?, path.display().to_string()))
}

impl Choice {
    /// What is chosen about the reading.
    pub fn settings(&self) -> Vec<Setting> {
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
    pub(super) fn line(&self, surface: &dyn Surface) -> Option<String> {
        let call = surface.call(&self.choice.settings())?;
        Some(match self.comment {
            "" => format!("\n  {call}"),
            comment => format!("\n  {call}  # {comment}"),
        })
    }
}
