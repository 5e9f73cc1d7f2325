//! Columns of numbers and words: a data frame, a dict of lists.

use super::cell::{Cell, Style};
use super::grid::{Cells, Grid, check};
use super::{Choice, RateTable, Refused, names_given, refused, tables_of_columns};
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

impl FrameColumn {
    /// A column of numbers.
    pub fn of_numbers(name: impl Into<String>, numbers: impl IntoIterator<Item = f64>) -> Self {
        Self {
            name: name.into(),
            cells: numbers.into_iter().map(FrameCell::Number).collect(),
        }
    }
}

impl FrameCell {
    fn cell(&self) -> Cell {
        match self {
            Self::Number(number) => Cell::exact(*number),
            Self::Word(word) => Cell::new(word, Style::Plain),
        }
    }
}

impl RateTable {
    /// Reads the columns of a data frame, with all digits of their numbers.
    ///
    /// * `argument`: the name of the data frame in messages.
    ///
    /// # Errors
    /// As [`RateTable::parse_all_with`]; also for columns of different lengths, for fewer than two
    /// rows, and for several ladders.
    pub fn from_columns(
        columns: &[FrameColumn],
        argument: &str,
        choice: &Choice,
    ) -> Result<Self, InputError> {
        let tables = refused::with_offers(
            |choice| frame(columns, choice).map(|table| vec![table]),
            choice,
            argument,
        );
        Ok(tables?.remove(0))
    }
}

fn frame(columns: &[FrameColumn], choice: &Choice) -> Result<RateTable, Refused> {
    let rows = columns.first().map_or(0, |column| column.cells.len());
    if let Some(other) = columns.iter().find(|column| column.cells.len() != rows) {
        let found = format!("{} in `{}`", other.cells.len(), other.name);
        let expected = format!("{} in each column", counted(rows, "cell"));
        return Err(Refused::new(expected, found));
    }
    if rows < 2 || columns.len() < 2 {
        let expected = "at least two columns of at least two rows";
        return Err(Refused::new(expected, "fewer"));
    }
    let own = columns.iter().map(|column| column.name.clone());
    let names = names_given(choice, columns.len())?.unwrap_or_else(|| own.collect());
    check(&names, rows, columns.len())?;
    let columns = columns.iter().zip(&names).map(|(column, name)| {
        let cells = column.cells.iter().map(FrameCell::cell);
        Cells::new(name, cells.collect())
    });
    let columns: Vec<Cells> = columns.collect();
    only(tables_of_columns(&Grid::default(), &columns, choice)?)
}

/// The only one of some tables.
fn only(mut tables: Vec<RateTable>) -> Result<RateTable, Refused> {
    if tables.len() > 1 {
        let expected = "one table, of one method and one degree";
        return Err(Refused::new(expected, counted(tables.len(), "table")));
    }
    Ok(tables.remove(0))
}
