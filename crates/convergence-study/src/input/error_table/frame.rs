//! Columns of numbers and words, read like the text of a table.

use super::original::{Original, Rows};
use super::{Choice, RateTable, cleaned, roles};
use crate::input::InputError;
use crate::text::number::counted;

/// A column of a data frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameColumn {
    /// Its name.
    pub name: String,
    /// Its cells, row by row.
    pub cells: Vec<FrameCell>,
}

/// A cell of a data frame.
#[derive(Debug, Clone, PartialEq)]
pub enum FrameCell {
    /// A number; NaN is a level without a result.
    Number(f64),
    /// A word, such as `diverged`, or nothing.
    Word(String),
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
        let rows = columns.iter().map(|column| column.cells.len()).max();
        let rows = rows.unwrap_or(0);
        let short = columns.iter().find(|column| column.cells.len() != rows);
        if let Some(FrameColumn { name, cells }) = short {
            let expected = format!("{}, as other columns have", counted(rows, "cell"));
            let found = cells.len().to_string();
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
        let cells = columns.iter().map(|column| column.cells[row].written());
        text += &line(cells.collect());
    }
    text
}

impl FrameColumn {
    /// A column of numbers.
    pub fn of_numbers(name: impl Into<String>, numbers: impl IntoIterator<Item = f64>) -> Self {
        Self {
            name: name.into(),
            cells: numbers.into_iter().map(FrameCell::Number).collect(),
        }
    }

    fn name_in_quotes(&self) -> String {
        in_quotes(&self.name)
    }
}

impl FrameCell {
    fn written(&self) -> String {
        match self {
            Self::Number(number) => all_digits(*number),
            Self::Word(word) if word.is_empty() => String::new(),
            Self::Word(word) => in_quotes(&word.replace(['\n', '\r'], " ")),
        }
    }
}

fn in_quotes(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "'"))
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
