//! A table as it stands in a text, and its columns.

use super::cell::{Cell, Number, Style, is_failure, plain, unit};
use super::names::{
    Family, Measure, error_of_rates, family, key, position, says_error, says_rates,
};
use super::{LineRange, Refused};
use crate::input::advice::Argument;
use crate::text::number::counted;
use crate::text::visible::is_hidden;
use convergence_judge::verdict::Samples;

/// Most rows of a table.
pub(super) const ROWS: usize = 10_000;
/// Most columns of a table.
pub(super) const COLUMNS: usize = 1_000;
/// Most characters of a name.
const NAME: usize = 200;

/// A line of names, and the rows below it.
#[derive(Debug, Clone, Default)]
pub(super) struct Grid {
    /// The line above it.
    pub(super) heading: String,
    /// The degree of elements that the heading says.
    pub(super) degree: Option<u32>,
    pub(super) lines: Option<LineRange>,
    pub(super) names: Vec<String>,
    /// The line of the names, where blanks part them.
    pub(super) head: Option<String>,
    /// Whether the names begin behind the first cells, as those of a data frame that prints the
    /// numbers of its rows.
    pub(super) is_indented: bool,
    /// As many cells in each.
    pub(super) rows: Vec<Vec<String>>,
    /// The line of each row, from 1; none without lines.
    pub(super) row_lines: Vec<usize>,
}

/// Refuses what is too large, and names with control characters.
pub(super) fn check(names: &[String], rows: usize, columns: usize) -> Result<(), Refused> {
    let most = |count: usize, noun: &str| format!("at most {}", counted(count, noun));
    if rows > ROWS {
        return Err(Refused::new(most(ROWS, "row"), "more"));
    }
    if columns > COLUMNS {
        let found = counted(columns, "column");
        return Err(Refused::new(most(COLUMNS, "column"), found));
    }
    if let Some(name) = names.iter().find(|name| name.contains(is_hidden)) {
        let expected = "a name without control characters";
        return Err(Refused::new(expected, format!("`{name}`")));
    }
    match names.iter().map(|name| name.chars().count()).max() {
        Some(longest) if longest > NAME => {
            let expected = format!("a name of {}", most(NAME, "character"));
            Err(Refused::new(expected, counted(longest, "character")))
        }
        _ => Ok(()),
    }
}

impl Grid {
    /// Its columns; `names` are as many as cells stand in a row.
    pub(super) fn columns(&self, names: &[String]) -> Vec<Cells> {
        let style = Style::of(self.rows.iter().flatten().map(String::as_str));
        let columns = names.iter().enumerate().map(|(k, name)| {
            let lines = self.row_lines.iter().copied().chain(std::iter::repeat(0));
            let texts = self.rows.iter().map(|row| row[k].as_str());
            let unit = unit(texts.filter(|text| text.contains(|c: char| c.is_ascii_digit())));
            let cells = self.rows.iter().zip(lines).map(|(row, line)| Cell {
                line,
                ..Cell::new(row[k].strip_suffix(unit).unwrap_or(&row[k]), style)
            });
            Cells::new(name, cells.collect())
        });
        columns.collect()
    }
}

/// A column.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    pub(super) name: String,
    pub(super) key: String,
    /// The column whose rates these are, where the table says so.
    pub(super) rates_of: Option<String>,
    pub(super) cells: Vec<Cell>,
    /// The numbers of its cells; none if a cell has none.
    pub(super) numbers: Vec<f64>,
    /// Half a unit of the last printed place of each cell; 0 without rounding.
    pub(super) halves: Vec<f64>,
    /// Whether the numbers are 0, 1, 2, ... or 1, 2, 3, ..., as the table has them.
    pub(super) numbers_rows: bool,
    /// The samples of which the cells are errors.
    pub(super) samples: Option<Samples>,
}

impl Cells {
    /// The row with the most decimals shows the place to which all numbers are printed: a program
    /// that prints 0.25 and 0.0625 omits zeros.
    pub(super) fn new(name: &str, mut cells: Vec<Cell>) -> Self {
        for has_power in [false, true] {
            let alike = cells.iter_mut().filter_map(|cell| cell.number.as_mut());
            let mut alike: Vec<&mut Number> = alike
                .filter(|number| number.exponent.is_some() == has_power)
                .filter(|number| number.decimals.is_some())
                .collect();
            let most = alike.iter().filter_map(|number| number.decimals).max();
            alike.iter_mut().for_each(|number| number.decimals = most);
        }
        let printed = cells.iter().map(|cell| cell.number.as_ref());
        let halves = printed.map(|number| number.map_or(0.0, Number::half));
        let numbers: Option<Vec<f64>> = cells.iter().map(Cell::value).collect();
        let numbers = numbers.unwrap_or_default();
        let goes_on = |two: &[f64]| two[1] - two[0] == 1.0;
        Self {
            name: plain(name),
            key: key(name),
            rates_of: error_of_rates(name),
            numbers_rows: cells.iter().all(Cell::is_whole)
                && [0.0, 1.0].contains(&numbers[0])
                && numbers.windows(2).all(goes_on),
            numbers,
            halves: halves.collect(),
            cells,
            samples: None,
        }
    }

    /// The column with these rows alone.
    pub(super) fn of_rows(&self, rows: &[usize]) -> Self {
        let cells = rows.iter().map(|row| self.cells[*row].clone());
        Self {
            rates_of: self.rates_of.clone(),
            ..Self::new(&self.name, cells.collect())
        }
    }

    /// Puts the last row first.
    pub(super) fn reverse(&mut self) {
        self.cells.reverse();
        self.numbers.reverse();
        self.halves.reverse();
        if let Some(samples) = &mut self.samples {
            samples.numbers.reverse();
        }
    }

    /// What the name says of steps. `H` is no `h`, and a `mesh` that does not grow no count: either
    /// is a step only where no other is.
    pub(super) fn family(&self) -> Option<(Family, Measure)> {
        family(&self.key).filter(|_| self.name != "H" && !self.is_size())
    }

    /// How the numbers change from row to row, if all cells have one.
    pub(super) fn sense(&self) -> Option<Sense> {
        moves(&self.numbers)
    }

    /// Whether a `mesh` or a `grid` has no growing whole numbers.
    pub(super) fn is_size(&self) -> bool {
        let grows = self.is_whole() && self.sense() == Some(Sense::Rises);
        ["mesh", "grid"].contains(&self.key.as_str()) && !grows
    }

    pub(super) fn has_numbers(&self) -> bool {
        self.cells.iter().any(|cell| cell.number.is_some())
    }

    pub(super) fn is_whole(&self) -> bool {
        self.cells.iter().all(Cell::is_whole)
    }

    /// Whether numbers stand in all cells, not all the same.
    pub(super) fn varies(&self) -> bool {
        self.numbers.iter().any(|number| *number != self.numbers[0])
    }

    /// Whether the same number stands in all cells.
    pub(super) fn is_constant(&self) -> bool {
        !self.numbers.is_empty() && !self.varies()
    }

    /// Whether positive numbers stand in all cells.
    pub(super) fn is_positive(&self) -> bool {
        !self.numbers.is_empty() && self.numbers.iter().all(|number| *number > 0.0)
    }

    /// Whether the cells have several texts.
    pub(super) fn differs(&self) -> bool {
        self.cells
            .iter()
            .any(|cell| cell.text != self.cells[0].text)
    }

    /// The line of the first row that does not go on as the rows before it.
    pub(super) fn turn(&self) -> usize {
        let mut ends = 2..=self.numbers.len();
        let end = ends.find(|end| moves(&self.numbers[..*end]).is_none());
        end.map_or(0, |end| self.cells[end - 1].line)
    }

    /// Whether all cells are words, none of them a word of failure.
    pub(super) fn are_labels(&self) -> bool {
        let is_word = |cell: &Cell| cell.is_blank() || !is_failure(&cell.text) && !cell.is_broken();
        !self.has_numbers()
            && self.cells.iter().all(is_word)
            && !self.cells.iter().all(Cell::is_blank)
    }

    /// Whether a cell is the name of an error, such as `L2`.
    pub(super) fn names_errors(&self) -> bool {
        self.cells.iter().any(|cell| says_error(&key(&cell.text)))
    }

    /// Whether its number at the coarsest level may be a rate over a level that is not printed. One
    /// number in all rows may be an order that is claimed, or an error that does not fall.
    pub(super) fn may_begin_late(&self) -> bool {
        says_rates(&self.key) && self.varies()
    }

    /// Whether the column is named like rates, and does not fall like an error.
    pub(super) fn is_named_rates(&self) -> bool {
        /// Least factor by which an error falls over a table.
        const STEEP: f64 = 3.0;
        let ends = self.numbers.first().zip(self.numbers.last());
        let falls = self.is_positive() && self.sense() == Some(Sense::Falls);
        let is_steep = falls && ends.is_some_and(|(first, last)| *first > STEEP * last);
        says_rates(&self.key) && !is_steep
    }
}

/// The column that the caller names for an argument.
pub(super) fn named(columns: &[Cells], argument: Argument, name: &str) -> Result<usize, Refused> {
    let names = columns.iter().map(|column| column.name.as_str());
    position(names.clone(), name).ok_or_else(|| {
        let found = names.take(12).collect::<Vec<_>>().join(", ");
        Refused::new(
            argument.with(name) + ", the name or number of a column",
            found,
        )
    })
}

/// How numbers change from row to row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sense {
    Falls,
    Rises,
}

/// How numbers change, if it is the same in all rows.
pub(super) fn moves(values: &[f64]) -> Option<Sense> {
    let all = |holds: fn(f64, f64) -> bool| values.windows(2).all(|two| holds(two[0], two[1]));
    match values.len() {
        0 | 1 => None,
        _ if all(|a, b| a > b) => Some(Sense::Falls),
        _ if all(|a, b| a < b) => Some(Sense::Rises),
        _ => None,
    }
}
