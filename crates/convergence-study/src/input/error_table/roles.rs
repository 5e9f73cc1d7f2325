//! Which columns are errors, values and rates: decided by their numbers, and by their names if the numbers do not decide.

use std::collections::HashSet;

use super::columns::{Cells, Derived, Trend};
use super::names::Word;
use super::reader::{NEIGHBOURS, TableReader, listed};
use super::step::Step;
use super::{Choice, Column, RateTable};
use crate::input::{InputError, shorten};
use crate::judge::verdict::Level;
use crate::text::number::plain_text;

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
    let mut reader = TableReader::new(text, file, choice)?;
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

impl TableReader<'_> {
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
        let derived = near.find_map(|error| Some((error, column.derived_from(error, steps)?)));
        match (derived, column.word.noun()) {
            _ if column.is_claimed => Ok(Holds::Error),
            _ if numbers == 0 => other("no number"),
            _ if column.is_index => other("the number of the row"),
            // Errors that are halved have the rate 1 and the factor 2.
            (Some((error, Derived::Factors)), _) if column.word == Word::Rate => {
                other(&format!("factors by which `{}` falls, not its rates", error.name))
            }
            (_, Some(_)) if column.is_constant() => other("the same in each row"),
            (Some((error, _)), _) => other(&format!("the rates of `{}`", error.name)),
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
}
