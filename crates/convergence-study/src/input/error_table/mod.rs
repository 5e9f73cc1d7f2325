//! Convergence rates of any code: a table of step sizes and errors, judged by the rule of
//! [`verdict`](crate::judge::verdict).
//!
//! ```text
//! # comments and blank lines are skipped
//! h,     L2,      H1
//! 0.1,   1.01e-3, 2.12e-2
//! 0.05,  2.51e-4, 1.03e-2
//! 0.025, 6.26e-5, 5.20e-3
//! ```
//!
//! Any text with such numbers is read: rows of cells, names before numbers, lists; `TABLES.md` shows which. The
//! numbers decide what a column is, and
//! its name where they leave it open: the step falls, or as a count grows, by regular ratios; errors are positive and
//! fall; rates are those of another
//! column; what tends to a limit is a value. [`RateTable::reading`] says in a line how the table was read. What is in
//! doubt is refused, with the
//! command that works. `NaN` and `inf` are errors; a column with one of them fails.

mod choice;
mod column;
mod columns;
mod digits;
pub(crate) mod names;
mod number;
mod pairs;
mod step;
mod text;

use std::io;
use std::path::Path;

use crate::input::{self, InputError};
use crate::judge::claims::Claim;
use crate::judge::verdict::{Judge, RateVerdict};
pub use choice::Choice;
pub use column::limit;
pub use digits::Column;
use text::RawTable;

/// A table of errors, read.
#[derive(Debug, Clone, PartialEq)]
pub struct RateTable {
    /// What the step is: the name of its column, or `cells^(-1/2)` where the column counts.
    pub step: String,
    /// The errors.
    pub columns: Vec<Column>,
    /// The values that a choice has named.
    pub values: Vec<Column>,
    /// Columns that are no errors, each with the reason.
    pub not_errors: Vec<(String, String)>,
    /// How the table was read: the step, errors, values, and what was left out with the reason.
    pub reading: String,
    /// Whether numbers, not names, have told the step.
    pub is_guessed: bool,
}

impl RateTable {
    /// Reads a file.
    ///
    /// # Errors
    /// [`InputError`] with line, column and the name of the table's column.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, InputError> {
        Self::read_with(path, &Choice::default())
    }

    /// Reads a file, of which `choice` says which columns are meant; `-` is standard input.
    ///
    /// # Errors
    /// As [`RateTable::read`]; and a choice of columns that are not there.
    pub fn read_with(path: impl AsRef<Path>, choice: &Choice) -> Result<Self, InputError> {
        let path = path.as_ref();
        if path == Path::new("-") {
            let text = input::read_from(STANDARD_INPUT, io::stdin().lock())?;
            return Self::parse_with(&text, STANDARD_INPUT, choice);
        }
        Self::parse_with(&input::read_text(path)?, &path.display().to_string(), choice)
    }

    /// Reads a table from `text`; messages name `file_name`.
    ///
    /// # Errors
    /// As [`RateTable::read`], but for the file.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, InputError> {
        Self::parse_with(text, file_name, &Choice::default())
    }

    /// As [`RateTable::parse`] with a choice of columns.
    ///
    /// # Errors
    /// As [`RateTable::read_with`], but for the file.
    pub fn parse_with(text: &str, file_name: &str, choice: &Choice) -> Result<Self, InputError> {
        columns::read(RawTable::read(&text::plain(text)), file_name, choice)
    }

    /// The column of errors of this name, with or without its unit.
    pub fn column(&self, name: &str) -> Option<&Column> {
        let at = names::position(self.columns.iter().map(|column| column.name.as_str()), name)?;
        self.columns.get(at)
    }

    /// Judges every column of errors against its order.
    pub fn judge(&self, judge: &Judge, order: impl Fn(&str) -> f64) -> Vec<(String, RateVerdict)> {
        let claim = |column: &Column| Claim::new(order(&column.name), judge.tolerance());
        self.columns.iter().map(|column| (column.name.clone(), column.judge(judge, &claim(column)))).collect()
    }
}

/// Standard input as messages name it.
const STANDARD_INPUT: &str = "standard input";
