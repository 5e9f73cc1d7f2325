//! A table in columns, and complaints about it.

use std::collections::HashSet;

use super::columns::Cells;
use super::frame::{Original, Rows};
use super::names::{self, Word};
use super::number::{common_unit, halves, has_percent, in_percent, number};
use super::pairs::{ColumnName, LeftOut, RawTable};
use super::text::counts_rows;
use super::{Choice, Offer};
use crate::input::advice::{Argument, Text};
use crate::input::{Complaint, InputError, Source, failed, shorten};
use crate::text::names::{did_you_mean, nearest};
use crate::text::number::counted;
use crate::text::visible::is_hidden;

/// Most names that a message lists.
const LISTED: usize = 12;
/// Rates are searched for among this many columns on either side.
pub(super) const NEIGHBOURS: usize = 40;

/// A table and the choices of the user.
pub(super) struct TableReader<'t> {
    pub(super) original: Original<'t>,
    pub(super) choice: &'t Choice,
    table: &'t RawTable<'t>,
    pub(super) columns: Vec<Cells<'t>>,
    /// The column that the reader has added: the numbers of the rows.
    pub(super) rows: Option<usize>,
    /// What is not an error.
    pub(super) left_out: Vec<LeftOut>,
    /// For each row whether its level was solved, as a column of states says.
    pub(super) is_solved: Vec<bool>,
    /// Whether the rows were in no order and have been sorted.
    pub(super) is_shuffled: bool,
}

/// The name of a column, with its unit if its numbers are in per cent.
fn named_in(name: String, percent: Option<bool>) -> String {
    match percent {
        Some(true) if !name.contains('%') => format!("{name} [%]"),
        _ => name,
    }
}

/// The cells of a column without the unit that stands in all of them.
fn without_unit(cells: Vec<&str>) -> Vec<&str> {
    let Some(unit) = common_unit(&cells) else {
        return cells;
    };
    let number = |cell: &&'_ str| cell.len() - unit.len();
    cells
        .iter()
        .map(|cell| cell[..number(cell)].trim_end())
        .collect()
}

/// Names in a message, but not too many.
pub(super) fn listed(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.take(LISTED + 1).collect();
    names[..names.len().min(LISTED)].join(", ") + if names.len() > LISTED { ", ..." } else { "" }
}

impl<'t> TableReader<'t> {
    /// Splits the table of a text into columns.
    pub(super) fn new(
        original: Original<'t>,
        choice: &'t Choice,
        table: &'t RawTable<'t>,
    ) -> Result<Self, InputError> {
        let mut reader = Self {
            original,
            choice,
            table,
            columns: vec![],
            rows: None,
            left_out: table.left_out.clone(),
            is_solved: vec![true; table.rows.len()],
            is_shuffled: false,
        };
        reader.columns = reader.columns()?;
        let has_levels = reader.columns.iter().any(|column| column.is_index);
        if choice.ratio.is_some() && choice.step.is_none() && !has_levels {
            reader.rows = Some(reader.columns.len());
            reader.columns.push(reader.numbers_of_rows());
        }
        Ok(reader)
    }

    /// The choice of the user, changed.
    pub(super) fn offer(&self, change: impl FnOnce(&mut Choice)) -> Offer {
        let mut choice = self.choice.clone();
        change(&mut choice);
        Offer {
            choice,
            comment: "",
        }
    }

    /// The columns; refuses a text without a table, and names that do not fit its columns.
    fn columns(&self) -> Result<Vec<Cells<'t>>, InputError> {
        let RawTable { rows, .. } = self.table;
        let width = rows.iter().map(Vec::len).max().unwrap_or(0);
        if width == 0 {
            let line = self
                .original
                .text
                .lines()
                .find(|line| !line.trim().is_empty())
                .map(|line| shorten(line.trim()));
            let found = line.map_or("an empty table".to_owned(), |line| {
                format!("no row of numbers, but `{line}`")
            });
            let expected = "a row of names, such as `h L2 H1`, then rows of numbers, such as `0.1 1.6e-3 4e-2`";
            return Err(self.refuse(expected, &found));
        }
        let names = self.table.column_names(self.choice.names.as_deref());
        if let Some(row) = rows.iter().find(|row| row.len() != names.len()) {
            let example = (1..=width).map(|k| format!("c{k}")).collect();
            let offer = self.offer(|choice| choice.names = Some(example));
            let expected = format!("{}, one for each name", counted(names.len(), "cell"));
            let found = counted(row.len(), "cell");
            let first = row.first().unwrap_or(&self.original.text);
            let error = self.error(first, None, expected, &found);
            return Err(error.offering([offer]));
        }
        if let Some(k) = names
            .iter()
            .position(|column| column.name.contains(is_hidden))
        {
            let found = format!("`{}`", shorten(&names[k].name));
            let expected = "a name without control characters";
            return Err(self.error(self.head(k), None, expected, &found));
        }
        let columns = self.columns_of(names);
        if width < 2 && self.choice.ratio.is_none() {
            let found = "one column: write the table as CSV";
            let refusal = self.refuse("a column of steps and at least one of errors", found);
            let halved = Offer {
                comment: "if each row halves the step",
                ..self.offer(|choice| choice.ratio = Some(2.0))
            };
            let is_column = columns[0].is_steep();
            return Err(refusal.offering(is_column.then_some(halved)));
        }
        Ok(columns)
    }

    /// A column that the table lacks: the numbers of its rows, for `--ratio`.
    fn numbers_of_rows(&self) -> Cells<'t> {
        let rows = self.table.rows.len();
        Cells {
            name: "row".to_owned(),
            word: Word::Cost,
            texts: vec![""; rows],
            values: (0..rows).map(|row| row as f64).collect(),
            is_number: vec![true; rows],
            halves: vec![0.0; rows],
            is_claimed: false,
            is_index: false,
        }
    }

    fn columns_of(&self, names: Vec<ColumnName>) -> Vec<Cells<'t>> {
        let RawTable {
            rows,
            decimal_comma,
            ..
        } = self.table;
        let mut names = names;
        for (k, column) in names
            .iter_mut()
            .enumerate()
            .filter(|(_, column)| column.name.is_empty())
        {
            column.name = format!("column {}", k + 1);
        }
        let Choice {
            columns,
            claimed,
            values,
            ..
        } = self.choice;
        let claimed = columns.iter().flatten().chain(claimed).chain(values);
        let claimed = claimed.filter_map(|name| {
            names::claimed_position(names.iter().map(|column| column.name.as_str()), name)
        });
        let claimed: HashSet<usize> = claimed.collect();
        // With decimal commas, `1.024` may be 1024.
        let has_comma = *decimal_comma
            && rows
                .iter()
                .flatten()
                .any(|cell| cell.contains(',') && number(cell, true).is_some());
        let mut columns = Vec::with_capacity(names.len());
        for (k, ColumnName { name, word }) in names.into_iter().enumerate() {
            let texts = without_unit(rows.iter().map(|row| row[k]).collect());
            let percent = in_percent(&texts);
            let numbers: Vec<_> = texts
                .iter()
                .map(|text| {
                    let is_ambiguous =
                        has_comma && text.contains('.') || percent.is_none() && has_percent(text);
                    number(text, *decimal_comma).filter(|_| !is_ambiguous)
                })
                .collect();
            let name = named_in(name, percent);
            let may_count =
                matches!(word, Word::Unknown | Word::Cost | Word::Count(_)) && rows.len() > 1;
            columns.push(Cells {
                name,
                word,
                values: numbers
                    .iter()
                    .map(|number| number.map_or(f64::NAN, |number| number.value))
                    .collect(),
                is_number: numbers.iter().map(Option::is_some).collect(),
                halves: halves(&numbers),
                is_claimed: claimed.contains(&k),
                is_index: may_count && counts_rows(&texts),
                texts,
            });
        }
        columns
    }

    /// The column with that name, or with that number from 1, which an argument selects.
    pub(super) fn find(&self, wanted: &str, argument: Argument) -> Result<usize, InputError> {
        let names = self.columns.iter().map(|column| column.name.as_str());
        if let Some(column) = names::position(names.clone(), wanted) {
            return Ok(column);
        }
        if let Ok(number @ 1..) = wanted.parse::<usize>()
            && number <= self.columns.len()
        {
            return Ok(number - 1);
        }
        let suggestion = nearest(wanted, names.clone().take(LISTED)).map(str::to_owned);
        let found = format!("`{}`{}", shorten(wanted), did_you_mean(&suggestion));
        let list = listed(names.map(str::to_owned));
        let expected = Text::from("a column for ") + argument.alone() + format!(": {list}");
        Err(self.refuse(expected, &found))
    }

    /// The number of a cell that must hold one.
    pub(super) fn must(&self, row: usize, column: usize) -> Result<f64, InputError> {
        let Cells {
            name,
            texts,
            values,
            is_number,
            ..
        } = &self.columns[column];
        is_number[row].then_some(values[row]).ok_or_else(|| {
            let cell = texts[row];
            let more = if has_percent(cell) && number(cell, true).is_some() {
                "; of its column, some numbers have `%` and others do not"
            } else if cell.len() > 1 && cell.chars().all(|c| c == '*') {
                "; Fortran writes stars where the field is too narrow"
            } else if self.table.decimal_comma && cell.contains(',') {
                "; its comma may be that of decimals or of thousands"
            } else if number(cell, true).is_some() {
                "; its point may be that of decimals or of thousands, for others have decimal commas"
            } else {
                ""
            };
            self.error(cell, Some(name), format!("a number{more}"), &format!("`{}`", shorten(cell)))
        })
    }

    pub(super) fn names(&self, columns: &[usize]) -> Vec<String> {
        columns
            .iter()
            .map(|k| self.columns[*k].name.clone())
            .collect()
    }

    /// Names of columns in a line or message.
    pub(super) fn quoted(&self, columns: &[usize]) -> String {
        listed(
            columns
                .iter()
                .map(|k| format!("`{}`", self.columns[*k].name)),
        )
    }

    /// The name above a column, or the beginning of the text.
    pub(super) fn head(&self, column: usize) -> &str {
        self.table
            .names
            .get(column)
            .copied()
            .unwrap_or(self.original.text)
    }

    /// A complaint about the row of names.
    pub(super) fn refuse(&self, expected: impl Into<Text>, found: &str) -> InputError {
        self.error(self.head(0), None, expected, found)
    }

    /// The byte offset of a piece within the text.
    pub(super) fn offset(&self, piece: &str) -> usize {
        (piece.as_ptr() as usize).saturating_sub(self.original.text.as_ptr() as usize)
    }

    /// A complaint about a piece of the text.
    pub(super) fn error(
        &self,
        piece: &str,
        field: Option<&str>,
        expected: impl Into<Text>,
        found: &str,
    ) -> InputError {
        let Original { text, name, rows } = self.original;
        let complaint = Complaint::Table {
            expected: expected.into(),
            found: found.to_owned(),
        };
        let offset = self.offset(piece);
        match (rows, field) {
            (Rows::Frame, Some(field)) => {
                let row = self.original.row(offset);
                failed(&format!("{field}[{row}]"), complaint)
            }
            (Rows::Lines, _) if !text.trim().is_empty() => {
                let source = Source { file: name, text };
                source.error(offset, field.map(str::to_owned), complaint)
            }
            _ => failed(name, complaint),
        }
    }
}
