//! A table as it stands in a text, and its columns.

use super::Refused;
use super::cell::{Cell, Style, is_failure, plain, unit};
use super::names::{Family, Measure, family, key, position, says_rates};
use crate::input::advice::Argument;
use crate::judge::verdict::Samples;
use crate::text::number::counted;
use crate::text::visible::is_hidden;

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
    /// Its first and last line, from 1; zeros without lines.
    pub(super) lines: [usize; 2],
    pub(super) names: Vec<String>,
    /// The line of the names, where blanks part them.
    pub(super) head: Option<String>,
    /// As many cells in each.
    pub(super) rows: Vec<Vec<String>>,
    /// The line of each row, from 1; empty without lines.
    pub(super) row_lines: Vec<usize>,
}

impl Grid {
    /// Refuses what is too large or holds control characters.
    pub(super) fn check(&self) -> Result<(), Refused> {
        let width = self.rows[0].len();
        let most = |count: usize, noun: &str| format!("at most {}", counted(count, noun));
        if self.rows.len() > ROWS {
            let line = self.row_lines.get(ROWS).copied().unwrap_or(0);
            return Err(Refused::new(most(ROWS, "row"), "more").at(line));
        }
        if width > COLUMNS {
            return Err(self.refuse(most(COLUMNS, "column"), counted(width, "column")));
        }
        for name in &self.names {
            if name.contains(is_hidden) {
                return Err(self.refuse("a name without control characters", format!("`{name}`")));
            }
            if name.chars().count() > NAME {
                let found = counted(name.chars().count(), "character");
                return Err(self.refuse(format!("a name of {}", most(NAME, "character")), found));
            }
        }
        Ok(())
    }

    /// A refusal at its first line.
    pub(super) fn refuse(
        &self,
        expected: impl Into<super::Text>,
        found: impl Into<String>,
    ) -> Refused {
        Refused::new(expected, found).at(self.lines[0])
    }

    /// Its columns; `names` are as many as cells stand in a row.
    pub(super) fn columns(&self, names: &[String]) -> Vec<Cells> {
        let style = Style::of(self.rows.iter().flatten().map(String::as_str));
        let column = |(k, name): (usize, &String)| {
            let lines = self.row_lines.iter().copied().chain(std::iter::repeat(0));
            let texts = self.rows.iter().map(|row| row[k].as_str());
            let unit = unit(texts.filter(|text| text.contains(|c: char| c.is_ascii_digit())));
            let cell = |(row, line): (&Vec<String>, usize)| Cell {
                line,
                ..Cell::new(row[k].strip_suffix(unit).unwrap_or(&row[k]), style)
            };
            Cells::new(name, self.rows.iter().zip(lines).map(cell).collect())
        };
        names.iter().enumerate().map(column).collect()
    }
}

/// A column.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    pub(super) name: String,
    pub(super) key: String,
    pub(super) cells: Vec<Cell>,
    /// The samples of which the cells are errors.
    pub(super) samples: Option<Samples>,
}

impl Cells {
    pub(super) fn new(name: &str, cells: Vec<Cell>) -> Self {
        Self {
            name: plain(name),
            key: key(name),
            cells,
            samples: None,
        }
    }

    /// The column with these rows alone.
    pub(super) fn of_rows(&self, rows: &[usize]) -> Self {
        Self {
            cells: rows.iter().map(|row| self.cells[*row].clone()).collect(),
            ..self.clone()
        }
    }

    /// The numbers; `None` if a cell has none.
    pub(super) fn values(&self) -> Option<Vec<f64>> {
        self.cells.iter().map(Cell::value).collect()
    }

    /// What the name says of steps. `H` is no `h`, and a `mesh` that does not grow no count: either
    /// is a step only where no other is.
    pub(super) fn family(&self) -> Option<(Family, Measure)> {
        family(&self.key).filter(|_| self.name != "H" && !self.is_size())
    }

    /// How the numbers change from row to row, if all cells have one.
    pub(super) fn sense(&self) -> Option<Sense> {
        moves(&self.values()?)
    }

    /// Whether the numbers are 0, 1, 2, ... or 1, 2, 3, ...
    pub(super) fn numbers_rows(&self) -> bool {
        let values = self.values().unwrap_or_default();
        let first = values.first().copied();
        self.is_whole()
            && first.is_some_and(|first| [0.0, 1.0].contains(&first))
            && values.windows(2).all(|two| two[1] - two[0] == 1.0)
    }

    /// Whether a `mesh` or a `grid` has no growing whole numbers.
    pub(super) fn is_size(&self) -> bool {
        let grows = || self.sense() == Some(Sense::Rises);
        ["mesh", "grid"].contains(&self.key.as_str()) && !(self.is_whole() && grows())
    }

    /// Half a unit of the last printed place of each number.
    ///
    /// The row with the most decimals shows the place to which all are printed: a program that
    /// prints 0.25 and 0.0625 omits zeros.
    pub(super) fn halves(&self) -> Vec<f64> {
        let numbers = || self.cells.iter().filter_map(|cell| cell.number.as_ref());
        let most = |has_power: bool| {
            let alike = numbers().filter(|number| number.exponent.is_some() == has_power);
            alike
                .filter_map(|number| number.decimals)
                .max()
                .unwrap_or(0)
        };
        let [plain, scaled] = [most(false), most(true)];
        let half = |cell: &Cell| match &cell.number {
            Some(number) if number.half > 0.0 => {
                let power = number.exponent.unwrap_or(0);
                let decimals = if number.exponent.is_some() {
                    scaled
                } else {
                    plain
                };
                0.5 * 10f64.powi(power - decimals)
            }
            _ => 0.0,
        };
        self.cells.iter().map(half).collect()
    }

    pub(super) fn has_numbers(&self) -> bool {
        self.cells.iter().any(|cell| cell.number.is_some())
    }

    pub(super) fn is_whole(&self) -> bool {
        self.cells.iter().all(Cell::is_whole)
    }

    /// Whether numbers stand in all cells, not all the same.
    pub(super) fn varies(&self) -> bool {
        self.values()
            .is_some_and(|values| values.iter().any(|value| *value != values[0]))
    }

    pub(super) fn is_constant(&self) -> bool {
        self.values().is_some() && !self.varies()
    }

    /// Whether the numbers are positive.
    pub(super) fn is_positive(&self) -> bool {
        self.values()
            .is_some_and(|values| values.iter().all(|value| *value > 0.0))
    }

    /// The line of the first row that does not go on as the rows before it.
    pub(super) fn turn(&self) -> usize {
        let values = self.values().unwrap_or_default();
        let going = |end: &usize| moves(&values[..*end]).is_none();
        let end = (2..=values.len()).find(going);
        end.map_or(0, |end| self.cells[end - 1].line)
    }

    /// Whether all cells are words, none of them a word of failure.
    pub(super) fn are_labels(&self) -> bool {
        let is_word = |cell: &Cell| cell.is_blank() || !is_failure(&cell.text) && !cell.is_broken();
        !self.has_numbers()
            && self.cells.iter().all(is_word)
            && !self.cells.iter().all(Cell::is_blank)
    }

    /// Whether the column is named like rates, and does not fall like an error.
    pub(super) fn is_named_rates(&self) -> bool {
        /// Least factor by which an error falls over a table.
        const STEEP: f64 = 3.0;
        let is_steep = |values: Vec<f64>| values[0] > STEEP * values[values.len() - 1];
        let falls = self.is_positive() && self.sense() == Some(Sense::Falls);
        says_rates(&self.key) && !(falls && self.values().is_some_and(is_steep))
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
