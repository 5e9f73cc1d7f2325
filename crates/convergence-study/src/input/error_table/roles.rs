//! Which columns are errors, values and rates: decided by their numbers, and by their names if the numbers do not decide.

use std::collections::HashSet;

use super::names::Word;
use super::step::Step;
use super::table::{Cells, NEIGHBOURS, TableReader, limit, listed};
use super::{Choice, Column, RateTable};
use crate::input::{InputError, shorten};
use crate::judge::verdict::Level;
use crate::text::number::plain_text;

/// What an unchosen column holds.
#[derive(PartialEq)]
enum Holds {
    Error,
    Value,
    Other,
    /// Possibly an error that does not fall.
    Doubtful,
}

/// Reads the step and the chosen errors.
pub(super) fn read(text: &str, file: &str, choice: &Choice) -> Result<RateTable, InputError> {
    let mut reader = TableReader::new(text, file, choice)?;
    let step = reader.step()?;
    let steps = reader.sort(&step)?;
    let [errors, values] = reader.chosen(step.column)?;
    let (errors, others) = match choice.columns {
        Some(_) => (errors, vec![]),
        None => (reader.found(&step, &steps, &values)?, std::mem::take(&mut reader.grid.left_out)),
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
    let quoted = |columns: &[usize]| listed(columns.iter().map(|k| format!("`{}`", reader.columns[*k].name)));
    let parts = [("errors", quoted(&errors)), ("values", quoted(&values)), ("left out", reasons(&others))];
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
            let refused = || self.at(row, *column, &format!("{what}, a finite number > 0"));
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
        for Cells { texts, values, is_number, halves, .. } in &mut self.columns {
            *texts = order.iter().map(|row| texts[*row]).collect();
            *values = order.iter().map(|row| values[*row]).collect();
            *is_number = order.iter().map(|row| is_number[*row]).collect();
            *halves = order.iter().map(|row| halves[*row]).collect();
        }
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
        let mut found = [const { Vec::new() }; 4];
        for k in (0..self.columns.len()).filter(|k| *k != step.column && !values.contains(k)) {
            let (kind, why) = self.kind(k, step.column, steps)?;
            if kind != Holds::Error {
                self.grid.left_out.push((self.columns[k].name.clone(), why));
            }
            found[kind as usize].push(k);
        }
        let ([errors, limits, _, doubtful], others) = (found, &self.grid.left_out);
        let named = |columns: &[usize]| columns.iter().map(|k| self.columns[*k].name.clone()).collect::<Vec<_>>();
        let command = |columns: &[usize]| self.choice.command(|choice| choice.columns = Some(named(columns)));
        let is_sure = |k: &usize| self.columns[*k].word == Word::Error || self.columns[*k].is_claimed;
        match doubtful.first() {
            _ if errors.is_empty() && values.is_empty() => {
                let is_open = |column: &Cells<'_>| column.word.noun().is_none() && !column.is_number[0];
                if let Some(k) = self.columns.iter().position(is_open) {
                    self.must(0, k)?;
                }
                let command = match doubtful.first() {
                    _ if !limits.is_empty() => self.choice.command(|choice| choice.values = named(&limits)),
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

    /// What a column holds, by its numbers and then by its name; if it is not an error, why.
    fn kind(&self, k: usize, step: usize, steps: &[f64]) -> Result<(Holds, String), InputError> {
        let column = &self.columns[k];
        let numbers = (0..steps.len()).filter(|row| column.is_number[*row]).map(|row| column.values[row]);
        let numbers: Vec<f64> = numbers.collect();
        let other = |why: &str| Ok((Holds::Other, why.to_owned()));
        let error = Ok((Holds::Error, String::new()));
        match () {
            () if column.is_claimed => return error,
            () if numbers.is_empty() => return other("no number"),
            () if column.is_index => return other("the number of the row"),
            () if column.word.noun().is_some() && column.is_constant() => return other("the same in each row"),
            () => {}
        }
        // Errors before it, the nearest first, and those after it.
        let near = (k.saturating_sub(NEIGHBOURS)..k).rev().chain(k + 1..(k + NEIGHBOURS).min(self.columns.len()));
        let mut near = near.filter(|near| *near != step).map(|near| &self.columns[near]);
        let missing = column.is_number.iter().position(|is_number| !is_number);
        if let Some(error) = near.find(|error| column.are_rates_of(error, steps)) {
            return other(&format!("the rates of `{}`", error.name));
        } else if column.word == Word::Rate && column.is_steep() {
            return error;
        } else if let Some(noun) = column.word.noun() {
            return other(noun);
        } else if let Some(row) = missing {
            let is_first = row == 0 && numbers.len() + 1 == steps.len();
            return match column.word {
                Word::Unknown if is_first => other("no number on the coarsest level"),
                Word::Unknown if 2 * numbers.len() < steps.len() => other("words"),
                _ => self.must(row, k).map(|_| (Holds::Error, String::new())),
            };
        }
        let (first, last) = (numbers[0], numbers[numbers.len() - 1]);
        let falls = 2 * numbers.windows(2).filter(|two| two[1] < two[0]).count() >= numbers.len() - 1 && last < first;
        let is_whole = numbers.iter().all(|value| value.fract() == 0.0);
        let is_sure = column.word == Word::Error || numbers.len() < 3 || numbers.iter().any(|value| value.is_nan());
        let doubtful = match limit(&numbers).filter(|_| !is_whole) {
            _ if is_sure => return error,
            _ if column.is_constant() => "the same in each row",
            _ if is_whole && !falls => "whole numbers that do not fall",
            _ if self.columns[step].is_in_proportion(column) => "in proportion to the step",
            Some(limit) => return Ok((Holds::Value, format!("tends to {}: a value, not an error", plain_text(limit)))),
            None if falls => return error,
            None => "growing or standing still where the step falls",
        };
        Ok((Holds::Doubtful, doubtful.to_owned()))
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
