//! Columns of numbers, read like the text of a table.

use super::{Choice, RateTable, cleaned, roles};
use crate::input::{Complaint, InputError, failed};
use crate::text::number::counted;

/// A column of a data frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameColumn {
    /// Its name.
    pub name: String,
    /// Its numbers, row by row.
    pub numbers: Vec<f64>,
}

/// A table to be read.
#[derive(Debug, Clone, Copy)]
pub(super) struct Original<'t> {
    /// Its text.
    pub(super) text: &'t str,
    /// Its name in messages.
    pub(super) name: &'t str,
    pub(super) rows: Rows,
}

/// What the rows of a table are to the caller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rows {
    /// Lines of a text, from 1.
    Lines,
    /// Rows of a data frame, from 0; the text has the names in its first line.
    Frame,
}

impl<'t> Original<'t> {
    /// A text, and the name of its file.
    pub(super) fn of_text(text: &'t str, name: &'t str) -> Self {
        Self {
            text,
            name,
            rows: Rows::Lines,
        }
    }

    /// The number of the row with the byte at `offset`, as the caller counts.
    pub(super) fn row(&self, offset: usize) -> usize {
        let before = self.text[..offset].matches('\n').count();
        match self.rows {
            Rows::Lines => before + 1,
            Rows::Frame => before.saturating_sub(1),
        }
    }

    /// What the caller calls several rows.
    pub(super) fn noun(&self) -> &'static str {
        match self.rows {
            Rows::Lines => "lines",
            Rows::Frame => "rows",
        }
    }
}

impl RateTable {
    /// Reads the columns of a data frame, with all digits of their numbers.
    ///
    /// * `argument`: the name of the data frame in messages.
    ///
    /// # Errors
    /// As [`RateTable::parse_with`]; rows are counted from 0. Also for columns of different lengths.
    pub fn from_columns(
        columns: &[FrameColumn],
        argument: &str,
        choice: &Choice,
    ) -> Result<Self, InputError> {
        let rows = columns.iter().map(|column| column.numbers.len()).max();
        let rows = rows.unwrap_or(0);
        let short = columns.iter().find(|column| column.numbers.len() != rows);
        if let Some(column) = short {
            let complaint = Complaint::Table {
                expected: format!("{}, as other columns have", counted(rows, "number")).into(),
                found: column.numbers.len().to_string(),
            };
            return Err(failed(&column.name, complaint));
        }
        let original = Original {
            text: &cleaned::plain(&text(columns, rows)),
            name: argument,
            rows: Rows::Frame,
        };
        roles::read(original, choice)
    }
}

/// Columns separated by commas, below their names in quotes.
fn text(columns: &[FrameColumn], rows: usize) -> String {
    let names = columns.iter().map(FrameColumn::name_in_quotes);
    let mut text = line(names.collect());
    for row in 0..rows {
        let cells = columns.iter().map(|column| all_digits(column.numbers[row]));
        text += &line(cells.collect());
    }
    text
}

impl FrameColumn {
    fn name_in_quotes(&self) -> String {
        format!("\"{}\"", self.name.replace('"', "'"))
    }
}

fn line(cells: Vec<String>) -> String {
    cells.join(",") + "\n"
}

/// A number with all digits; levels and counts are whole, without a point.
fn all_digits(number: f64) -> String {
    const WHOLE: f64 = 1e15;
    if number.fract() == 0.0 && number.abs() < WHOLE {
        format!("{number}")
    } else {
        format!("{number:?}")
    }
}
