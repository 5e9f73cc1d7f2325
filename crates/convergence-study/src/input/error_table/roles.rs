//! Which columns are errors, values and rates: decided by their numbers, and by their names if the numbers do not decide.

use std::collections::HashSet;

use super::columns::{Cells, Trend};
use super::names::{self, Word};
use super::number::{halves, number};
use super::step::Step;
use super::text::{self, RawTable};
use super::{Choice, Column, RateTable};
use crate::input::{Complaint, InputError, Source, shorten};
use crate::judge::verdict::Level;
use crate::text::names::{did_you_mean, nearest};
use crate::text::number::{counted, plain_text};

/// Most names that a message lists.
const LISTED: usize = 12;
/// Rates are searched for among this many columns on either side.
pub(super) const NEIGHBOURS: usize = 40;

/// A table and the choices of the user.
pub(super) struct TableReader<'t> {
    text: &'t str,
    file: &'t str,
    pub(super) choice: &'t Choice,
    table: RawTable<'t>,
    pub(super) columns: Vec<Cells<'t>>,
}

/// What an unchosen column holds; if it is not an error, why.
enum Holds {
    Error,
    Value(String),
    Other(String),
    /// Possibly an error that does not fall.
    Doubtful(String),
}

/// Reads the step and the chosen errors.
pub(super) fn read(text: &str, file: &str, choice: &Choice) -> Result<RateTable, InputError> {
    let mut reader = TableReader { text, file, choice, table: text::read(text), columns: vec![] };
    reader.columns = reader.filled()?;
    let step = reader.step()?;
    let steps = reader.sort(&step)?;
    let [errors, values] = reader.chosen(step.column)?;
    let (errors, others) = match choice.columns {
        Some(_) => (errors, vec![]),
        None => (reader.found(&step, &steps, &values)?, std::mem::take(&mut reader.table.left_out)),
    };
    let mut seen = HashSet::new();
    if let Some(&twice) = errors.iter().chain(&values).find(|k| !seen.insert(&reader.columns[**k].name)) {
        return Err(reader.twice(twice));
    }
    let is_exact = step.dim.is_some() || reader.columns[step.column].regular().is_some();
    let step_halves = if is_exact { vec![0.0; steps.len()] } else { reader.columns[step.column].halves.clone() };
    let column = |&k: &usize| {
        let Cells { name, halves, .. } = &reader.columns[k];
        let level = |(row, step): (usize, &f64)| Ok(Level { step: *step, error: reader.must(row, k)? });
        let levels = steps.iter().enumerate().map(level).collect::<Result<_, InputError>>()?;
        Ok(Column { name: name.clone(), levels, halves: halves.clone(), step_halves: step_halves.clone() })
    };
    let parts =
        [("errors", reader.quoted(&errors)), ("values", reader.quoted(&values)), ("left out", reasons(&others))];
    let parts = parts.iter().filter(|(_, list)| !list.is_empty()).map(|(what, list)| format!("; {what}: {list}"));
    Ok(RateTable {
        reading: format!("step: `{}`{}{}", step.label, step.how, parts.collect::<String>()),
        columns: errors.iter().map(column).collect::<Result<_, InputError>>()?,
        values: values.iter().map(column).collect::<Result<_, InputError>>()?,
        not_errors: others,
        is_guessed: !step.how.is_empty(),
        step: step.label,
    })
}

/// Columns that are not errors, each with the reason.
fn reasons(others: &[(String, String)]) -> String {
    listed(others.iter().map(|(name, why)| format!("`{name}` ({why})")))
}

/// Names in a message, but not too many.
pub(super) fn listed(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.take(LISTED + 1).collect();
    names[..names.len().min(LISTED)].join(", ") + if names.len() > LISTED { ", ..." } else { "" }
}

impl<'t> TableReader<'t> {
    /// The columns; refuses a text without a table, and names that do not fit its columns.
    fn filled(&self) -> Result<Vec<Cells<'t>>, InputError> {
        let RawTable { names, rows, .. } = &self.table;
        let width = rows.iter().map(Vec::len).max().unwrap_or(0);
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
            return Err(
                self.refuse("a column of steps and at least one of errors", "one column: write the table as CSV")
            );
        }
        Ok(self.columns_of(names))
    }

    fn columns_of(&self, names: Vec<String>) -> Vec<Cells<'t>> {
        let RawTable { rows, decimal_comma, .. } = &self.table;
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
            let may_count = matches!(word, Word::Unknown | Word::Cost | Word::Count(_)) && rows.len() > 1;
            let (is_claimed, is_index) = (claimed.contains(&k), may_count && text::counts_rows(&texts));
            let values = numbers.iter().map(|number| number.map_or(f64::NAN, |number| number.value)).collect();
            let is_number = numbers.iter().map(Option::is_some).collect();
            Cells { name, word, texts, values, is_number, halves: halves(&numbers), is_claimed, is_index }
        };
        names.iter().enumerate().map(column).collect()
    }

    /// The step of each row; sorts the rows by step, coarsest level first, as the judge requires.
    fn sort(&mut self, Step { column, dim, .. }: &Step) -> Result<Vec<f64>, InputError> {
        let what = if dim.is_some() { "a count" } else { "a step" };
        let cells = &self.columns[*column];
        let step = |row: usize| {
            let value = self.must(row, *column)?;
            let step = dim.map_or(value, |dim| value.powf(-1.0 / dim));
            let refused = || {
                let found = format!("`{}`", shorten(cells.texts[row]));
                self.error(cells.texts[row], Some(&cells.name), &format!("{what}, a finite number > 0"), &found)
            };
            (value > 0.0 && value.is_finite()).then_some(step).ok_or_else(refused)
        };
        let steps = (0..cells.texts.len()).map(step).collect::<Result<Vec<f64>, _>>()?;
        let mut order: Vec<usize> = (0..steps.len()).collect();
        order.sort_by(|a, b| steps[*b].total_cmp(&steps[*a]));
        if let Some(two) = order.windows(2).find(|two| steps[two[0]] == steps[two[1]]) {
            let [before, cell] = [two[0], two[1]].map(|row| cells.texts[row]);
            let [first, second] = [before, cell].map(|cell| self.text[..self.offset(cell)].matches('\n').count() + 1);
            let found = format!("`{}` = {cell} in lines {first} and {second}", cells.name);
            return Err(self.error(cell, None, "each step once: give one table at a time", &found));
        }
        self.columns.iter_mut().for_each(|cells| cells.sort(&order));
        Ok(order.iter().map(|row| steps[*row]).collect())
    }

    /// The columns chosen as errors and as values.
    fn chosen(&self, step: usize) -> Result<[Vec<usize>; 2], InputError> {
        let find = |wanted: &[String], option: &str| {
            wanted.iter().map(|name| self.find(name, option)).collect::<Result<Vec<usize>, _>>()
        };
        let values = find(&self.choice.values, "--values")?;
        let errors = find(self.choice.columns.as_deref().unwrap_or_default(), "--columns")?;
        let mut seen = HashSet::from([step]);
        for k in errors.iter().chain(&values) {
            let (expected, what) = match self.columns[*k].word {
                _ if *k == step => ("errors for --columns", "the step "),
                _ if !seen.insert(*k) => ("each column of --columns and --values once", "twice "),
                Word::Logarithm => ("the values, not their logarithms", ""),
                _ => continue,
            };
            return Err(self.refuse(expected, &format!("{what}`{}`", self.columns[*k].name)));
        }
        Ok([errors, values])
    }

    /// The columns of errors; the others are left out, each with the reason. Refuses to judge without errors, or if a
    /// column may be an error but does not fall and no name says which columns are errors.
    fn found(&mut self, step: &Step, steps: &[f64], values: &[usize]) -> Result<Vec<usize>, InputError> {
        let (mut errors, mut limits, mut doubtful) = (vec![], vec![], vec![]);
        for k in (0..self.columns.len()).filter(|k| *k != step.column && !values.contains(k)) {
            let (columns, why) = match self.holds(k, step.column, steps)? {
                Holds::Error => (&mut errors, None),
                Holds::Value(why) => (&mut limits, Some(why)),
                Holds::Doubtful(why) => (&mut doubtful, Some(why)),
                Holds::Other(why) => (&mut vec![], Some(why)),
            };
            columns.push(k);
            self.table.left_out.extend(why.map(|why| (self.columns[k].name.clone(), why)));
        }
        let others = &self.table.left_out;
        let command = |columns: &[usize]| self.choice.command(|choice| choice.columns = Some(self.names(columns)));
        let is_sure = |k: &usize| self.columns[*k].word == Word::Error || self.columns[*k].is_claimed;
        match doubtful.first() {
            _ if errors.is_empty() && values.is_empty() => {
                let is_open = |column: &Cells<'_>| column.word.noun().is_none() && !column.is_number[0];
                if let Some(k) = self.columns.iter().position(is_open) {
                    self.must(0, k)?;
                }
                let command = match doubtful.first() {
                    _ if !limits.is_empty() => self.choice.command(|choice| choice.values = self.names(&limits)),
                    Some(first) => command(&[*first]),
                    None => String::new(),
                };
                Err(self.refuse("a column of errors, or --columns LIST", &(reasons(others) + &command)))
            }
            Some(first) if values.is_empty() && !errors.iter().any(is_sure) => {
                let name = &self.columns[*first].name;
                let why = others.iter().find(|(other, _)| other == name).map_or("", |(_, why)| why);
                let commands = command(&errors) + &command(&[errors.as_slice(), &doubtful].concat());
                let found = format!("`{name}`, which is {why}{commands}");
                Err(self.refuse("--columns LIST to say which columns are errors", &found))
            }
            _ => Ok(errors),
        }
    }

    /// What a column holds, by its numbers and then by its name.
    fn holds(&self, k: usize, step: usize, steps: &[f64]) -> Result<Holds, InputError> {
        let column = &self.columns[k];
        let numbers = column.is_number.iter().filter(|is_number| **is_number).count();
        let other = |why: &str| Ok(Holds::Other(why.to_owned()));
        // Errors before it, the nearest first, and those after it.
        let near = (k.saturating_sub(NEIGHBOURS)..k).rev().chain(k + 1..(k + NEIGHBOURS).min(self.columns.len()));
        let mut near = near.filter(|near| *near != step).map(|near| &self.columns[near]);
        match (near.find(|error| column.are_rates_of(error, steps)), column.word.noun()) {
            _ if column.is_claimed => Ok(Holds::Error),
            _ if numbers == 0 => other("no number"),
            _ if column.is_index => other("the number of the row"),
            (_, Some(_)) if column.is_constant() => other("the same in each row"),
            (Some(error), _) => other(&format!("the rates of `{}`", error.name)),
            _ if column.word == Word::Rate && column.is_steep() => Ok(Holds::Error),
            (None, Some(noun)) => other(noun),
            _ if numbers < steps.len() => match column.word {
                Word::Unknown if !column.is_number[0] && numbers + 1 == steps.len() => {
                    other("no number on the coarsest level")
                }
                Word::Unknown if 2 * numbers < steps.len() => other("words"),
                _ => {
                    (0..steps.len()).try_for_each(|row| self.must(row, k).map(|_| ()))?;
                    Ok(Holds::Error)
                }
            },
            _ if column.word == Word::Error || numbers < 3 || column.values.iter().any(|value| value.is_nan()) => {
                Ok(Holds::Error)
            }
            _ => Ok(match column.trend(&self.columns[step]) {
                Trend::Falls => Holds::Error,
                Trend::Grows => Holds::Other("whole numbers that do not fall".to_owned()),
                Trend::Limit(limit) => Holds::Value(format!("tends to {}: a value, not an error", plain_text(limit))),
                Trend::Doubtful(why) => Holds::Doubtful(why.to_owned()),
            }),
        }
    }

    fn twice(&self, column: usize) -> InputError {
        let mut seen = HashSet::new();
        let numbered = self.columns.iter().enumerate().map(|(k, Cells { name, .. })| {
            if seen.insert(name) { name.clone() } else { format!("{name}_{}", k + 1) }.replace(',', ";")
        });
        let command = self.choice.command(|choice| choice.names = Some(numbered.collect()));
        let found = format!("`{}` a second time{command}", shorten(&self.columns[column].name));
        self.error(self.head(column), None, "each name once", &found)
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
    fn must(&self, row: usize, column: usize) -> Result<f64, InputError> {
        let Cells { name, texts, values, is_number, .. } = &self.columns[column];
        is_number[row].then_some(values[row]).ok_or_else(|| {
            let cell = texts[row];
            let more = match () {
                () if cell.len() > 1 && cell.chars().all(|c| c == '*') => {
                    "; Fortran writes stars where the field is too narrow"
                }
                () if self.table.decimal_comma && cell.contains(',') => {
                    "; its comma may be that of decimals or of thousands"
                }
                () if number(cell, true).is_some() => {
                    "; its point may be that of decimals or of thousands, for others have decimal commas"
                }
                () => "",
            };
            self.error(cell, Some(name), &format!("a number{more}"), &format!("`{}`", shorten(cell)))
        })
    }

    pub(super) fn names(&self, columns: &[usize]) -> Vec<String> {
        columns.iter().map(|k| self.columns[*k].name.clone()).collect()
    }

    /// Names of columns in a line or message.
    pub(super) fn quoted(&self, columns: &[usize]) -> String {
        listed(columns.iter().map(|k| format!("`{}`", self.columns[*k].name)))
    }

    /// The name above a column, or the beginning of the text.
    fn head(&self, column: usize) -> &str {
        self.table.names.get(column).copied().unwrap_or(self.text)
    }

    /// A complaint about the row of names.
    pub(super) fn refuse(&self, expected: &str, found: &str) -> InputError {
        self.error(self.head(0), None, expected, found)
    }

    /// The byte offset of a piece within the text.
    fn offset(&self, piece: &str) -> usize {
        (piece.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize)
    }

    /// A complaint about a piece of the text.
    fn error(&self, piece: &str, field: Option<&str>, expected: &str, found: &str) -> InputError {
        let reason = format!("expected {expected}, found {found}");
        let source = Source { file: self.file, text: self.text };
        let error = source.error(self.offset(piece), field.map(str::to_owned), Complaint::Invalid { reason });
        InputError { place: error.place.filter(|_| !self.text.trim().is_empty()), ..error }
    }
}
