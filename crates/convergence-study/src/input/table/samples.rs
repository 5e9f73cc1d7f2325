//! Rows with equal steps that are samples: each step becomes a level.

use std::collections::{BTreeMap, BTreeSet};

use super::cell::{Cell, is_failure};
use super::grid::{Cells, named};
use super::ladders::Ladder;
use super::names::{is_level, says_error, says_sample};
use super::{Choice, LeftOut, Refused};
use crate::input::advice::Argument;
use crate::text::lists::grouped;
use crate::text::number::counted;
use convergence_judge::verdict::{FEWEST_NUMBERS, Of, Samples};

/// Makes a level of the rows of each step; in words of what.
///
/// # Errors
/// No column of steps, or fewer rows of a step than a sample needs.
pub(super) fn sample(ladder: &mut Ladder, of: Of, choice: &Choice) -> Result<String, Refused> {
    let columns = std::mem::take(&mut ladder.columns);
    let is_step = |column: &Cells| column.family().is_some() || is_level(&column.key);
    let step = match &choice.step {
        Some(name) => named(&columns, Argument::Step, name)?,
        None => columns.iter().position(is_step).ok_or_else(|| {
            let expected = Argument::Step.with_placeholder() + ", whose equal rows are samples";
            Refused::new(expected, "no column of steps")
        })?,
    };
    let mut levels = rows_of_steps(&columns[step])?;
    let numbering = numbering(&columns, step);
    let mut seeds = vec![];
    if let Some(first) = numbering.first() {
        let name = |row: &usize| name(&columns, &numbering, *row);
        levels.iter_mut().for_each(|rows| rows.sort_by_key(name));
        let mut pairs = levels.iter().flat_map(|rows| rows.windows(2));
        if let Some(twice) = pairs.find(|pair| name(&pair[0]) == name(&pair[1])) {
            let cell = &columns[*first].cells[twice[1]];
            let found = format!("`{}` twice", cell.text);
            let expected = format!("each `{}` once at each step", columns[*first].name);
            return Err(Refused::new(expected, found).at(cell.line));
        }
        let names: BTreeSet<_> = levels.iter().flatten().map(name).collect();
        let numbers: BTreeMap<_, usize> = names.into_iter().zip(0..).collect();
        let of_level = |rows: &Vec<usize>| rows.iter().map(|row| numbers[&name(row)]).collect();
        seeds = levels.iter().map(of_level).collect();
    }
    let aside = numbering.iter().map(|column| &columns[*column]);
    let aside = aside.map(|column| LeftOut::new(column, "numbers of the samples"));
    ladder.table.left_out.extend(aside);
    let others = columns
        .iter()
        .enumerate()
        .filter(|(k, _)| !numbering.contains(k));
    ladder.columns = others
        .map(|(_, column)| of_levels(column, &levels, of, &seeds))
        .collect();
    let counts = levels.iter().map(Vec::len);
    let most = counts.clone().max().unwrap_or(0);
    let range = match counts.min() {
        Some(fewest) if fewest < most => format!("{fewest} to {most} rows"),
        _ => counted(most, "row"),
    };
    Ok(format!("; samples: the {of} of {range} at each step"))
}

/// The columns that number the samples: seeds, and paths of a seed.
fn numbering(columns: &[Cells], step: usize) -> Vec<usize> {
    let numbers_samples = |k: &usize| {
        let column = &columns[*k];
        let is_named = says_sample(&column.key) && !says_error(&column.key);
        *k != step && is_named && column.is_whole() && column.varies()
    };
    (0..columns.len()).filter(numbers_samples).collect()
}

/// What a row has in some columns.
fn name(columns: &[Cells], numbering: &[usize], row: usize) -> Vec<String> {
    let texts = numbering
        .iter()
        .map(|column| columns[*column].cells[row].text.clone());
    texts.collect()
}

/// The rows of each step.
fn rows_of_steps(step: &Cells) -> Result<Vec<Vec<usize>>, Refused> {
    let rows = step.cells.iter().enumerate();
    let groups = grouped(rows.map(|(row, cell)| (&cell.text, row)));
    if let Some((text, rows)) = groups.iter().find(|(_, rows)| rows.len() < FEWEST_NUMBERS) {
        let found = format!("{} of `{}` {text}", counted(rows.len(), "row"), step.name);
        let expected = format!("at least {FEWEST_NUMBERS} rows of each step");
        return Err(Refused::new(expected, found).at(step.cells[rows[0]].line));
    }
    Ok(groups.into_iter().map(|(_, rows)| rows).collect())
}

/// The errors of the samples. Of what is no error, a cell of each level: where words differ, one
/// that says a failure, or the first by the alphabet.
///
/// * `seeds`: of the rows of each level.
fn of_levels(column: &Cells, levels: &[Vec<usize>], of: Of, seeds: &[Vec<usize>]) -> Cells {
    let text = |row: usize| &column.cells[row].text;
    let differs = |rows: &Vec<usize>| rows.iter().any(|row| text(*row) != text(rows[0]));
    let is_counted = column.family().is_some() || is_level(&column.key) || column.is_whole();
    // Errors that do not depend on their seed are samples, which the judge doubts.
    let may_be_error = !is_counted && column.rates_of.is_none();
    if !column.has_numbers() || !may_be_error && !levels.iter().any(differs) {
        let worst = levels.iter().map(|rows| {
            let rank = |row: &usize| (!is_failure(text(*row)), text(*row).to_lowercase());
            rows.iter().copied().min_by_key(rank).unwrap_or(rows[0])
        });
        return column.of_rows(&worst.collect::<Vec<_>>());
    }
    let number = |row: &usize| column.cells[*row].value().unwrap_or(f64::NAN);
    let numbers = levels.iter().map(|rows| rows.iter().map(number).collect());
    let numbers: Vec<Vec<f64>> = numbers.collect();
    let errors = numbers.iter().map(|numbers| Cell::exact(of.error(numbers)));
    let errors = Cells::new(&column.name, errors.collect());
    Cells {
        samples: Some(Samples {
            numbers,
            of,
            seeds: seeds.to_vec(),
        }),
        rates_of: column.rates_of.clone(),
        ..errors
    }
}
