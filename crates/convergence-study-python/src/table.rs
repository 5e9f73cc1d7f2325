//! Tables of several errors, read as `convergence-study rates` reads them.

use std::collections::BTreeMap;
use std::str::FromStr;

use convergence_study::rates::{Choice, RateTable};
use convergence_study::{Claim, Reason};
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
    lines: Option<Vec<String>>,
    samples: Option<String>,
}

fn parsed<T: FromStr<Err = String>>(argument: &str, text: &str) -> PyResult<T> {
    text.parse()
        .map_err(|expected| refuse(format!("{argument}: {expected}; found {text:?}")))
}

impl Chosen {
    /// # Errors
    /// `ValueError` for lines that are no range.
    pub(crate) fn choice(self) -> PyResult<Choice> {
        let lines = self.lines.iter().flatten();
        let lines = lines.map(|text| parsed("lines", text));
        let samples = self.samples.map(|text| parsed("samples", &text));
        Ok(Choice {
            lines: lines.collect::<PyResult<_>>()?,
            step: self.step,
            columns: self.columns,
            values: self.values.unwrap_or_default(),
            names: self.names,
            dim: self.dim,
            ratio: self.ratio,
            samples: samples.transpose()?,
            ..Choice::default()
        })
    }
}

/// Judges the columns of a data frame or of a dict of lists; `None` if `table` is neither.
///
/// * `function`: the function that was called, for the calls that a refusal offers.
/// * Returns the judgements of the columns with a claim; of all, or of those that are chosen, for
///   a common claim. What is not judged is left out, with the reason.
///
/// # Errors
/// `ValueError` with the argument, or with the cell of the table.
#[pyfunction]
pub(crate) fn judge_table(
    table: &Bound<'_, PyAny>,
    order: Option<&Bound<'_, PyAny>>,
    tolerance: Option<f64>,
    floor: f64,
    chosen: Chosen,
    function: &str,
) -> PyResult<Option<Vec<Judgement>>> {
    let claims = Claims::read(order, tolerance)?;
    let floor = values::floor_of(floor)?;
    let choice = Choice {
        claimed: claims.names(),
        ..chosen.choice()?
    };
    let call = Call::new(table.py(), function, "table", ("order", order), OF_JUDGE)?;
    let Some(columns) = values::columns(table)? else {
        return Ok(None);
    };
    let table = RateTable::from_columns(&columns, "h", &choice)
        .map_err(|error| refuse(error.words(&call)))?;
    if let Some(doubt) = table.first_doubt() {
        return Err(refuse(format!("table: {doubt}")));
    }
    let judged = judged_columns(&table, claims)?;
    let mut claims = vec![None; table.columns.len()];
    for one in &judged {
        claims[one.place] = one.claim;
    }
    let rates = table.judge(&claims, floor);
    let rates = rates.map_err(|words| refuse(format!("table: {words}")))?;
    let left_out = left_out(&table, &judged);
    let judgements = judged.iter().map(|one| {
        let column = &table.columns[one.place];
        Judgement {
            name: column.name.clone(),
            step: table.step.clone(),
            rate: rates[one.place].clone(),
            levels: column.levels.clone(),
            claim: one.claim,
            tolerance,
            floor,
            left_out: left_out.clone(),
        }
    });
    Ok(Some(judgements.collect()))
}

/// A column that is judged, by its place.
struct JudgedColumn {
    place: usize,
    claim: Option<Claim>,
}

/// The columns with a claim by name; for a common claim those that are chosen.
///
/// # Errors
/// `ValueError` for the name of no column of errors.
fn judged_columns(table: &RateTable, claims: Claims) -> PyResult<Vec<JudgedColumn>> {
    let named = match claims {
        Claims::ForAll(claim) => {
            let columns = table.columns.iter().enumerate();
            let chosen = columns.filter(|(_, column)| column.is_chosen);
            return Ok(chosen
                .map(|(place, _)| JudgedColumn { place, claim })
                .collect());
        }
        Claims::Named(named) => named,
    };
    let judged = named.into_iter().map(|(name, claim)| {
        let column = table.column(&name).ok_or_else(|| {
            let names: Vec<&str> = table.columns.iter().map(|one| one.name.as_str()).collect();
            let known = names.join(", ");
            refuse(format!(
                "order: expected names of columns of errors, {known}; found `{name}`"
            ))
        })?;
        let mut columns = table.columns.iter();
        let place = columns.position(|other| std::ptr::eq(other, column));
        let claim = Some(claim);
        Ok(place.map(|place| JudgedColumn { place, claim }))
    });
    judged.filter_map(Result::transpose).collect()
}

/// The columns that are not judged, by name, each with the reason.
fn left_out(table: &RateTable, judged: &[JudgedColumn]) -> BTreeMap<String, String> {
    let others = table.columns.iter().enumerate();
    let others = others.filter(|(place, _)| judged.iter().all(|one| one.place != *place));
    let others = others.map(|(_, column)| {
        let because = Reason::NotClaimed.text();
        (column.name.clone(), because.to_owned())
    });
    let left_out = table.left_out.iter();
    left_out
        .map(|one| (one.column.clone(), one.because.clone()))
        .chain(others)
        .collect()
}
