//! Which columns are errors, values and rates: by their numbers, and by their names where the numbers leave it open.

use std::collections::HashSet;

use super::column::{Cells, limit};
use super::names::{self, Word};
use super::number::{halves, number};
use super::text::RawTable;
use super::{Choice, Column, RateTable};
use crate::input::{Complaint, InputError, shorten};
use crate::judge::verdict::Level;
use crate::text::names::{did_you_mean, nearest};
use crate::text::number::{counted, plain_text};

/// Most names that a message lists.
const LISTED: usize = 12;
/// Rates are looked for among as many columns on either side.
pub(super) const NEIGHBOURS: usize = 40;

/// A grid and what is asked of it.
pub(super) struct TableReader<'g, 't> {
    grid: RawTable<'t>,
    file: &'g str,
    pub(super) choice: &'g Choice,
    /// The columns of the grid.
    pub(super) columns: Vec<Cells>,
}

/// What a column that nobody has chosen holds.
#[derive(PartialEq)]
enum Holds {
    Error,
    Value,
    Other,
    /// Perhaps an error that does not fall.
    Doubtful,
}

/// Columns by what they hold.
#[derive(Default)]
struct Sorted {
    errors: Vec<usize>,
    values: Vec<usize>,
    limits: Vec<usize>,
    doubtful: Vec<usize>,
    others: Vec<(String, String)>,
}

/// Reads the step and the errors that are meant.
pub(super) fn read(grid: RawTable<'_>, file: &str, choice: &Choice) -> Result<RateTable, InputError> {
    let width = grid.rows.iter().map(Vec::len).max().unwrap_or(0);
    let names = choice.names.clone().unwrap_or_else(|| match grid.names[..] {
        [] => vec![String::new(); grid.misfit.unwrap_or(width)],
        _ => grid.names.iter().map(|name| names::shown(name)).collect(),
    });
    let has_comma =
        grid.decimal_comma && grid.rows.iter().flatten().any(|cell| cell.contains(',') && number(cell, true).is_some());
    // `1.024` among decimal commas may be 1024.
    let value = |text: &str| number(text, grid.decimal_comma).filter(|_| !(has_comma && text.contains('.')));
    let column = |(k, name): (usize, &String)| {
        let numbers: Vec<_> = grid.rows.iter().map(|row| value(row.get(k)?)).collect();
        let word = Word::of(name);
        let may_count = matches!(word, Word::Unknown | Word::Cost | Word::Count(1)) && grid.rows.len() > 1;
        Cells {
            name: if name.is_empty() { format!("column {}", k + 1) } else { name.clone() },
            word,
            halves: halves(&numbers),
            numbers,
            is_claimed: false,
            is_index: may_count && grid.counts_rows(k),
        }
    };
    let mut columns: Vec<Cells> = names.iter().enumerate().map(column).collect();
    for name in choice.columns.iter().flatten().chain(&choice.claimed).chain(&choice.values) {
        if let Some(k) = names::position(columns.iter().map(|column| column.name.as_str()), name) {
            columns[k].is_claimed = true;
        }
    }
    let reader = TableReader { grid, file, choice, columns };
    reader.check(width)?;
    reader.read()
}

impl TableReader<'_, '_> {
    /// Refuses what is no table, and names that cannot be those of its columns.
    fn check(&self, width: usize) -> Result<(), InputError> {
        if width == 0 {
            let line = self.grid.text.lines().find(|line| !line.trim().is_empty());
            let found = line.map(|line| format!("no row of numbers, but `{}`", shorten(line.trim())));
            let expected = "a row of names, such as `h L2 H1`, then rows of numbers, such as `0.1 1.6e-3 4e-2`";
            let at = line.map(|_| &self.grid.text[..0]);
            return Err(self.error(at, expected, found.as_deref().unwrap_or("an empty table")));
        }
        let count = self.columns.len();
        if let Some(row) = self.grid.rows.iter().find(|row| row.len() != count) {
            let example = (1..).map(|k| format!("c{k}"));
            let is_even = self.grid.rows.iter().all(|row| row.len() == width);
            let command = self.choice.command(|choice| choice.names = Some(example.take(width).collect()));
            let found = counted(row.len(), "cell") + if is_even { &command } else { "" };
            let expected = format!("{}, one for each name", counted(count, "cell"));
            return Err(self.error(row.first().copied(), &expected, &found));
        }
        if let Some(k) = self.columns.iter().position(|column| column.name.contains(char::is_control)) {
            let found = format!("`{}`", shorten(&self.columns[k].name));
            return Err(self.error(Some(self.above(k)), "a name without control characters", &found));
        }
        if width < 2 {
            return Err(self.refuse("a column of steps and at least one of errors", "one column"));
        }
        Ok(())
    }

    fn read(mut self) -> Result<RateTable, InputError> {
        let (step, how) = self.step()?;
        let dim = self.dim(step)?;
        let steps = self.sort(step, dim)?;
        let Sorted { errors, values, others, .. } = self.sorted(step, &steps)?;
        let mut seen = HashSet::new();
        if let Some(&twice) = errors.iter().chain(&values).find(|k| !seen.insert(&self.columns[**k].name)) {
            return Err(self.twice(twice));
        }
        let is_exact = self.columns[step].regular().is_some() || dim.is_some();
        let step_halves = if is_exact { vec![0.0; steps.len()] } else { self.columns[step].halves.clone() };
        let read = |&k: &usize| {
            let Cells { name, halves, .. } = &self.columns[k];
            let level = |(row, step): (usize, &f64)| Ok(Level { step: *step, error: self.must(row, k)? });
            let levels = steps.iter().enumerate().map(level).collect::<Result<_, InputError>>()?;
            Ok(Column { name: name.clone(), levels, halves: halves.clone(), step_halves: step_halves.clone() })
        };
        let quoted = |columns: &[usize]| listed(columns.iter().map(|k| format!("`{}`", self.columns[*k].name)));
        let left_out = listed(others.iter().map(|(name, why)| format!("`{name}` ({why})")));
        let parts = [("errors", quoted(&errors)), ("values", quoted(&values)), ("left out", left_out)];
        let parts = parts.iter().filter(|(_, list)| !list.is_empty()).map(|(what, list)| format!("; {what}: {list}"));
        let label = self.label(step, dim);
        let reading = format!("step: `{label}`{how}{}", parts.collect::<String>());
        let columns = errors.iter().map(read).collect::<Result<_, InputError>>()?;
        let values = values.iter().map(read).collect::<Result<_, InputError>>()?;
        Ok(RateTable { step: label, columns, values, not_errors: others, reading, is_guessed: !how.is_empty() })
    }

    /// The step of each row; puts the rows into the order of the steps, the coarsest level first, as the judge wants it.
    fn sort(&mut self, column: usize, dim: Option<f64>) -> Result<Vec<f64>, InputError> {
        let what = if dim.is_some() { "a count" } else { "a step" };
        let step = |row: usize| {
            let value = self.must(row, column)?;
            let is_step = value > 0.0 && value.is_finite();
            let step = dim.map_or(value, |dim| value.powf(-1.0 / dim));
            is_step.then_some(step).ok_or_else(|| self.at(row, column, &format!("{what}, a finite number > 0")))
        };
        let steps = (0..self.grid.rows.len()).map(step).collect::<Result<Vec<f64>, _>>()?;
        let mut order: Vec<usize> = (0..steps.len()).collect();
        order.sort_by(|a, b| steps[*b].total_cmp(&steps[*a]));
        self.grid.rows = order.iter().map(|row| std::mem::take(&mut self.grid.rows[*row])).collect();
        for Cells { numbers, halves, .. } in &mut self.columns {
            *numbers = order.iter().map(|row| numbers[*row]).collect();
            *halves = order.iter().map(|row| halves[*row]).collect();
        }
        let steps: Vec<f64> = order.iter().map(|row| steps[*row]).collect();
        if let Some(row) = steps.windows(2).position(|two| two[0] == two[1]) {
            let [before, cell] = [row, row + 1].map(|row| self.grid.rows[row][column]);
            let [first, second] = [before, cell].map(|cell| self.grid.place(cell).line);
            let found = format!("`{}` = {cell} in lines {first} and {second}", self.columns[column].name);
            return Err(self.error(Some(cell), "each step once: give one table at a time", &found));
        }
        Ok(steps)
    }

    fn twice(&self, column: usize) -> InputError {
        let again = |(k, name): (usize, &String)| {
            let is_again = self.columns[..k].iter().any(|earlier| earlier.name == *name);
            if is_again { format!("{name}_{}", k + 1) } else { name.clone() }.replace(',', ";")
        };
        let numbered = self.columns.iter().map(|column| &column.name).enumerate().map(again).collect();
        let command = self.choice.command(|choice| choice.names = Some(numbered));
        let found = format!("`{}` a second time{command}", shorten(&self.columns[column].name));
        self.error(Some(self.above(column)), "each name once", &found)
    }

    /// * `at`: a piece of the text.
    fn error(&self, at: Option<&str>, expected: &str, found: &str) -> InputError {
        let reason = format!("expected {expected}, found {found}");
        let place = at.map(|piece| self.grid.place(piece));
        InputError {
            file: self.file.to_owned(),
            place,
            field: None,
            complaint: Box::new(Complaint::Invalid { reason }),
        }
    }

    /// The name above a column, or where the text begins.
    fn above(&self, column: usize) -> &str {
        self.grid.names.get(column).copied().unwrap_or(&self.grid.text[..0])
    }

    /// A complaint about the row of names.
    pub(super) fn refuse(&self, expected: &str, found: &str) -> InputError {
        self.error(Some(self.above(0)), expected, found)
    }

    fn at(&self, row: usize, column: usize, expected: &str) -> InputError {
        let cell = self.grid.rows[row][column];
        let field = Some(self.columns[column].name.clone());
        InputError { field, ..self.error(Some(cell), expected, &format!("`{}`", shorten(cell))) }
    }

    pub(super) fn named(&self, columns: &[usize]) -> Vec<String> {
        columns.iter().map(|k| self.columns[*k].name.clone()).collect()
    }

    fn must(&self, row: usize, column: usize) -> Result<f64, InputError> {
        self.columns[column].value(row).ok_or_else(|| {
            let cell = self.grid.rows[row][column];
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

    /// The column of that name, or of that number from 1.
    pub(super) fn find(&self, wanted: &str, option: &str) -> Result<usize, InputError> {
        let names = || self.columns.iter().map(|column| column.name.as_str());
        let numbered = || wanted.parse::<usize>().ok()?.checked_sub(1).filter(|column| *column < self.columns.len());
        names::position(names(), wanted).or_else(numbered).ok_or_else(|| {
            let suggestion = nearest(wanted, names().take(LISTED)).map(str::to_owned);
            let found = format!("`{}`{}", shorten(wanted), did_you_mean(&suggestion));
            self.refuse(&format!("a column for {option}: {}", listed(names().map(str::to_owned))), &found)
        })
    }

    /// The columns of errors, those of values, and the others, each with the reason.
    fn sorted(&self, step: usize, steps: &[f64]) -> Result<Sorted, InputError> {
        let chosen = |wanted: &[String], option: &str| {
            wanted.iter().map(|name| self.find(name, option)).collect::<Result<Vec<usize>, _>>()
        };
        let mut found = Sorted { values: chosen(&self.choice.values, "--values")?, ..Sorted::default() };
        let wanted = chosen(self.choice.columns.as_deref().unwrap_or_default(), "--columns")?;
        let mut seen = HashSet::from([step]);
        for k in wanted.iter().chain(&found.values) {
            let (expected, what) = match self.columns[*k].word {
                _ if *k == step => ("errors for --columns", "the step "),
                _ if !seen.insert(*k) => ("each column of --columns and --values once", "twice "),
                Word::Logarithm => ("the values, not their logarithms", ""),
                _ => continue,
            };
            return Err(self.refuse(expected, &format!("{what}`{}`", self.columns[*k].name)));
        }
        if self.choice.columns.is_some() {
            return Ok(Sorted { errors: wanted, ..found });
        }
        found.others.clone_from(&self.grid.left_out);
        for k in (0..self.columns.len()).filter(|k| !seen.contains(k)) {
            let (kind, why) = self.kind(k, step, steps)?;
            match kind {
                Holds::Error => found.errors.push(k),
                Holds::Value => found.limits.push(k),
                Holds::Doubtful => found.doubtful.push(k),
                Holds::Other => {}
            }
            if kind != Holds::Error {
                found.others.push((self.columns[k].name.clone(), why));
            }
        }
        self.doubts(&found).map_or(Ok(found), Err)
    }

    /// What forbids to judge: no error, or a column that may be one and does not fall, where no name says which are
    /// errors.
    fn doubts(&self, found: &Sorted) -> Option<InputError> {
        let Sorted { errors, values, limits, doubtful, others } = found;
        let columns = |columns: &[usize]| self.choice.command(|choice| choice.columns = Some(self.named(columns)));
        if errors.is_empty() && values.is_empty() {
            let is_open =
                |column: &Cells| matches!(column.word, Word::Unknown | Word::Error) && column.value(0).is_none();
            if let Some(k) = self.columns.iter().position(is_open) {
                return self.must(0, k).err();
            }
            let command = match (&limits[..], &doubtful[..]) {
                ([], []) => String::new(),
                ([], [first, ..]) => columns(&[*first]),
                (limits, _) => self.choice.command(|choice| choice.values = self.named(limits)),
            };
            let quoted = listed(others.iter().map(|(name, why)| format!("`{name}` ({why})")));
            return Some(self.refuse("a column of errors, or --columns LIST", &(quoted + &command)));
        }
        let is_named = |k: &usize| self.columns[*k].word == Word::Error || self.columns[*k].is_claimed;
        if errors.iter().any(is_named) || !values.is_empty() {
            return None;
        }
        let name = &self.columns[*doubtful.first()?].name;
        let why = others.iter().find(|(other, _)| other == name).map_or("", |(_, why)| why);
        let commands = columns(errors) + &columns(&[errors.as_slice(), doubtful].concat());
        let found = format!("`{name}`, which is {why}{commands}");
        Some(self.refuse("--columns LIST to say which columns are errors", &found))
    }

    /// What a column holds, by its numbers and then by its name; where it is no error, why.
    fn kind(&self, k: usize, step: usize, steps: &[f64]) -> Result<(Holds, String), InputError> {
        let column = &self.columns[k];
        let numbers: Vec<f64> = column.numbers.iter().flatten().map(|number| number.value).collect();
        let missing = column.numbers.iter().position(Option::is_none);
        let other = |why: &str| Ok((Holds::Other, why.to_owned()));
        let error = || Ok((Holds::Error, String::new()));
        match column.word {
            _ if column.is_claimed => return error(),
            _ if numbers.is_empty() => return other("no number"),
            _ if column.is_index => return other("the number of the row"),
            Word::Error | Word::Unknown => {}
            _ if column.is_constant() => return other("the same in each row"),
            _ => {}
        }
        if let Some(rates) = self.rates_of(k, step, steps) {
            return other(&format!("the rates of `{}`", self.columns[rates].name));
        }
        match (column.word, missing) {
            (Word::Logarithm, _) => return other("a logarithm"),
            (Word::Step, _) => return other("a step"),
            (Word::Count(_), _) => return other("a count"),
            (Word::Cost, _) => return other("a cost"),
            (Word::Rate, _) => return other("a rate"),
            (Word::Unknown, Some(0)) if numbers.len() + 1 == steps.len() => {
                return other("no number on the coarsest level");
            }
            (Word::Error, None) => return error(),
            (word, Some(_)) if word != Word::Error && 2 * numbers.len() < steps.len() => return other("words"),
            (_, Some(row)) => return self.must(row, k).map(|_| (Holds::Error, String::new())),
            (_, None) => {}
        }
        let (first, last) = (numbers[0], numbers[numbers.len() - 1]);
        let falls = 2 * numbers.windows(2).filter(|two| two[1] < two[0]).count() >= numbers.len() - 1 && last < first;
        let is_whole = numbers.iter().all(|value| value.fract() == 0.0);
        let doubtful = |why: &str| Ok((Holds::Doubtful, why.to_owned()));
        match column.word {
            Word::MaybeRate if !(falls && last <= 0.6 * first) => other("a rate"),
            Word::MaybeRate => error(),
            _ if numbers.len() < 3 || numbers.iter().any(|value| value.is_nan()) => error(),
            _ if column.is_constant() => doubtful("the same in each row"),
            _ if is_whole && !falls => doubtful("whole numbers that do not fall"),
            _ if self.columns[step].is_in_proportion(column) => doubtful("in proportion to the step"),
            _ => match limit(&numbers).filter(|_| !is_whole) {
                Some(limit) => Ok((Holds::Value, format!("tends to {}: a value, not an error", plain_text(limit)))),
                None if falls => error(),
                None => doubtful("growing or standing still where the step falls"),
            },
        }
    }

    /// The error whose rates or reductions a column has, to its digits.
    fn rates_of(&self, column: usize, step: usize, steps: &[f64]) -> Option<usize> {
        // Those before it, the nearest first, and those behind.
        let before = (column.saturating_sub(NEIGHBOURS)..column).rev();
        let mut near = before.chain(column + 1..(column + NEIGHBOURS).min(self.columns.len()));
        near.find(|k| *k != step && self.columns[column].are_rates_of(&self.columns[*k], steps))
    }
}

/// Names in a message, not too many of them.
pub(super) fn listed(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.take(LISTED + 1).collect();
    names[..names.len().min(LISTED)].join(", ") + if names.len() > LISTED { ", ..." } else { "" }
}
