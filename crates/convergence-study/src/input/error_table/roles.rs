//! Each table of a text with its step, its errors and its values: those that the user has chosen, or
//! what the columns hold.

use std::collections::HashSet;
use std::hash::Hash;

use super::columns::Cells;
use super::doubt;
use super::failed_run;
use super::groups::{self, Group, Side};
use super::limits;
use super::names::Word;
use super::original::Original;
use super::outside;
use super::parameters;
use super::parts::{self, Part};
use super::reader::{self, TableReader, listed, reasons};
use super::step::{Measure, Step};
use super::{Choice, Column, Doubt, NotError, RateTable, names};
use crate::input::advice::{Argument, Text};
use crate::input::{InputError, shorten};
use crate::judge::verdict::Level;
use crate::text::number::counted;

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
/// and find the claimed columns; beside others, a table without such a choice is a doubt.
pub(super) fn read_all(
    original: Original<'_>,
    choice: &Choice,
) -> Result<Vec<(String, RateTable)>, InputError> {
    reader::refuse_factor(original)?;
    let parts = parts::read(original.text);
    limits::check(original, &parts)?;
    let failure = failed_run::line(original.text);
    let outside = outside::of_text(original.text, &parts);
    let Attempt { mut tables, unread } = attempt_all(original, choice, &parts);
    if let Some(mut error) = unread {
        error.offers.retain(|offer| {
            let Attempt { tables, unread } = attempt_all(original, &offer.choice, &parts);
            unread.is_none() && has_claimed_columns(&tables, choice)
        });
        let is_alone = error.offers.is_empty() && has_claimed_columns(&tables, choice);
        match tables.first_mut() {
            Some((_, first)) if is_alone => first.doubts.push(Doubt::Unread(Box::new(error))),
            _ => return Err(error),
        }
    }
    for (_, table) in &mut tables {
        table.doubts.extend(failure.clone());
    }
    if let Some((_, first)) = tables.first_mut()
        && outside.lines > 0
    {
        first.reading += &format!("; outside the tables: {}", counted(outside.lines, "line"));
        first.doubts.extend(outside.rows);
    }
    Ok(tables)
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
            Err(original.refuse("one table", &listed(headings)))
        }
    }
}

/// Whether one of the tables has each column with an order claimed by name.
fn has_claimed_columns(tables: &[(String, RateTable)], choice: &Choice) -> bool {
    let has = |table: &RateTable, name: &str| {
        let columns = table.columns.iter().chain(&table.values);
        let names = columns.map(|column| column.name.as_str());
        name.ends_with(':') || names::claimed_position(names, name).is_some()
    };
    let mut claimed = choice.claimed.iter();
    claimed.all(|name| tables.iter().any(|(_, table)| has(table, name)))
}

/// What was read with one choice.
struct Attempt {
    /// Each table with its heading.
    tables: Vec<(String, RateTable)>,
    /// Why the first of those that cannot be read is refused.
    unread: Option<InputError>,
}

/// Columns of a part, which are a table or several below each other.
struct Grid<'p, 't> {
    part: &'p Part<'t>,
    side: Side<'t>,
}

/// Reads all tables with one choice. Beside others, a table that holds no errors by its names is
/// left out, which the first one says.
fn attempt_all(original: Original<'_>, choice: &Choice, parts: &[Part<'_>]) -> Attempt {
    let sides = parts.iter().flat_map(|part| {
        let sides = groups::side_by_side(&part.table, choice).into_iter();
        sides.map(move |side| Grid { part, side })
    });
    let chosen = choice.names.as_deref();
    let (mut grids, mut others): (Vec<Grid<'_, '_>>, Vec<Grid<'_, '_>>) =
        sides.partition(|grid| grid.side.table.may_have_errors(chosen));
    if grids.is_empty() {
        std::mem::swap(&mut grids, &mut others);
    }
    let is_only = parts.len() == 1;
    // One table may have counts or levels, another one steps by their name.
    let has_measure = choice.dim.is_some() || choice.ratio.is_some();
    let without_measure = has_measure.then(|| Choice {
        dim: None,
        ratio: None,
        ..choice.clone()
    });
    let mut tables = vec![];
    let mut unread = None;
    let mut with_own_step = None;
    let mut is_measured = false;
    for grid in &grids {
        let error = match attempt_grid(original, choice, grid, is_only) {
            Ok(more) => {
                tables.extend(more);
                is_measured = true;
                continue;
            }
            Err(error) => error,
        };
        let again = without_measure.as_ref();
        match again.map(|choice| attempt_grid(original, choice, grid, is_only)) {
            Some(Ok(more)) if more.iter().all(|(_, table)| !table.is_guessed) => {
                tables.extend(more);
                with_own_step = with_own_step.or(Some(error));
            }
            _ => unread = unread.or(Some(error)),
        }
    }
    if !is_measured && with_own_step.is_some() {
        return Attempt {
            tables: vec![],
            unread: unread.or(with_own_step),
        };
    }
    if let Some((_, first)) = tables.first_mut() {
        leave_out(first, &others);
    }
    Attempt { tables, unread }
}

/// Says in the first table which others have no errors.
fn leave_out(first: &mut RateTable, others: &[Grid<'_, '_>]) {
    if others.is_empty() {
        return;
    }
    let heading = |Grid { part, side }: &Grid<'_, '_>| match &*side.heading {
        "" => part.heading.clone(),
        heading => heading.to_owned(),
    };
    let headings: Vec<String> = others.iter().map(heading).collect();
    let quoted = headings.iter().map(|heading| format!("`{heading}`"));
    first.reading += &format!("; without errors: {}", listed(quoted));
    let not_errors = headings.into_iter().map(|column| NotError {
        column,
        because: "a table without errors".to_owned(),
        is_checked: false,
    });
    first.not_errors.extend(not_errors);
}

/// Reads the tables below each other in some columns.
///
/// * `is_only`: whether no other part needs a heading.
fn attempt_grid(
    original: Original<'_>,
    choice: &Choice,
    Grid { part, side }: &Grid<'_, '_>,
    is_only: bool,
) -> Result<Vec<(String, RateTable)>, InputError> {
    let mut tables = vec![];
    let group = Group {
        heading: side.heading.clone(),
        columns: reader::columns(original, choice, &side.table)?,
    };
    for Group { heading, columns } in groups::below_each_other(group, choice) {
        let all = [part.heading.as_str(), &heading].join(", ");
        let parameters = parameters::of_table(&all, &columns);
        let reader = TableReader::new(original, choice, columns, &side.table);
        let mut table = RateTable {
            parameters,
            ..attempt(reader)?
        };
        // Under a claim for all columns it may be an error.
        if choice.columns.is_none() && choice.claimed.is_empty() {
            table
                .doubts
                .extend(side.table.uneven.clone().map(Doubt::Uneven));
        }
        let heading = match heading.as_str() {
            _ if is_only => heading,
            "" => part.heading.clone(),
            _ => all,
        };
        tables.push((heading, table));
    }
    Ok(tables)
}

/// The k-th column over the steps.
///
/// The coarsest levels may lack a number; any other level without one has failed, and is NaN.
///
/// * `step_halves`: half the last digit of each step as printed; 0 where it is known exactly.
fn column(
    reader: &TableReader<'_>,
    k: usize,
    steps: &[f64],
    step_halves: &[f64],
) -> Result<Column, InputError> {
    let cells = &reader.columns[k];
    let missing = match cells.missing() {
        missing if missing < steps.len() => missing,
        _ => 0,
    };
    let mut levels = Vec::with_capacity(steps.len());
    for (row, step) in steps.iter().enumerate().skip(missing) {
        let error = if reader.has_failed(row, k) {
            f64::NAN
        } else {
            reader.must(row, k)?
        };
        levels.push(Level { step: *step, error });
    }
    Ok(Column {
        name: cells.name.clone(),
        levels,
        halves: cells.halves[missing..].to_vec(),
        step_halves: step_halves[missing..].to_vec(),
    })
}

/// Reads a table with one choice.
fn attempt(mut reader: TableReader<'_>) -> Result<RateTable, InputError> {
    let step = reader.step()?;
    let steps = reader.sort(&step)?;
    let ChosenColumns { mut errors, values } = reader.chosen_columns(step.column)?;
    reader.find_states(step.column, &errors, &values);
    let mut not_errors = vec![];
    if reader.choice.columns.is_none() {
        errors = reader.error_columns(&step, &steps, &values)?;
        not_errors = std::mem::take(&mut reader.left_out);
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
    let columns_of_errors = columns(&errors)?;
    let jumps = columns_of_errors
        .iter()
        .filter_map(|column| doubt::unit(column).or_else(|| doubt::jump(column)));
    let doubts = reader.doubts.iter().cloned().chain(jumps);
    let doubts = doubts.chain(reader.contradiction(step.column)).collect();
    Ok(RateTable {
        reading: reading(&reader, &step, [&errors, &values], &not_errors),
        columns: columns_of_errors,
        values: columns(&values)?,
        not_errors,
        parameters: vec![],
        doubts,
        is_guessed: !step.how.is_empty(),
        step: step.label,
    })
}

/// How a table was read.
///
/// * `judged`: the columns of errors and those of values.
fn reading(
    reader: &TableReader<'_>,
    step: &Step,
    judged: [&[usize]; 2],
    others: &[NotError],
) -> String {
    let parts = [
        ("errors", reader.quoted(judged[0])),
        ("values", reader.quoted(judged[1])),
        ("left out", reasons(others)),
    ];
    let mut reading = format!("step: `{}`{}", step.label, step.how);
    for (what, list) in parts.iter().filter(|(_, list)| !list.is_empty()) {
        reading += &format!("; {what}: {list}");
    }
    if reader.is_shuffled {
        reading += &format!("; rows sorted by `{}`", reader.columns[step.column].name);
    }
    let unsolved = reader
        .is_solved
        .iter()
        .filter(|is_solved| !**is_solved)
        .count();
    if unsolved > 0 {
        reading += &format!("; not solved: {}", counted(unsolved, "level"));
    }
    reading
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
            let [first, second] = [before, cell].map(|cell| self.original.row(cell));
            let rows = self.original.noun();
            let found = format!("`{}` = {cell} in {rows} {first} and {second}", cells.name);
            return Err(self.error(
                cell,
                None,
                "each step once: give one table at a time",
                &found,
            ));
        }
        self.is_reversed = order.is_sorted_by(|a, b| a > b);
        self.is_shuffled = !order.is_sorted() && !self.is_reversed;
        let sorted = self.columns.iter().map(|cells| cells.select(&order));
        self.columns = sorted.collect();
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
                return Err(self.refuse_logarithm(&self.columns[*k]));
            }
        }
        Ok(ChosenColumns { errors, values })
    }

    /// The columns of these names, which an argument selects.
    fn find_all(&self, names: &[String], argument: Argument) -> Result<Vec<usize>, InputError> {
        let columns = names.iter().map(|name| self.find(name, argument));
        columns.collect()
    }

    pub(super) fn refuse_logarithm(&self, column: &Cells<'_>) -> InputError {
        let expected = "the values, not their logarithms";
        self.refuse(expected, &format!("`{}`", column.name))
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
        let offer = self
            .choice
            .offer("", |choice| choice.names = Some(numbered.collect()));
        let found = format!("`{}` a second time", shorten(&self.columns[column].name));
        self.error(self.columns[column].head, None, "each name once", &found)
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
