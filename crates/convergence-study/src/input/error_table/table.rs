//! A table in columns: properties of their numbers, and complaints about them.

use std::f64::consts::LN_2;

use super::names::{self, Word};
use super::number::{halves, number};
use super::text::RawTable;
use super::{Choice, rows};
use crate::input::{Complaint, InputError, Source, shorten};
use crate::text::names::{did_you_mean, nearest};
use crate::text::number::counted;

/// Most names that a message lists.
const LISTED: usize = 12;
/// Rates are searched for among this many columns on either side.
pub(super) const NEIGHBOURS: usize = 40;
/// Largest relative difference of two equal ratios, given their digits.
const SAME: f64 = 1e-5;
/// Largest ratio between numbers that tend to a limit.
const NEAR: f64 = 1.5;
/// Errors fall at least by this factor from level to level if their column has a name like one of rates.
const STEEP: f64 = 0.72;

/// Formats that are not read: a mark of each, and what to do.
const FOREIGN: [(&str, &str); 4] = [
    (
        "<td",
        "an HTML table: copy its rows from the browser, or write them with `pandas.read_html(FILE)[0].to_csv(OTHER)`",
    ),
    ("\n|-\n", "a MediaWiki table: copy it from the page, or write it as CSV"),
    ("\"columns\":[", "JSON of pandas that is split: write `to_json(orient=\"records\")`"),
    ("\":{\"0\":", "JSON of pandas with an object for each column: write `to_json(orient=\"records\")`"),
];

/// A table and the choices of the user.
pub(super) struct TableReader<'t> {
    pub(super) text: &'t str,
    file: &'t str,
    pub(super) choice: &'t Choice,
    pub(super) grid: RawTable<'t>,
    pub(super) columns: Vec<Cells<'t>>,
}

/// A column, row by row.
pub(super) struct Cells<'t> {
    /// Its name in messages.
    pub(super) name: String,
    pub(super) word: Word,
    pub(super) texts: Vec<&'t str>,
    /// NaN if there is no number.
    pub(super) values: Vec<f64>,
    pub(super) is_number: Vec<bool>,
    /// Half a unit of the last place of each number.
    pub(super) halves: Vec<f64>,
    /// Whether `--columns`, `--values` or `--order` names it.
    pub(super) is_claimed: bool,
    /// Whether it counts the rows.
    pub(super) is_index: bool,
}

impl Cells<'_> {
    pub(super) fn is_constant(&self) -> bool {
        self.values.len() > 1 && self.values.iter().all(|value| *value == self.values[0])
    }

    /// Whether each number is positive and much smaller than the previous one.
    pub(super) fn is_steep(&self) -> bool {
        self.values.len() > 2 && self.values.windows(2).all(|two| 0.0 < two[1] && two[1] <= STEEP * two[0])
    }

    fn widest_half(&self) -> f64 {
        self.halves.iter().copied().fold(0.0, f64::max)
    }

    /// The least ratio by which the column falls or grows, if all ratios are equal or its numbers are whole multiples
    /// or fractions of one of them.
    pub(super) fn regular(&self) -> Option<f64> {
        let mut values = self.values.clone();
        values.sort_by(f64::total_cmp);
        let (least, most) = (*values.first()?, *values.last()?);
        let same = SAME.max(2.0 * self.widest_half() / least).min(0.02);
        let ratios: Vec<f64> = values.windows(2).map(|two| two[1] / two[0]).collect();
        let ratio = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let is_whole = |multiple: f64| (multiple / multiple.round() - 1.0).abs() < SAME;
        let is_regular = ratios.iter().all(|one| (one / ratio - 1.0).abs() < same)
            || values.iter().all(|value| is_whole(most / value))
            || values.iter().all(|value| is_whole(value / least));
        (ratios.len() > 1 && is_regular && ratio > 1.0 && ratio.is_finite() && least > 0.0).then_some(ratio)
    }

    /// Whether two columns are the steps of one mesh in several directions, or of space and time.
    pub(super) fn is_in_proportion(&self, other: &Self) -> bool {
        let (a, b) = (&self.values, &other.values);
        a.iter().zip(b).all(|(x, y)| (x * b[0] / (y * a[0]) - 1.0).abs() < SAME)
    }

    /// Whether these are the rates or the reduction factors of an error, to its digits, on the finer or on the coarser
    /// level of each pair.
    ///
    /// * `steps`: of the rows, the coarsest first.
    pub(super) fn are_rates_of(&self, error: &Self, steps: &[f64]) -> bool {
        let (last, errors) = (steps.len() - 1, &error.values);
        if last < 2 || !errors.iter().all(|value| *value > 0.0) || errors[last] >= 0.7 * errors[0] {
            return false;
        }
        let half = 1.2 * self.widest_half();
        let is_same = |k: usize, found: f64, measure: usize| {
            let reduction = errors[k] / errors[k + 1];
            let doubt = error.halves[k] / errors[k] + error.halves[k + 1] / errors[k + 1];
            let (value, doubt) = match measure {
                0 => (reduction, doubt * reduction),
                1 => (reduction.log2(), doubt / LN_2),
                _ => (reduction.ln() / (steps[k] / steps[k + 1]).ln(), doubt / (steps[k] / steps[k + 1]).ln()),
            };
            (found - value).abs() <= (half + doubt).min(0.25) + SAME * value.abs()
        };
        let matches = |shift: usize, measure| (0..last).all(|k| is_same(k, self.values[k + shift], measure));
        // Three rates are proof enough; two need a name, or an end without one.
        let is_end = |row: usize| !self.values[row].is_finite() || [0.0, 1.0].contains(&self.values[row]);
        let may = |shift: &usize| last > 2 || self.word == Word::Rate || is_end(if *shift == 1 { 0 } else { last });
        [1, 0].into_iter().filter(may).any(|shift| (0..3).any(|measure| matches(shift, measure)))
    }
}

/// The limit of numbers, if it is near the last of them and not zero.
pub fn limit(numbers: &[f64]) -> Option<f64> {
    let [.., a, b, c] = *numbers else { return None };
    let shrinks = (c - b) / (b - a);
    let limit = if shrinks.abs() < 0.95 { c + (c - b) * shrinks / (1.0 - shrinks) } else { c };
    let sizes = || numbers.iter().map(|value| value.abs());
    let is_near = sizes().fold(0.0, f64::max) < NEAR * sizes().fold(f64::INFINITY, f64::min) && b != c;
    let settles = b != a && shrinks.abs() < 0.95 && limit / c > 0.7;
    (numbers.iter().all(|value| value * c > 0.0) && (settles || is_near) && limit.is_finite()).then_some(limit)
}

/// Names in a message, but not too many.
pub(super) fn listed(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.take(LISTED + 1).collect();
    names[..names.len().min(LISTED)].join(", ") + if names.len() > LISTED { ", ..." } else { "" }
}

impl<'t> TableReader<'t> {
    /// Splits a text into columns; refuses a text without a table, and names that do not fit its columns.
    pub(super) fn new(text: &'t str, file: &'t str, choice: &'t Choice) -> Result<Self, InputError> {
        let mut reader = Self { text, file, choice, grid: rows::read(text), columns: vec![] };
        reader.columns = reader.filled()?;
        Ok(reader)
    }

    fn filled(&self) -> Result<Vec<Cells<'t>>, InputError> {
        let RawTable { names, rows, .. } = &self.grid;
        let width = rows.iter().map(Vec::len).max().unwrap_or(0);
        if let Some((_, what)) = FOREIGN.iter().find(|(mark, _)| self.text.contains(mark)) {
            return Err(self.error(self.text, None, "rows of numbers", what));
        }
        if width == 0 {
            let line = self.text.lines().find(|line| !line.trim().is_empty()).map(|line| shorten(line.trim()));
            let found = line.map_or("an empty table".to_owned(), |line| format!("no row of numbers, but `{line}`"));
            let expected = "a row of names, such as `h L2 H1`, then rows of numbers, such as `0.1 1.6e-3 4e-2`";
            return Err(self.refuse(expected, &found));
        }
        let shown = || names.iter().map(|name| names::shown(name)).collect();
        let names: Vec<String> = self.choice.names.clone().unwrap_or_else(shown);
        if let Some(row) = rows.iter().find(|row| row.len() != names.len()) {
            let example = (1..=width).map(|k| format!("c{k}")).collect();
            let command = self.choice.command(|choice| choice.names = Some(example));
            let is_even = rows.iter().all(|row| row.len() == width);
            let found = counted(row.len(), "cell") + if is_even { &command } else { "" };
            let expected = format!("{}, one for each name", counted(names.len(), "cell"));
            return Err(self.error(row.first().unwrap_or(&self.text), None, &expected, &found));
        }
        if let Some(k) = names.iter().position(|name| name.contains(char::is_control)) {
            let found = format!("`{}`", shorten(&names[k]));
            return Err(self.error(self.head(k), None, "a name without control characters", &found));
        }
        if width < 2 {
            return Err(self.refuse("a column of steps and at least one of errors", "one column"));
        }
        Ok(self.columns_of(names))
    }

    fn columns_of(&self, names: Vec<String>) -> Vec<Cells<'t>> {
        let RawTable { rows, decimal_comma, .. } = &self.grid;
        let numbered = |(k, name): (usize, String)| if name.is_empty() { format!("column {}", k + 1) } else { name };
        let names: Vec<String> = names.into_iter().enumerate().map(numbered).collect();
        let Choice { columns, claimed, values, .. } = self.choice;
        let claimed = columns.iter().flatten().chain(claimed).chain(values);
        let claimed = claimed.filter_map(|name| names::position(names.iter().map(String::as_str), name));
        let claimed: Vec<usize> = claimed.collect();
        // With decimal commas, `1.024` may be 1024.
        let is_comma = |cell: &&str| *decimal_comma && cell.contains(',') && number(cell, true).is_some();
        let has_comma = rows.iter().flatten().any(is_comma);
        let value = |text: &&str| number(text, *decimal_comma).filter(|_| !(has_comma && text.contains('.')));
        let column = |(k, name): (usize, &String)| {
            let texts: Vec<&str> = rows.iter().map(|row| row[k]).collect();
            let numbers: Vec<_> = texts.iter().map(value).collect();
            let (name, word) = (name.clone(), Word::of(name));
            let may_count = matches!(word, Word::Unknown | Word::Cost | Word::Count(1)) && rows.len() > 1;
            let (is_claimed, is_index) = (claimed.contains(&k), may_count && rows::counts_rows(&texts));
            let values = numbers.iter().map(|number| number.map_or(f64::NAN, |number| number.value)).collect();
            let is_number = numbers.iter().map(Option::is_some).collect();
            Cells { name, word, texts, values, is_number, halves: halves(&numbers), is_claimed, is_index }
        };
        names.iter().enumerate().map(column).collect()
    }

    /// The column with that name, or with that number from 1.
    pub(super) fn find(&self, wanted: &str, option: &str) -> Result<usize, InputError> {
        let names = || self.columns.iter().map(|column| column.name.as_str());
        let numbered = || wanted.parse::<usize>().ok()?.checked_sub(1).filter(|column| *column < self.columns.len());
        names::position(names(), wanted).or_else(numbered).ok_or_else(|| {
            let suggestion = nearest(wanted, names().take(LISTED)).map(str::to_owned);
            let found = format!("`{}`{}", shorten(wanted), did_you_mean(&suggestion));
            self.refuse(&format!("a column for {option}: {}", listed(names().map(str::to_owned))), &found)
        })
    }

    /// The number of a cell that must hold one.
    pub(super) fn must(&self, row: usize, column: usize) -> Result<f64, InputError> {
        let Cells { texts, values, is_number, .. } = &self.columns[column];
        is_number[row].then_some(values[row]).ok_or_else(|| {
            let cell = texts[row];
            let more = match cell {
                _ if cell.len() > 1 && cell.chars().all(|c| c == '*') => {
                    "; Fortran writes stars where the field is too narrow"
                }
                _ if cell.contains(',') && self.grid.decimal_comma => {
                    "; its comma may be that of decimals or of thousands"
                }
                _ if number(cell, true).is_some() => {
                    "; its point may be that of decimals or of thousands, for others have decimal commas"
                }
                _ => "",
            };
            self.at(row, column, &format!("a number{more}"))
        })
    }

    /// The name above a column, or the beginning of the text.
    pub(super) fn head(&self, column: usize) -> &str {
        self.grid.names.get(column).copied().unwrap_or(self.text)
    }

    /// A complaint about the row of names.
    pub(super) fn refuse(&self, expected: &str, found: &str) -> InputError {
        self.error(self.head(0), None, expected, found)
    }

    /// A complaint about a cell.
    pub(super) fn at(&self, row: usize, column: usize, expected: &str) -> InputError {
        let Cells { name, texts, .. } = &self.columns[column];
        self.error(texts[row], Some(name.clone()), expected, &format!("`{}`", shorten(texts[row])))
    }

    /// The byte offset of a piece within the text.
    pub(super) fn offset(&self, piece: &str) -> usize {
        (piece.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize)
    }

    /// A complaint about a piece of the text.
    pub(super) fn error(&self, piece: &str, field: Option<String>, expected: &str, found: &str) -> InputError {
        let reason = format!("expected {expected}, found {found}");
        let source = Source { file: self.file, text: self.text };
        let error = source.error(self.offset(piece), field, Complaint::Invalid { reason });
        InputError { place: error.place.filter(|_| !self.text.trim().is_empty()), ..error }
    }
}
