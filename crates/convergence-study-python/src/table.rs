//! Tables of several errors, read as `convergence-study rates` reads them.

use convergence_study::{Choice, Claim, Column, RateTable, observe};
use pyo3::prelude::*;

use crate::call::{Call, OF_JUDGE};
use crate::judged::Judgement;
use crate::values::{self, Claims, refuse};

/// Which columns of a table to use, as `rates` knows it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Chosen {
    step: Option<String>,
    columns: Option<Vec<String>>,
    values: Option<Vec<String>>,
    names: Option<Vec<String>>,
    dim: Option<f64>,
    ratio: Option<f64>,
}

impl From<Chosen> for Choice {
    fn from(chosen: Chosen) -> Self {
        Self {
            step: chosen.step,
            columns: chosen.columns,
            values: chosen.values.unwrap_or_default(),
            names: chosen.names,
            dim: chosen.dim,
            ratio: chosen.ratio,
            ..Self::default()
        }
    }
}

/// Judges the columns of a data frame or of a dict of lists; `None` if `table` is neither.
///
/// * `function`: the function that was called, for the calls that a refusal offers.
/// * Returns the judgements of the columns with a claim, or of all for a common claim.
///
/// # Errors
/// `ValueError` with the argument, or with the cell of the table.
#[pyfunction]
pub(crate) fn judge_table(
    table: &Bound<'_, PyAny>,
    order: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
    floor: f64,
    chosen: Chosen,
    function: &str,
) -> PyResult<Option<Vec<Judgement>>> {
    let claims = Claims::read(order, tolerance)?;
    let floor = values::floor_of(floor)?;
    let choice = Choice {
        claimed: claims.names(),
        ..chosen.into()
    };
    let call = Call::new(table.py(), function, "table", order, OF_JUDGE)?;
    let Some(columns) = values::columns(table)? else {
        return Ok(None);
    };
    let table = RateTable::from_columns(&columns, "h", &choice)
        .map_err(|error| refuse(error.words(&call)))?;
    if let Some(doubt) = table.doubts.first() {
        return Err(refuse(format!("table: {doubt}")));
    }
    let left_out = table.left_out.iter();
    let left_out: Vec<(String, String)> = left_out
        .map(|one| (one.column.clone(), one.because.clone()))
        .collect();
    let judged = |column: &Column, claim: Option<Claim>| Judgement {
        name: column.name.clone(),
        step: table.step.clone(),
        rate: match &claim {
            Some(claim) => claim.judge(&column.levels, floor),
            None => observe(&column.levels, floor),
        },
        levels: column.levels.clone(),
        claim,
        tolerance,
        floor,
        left_out: left_out.clone(),
    };
    let named = match claims {
        Claims::ForAll(claim) => {
            let claim_of = |column: &Column| claim.filter(|_| column.is_chosen);
            let judgements = table
                .columns
                .iter()
                .map(|column| judged(column, claim_of(column)));
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
        Ok(judged(column, Some(claim)))
    };
    named
        .into_iter()
        .map(judgement)
        .collect::<PyResult<_>>()
        .map(Some)
}
