//! A table in columns, and complaints about it.

use std::collections::HashSet;

use super::columns::Cells;
use super::grid::{ColumnName, RawTable, Turned};
use super::names::{self, Word};
use super::number::{Number, common_unit, number, without_thousands};
use super::original::Original;
use super::{Choice, Doubt, NotError, Offer};
use crate::input::advice::{Argument, Text};
use crate::input::{InputError, shorten};
use crate::text::names::{did_you_mean, nearest};
use crate::text::number::counted;
use crate::text::visible::is_hidden;

/// Most names that a message lists.
const LISTED: usize = 12;
/// Rates are searched for among this many columns on either side.
pub(super) const NEIGHBOURS: usize = 40;

/// When an offer to number the rows is right.
pub(super) const HALVED_ROWS: &str = "if each row halves the step";

/// A table and the choices of the user.
pub(super) struct TableReader<'t> {
    pub(super) original: Original<'t>,
    pub(super) choice: &'t Choice,
    pub(super) columns: Vec<Cells<'t>>,
    /// Whether its columns stand as rows in the text.
    pub(super) turned: Option<Turned>,
    /// The ratio of the steps of consecutive levels, as chosen or as the rates between errors say.
    pub(super) ratio: Option<f64>,
    /// The column that the reader has added: the numbers of the rows.
    pub(super) rows: Option<usize>,
    /// What is not an error.
    pub(super) left_out: Vec<NotError>,
    /// For each row whether its level was solved, as a column of states says.
    pub(super) is_solved: Vec<bool>,
    /// Whether a blank cell is a level without a result.
    is_separated: bool,
    /// Whether the rows were in no order and have been sorted.
    pub(super) is_shuffled: bool,
    /// Whether the rows stood from the finest level to the coarsest.
    pub(super) is_reversed: bool,
    /// Why none of its columns should pass, as its columns say.
    pub(super) doubts: Vec<Doubt>,
}

/// Names in a message, but not too many.
pub(super) fn listed(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.take(LISTED + 1).collect();
    names[..names.len().min(LISTED)].join(", ") + if names.len() > LISTED { ", ..." } else { "" }
}

/// Columns that are not errors, each with the reason.
pub(super) fn reasons(others: &[NotError]) -> String {
    listed(
        others
            .iter()
            .map(|one| format!("`{}` ({})", one.column, one.because)),
    )
}

impl Choice {
    /// This choice, changed.
    ///
    /// * `comment`: when it is right; may be empty.
    pub(super) fn offer(&self, comment: &'static str, change: impl FnOnce(&mut Self)) -> Offer {
        let mut choice = self.clone();
        change(&mut choice);
        Offer { choice, comment }
    }

    /// The choice that the step is halved, with the comment when.
    pub(super) fn halved(&self, comment: &'static str) -> Offer {
        self.offer(comment, |choice| choice.ratio = Some(2.0))
    }
}

/// The columns of a table; refuses a text without a table, and names that do not fit its columns.
pub(super) fn columns<'t>(
    original: Original<'t>,
    choice: &Choice,
    table: &RawTable<'t>,
) -> Result<Vec<Cells<'t>>, InputError> {
    let width = table.width();
    let mut cells = table.rows.iter().flatten();
    if let Some(power) = cells.find(|cell| cell.starts_with("10⁻")) {
        let expected = "a number with its power of ten as in `1.6e-3`";
        return Err(original.error(power, None, expected, &format!("`{}`", shorten(power))));
    }
    if width == 0 {
        let mut lines = original.text.lines().filter(|line| !line.trim().is_empty());
        let found = lines.next().map_or("an empty table".to_owned(), |line| {
            format!("no row of numbers, but `{}`", shorten(line.trim()))
        });
        let expected =
            "a row of names, such as `h L2 H1`, then rows of numbers, such as `0.1 1.6e-3 4e-2`";
        return Err(original.error(original.text, None, expected, &found));
    }
    let names = table.column_names(choice.names.as_deref());
    if let Some(row) = table.rows.iter().find(|row| row.len() != names.len()) {
        let example = (1..=width).map(|k| format!("c{k}")).collect();
        let offer = choice.offer("", |choice| choice.names = Some(example));
        let expected = format!("{}, one for each name", counted(names.len(), "cell"));
        let found = counted(row.len(), "cell");
        let first = row.first().unwrap_or(&original.text);
        let error = original.error(first, None, expected, &found);
        return Err(error.offering([offer]));
    }
    let heads: Vec<&str> = (0..width)
        .map(|k| table.names.get(k).copied().unwrap_or(original.text))
        .collect();
    if let Some(k) = names
        .iter()
        .position(|column| column.name.contains(is_hidden))
    {
        let found = format!("`{}`", shorten(&names[k].name));
        let expected = "a name without control characters";
        return Err(original.error(heads[k], None, expected, &found));
    }
    let columns = columns_of(table, names, &heads, choice);
    if width < 2 && choice.ratio.is_none() {
        let found = "one column: write the table as CSV";
        let expected = "a column of steps and at least one of errors";
        let halved = columns[0].is_steep().then(|| choice.halved(HALVED_ROWS));
        let refusal = original.error(heads[0], None, expected, found);
        return Err(refusal.offering(halved));
    }
    Ok(columns)
}

/// Refuses a text with a factor above its numbers, as MATLAB prints a matrix.
pub(super) fn refuse_factor(original: Original<'_>) -> Result<(), InputError> {
    let Some(factor) = original.text.lines().find(is_factor) else {
        return Ok(());
    };
    let expected = "numbers that need no factor; MATLAB prints them after `format short g`";
    let found = format!("the factor `{}`", shorten(factor.trim()));
    Err(original.error(factor, None, expected, &found))
}

/// Whether a line is a factor of the numbers below it: `1.0e-03 *`.
fn is_factor(line: &&str) -> bool {
    let factor = line.trim().strip_suffix('*');
    factor.is_some_and(|factor| number(factor.trim_end(), false).is_some())
}

/// * `heads`: the names in the text.
fn columns_of<'t>(
    table: &RawTable<'t>,
    mut names: Vec<ColumnName>,
    heads: &[&'t str],
    choice: &Choice,
) -> Vec<Cells<'t>> {
    let nameless = names.iter_mut().enumerate();
    for (k, column) in nameless.filter(|(_, column)| column.name.is_empty()) {
        column.name = format!("column {}", k + 1);
    }
    let claims = choice.columns.iter().flatten().chain(&choice.claimed);
    let claims = claims.chain(&choice.values).filter_map(|name| {
        names::claimed_position(names.iter().map(|column| column.name.as_str()), name)
    });
    let claims: HashSet<usize> = claims.collect();
    let has = |mark: char| {
        let mut cells = table.rows.iter().flatten();
        cells.any(|cell| cell.contains(mark) && number(cell, table.decimal_comma).is_some())
    };
    // With decimal commas, `1.024` may be 1024; with decimal points, `1,024` is.
    let (has_comma, has_point) = (has(','), has('.'));
    let mut columns = Vec::with_capacity(names.len());
    for (k, name) in names.into_iter().enumerate() {
        let texts = without_unit(table.column(k));
        let number = |text: &&str| {
            if has_point
                && !has_comma
                && let Some(plain) = without_thousands(text)
            {
                return number(&plain, false);
            }
            let is_ambiguous = has_comma && text.contains('.');
            number(text, table.decimal_comma).filter(|_| !is_ambiguous)
        };
        let numbers = texts.iter().map(number).collect();
        columns.push(Cells {
            is_claimed: claims.contains(&k),
            ..Cells::new(heads[k], name, texts, numbers)
        });
    }
    columns
}

/// The cells of a column without the unit that stands in all of them.
fn without_unit(cells: Vec<&str>) -> Vec<&str> {
    let Some(unit) = common_unit(&cells) else {
        return cells;
    };
    cells
        .iter()
        .map(|cell| cell.strip_suffix(unit).unwrap_or(cell).trim_end())
        .collect()
}

impl<'t> TableReader<'t> {
    pub(super) fn new(
        original: Original<'t>,
        choice: &'t Choice,
        columns: Vec<Cells<'t>>,
        table: &RawTable<'t>,
    ) -> Self {
        let rows = columns[0].texts.len();
        let Choice {
            step, dim, ratio, ..
        } = choice;
        let is_halved = table.turned == Some(Turned::Halved);
        let stated = (is_halved && step.is_none() && dim.is_none()).then_some(2.0);
        let mut reader = Self {
            original,
            choice,
            columns,
            turned: table.turned,
            ratio: ratio.or(stated),
            rows: None,
            left_out: table.left_out.clone(),
            is_solved: vec![true; rows],
            is_separated: table.is_separated,
            is_shuffled: false,
            is_reversed: false,
            doubts: vec![],
        };
        let has_levels = reader.columns.iter().any(|column| column.is_index);
        if reader.ratio.is_some() && step.is_none() && !has_levels {
            reader.rows = Some(reader.columns.len());
            reader.columns.push(numbers_of_rows(rows));
        }
        reader.columns.extend(reader.difference());
        reader
    }

    /// The errors of a table that has none, but a column of values and one of what they tend to.
    fn difference(&self) -> Option<Cells<'t>> {
        let is_free = |column: &&Cells<'_>| column.word == Word::Value && !column.is_claimed;
        let values: Vec<&Cells<'_>> = self.columns.iter().filter(is_free).collect();
        let [one, other] = values[..] else {
            return None;
        };
        if self.columns.iter().any(|column| column.word == Word::Error) {
            return None;
        }
        match [one, other].map(|column| names::is_exact(&column.name)) {
            [false, true] => Some(one.difference(other)),
            [true, false] => Some(other.difference(one)),
            _ => None,
        }
    }

    /// The column with that name, or with that number from 1, which an argument selects.
    pub(super) fn find(&self, wanted: &str, argument: Argument) -> Result<usize, InputError> {
        if let Some(column) = position(&self.columns, wanted) {
            return Ok(column);
        }
        let names = self.columns.iter().map(|column| column.name.as_str());
        let suggestion = nearest(wanted, names.clone().take(LISTED)).map(str::to_owned);
        let found = format!("`{}`{}", shorten(wanted), did_you_mean(&suggestion));
        let list = listed(names.map(str::to_owned));
        let expected = Text::from("a column for ") + argument.alone() + format!(": {list}");
        Err(self.refuse(expected, &found))
    }

    /// The number of a cell that must hold one.
    pub(super) fn must(&self, row: usize, column: usize) -> Result<f64, InputError> {
        let cells = &self.columns[column];
        if cells.is_number(row) {
            return Ok(cells.values[row]);
        }
        let cell = cells.texts[row];
        let more = if cell.contains('%') {
            "; of its column, some numbers have `%` and others do not"
        } else if cell.len() > 1 && cell.chars().all(|c| c == '*') {
            "; Fortran writes stars where the field is too narrow"
        } else if cell.contains(',') {
            "; its comma may be that of decimals or of thousands"
        } else if number(cell, true).is_some() {
            "; its point may be that of decimals or of thousands, for others have decimal commas"
        } else {
            ""
        };
        let found = format!("`{}`", shorten(cell));
        Err(self.error(cell, Some(&cells.name), format!("a number{more}"), &found))
    }

    /// Whether a level has no result in a column: the code says so, or its cell is blank.
    pub(super) fn has_failed(&self, row: usize, column: usize) -> bool {
        let cells = &self.columns[column];
        let is_blank = self.is_separated && cells.texts[row].is_empty();
        !self.is_solved[row] || cells.has_failed(row) || is_blank
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

    /// A complaint about the row of names.
    pub(super) fn refuse(&self, expected: impl Into<Text>, found: &str) -> InputError {
        self.error(self.columns[0].head, None, expected, found)
    }

    /// A complaint about a piece of the text.
    pub(super) fn error(
        &self,
        piece: &str,
        field: Option<&str>,
        expected: impl Into<Text>,
        found: &str,
    ) -> InputError {
        self.original.error(piece, field, expected, found)
    }
}

/// A column that the table lacks: the numbers of its rows, for `--ratio`.
fn numbers_of_rows<'t>(rows: usize) -> Cells<'t> {
    let name = ColumnName {
        name: "row".to_owned(),
        word: Word::Cost,
    };
    let numbers = (0..rows).map(|row| Some(Number::exact(row as f64)));
    Cells::new("", name, vec![""; rows], numbers.collect())
}

/// The column of this name, or of this number from 1.
pub(super) fn position(columns: &[Cells<'_>], wanted: &str) -> Option<usize> {
    let names = columns.iter().map(|column| column.name.as_str());
    let number = || wanted.parse::<usize>().ok()?.checked_sub(1);
    names::position(names, wanted).or_else(|| number().filter(|k| *k < columns.len()))
}
