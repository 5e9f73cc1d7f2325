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
//! is the step, every other an error, but for those that by their name hold rates, counts, costs or the number of the row. Rows may have any
//! order. `NaN` and `inf` are accepted as errors; a column with one of them fails.

mod cells;
mod columns;
mod grid;
mod number;
mod spans;
mod words;

use std::collections::HashSet;
use std::io::{self, Read};
use std::panic::resume_unwind;
use std::path::Path;
use std::thread;

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
        let grid = Grid::read(text, file_name)?;
        columns::read(&grid, file_name, choice)
    }

    /// Judges every column against its order. Tables of many columns are shared out among the processors; the result is the same.
    pub fn judge(&self, judge: &Judge, order: impl Fn(&str) -> f64) -> Vec<(String, RateVerdict)> {
        let orders: Vec<f64> = self.columns.iter().map(|(name, _)| order(name)).collect();
        let part = &|columns: &[(String, Vec<Level>)], orders: &[f64]| -> Vec<(String, RateVerdict)> {
            let columns = columns.iter().zip(orders);
            columns.map(|((name, levels), order)| (name.clone(), judge.judge(levels, *order))).collect()
        };
        if orders.len() < MANY {
            return part(&self.columns, &orders);
        }
        let processors = thread::available_parallelism().map_or(1, usize::from);
        let share = orders.len().div_ceil(processors);
        thread::scope(|scope| {
            let parts = self.columns.chunks(share).zip(orders.chunks(share));
            let running: Vec<_> = parts.map(|(columns, orders)| scope.spawn(move || part(columns, orders))).collect();
            running.into_iter().flat_map(|part| part.join().unwrap_or_else(|panic| resume_unwind(panic))).collect()
        })
    }
}

/// Columns from which on a table is judged on all processors.
const MANY: usize = 1000;

/// Standard input as messages name it.
const STANDARD_INPUT: &str = "standard input";

fn standard_input() -> Result<String, InputError> {
    let fail = |complaint| InputError {
        file: STANDARD_INPUT.to_owned(),
        place: None,
        field: None,
        complaint: Box::new(complaint),
    };
    let mut bytes = vec![];
    let read = io::stdin().lock().take(input::FILE_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(|error| fail(Complaint::Unreadable { reason: error.to_string() }))?;
    if bytes.len() as u64 > input::FILE_BYTES {
        return Err(fail(Complaint::TooLarge { allowed: input::FILE_BYTES }));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let reason = format!("expected UTF-8 text, found the byte 0x{:02x}", error.as_bytes()[valid]);
        fail(Complaint::Invalid { reason })
    })
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
