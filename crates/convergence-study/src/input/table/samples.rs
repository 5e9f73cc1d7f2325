//! Rows with equal steps that are samples: each step becomes a level.

use super::cell::{Cell, is_failure};
use super::grid::{Cells, named};
use super::names::{is_level, says_sample};
use super::{Choice, LeftOut, Refused};
use crate::input::advice::Argument;
use crate::judge::verdict::{FEWEST_NUMBERS, Of, Samples};
use crate::text::lists::grouped;
use crate::text::number::counted;

/// A ladder of levels, each from the rows of one step.
pub(super) struct Sampled {
    pub(super) columns: Vec<Cells>,
    /// The numbers of the samples.
    pub(super) left_out: Vec<LeftOut>,
    /// How many rows a level has.
    pub(super) words: String,
}

/// Makes a level of the rows of each step.
///
/// # Errors
/// No column of steps, or fewer rows of a step than a sample needs.
pub(super) fn sampled(columns: &[Cells], of: Of, choice: &Choice) -> Result<Sampled, Refused> {
    let is_step = |column: &&Cells| column.family().is_some() || is_level(&column.key);
    let step = match &choice.step {
        Some(name) => &columns[named(columns, Argument::Step, name)?],
        None => columns.iter().find(is_step).ok_or_else(|| {
            let expected = Argument::Step.with_placeholder() + ", whose equal rows are samples";
            Refused::new(expected, "no column of steps")
        })?,
    };
    let mut groups = rows_of_steps(step)?;
    let numbers = columns
        .iter()
        .find(|column| says_sample(&column.key) && column.is_whole() && column.name != step.name);
    let names = |rows: &Vec<usize>| -> Option<Vec<&str>> {
        let names = rows
            .iter()
            .map(|row| numbers.map(|one| one.cells[*row].text.as_str()));
        names.collect()
    };
    if numbers.is_some() {
        groups
            .iter_mut()
            .for_each(|rows| rows.sort_by_key(|row| names(&vec![*row])));
    }
    let are_shared =
        numbers.is_some() && groups.iter().all(|rows| names(rows) == names(&groups[0]));
    let level = |column: &Cells| Cells {
        samples: samples(column, &groups).map(|numbers| Samples {
            numbers,
            of,
            are_shared,
        }),
        ..of_levels(column, &groups)
    };
    let others = columns
        .iter()
        .filter(|column| numbers.is_none_or(|one| one.name != column.name));
    let most = groups.iter().map(Vec::len).max().unwrap_or(0);
    let fewest = groups.iter().map(Vec::len).min().unwrap_or(0);
    let range = if most == fewest {
        counted(most, "row")
    } else {
        format!("{fewest} to {most} rows")
    };
    Ok(Sampled {
        columns: others.map(level).map(with_errors).collect(),
        left_out: numbers.into_iter().map(LeftOut::of_samples).collect(),
        words: format!("the {of} of {range} at each step"),
    })
}

/// The rows of each step.
fn rows_of_steps(step: &Cells) -> Result<Vec<Vec<usize>>, Refused> {
    let rows = step.cells.iter().enumerate();
    let groups: Vec<Vec<usize>> = grouped(rows.map(|(row, cell)| (cell.text.clone(), row)))
        .into_iter()
        .map(|(_, rows)| rows)
        .collect();
    if let Some(few) = groups.iter().find(|rows| rows.len() < FEWEST_NUMBERS) {
        let cell = &step.cells[few[0]];
        let found = format!(
            "{} of `{}` {}",
            counted(few.len(), "row"),
            step.name,
            cell.text
        );
        let expected = format!("at least {FEWEST_NUMBERS} rows of each step");
        return Err(Refused::new(expected, found).at(cell.line));
    }
    Ok(groups)
}

/// The numbers of a column that differ within a level, level by level.
fn samples(column: &Cells, groups: &[Vec<usize>]) -> Option<Vec<Vec<f64>>> {
    let differs = |rows: &Vec<usize>| {
        let first = &column.cells[rows[0]].text;
        rows.iter().any(|row| column.cells[*row].text != *first)
    };
    let number = |row: &usize| column.cells[*row].value().unwrap_or(f64::NAN);
    let numbers = groups.iter().map(|rows| rows.iter().map(number).collect());
    (column.has_numbers() && groups.iter().any(differs)).then(|| numbers.collect())
}

/// A cell for each level: where words differ, one that says a failure, or the first by the alphabet.
fn of_levels(column: &Cells, groups: &[Vec<usize>]) -> Cells {
    let first = |rows: &Vec<usize>| {
        let worst = |row: &&usize| {
            let text = column.cells[**row].text.to_lowercase();
            (!is_failure(&text), text)
        };
        *rows.iter().min_by_key(worst).unwrap_or(&rows[0])
    };
    column.of_rows(&groups.iter().map(first).collect::<Vec<_>>())
}

/// The errors of the samples in place of the cells.
fn with_errors(column: Cells) -> Cells {
    let Some(samples) = &column.samples else {
        return column;
    };
    let errors = samples
        .numbers
        .iter()
        .map(|numbers| samples.of.error(numbers));
    let cells = errors.map(Cell::exact).collect();
    Cells { cells, ..column }
}
