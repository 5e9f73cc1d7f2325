//! Which column is the step and which are errors.

use super::cells::Cell;
use super::grid::Grid;
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
    /// Dimension D > 0 of what a count counts: h = count^(-1/D).
    pub dim: Option<f64>,
}

/// Columns that are no errors, each with the reason.
type NotErrors = Vec<(String, &'static str)>;

/// Most names that a message lists.
const LISTED: usize = 12;

/// A grid and what is asked of it.
struct Reader<'g, 't> {
    grid: &'g Grid<'t>,
    meanings: Vec<Meaning>,
    file: &'g str,
    choice: &'g Choice,
}

/// Reads the step and the errors that are meant.
pub(super) fn read(grid: &Grid<'_>, file: &str, choice: &Choice) -> Result<RateTable, InputError> {
    let by_name: Vec<Meaning> = grid.names.iter().map(|cell| meaning(&name(*cell))).collect();
    let named = |k: usize| match (by_name[k], grid.names[k].text) {
        // Nameless are the number of the row and, behind an error, its rate.
        (_, "") => !(grid.has_dash(k) || (k == 0 && grid.counts_rows(0))),
        (Meaning::Rate, _) => false,
        _ => true,
    };
    check_names(grid, named, file)?;
    let meanings = by_name.iter().enumerate().map(|(k, by_name)| meant(grid, k, *by_name)).collect();
    Reader { grid, meanings, file, choice }.read()
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

/// A name without the markup of mathematics.
fn name(cell: Cell<'_>) -> String {
    let text = cell.text;
    if let Some((_, text)) = text.strip_prefix("\\multicolumn").and_then(|rest| rest.rsplit_once('{')) {
        return text.trim_end_matches('}').trim().trim_matches('$').to_owned();
    }
    let strip = |text: &str, mark: &str| text.strip_prefix(mark)?.strip_suffix(mark).map(str::to_owned);
    let text = ["**", "`", "$"].iter().fold(text.to_owned(), |text, mark| strip(&text, mark).unwrap_or(text));
    if text.contains('\\') {
        text.replace("\\_", "_").replace("\\|", "|").replace("\\#", "#").replace("\\Delta ", "Δ")
    } else {
        text
    }
}

impl Reader<'_, '_> {
    fn read(&self) -> Result<RateTable, InputError> {
        let step = self.step()?;
        let count = matches!(self.meanings[step], Meaning::Count(_))
            || (self.choice.dim.is_some() && self.meanings[step] != Meaning::Step);
        let dim = self.dim(step, count)?;
        let (errors, not_errors) = self.errors(step)?;
        let name = name(self.grid.names[step]);
        let label = match dim {
            Some(1.0) => format!("1/{name}"),
            Some(dim) => format!("{name}^(-1/{dim})"),
            None => name,
        };
        let steps =
            (0..self.grid.rows.len()).map(|row| self.step_at(row, step, dim)).collect::<Result<Vec<f64>, _>>()?;
        // The judge wants the coarsest level first.
        let mut order: Vec<usize> = (0..steps.len()).collect();
        order.sort_by(|a, b| steps[*b].total_cmp(&steps[*a]));
        let mut columns: Vec<(String, Vec<Level>)> =
            errors.iter().map(|&k| (self.name(k), Vec::with_capacity(steps.len()))).collect();
        for row in order {
            for ((_, levels), &column) in columns.iter_mut().zip(&errors) {
                let error = self.number(row, column).ok_or_else(|| self.no_number(row, column))?;
                levels.push(Level { step: steps[row], error });
            }
        }
        Ok(RateTable { step: label, columns, not_errors })
    }

    fn name(&self, column: usize) -> String {
        name(self.grid.names[column])
    }

    /// The column of that name.
    fn find(&self, wanted: &str, option: &str) -> Result<usize, InputError> {
        let names = || (0..self.grid.names.len()).map(|k| self.name(k));
        names().position(|name| name == wanted).ok_or_else(|| {
            let known: Vec<String> = names().filter(|name| !name.is_empty()).take(LISTED + 1).collect();
            let suggestion = nearest(wanted, known.iter().map(String::as_str)).map(str::to_owned);
            let found = format!("{}{}", shown(wanted), did_you_mean(&suggestion));
            self.refuse(&format!("a column for {option}: {}", listed(&known)), &found)
        })
    }

    /// The column of the step: the one asked for, named like a step, or like a count, or else the first.
    fn step(&self) -> Result<usize, InputError> {
        if let Some(wanted) = &self.choice.step {
            return self.find(wanted, "--step");
        }
        let of = |wanted: &dyn Fn(Meaning) -> bool| -> Vec<usize> {
            let all = self.meanings.iter().enumerate();
            all.filter(|(k, meaning)| wanted(**meaning) && !self.is_constant(*k)).map(|(k, _)| k).collect()
        };
        let is_excluded =
            |k: &usize| self.choice.columns.as_ref().is_some_and(|errors| errors.contains(&self.name(*k)));
        let mut steps = of(&|meaning| meaning == Meaning::Step);
        steps.retain(|k| !is_excluded(k));
        match steps[..] {
            [only] => return Ok(only),
            [] => {}
            _ => {
                let names: Vec<String> = steps.iter().map(|k| self.name(*k)).collect();
                return Err(self.refuse("one column of steps, or --step COLUMN", &listed(&names)));
            }
        }
        let rank = |k: &usize| match self.meanings[*k] {
            Meaning::Count(rank) => rank,
            _ => u8::MAX,
        };
        if let Some(count) = of(&|meaning| matches!(meaning, Meaning::Count(_))).into_iter().min_by_key(rank) {
            return Ok(count);
        }
        let first =
            self.meanings.iter().position(|meaning| matches!(meaning, Meaning::Step | Meaning::Unknown)).unwrap_or(0);
        if self.choice.dim.is_none() && self.counts(first) {
            let found = format!("`{}` with whole numbers, which counts have", self.name(first));
            return Err(self.refuse("a column of steps; --step COLUMN says which, --dim D that it counts", &found));
        }
        Ok(first)
    }

    fn is_constant(&self, column: usize) -> bool {
        let mut cells = self.grid.rows.iter().map(|row| row.cells[column].text);
        self.grid.rows.len() > 1 && cells.next().is_some_and(|first| cells.all(|cell| cell == first))
    }

    /// Whether all numbers are whole and some are not small.
    fn counts(&self, column: usize) -> bool {
        let value = |row| self.number(row, column);
        let rows = || 0..self.grid.rows.len();
        rows().all(|row| value(row).is_some_and(|value| value >= 1.0 && value.fract() == 0.0))
            && rows().any(|row| value(row).is_some_and(|value| value > 1.0))
    }

    /// The dimension for a column that counts; `None` for a step.
    fn dim(&self, step: usize, count: bool) -> Result<Option<f64>, InputError> {
        let name = self.name(step);
        match self.choice.dim {
            Some(dim) if count => Ok(Some(dim)),
            Some(_) => Err(self.refuse("no --dim, which is for counts such as `cells`", &format!("the step `{name}`"))),
            // Steps in time have one dimension.
            None if count && matches!(name.to_lowercase().as_str(), "steps" | "timesteps" | "time steps" | "nt") => {
                Ok(Some(1.0))
            }
            None if count => {
                let expected =
                    format!("--dim D for h = {name}^(-1/D), with D = 1 for cells along an edge, or --step COLUMN");
                Err(self.refuse(&expected, &format!("the count `{name}` and no step")))
            }
            None => Ok(None),
        }
    }

    /// The columns of errors, and those that are none.
    fn errors(&self, step: usize) -> Result<(Vec<usize>, NotErrors), InputError> {
        if let Some(wanted) = &self.choice.columns {
            let errors: Vec<usize> =
                wanted.iter().map(|name| self.find(name, "--columns")).collect::<Result<_, _>>()?;
            if let Some(twice) = errors.iter().enumerate().find(|(k, column)| errors[..*k].contains(column)) {
                return Err(
                    self.refuse("each column of --columns once", &format!("`{}` a second time", self.name(*twice.1)))
                );
            }
            if errors.contains(&step) {
                return Err(self.refuse("errors for --columns", &format!("the step `{}`", self.name(step))));
            }
            return Ok((errors, vec![]));
        }
        let (mut errors, mut others) = (vec![], vec![]);
        for (k, meaning) in self.meanings.iter().enumerate().filter(|(k, _)| *k != step) {
            let why = match meaning {
                Meaning::Step => "a step",
                Meaning::Count(_) => "a count",
                Meaning::Index => "the number of the row",
                Meaning::Rate => "a rate",
                Meaning::Cost => "a cost",
                Meaning::Unknown => {
                    errors.push(k);
                    continue;
                }
            };
            let name = self.name(k);
            others.push((if name.is_empty() { format!("column {}", k + 1) } else { name }, why));
        }
        if errors.is_empty() {
            let names: Vec<String> = others.iter().map(|(name, why)| format!("`{name}` ({why})")).collect();
            return Err(self.refuse("a column of errors, or --columns LIST", &listed(&names)));
        }
        Ok((errors, others))
    }

    fn cell(&self, row: usize, column: usize) -> Cell<'_> {
        self.grid.rows[row].cells[column]
    }

    fn number(&self, row: usize, column: usize) -> Option<f64> {
        number(self.cell(row, column).text, self.grid.decimal_comma)
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
        } else {
            "a number"
        };
        self.at(row, column, expected, &shown(text))
    }

    fn at(&self, row: usize, column: usize, expected: &str, found: &str) -> InputError {
        let place = Place { line: self.grid.rows[row].line, column: self.cell(row, column).column };
        InputError { field: Some(self.name(column)), ..complaint(self.file, Some(place), expected, found) }
    }

    /// A complaint about the row of names.
    fn refuse(&self, expected: &str, found: &str) -> InputError {
        let column = self.grid.names.first().map_or(1, |cell| cell.column);
        complaint(self.file, Some(Place { line: self.grid.line, column }), expected, found)
    }
}

/// Names in a message, not too many of them.
fn listed(names: &[String]) -> String {
    if names.is_empty() {
        return "none".to_owned();
    }
    let more = if names.len() > LISTED { ", ..." } else { "" };
    names[..names.len().min(LISTED)].join(", ") + more
}
