//! Convergence rates of any code: a table of step sizes and errors, judged by the rule of [`verdict`](crate::judge::verdict).
//!
//! ```text
//! # comments and blank lines are skipped
//! h,     L2,      H1
//! 0.1,   1.0e-3,  2.1e-2
//! 0.05,  2.5e-4,  1.0e-2
//! 0.025, 6.2e-5,  5.2e-3
//! ```
//!
//! Commas, semicolons, tabs, blanks, the bars of Markdown or `&` of LaTeX separate the cells; `TABLES.md` shows the formats that are read. One column
//! is the step, every other an error, but for those that by their name hold rates, counts, costs or the number of the row. Where no name shows the
//! step it is the first column, unless that is named like an error. Rows may have any order, each with a step of its own. `NaN` and `inf` are
//! accepted as errors; a column with one of them fails.

mod cells;
mod columns;
mod grid;
pub(crate) mod names;
mod number;
mod pairs;
mod spans;
mod step;
mod words;

use std::borrow::Cow;
use std::collections::HashSet;
use std::io;
use std::path::Path;

use crate::input::{self, Complaint, InputError, Place};
use crate::judge::verdict::{Judge, Level, RateVerdict};
pub use columns::Choice;
use grid::Grid;

/// A table of errors, read.
#[derive(Debug, Clone, PartialEq)]
pub struct RateTable {
    /// What the step is: the name of its column, or `cells^(-1/2)` where the column counts.
    pub step: String,
    /// The errors by name, coarsest level first.
    pub columns: Vec<(String, Vec<Level>)>,
    /// Columns that are no errors, each with the reason.
    pub not_errors: Vec<(String, &'static str)>,
    /// Columns that an order claimed of all does not mean: nothing in their names says that they are errors, and they do not fall with the step.
    pub unclaimed: Vec<String>,
    /// How the table was read, where the names did not decide.
    pub notes: Vec<String>,
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
            return Self::parse_with(&standard_input()?, STANDARD_INPUT, choice);
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
        // Spreadsheets put a byte order mark in front.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        // Line ends of the first Macintosh.
        let text = if text.contains('\n') { Cow::from(text) } else { text.replace('\r', "\n").into() };
        let grid = Grid::read(&text, file_name)?;
        columns::read(&grid, file_name, choice)
    }

    /// Judges every column against its order.
    pub fn judge(&self, judge: &Judge, order: impl Fn(&str) -> f64) -> Vec<(String, RateVerdict)> {
        self.columns.iter().map(|(name, levels)| (name.clone(), judge.judge(levels, order(name)))).collect()
    }
}

/// Standard input as messages name it.
const STANDARD_INPUT: &str = "standard input";

fn standard_input() -> Result<String, InputError> {
    input::read_from(STANDARD_INPUT, io::stdin().lock())
}

fn complaint(file: &str, place: Option<Place>, expected: &str, found: &str) -> InputError {
    let reason = format!("expected {expected}, found {found}");
    InputError { file: file.to_owned(), place, field: None, complaint: Box::new(Complaint::Invalid { reason }) }
}

/// A cell as it is quoted: on one line, and no longer than can be read.
fn shown(cell: &str) -> String {
    format!("`{}`", input::shorten(cell))
}

/// Refuses names that are the same or cannot be shown.
fn check_names(grid: &Grid<'_>, is_named: impl Fn(usize) -> bool, file: &str) -> Result<(), InputError> {
    let mut seen: HashSet<&str> = HashSet::new();
    for (k, cell) in grid.names.iter().enumerate() {
        let place = Some(Place { line: grid.line, column: cell.column });
        let refuse = |expected: &str, found: &str| Err(complaint(file, place, expected, found));
        if cell.text.contains(char::is_control) {
            return refuse("a name without control characters", &shown(cell.text));
        }
        if !is_named(k) {
            continue;
        }
        if cell.text.is_empty() || number::number(cell.text, false).is_some() {
            return refuse("a name in the first row", &shown(cell.text));
        }
        if !seen.insert(cell.text) {
            return refuse("each name once", &format!("{} a second time", shown(cell.text)));
        }
    }
    if grid.names.len() < 2 {
        let place = Some(Place { line: grid.line, column: 1 });
        return Err(complaint(file, place, "a column of steps and at least one of errors", "one column"));
    }
    Ok(())
}
