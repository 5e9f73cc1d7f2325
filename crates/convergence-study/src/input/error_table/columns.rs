//! Which column is the step and which are errors.

use super::cells::Cell;
use super::grid::Grid;
use super::names::{self, name};
use super::number::number;
use super::words::{Meaning, meaning};
use super::{RateTable, check_names, complaint, shown};
use crate::input::{InputError, Place};
use crate::judge::verdict::Level;
use crate::text::names::{did_you_mean, nearest};

/// Which columns of a table are meant; by default the names of the columns decide.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Choice {
    /// The column of the step, or of the count that it is computed from.
    pub step: Option<String>,
    /// The columns of errors.
    pub columns: Option<Vec<String>>,
    /// Columns of which an order is claimed by name: none of them is taken for the step.
    pub claimed: Vec<String>,
    /// Dimension D > 0 of what a count counts: h = count^(-1/D).
    pub dim: Option<f64>,
}

/// Columns that are no errors, each with the reason.
type NotErrors = Vec<(String, &'static str)>;

/// Most names that a message lists.
const LISTED: usize = 12;

/// Largest distance of a rate as it is written from the rate of two errors: half a unit of one decimal.
const ROUNDED_RATE: f64 = 0.05;

/// A grid and what is asked of it.
pub(super) struct Reader<'g, 't> {
    pub(super) grid: &'g Grid<'t>,
    /// As messages show them.
    pub(super) names: Vec<String>,
    pub(super) meanings: Vec<Meaning>,
    file: &'g str,
    pub(super) choice: &'g Choice,
    /// Which columns `--columns` and `--order` name.
    claimed: Vec<usize>,
    /// Whether the table has a decimal comma.
    has_comma: bool,
}

/// Reads the step and the errors that are meant.
pub(super) fn read(grid: &Grid<'_>, file: &str, choice: &Choice) -> Result<RateTable, InputError> {
    let names: Vec<String> = grid.names.iter().map(|cell| name(*cell)).collect();
    let by_name: Vec<Meaning> = names.iter().map(|name| meaning(name)).collect();
    let named = |k: usize| match (by_name[k], grid.names[k].text) {
        // Nameless are the number of the row and, behind an error, its rate.
        (_, "") => !(grid.has_dash(k) || (k == 0 && grid.counts_rows(0))),
        (Meaning::Rate, _) => false,
        _ => true,
    };
    check_names(grid, named, file)?;
    let meanings = by_name.iter().enumerate().map(|(k, by_name)| meant(grid, k, *by_name)).collect();
    let wanted = choice.columns.iter().flatten().chain(&choice.claimed);
    let claimed = wanted.filter_map(|name| names::position(names.iter().map(String::as_str), name)).collect();
    let has_comma = grid.decimal_comma
        && grid
            .rows
            .iter()
            .flat_map(|row| &row.cells)
            .any(|cell| cell.text.contains(',') && number(cell.text, true).is_some());
    Reader { grid, names, meanings, file, choice, claimed, has_comma }.read()
}

/// What a column holds, by its name and, where that may be either, by its numbers.
fn meant(grid: &Grid<'_>, column: usize, by_name: Meaning) -> Meaning {
    let text = grid.names[column].text;
    match by_name {
        Meaning::Index if text.is_empty() && column > 0 => Meaning::Rate,
        Meaning::Index | Meaning::Count(1) if grid.rows.len() > 1 && grid.counts_rows(column) => Meaning::Index,
        Meaning::Index if !text.is_empty() => Meaning::Unknown,
        meaning => meaning,
    }
}

impl Reader<'_, '_> {
    fn read(&self) -> Result<RateTable, InputError> {
        let (step, note) = self.step()?;
        let dim = self.dim(step)?;
        let steps =
            (0..self.grid.rows.len()).map(|row| self.step_at(row, step, dim)).collect::<Result<Vec<f64>, _>>()?;
        // The judge wants the coarsest level first.
        let mut order: Vec<usize> = (0..steps.len()).collect();
        order.sort_by(|a, b| steps[*b].total_cmp(&steps[*a]));
        self.each_step_once(step, &steps, &order)?;
        let (errors, not_errors) = self.errors(step, &steps, &order)?;
        let mut columns: Vec<(String, Vec<Level>)> =
            errors.iter().map(|&k| (self.name(k).to_owned(), Vec::with_capacity(steps.len()))).collect();
        for row in order {
            for ((_, levels), &column) in columns.iter_mut().zip(&errors) {
                let error = self.number(row, column).ok_or_else(|| self.no_number(row, column))?;
                levels.push(Level { step: steps[row], error });
            }
        }
        let unclaimed = self.unlike_errors(&errors, &columns);
        Ok(RateTable { step: self.label(step, dim), columns, not_errors, unclaimed, notes: note.into_iter().collect() })
    }

    pub(super) fn name(&self, column: usize) -> &str {
        &self.names[column]
    }

    pub(super) fn is_claimed(&self, column: usize) -> bool {
        self.claimed.contains(&column)
    }

    /// The column of that name.
    pub(super) fn find(&self, wanted: &str, option: &str) -> Result<usize, InputError> {
        let names = || self.names.iter().map(String::as_str);
        names::position(names(), wanted).ok_or_else(|| {
            let known: Vec<String> =
                names().filter(|name| !name.is_empty()).take(LISTED + 1).map(str::to_owned).collect();
            let suggestion = nearest(wanted, known.iter().map(String::as_str)).map(str::to_owned);
            let found = format!("{}{}", shown(wanted), did_you_mean(&suggestion));
            self.refuse(&format!("a column for {option}: {}", listed(&known)), &found)
        })
    }

    fn each_step_once(&self, step: usize, steps: &[f64], order: &[usize]) -> Result<(), InputError> {
        let Some(twice) = order.windows(2).find(|two| steps[two[0]] == steps[two[1]]) else { return Ok(()) };
        let line = |row: usize| self.grid.rows[row].line;
        let (name, text) = (self.name(step), self.cell(twice[1], step).text);
        let found = format!("`{name}` = {text} in lines {} and {}", line(twice[0]), line(twice[1]));
        let place = Place { line: line(twice[1]), column: self.cell(twice[1], step).column };
        Err(complaint(self.file, Some(place), "each step once: give one table at a time", &found))
    }

    /// The columns of errors that `--columns` names.
    fn chosen(&self, wanted: &[String], step: usize) -> Result<Vec<usize>, InputError> {
        let errors: Vec<usize> = wanted.iter().map(|name| self.find(name, "--columns")).collect::<Result<_, _>>()?;
        if let Some(twice) = errors.iter().enumerate().find(|(k, column)| errors[..*k].contains(column)) {
            return Err(
                self.refuse("each column of --columns once", &format!("`{}` a second time", self.name(*twice.1)))
            );
        }
        if errors.contains(&step) {
            return Err(self.refuse("errors for --columns", &format!("the step `{}`", self.name(step))));
        }
        match errors.iter().find(|k| self.meanings[**k] == Meaning::Logarithm) {
            Some(logarithm) => Err(self.logarithm(*logarithm)),
            None => Ok(errors),
        }
    }

    /// The columns of errors, and those that are none.
    fn errors(&self, step: usize, steps: &[f64], order: &[usize]) -> Result<(Vec<usize>, NotErrors), InputError> {
        if let Some(wanted) = &self.choice.columns {
            return Ok((self.chosen(wanted, step)?, vec![]));
        }
        let (mut errors, mut others) = (vec![], vec![]);
        for (k, meaning) in self.meanings.iter().enumerate().filter(|(k, _)| *k != step) {
            let why = match meaning {
                Meaning::Step => "a step",
                Meaning::Count(_) => "a count",
                Meaning::Index => "the number of the row",
                Meaning::Rate => "a rate",
                Meaning::Cost => "a cost",
                Meaning::RateOrError if self.repeats_rates(k, steps, order) => "a rate",
                Meaning::Logarithm if self.repeats_logarithm(k) => "a logarithm",
                Meaning::Logarithm => return Err(self.logarithm(k)),
                Meaning::Unknown | Meaning::Error | Meaning::RateOrError => {
                    errors.push(k);
                    continue;
                }
            };
            let name = self.name(k);
            others.push((if name.is_empty() { format!("column {}", k + 1) } else { name.to_owned() }, why));
        }
        if errors.is_empty() {
            let names: Vec<String> = others.iter().map(|(name, why)| format!("`{name}` ({why})")).collect();
            return Err(self.refuse("a column of errors, or --columns LIST", &listed(&names)));
        }
        Ok((errors, others))
    }

    fn logarithm(&self, column: usize) -> InputError {
        self.refuse("the values, not their logarithms", &format!("`{}`", self.name(column)))
    }

    /// Whether the numbers of a column are the rates or the reductions of an error in the table, from the second level on.
    fn repeats_rates(&self, column: usize, steps: &[f64], order: &[usize]) -> bool {
        let is_error = |k: &usize| matches!(self.meanings[*k], Meaning::Unknown | Meaning::Error);
        let repeats = |error: usize, two: &[usize]| {
            let reduction = self.number(two[0], error)? / self.number(two[1], error)?;
            let rate = reduction.ln() / (steps[two[0]] / steps[two[1]]).ln();
            let written = self.number(two[1], column)?;
            Some([rate, reduction].iter().any(|value| (written - value).abs() <= ROUNDED_RATE))
        };
        let mut errors = (0..self.names.len()).filter(is_error);
        order.len() > 2 && errors.any(|error| order.windows(2).all(|two| repeats(error, two) == Some(true)))
    }

    /// Columns whose names are not those of errors and whose numbers are the same on all levels, or counts that grow.
    ///
    /// None where no column is named like an error, but for counts: then any name may be that of an error.
    fn unlike_errors(&self, errors: &[usize], columns: &[(String, Vec<Level>)]) -> Vec<String> {
        let is_named = |k: usize| self.meanings[k] == Meaning::Error || self.is_claimed(k);
        let some_named = errors.iter().any(|k| is_named(*k));
        let grows = |levels: &[Level]| levels.windows(2).all(|two| two[0].error < two[1].error);
        let is_unlike = |(k, (_, levels)): &(&usize, &(String, Vec<Level>))| {
            levels.len() > 2
                && self.meanings[**k] == Meaning::Unknown
                && !self.is_claimed(**k)
                && ((some_named && self.is_constant(**k)) || (self.counts(**k) && grows(levels)))
        };
        let unlike: Vec<String> =
            errors.iter().zip(columns).filter(is_unlike).map(|(_, (name, _))| name.clone()).collect();
        if unlike.len() == errors.len() { vec![] } else { unlike }
    }

    fn cell(&self, row: usize, column: usize) -> Cell<'_> {
        self.grid.rows[row].cells[column]
    }

    pub(super) fn number(&self, row: usize, column: usize) -> Option<f64> {
        let text = self.cell(row, column).text;
        number(text, self.grid.decimal_comma).filter(|_| !(self.has_comma && has_points_of_thousands(text)))
    }

    /// The step of a row, a finite number > 0.
    fn step_at(&self, row: usize, column: usize, dim: Option<f64>) -> Result<f64, InputError> {
        let value = self.number(row, column).ok_or_else(|| self.no_number(row, column))?;
        let found = shown(self.cell(row, column).text);
        match dim {
            _ if !(value > 0.0 && value.is_finite()) => {
                let expected =
                    if dim.is_some() { "a count, a finite number > 0" } else { "a step, a finite number > 0" };
                Err(self.at(row, column, expected, &found))
            }
            Some(dim) => Ok(value.powf(-1.0 / dim)),
            None => Ok(value),
        }
    }

    fn no_number(&self, row: usize, column: usize) -> InputError {
        let text = self.cell(row, column).text;
        let expected = if text.len() > 1 && text.chars().all(|c| c == '*') {
            "a number; Fortran writes stars where the field is too narrow"
        } else if text.contains(',') && self.grid.decimal_comma {
            "a number; its comma may be that of decimals or of thousands"
        } else if self.has_comma && has_points_of_thousands(text) {
            "a number; its point may be that of decimals or of thousands, for others have decimal commas"
        } else if text.ends_with(')') && text.contains(" (") {
            "a number; what stands in parentheses behind it needs a column of its own"
        } else {
            "a number"
        };
        self.at(row, column, expected, &shown(text))
    }

    fn at(&self, row: usize, column: usize, expected: &str, found: &str) -> InputError {
        let place = Place { line: self.grid.rows[row].line, column: self.cell(row, column).column };
        InputError { field: Some(self.name(column).to_owned()), ..complaint(self.file, Some(place), expected, found) }
    }

    /// A complaint about the row of names.
    pub(super) fn refuse(&self, expected: &str, found: &str) -> InputError {
        let column = self.grid.names.first().map_or(1, |cell| cell.column);
        complaint(self.file, Some(Place { line: self.grid.line, column }), expected, found)
    }
}

/// `1.024`, in a table of decimal commas: 1024 as well as 1.024.
fn has_points_of_thousands(text: &str) -> bool {
    let is_digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    let mut groups = text.trim_start_matches(['+', '-']).split('.');
    let first = groups.next().unwrap_or("");
    let mut groups = groups.peekable();
    is_digits(first)
        && first.len() <= 3
        && !first.starts_with('0')
        && groups.peek().is_some()
        && groups.all(|group| group.len() == 3 && is_digits(group))
}

/// Names in a message, not too many of them.
pub(super) fn listed(names: &[String]) -> String {
    if names.is_empty() {
        return "none".to_owned();
    }
    let more = if names.len() > LISTED { ", ..." } else { "" };
    names[..names.len().min(LISTED)].join(", ") + more
}
