//! Which columns are errors, values and rates: decided by their numbers, and by their names if the
//! numbers do not decide.

use std::collections::HashSet;
use std::hash::Hash;

use super::columns::{Cells, Derived, Trend};
use super::frame::Original;
use super::groups;
use super::names::Word;
use super::pairs::{LeftOut, RawTable};
use super::parts::{self, Part};
use super::reader::{NEIGHBOURS, TableReader, listed};
use super::step::{Measure, Step};
use super::{Choice, Column, Offer, RateTable, names};
use crate::input::advice::{Argument, Text};
use crate::input::{Complaint, InputError, failed, shorten};
use crate::judge::verdict::Level;
use crate::text::number::plain_text;

/// What a column holds that nobody has chosen; if it is not an error, why.
enum Content {
    Error,
    Value(String),
    Other(String),
}

impl Content {
    /// No error, for this reason.
    fn other(reason: &str) -> Self {
        Self::Other(reason.to_owned())
    }
}

/// The first key whose name an earlier key has. Tables may have many thousand columns: no name is
/// compared with all others.
fn repeated<K: Copy, N: Eq + Hash>(
    mut keys: impl Iterator<Item = K>,
    name: impl Fn(K) -> N,
) -> Option<K> {
    let mut seen = HashSet::new();
    keys.find(|key| !seen.insert(name(*key)))
}

/// Reads each table of a text, with its heading. A refusal offers the choices that read all tables
/// and find the claimed columns.
pub(super) fn read_all(
    original: Original<'_>,
    choice: &Choice,
) -> Result<Vec<(String, RateTable)>, InputError> {
    let parts = parts::read(original.text);
    attempt_all(original, choice, &parts).map_err(|mut error| {
        error.offers.retain(|offer| {
            attempt_all(original, &offer.choice, &parts)
                .is_ok_and(|tables| has_claimed_columns(&tables, choice))
        });
        error
    })
}

/// Reads the only table of a text; refuses several.
pub(super) fn read(original: Original<'_>, choice: &Choice) -> Result<RateTable, InputError> {
    let mut tables = read_all(original, choice)?;
    match (tables.pop(), tables.len()) {
        (Some((_, table)), 0) => Ok(table),
        (last, _) => {
            let headings = tables
                .iter()
                .chain(&last)
                .map(|(heading, _)| format!("`{heading}`"));
            let complaint = Complaint::Table {
                expected: "one table".into(),
                found: listed(headings),
            };
            Err(failed(original.name, complaint))
        }
    }
}

/// Whether one of the tables has each column with an order claimed by name.
fn has_claimed_columns(tables: &[(String, RateTable)], choice: &Choice) -> bool {
    let has = |table: &RateTable, name: &str| {
        let columns = table.columns.iter().chain(&table.values);
        names::position(columns.map(|column| column.name.as_str()), name).is_some()
    };
    let mut claimed = choice.claimed.iter();
    claimed.all(|name| tables.iter().any(|(_, table)| has(table, name)))
}

/// Reads all tables with one choice. Beside others, a table that holds no errors by its names is
/// left out, which the first one says.
fn attempt_all(
    original: Original<'_>,
    choice: &Choice,
    parts: &[Part<'_>],
) -> Result<Vec<(String, RateTable)>, InputError> {
    let mut grids = vec![];
    for part in parts {
        for group in groups::split(&part.table, choice) {
            let headings = [part.heading.as_str(), group.heading.as_str()];
            let headings = if parts.len() == 1 {
                &headings[1..]
            } else {
                &headings[..]
            };
            let headings: Vec<&str> = headings
                .iter()
                .copied()
                .filter(|heading| !heading.is_empty())
                .collect();
            grids.push((headings.join(", "), group.table));
        }
    }
    let has_errors = |grid: &(String, RawTable<'_>)| may_have_errors(&grid.1, choice);
    let without_errors: Vec<String> = grids
        .iter()
        .filter(|grid| !has_errors(grid))
        .map(|(heading, _)| heading.clone())
        .collect();
    let leaves_out = !without_errors.is_empty() && without_errors.len() < grids.len();
    if leaves_out {
        grids.retain(has_errors);
    }
    let mut tables = vec![];
    for (heading, grid) in &grids {
        tables.push((heading.clone(), attempt(original, choice, grid)?));
    }
    if let [(_, first), ..] = &mut tables[..]
        && leaves_out
    {
        first.reading += &format!(
            "; without errors: {}",
            listed(without_errors.iter().map(|heading| format!("`{heading}`")))
        );
    }
    Ok(tables)
}

/// Whether some name of a grid is not that of a step, a count, a rate or a cost.
fn may_have_errors(grid: &RawTable<'_>, choice: &Choice) -> bool {
    let names = choice.names.clone();
    let names = names.unwrap_or_else(|| {
        grid.names
            .iter()
            .map(|name| names::without_markup(name))
            .collect()
    });
    names.iter().any(|name| Word::of(name).noun().is_none())
}

/// The k-th column over the steps.
///
/// * `step_halves`: half the last digit of each step as printed; 0 where it is known exactly.
fn column(
    reader: &TableReader<'_>,
    k: usize,
    steps: &[f64],
    step_halves: &[f64],
) -> Result<Column, InputError> {
    let Cells { name, halves, .. } = &reader.columns[k];
    let mut levels = Vec::with_capacity(steps.len());
    for (row, step) in steps.iter().enumerate() {
        levels.push(Level {
            step: *step,
            error: reader.must(row, k)?,
        });
    }
    Ok(Column {
        name: name.clone(),
        levels,
        halves: halves.clone(),
        step_halves: step_halves.to_vec(),
    })
}

/// Reads a table with one choice.
fn attempt(
    original: Original<'_>,
    choice: &Choice,
    table: &RawTable<'_>,
) -> Result<RateTable, InputError> {
    let mut reader = TableReader::new(original, choice, table)?;
    let step = reader.step()?;
    let steps = reader.sort(&step)?;
    let ChosenColumns { mut errors, values } = reader.chosen_columns(step.column)?;
    let mut others = vec![];
    if choice.columns.is_none() {
        errors = reader.error_columns(&step, &steps, &values)?;
        others = std::mem::take(&mut reader.left_out);
    }
    if let Some(&second) = repeated(errors.iter().chain(&values), |k| &reader.columns[*k].name) {
        return Err(reader.refuse_repetition(second));
    }
    let is_exact = step.measure != Measure::Step || reader.columns[step.column].regular().is_some();
    let step_halves = if is_exact {
        vec![0.0; steps.len()]
    } else {
        reader.columns[step.column].halves.clone()
    };
    let columns = |list: &[usize]| -> Result<Vec<Column>, InputError> {
        list.iter()
            .map(|k| column(&reader, *k, &steps, &step_halves))
            .collect()
    };
    let parts = [
        ("errors", reader.quoted(&errors)),
        ("values", reader.quoted(&values)),
        ("left out", reasons(&others)),
    ];
    let mut reading = format!("step: `{}`{}", step.label, step.how);
    for (what, list) in parts.iter().filter(|(_, list)| !list.is_empty()) {
        reading += &format!("; {what}: {list}");
    }
    Ok(RateTable {
        reading,
        columns: columns(&errors)?,
        values: columns(&values)?,
        not_errors: others
            .into_iter()
            .map(|LeftOut { name, reason }| (name, reason))
            .collect(),
        is_guessed: !step.how.is_empty(),
        step: step.label,
    })
}

/// Columns that are not errors, each with the reason.
fn reasons(others: &[LeftOut]) -> String {
    listed(
        others
            .iter()
            .map(|LeftOut { name, reason }| format!("`{name}` ({reason})")),
    )
}

/// The columns that the user has chosen.
struct ChosenColumns {
    errors: Vec<usize>,
    values: Vec<usize>,
}

impl TableReader<'_> {
    /// The step of each row; sorts the rows by step, coarsest level first, as the judge requires.
    fn sort(
        &mut self,
        Step {
            column, measure, ..
        }: &Step,
    ) -> Result<Vec<f64>, InputError> {
        let cells = &self.columns[*column];
        let mut steps = Vec::with_capacity(cells.texts.len());
        for (row, cell) in cells.texts.iter().enumerate() {
            let step = measure.step(self.must(row, *column)?).map_err(|expected| {
                let found = format!("`{}`", shorten(cell));
                self.error(cell, Some(&cells.name), expected, &found)
            })?;
            steps.push(step);
        }
        let mut order: Vec<usize> = (0..steps.len()).collect();
        order.sort_by(|a, b| steps[*b].total_cmp(&steps[*a]));
        if let Some(two) = order.windows(2).find(|two| steps[two[0]] == steps[two[1]]) {
            let [before, cell] = [two[0], two[1]].map(|row| cells.texts[row]);
            let [first, second] = [before, cell].map(|cell| self.original.row(self.offset(cell)));
            let rows = self.original.noun();
            let found = format!("`{}` = {cell} in {rows} {first} and {second}", cells.name);
            return Err(self.error(
                cell,
                None,
                "each step once: give one table at a time",
                &found,
            ));
        }
        self.columns.iter_mut().for_each(|cells| cells.sort(&order));
        Ok(order.iter().map(|row| steps[*row]).collect())
    }

    /// The columns chosen as errors and as values.
    fn chosen_columns(&self, step: usize) -> Result<ChosenColumns, InputError> {
        let values = self.find_all(&self.choice.values, Argument::Values)?;
        let names = self.choice.columns.as_deref().unwrap_or_default();
        let errors = self.find_all(names, Argument::Columns)?;
        let mut earlier = HashSet::new();
        for k in errors.iter().chain(&values) {
            let Cells { name, word, .. } = &self.columns[*k];
            if *k == step {
                let expected = Text::from("errors for ") + Argument::Columns.alone();
                return Err(self.refuse(expected, &format!("the step `{name}`")));
            }
            if !earlier.insert(*k) {
                let both = Argument::Columns.alone() + " and " + Argument::Values.alone();
                let expected = Text::from("each column of ") + both + " once";
                return Err(self.refuse(expected, &format!("twice `{name}`")));
            }
            if *word == Word::Logarithm {
                let expected = "the values, not their logarithms";
                return Err(self.refuse(expected, &format!("`{name}`")));
            }
        }
        Ok(ChosenColumns { errors, values })
    }

    /// The columns of these names, which an argument selects.
    fn find_all(&self, names: &[String], argument: Argument) -> Result<Vec<usize>, InputError> {
        let columns = names.iter().map(|name| self.find(name, argument));
        columns.collect()
    }

    /// The columns of errors; the others are left out, each with the reason. Refuses to judge
    /// without errors, or if a column tends to a limit. Nothing is left out because it does not
    /// fall: a lost order looks like that.
    fn error_columns(
        &mut self,
        step: &Step,
        steps: &[f64],
        values: &[usize],
    ) -> Result<Vec<usize>, InputError> {
        let mut errors = vec![];
        let mut limits = vec![];
        for k in (0..self.columns.len()).filter(|k| *k != step.column && !values.contains(k)) {
            let reason = match self.content(k, step.column, steps)? {
                Content::Error => {
                    errors.push(k);
                    continue;
                }
                Content::Value(reason) => {
                    limits.push(k);
                    reason
                }
                Content::Other(reason) => reason,
            };
            let name = self.columns[k].name.clone();
            self.left_out.push(LeftOut { name, reason });
        }
        if errors.is_empty() && values.is_empty() {
            return Err(self.refuse_without_errors(&limits)?);
        }
        if limits.is_empty() {
            return Ok(errors);
        }
        Err(self.refuse_limits(&errors, values, &limits))
    }

    /// The refusal of a table without errors and without chosen values: it offers the columns with
    /// a limit as values.
    fn refuse_without_errors(&self, limits: &[usize]) -> Result<InputError, InputError> {
        let mut columns = self.columns.iter();
        let unknown =
            columns.position(|column| column.word.noun().is_none() && !column.is_number[0]);
        if let Some(k) = unknown {
            self.must(0, k)?;
        }
        let offer =
            (!limits.is_empty()).then(|| self.offer(|choice| choice.values = self.names(limits)));
        let expected = Text::from("a column of errors, or ") + Argument::Columns.with_placeholder();
        Ok(self
            .refuse(expected, &reasons(&self.left_out))
            .offering(offer))
    }

    /// The refusal of columns that may be values, for they tend to a limit, or errors that no longer
    /// fall: only the user can tell. Left out, a lost order would pass.
    fn refuse_limits(&self, errors: &[usize], values: &[usize], limits: &[usize]) -> InputError {
        let found = format!(
            "{}, which tends to a limit: a value, or an error that no longer falls",
            self.quoted(&limits[..1])
        );
        let expected = Argument::Values.with_placeholder()
            + " or "
            + Argument::Columns.with_placeholder()
            + " to say what each column holds";
        let all_values = self.names(&[values, limits].concat());
        let as_values = Offer {
            comment: "if it is a value",
            ..self.offer(|choice| choice.values = all_values)
        };
        let as_errors = Offer {
            comment: "if it is an error",
            ..self.with_columns(&[errors, limits].concat())
        };
        self.refuse(expected, &found)
            .offering([as_values, as_errors])
    }

    /// The command with these columns as errors.
    fn with_columns(&self, columns: &[usize]) -> Offer {
        self.offer(|choice| choice.columns = Some(self.names(columns)))
    }

    /// What a column holds, by its numbers and then by its name.
    fn content(&self, k: usize, step: usize, steps: &[f64]) -> Result<Content, InputError> {
        let column = &self.columns[k];
        let numbers = column
            .is_number
            .iter()
            .filter(|is_number| **is_number)
            .count();
        if column.is_claimed {
            return Ok(Content::Error);
        }
        if numbers == 0 {
            return Ok(Content::other("no number"));
        }
        if column.is_index {
            return Ok(Content::other("the number of the row"));
        }
        // Errors before it, the nearest first, and those after it.
        let near = (k.saturating_sub(NEIGHBOURS)..k)
            .rev()
            .chain(k + 1..(k + NEIGHBOURS).min(self.columns.len()));
        let mut near = near
            .filter(|near| *near != step)
            .map(|near| &self.columns[near]);
        let derived = near.find_map(|error| Some((error, column.derived_from(error, steps)?)));
        match (derived, column.word.noun()) {
            // Errors that are halved have the rate 1 and the factor 2.
            (Some((error, Derived::Factors)), _) if column.word == Word::Rate => {
                let reason = format!("factors by which `{}` falls, not its rates", error.name);
                Ok(Content::Other(reason))
            }
            (Some((error, Derived::Factors)), _) => {
                let reason = format!("the factors by which `{}` falls", error.name);
                Ok(Content::Other(reason))
            }
            (_, Some(_)) if column.is_constant() => Ok(Content::other("the same in each row")),
            (Some((error, _)), _) => Ok(Content::Other(format!("the rates of `{}`", error.name))),
            (None, Some(_)) if column.word == Word::Rate && column.is_steep() => Ok(Content::Error),
            (None, Some(noun)) => Ok(Content::other(noun)),
            (None, None) if numbers < steps.len() => self.content_with_gaps(k, numbers),
            (None, None)
                if column.word == Word::Error
                    || numbers < 3
                    || column.values.iter().any(|value| value.is_nan()) =>
            {
                Ok(Content::Error)
            }
            (None, None) => Ok(match column.trend() {
                Trend::Error => Content::Error,
                Trend::Grows => Content::other("whole numbers that do not fall"),
                Trend::Limit(limit) => Content::Value(format!(
                    "tends to {}: a value, not an error",
                    plain_text(limit)
                )),
            }),
        }
    }

    /// What a column holds whose name says nothing, or errors, and which lacks some numbers.
    fn content_with_gaps(&self, k: usize, numbers: usize) -> Result<Content, InputError> {
        let column = &self.columns[k];
        let rows = column.texts.len();
        if column.word == Word::Unknown {
            if !column.is_number[0] && numbers + 1 == rows {
                return Ok(Content::other("no number on the coarsest level"));
            }
            if 2 * numbers < rows {
                return Ok(Content::other("words"));
            }
        }
        for row in 0..rows {
            self.must(row, k)?;
        }
        Ok(Content::Error)
    }

    /// The refusal of a name that two of the columns have; it offers names with numbers.
    fn refuse_repetition(&self, column: usize) -> InputError {
        let mut seen = HashSet::new();
        let numbered = self
            .columns
            .iter()
            .enumerate()
            .map(|(k, Cells { name, .. })| {
                if seen.insert(name) {
                    name.clone()
                } else {
                    format!("{name}_{}", k + 1)
                }
                .replace(',', ";")
            });
        let offer = self.offer(|choice| choice.names = Some(numbered.collect()));
        let found = format!("`{}` a second time", shorten(&self.columns[column].name));
        self.error(self.head(column), None, "each name once", &found)
            .offering([offer])
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::hash::Hasher;

    use super::*;

    /// A name that counts how often it is compared.
    struct Counted<'c>(usize, &'c Cell<usize>);

    impl PartialEq for Counted<'_> {
        fn eq(&self, other: &Self) -> bool {
            self.1.set(self.1.get() + 1);
            self.0 == other.0
        }
    }

    impl Eq for Counted<'_> {}

    impl Hash for Counted<'_> {
        fn hash<H: Hasher>(&self, state: &mut H) {
            self.0.hash(state);
        }
    }

    #[test]
    fn a_name_is_not_compared_with_all_others() {
        let compared = Cell::new(0);
        let name = |k| Counted(k, &compared);
        assert_eq!(repeated([3, 1, 3, 1].into_iter(), name), Some(3));
        assert_eq!(repeated(0..20_000, name), None);
        // Each with all others: 2e8.
        assert!(compared.get() < 20_000, "{} comparisons", compared.get());
    }
}
