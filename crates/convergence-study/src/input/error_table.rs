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
//! The first column is the step, h or dt, coarse to fine or fine to coarse; every other column an error. Cells are separated by commas,
//! semicolons or tabs. `NaN` and `inf` are accepted as errors; a column with one of them fails.

use std::collections::HashSet;
use std::path::Path;

use crate::input::{self, Complaint, InputError, Place};
use crate::judge::verdict::{Judge, Level, RateVerdict};

/// A table of errors, read.
#[derive(Debug, Clone, PartialEq)]
pub struct RateTable {
    /// Name of the first column.
    pub step: String,
    /// The other columns by name, coarsest level first.
    pub columns: Vec<(String, Vec<Level>)>,
}

impl RateTable {
    /// Reads a CSV file.
    ///
    /// # Errors
    /// [`InputError`] with line, column and the name of the table's column.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        Self::parse(&input::read_text(path)?, &path.display().to_string())
    }

    /// Reads a table from `text`; messages name `file_name`.
    ///
    /// # Errors
    /// As [`RateTable::read`], but for the file.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, InputError> {
        // Spreadsheets put a byte order mark in front.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut rows = text.lines().enumerate().filter(|(_, line)| {
            let line = line.trim();
            !line.is_empty() && !line.starts_with('#')
        });
        let Some((number, head)) = rows.next() else {
            return Err(complaint(file_name, None, "an empty table", "a row of names, then rows of numbers"));
        };
        let separator = [',', ';', '\t'].into_iter().find(|&c| head.contains(c)).unwrap_or(',');
        let names = names(&cells(head, separator), file_name, number)?;
        let mut columns: Vec<(String, Vec<Level>)> = names[1..].iter().map(|name| (name.clone(), vec![])).collect();
        for (number, line) in rows {
            let row = cells(line, separator);
            let row = numbers(&row, &names, Source { file: file_name, line: number })?;
            for ((_, levels), &error) in columns.iter_mut().zip(&row[1..]) {
                levels.push(Level { step: row[0], error });
            }
        }
        // The judge wants the coarsest level first; any other order it will refuse.
        if columns.iter().all(|(_, levels)| levels.windows(2).all(|pair| pair[0].step < pair[1].step)) {
            columns.iter_mut().for_each(|(_, levels)| levels.reverse());
        }
        Ok(Self { step: names[0].clone(), columns })
    }

    /// Judges every column against its order.
    pub fn judge(&self, judge: &Judge, order: impl Fn(&str) -> f64) -> Vec<(String, RateVerdict)> {
        self.columns.iter().map(|(name, levels)| (name.clone(), judge.judge(levels, order(name)))).collect()
    }
}

/// A row of a file, from 0.
#[derive(Clone, Copy)]
struct Source<'a> {
    file: &'a str,
    line: usize,
}

impl Source<'_> {
    fn complain(self, column: usize, field: Option<&str>, found: &str, allowed: impl Into<String>) -> InputError {
        let place = Place { line: self.line + 1, column };
        InputError { field: field.map(str::to_owned), ..complaint(self.file, Some(place), found, allowed) }
    }
}

fn complaint(file: &str, place: Option<Place>, found: &str, allowed: impl Into<String>) -> InputError {
    let complaint = Complaint::NotAllowed { found: found.to_owned(), allowed: allowed.into() };
    InputError { file: file.to_owned(), place, field: None, complaint: Box::new(complaint) }
}

/// The cells of a row without blanks and quotes, each with its column in characters, from 1.
fn cells(line: &str, separator: char) -> Vec<(usize, &str)> {
    let mut column = 1;
    line.split(separator)
        .map(|cell| {
            let blanks = cell.chars().take_while(|c| c.is_whitespace()).count();
            let here = column + blanks;
            column += cell.chars().count() + 1;
            let cell = cell.trim();
            (here, cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).unwrap_or(cell).trim())
        })
        .collect()
}

/// A cell as it is quoted: on one line, and no longer than can be read.
fn shown(cell: &str) -> String {
    format!("`{}`", input::shorten(cell))
}

fn names(cells: &[(usize, &str)], file: &str, line: usize) -> Result<Vec<String>, InputError> {
    let source = Source { file, line };
    let (mut names, mut seen): (Vec<String>, HashSet<&str>) = (vec![], HashSet::new());
    for &(column, cell) in cells {
        if cell.is_empty() || cell.parse::<f64>().is_ok() {
            return Err(source.complain(column, None, &shown(cell), "a name in the first row"));
        }
        if cell.contains(char::is_control) {
            return Err(source.complain(column, None, &shown(cell), "a name without control characters"));
        }
        if !seen.insert(cell) {
            return Err(source.complain(column, None, &format!("{} a second time", shown(cell)), "each name once"));
        }
        names.push(cell.to_owned());
    }
    if names.len() < 2 {
        return Err(source.complain(1, None, "one column", "a column of steps and at least one of errors"));
    }
    Ok(names)
}

fn numbers(cells: &[(usize, &str)], names: &[String], source: Source<'_>) -> Result<Vec<f64>, InputError> {
    if cells.len() != names.len() {
        let found = format!("{} cells", cells.len());
        return Err(source.complain(1, None, &found, format!("{}, one for each name", names.len())));
    }
    let number = |(index, (&(column, cell), name)): (usize, (&(usize, &str), &String))| {
        let refuse = |allowed: &str| source.complain(column, Some(name), &shown(cell), allowed);
        let value: f64 = cell.parse().map_err(|_| refuse("a number"))?;
        if index == 0 && !(value > 0.0 && value.is_finite()) {
            return Err(refuse("a step, a finite number > 0"));
        }
        Ok(value)
    };
    cells.iter().zip(names).enumerate().map(number).collect()
}
