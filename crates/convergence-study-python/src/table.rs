//! Tables of several errors, read as `convergence-study rates` reads them.

use convergence_harness::input::error_table::{Choice, Column, RateTable};
use convergence_harness::study::Claim;
use pyo3::prelude::*;

use crate::judged::Judgement;
use crate::values::{self, Claims, Columns, refuse};

/// Which columns of a table to use, as `rates` knows it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Chosen {
    step: Option<String>,
    columns: Option<Vec<String>>,
    names: Option<Vec<String>>,
    dim: Option<f64>,
    ratio: Option<f64>,
}

/// Judges the columns of a data frame or of a dict of lists; `None` if `table` is neither.
///
/// * Returns the judgements of the columns with a claim, or of all for a common claim.
///
/// # Errors
/// `ValueError` with the options of the command line: Python words them.
#[pyfunction]
pub(crate) fn judge_table(
    table: &Bound<'_, PyAny>,
    order: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
    floor: f64,
    chosen: Chosen,
) -> PyResult<Option<Vec<Judgement>>> {
    let claims = Claims::read(order, tolerance)?;
    let judge = values::judge_with(tolerance, floor)?;
    let choice = Choice {
        step: chosen.step,
        columns: chosen.columns,
        names: chosen.names,
        claimed: claims.names(),
        dim: chosen.dim,
        ratio: chosen.ratio,
        command: "judge".to_owned(),
        ..Choice::default()
    };
    let Some(columns) = values::columns(table, &choice.claimed)? else {
        return Ok(None);
    };
    let table = read(&columns, &choice)?;
    let judged = |column: &Column, claim: Claim| Judgement {
        name: column.name.clone(),
        step: table.step.clone(),
        rate: claim.judge(&judge, &column.levels),
        levels: column.levels.clone(),
        claim,
        floor,
    };
    let named = match claims {
        Claims::ForAll(claim) => {
            let judgements = table.columns.iter().map(|column| judged(column, claim));
            return Ok(Some(judgements.collect()));
        }
        Claims::Named(named) => named,
    };
    let judgement = |(name, claim): (String, Claim)| {
        let column = table.column(&name).ok_or_else(|| {
            let names: Vec<&str> = table.columns.iter().map(|one| one.name.as_str()).collect();
            let known = names.join(", ");
            refuse(format!(
                "order: expected names of columns of errors, {known}; found `{name}`"
            ))
        })?;
        Ok(judged(column, claim))
    };
    named
        .into_iter()
        .map(judgement)
        .collect::<PyResult<_>>()
        .map(Some)
}

/// Columns of numbers, read like a text by `convergence-study rates`, with all digits.
fn read(columns: &Columns, choice: &Choice) -> PyResult<RateTable> {
    let rows = columns.iter().map(|(_, numbers)| numbers.len()).max();
    let rows = rows.unwrap_or(0);
    if let Some((name, numbers)) = columns.iter().find(|(_, numbers)| numbers.len() != rows) {
        return Err(refuse(format!(
            "{name}: expected {rows} numbers, as other columns have; found {}",
            numbers.len()
        )));
    }
    let names: Vec<String> = columns
        .iter()
        .map(|(name, _)| format!("\"{}\"", name.replace('"', "'")))
        .collect();
    let mut text = names.join(",") + "\n";
    for row in 0..rows {
        let cells: Vec<String> = columns
            .iter()
            .map(|(_, numbers)| values::text(numbers[row]))
            .collect();
        text += &(cells.join(",") + "\n");
    }
    RateTable::parse_with(&text, "h", choice).map_err(|error| {
        // The text is not the user's: a cell has a row, counted as in Python.
        let place = match (&error.field, error.place) {
            (Some(field), Some(place)) => format!("{field}[{}]", place.line.saturating_sub(2)),
            _ => error.file.clone(),
        };
        refuse(format!("{place}: {}", error.complaint))
    })
}
