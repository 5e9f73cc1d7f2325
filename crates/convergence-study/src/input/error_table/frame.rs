//! Columns of numbers, read like the text of a table.

use super::original::{Original, Rows};
use super::{Choice, RateTable, cleaned, roles};
use crate::input::InputError;
use crate::text::number::counted;

/// A column of a data frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameColumn {
    /// Its name.
    pub name: String,
    /// Its numbers, row by row.
    pub numbers: Vec<f64>,
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
        if let Some(FrameColumn { name, numbers }) = short {
            let expected = format!("{}, as other columns have", counted(rows, "number"));
            let found = numbers.len().to_string();
            return Err(Original::of_text("", name).refuse(expected, &found));
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
