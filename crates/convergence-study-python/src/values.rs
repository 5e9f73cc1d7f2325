//! Converts Python values to Rust; an invalid value is a `ValueError` that names the argument.

use std::collections::BTreeSet;

use convergence_judge::{
    claims::{Bound as ClaimBound, order_from_text},
    fit::Level,
    verdict::Judge,
};
use convergence_study::rates::{FrameCell, FrameColumn};
use convergence_study::{Claim, Floor};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyBytes, PyDict, PyFloat, PyString};

/// The allowed values of an order.
const ORDER: &str = "a number > 0, or a text such as \">= 2\", or \">= 2..\" for any higher rate";

pub(crate) fn refuse(message: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(message.to_string())
}

/// The start of Python's text for a value.
fn shown(value: &Bound<'_, PyAny>) -> String {
    let text = value
        .repr()
        .map_or_else(|_| "a value".to_owned(), |text| text.to_string());
    if text.chars().count() > 60 {
        text.chars().take(60).chain("...".chars()).collect()
    } else {
        text
    }
}

fn is_text(value: &Bound<'_, PyAny>) -> bool {
    value.is_instance_of::<PyString>()
        || value.is_instance_of::<PyBytes>()
        || value.is_instance_of::<PyBool>()
}

/// Whether a value is no complex number, whose imaginary part would be dropped, no duration and no
/// truth value of NumPy.
fn is_real(value: &Bound<'_, PyAny>) -> bool {
    if value.is_exact_instance_of::<PyFloat>() {
        return true;
    }
    let kind = value.getattr("dtype").and_then(|kind| kind.getattr("kind"));
    let kind = kind.and_then(|kind| kind.extract::<String>());
    !kind.is_ok_and(|kind| ["b", "c", "m", "M"].contains(&&*kind))
}

/// A number; NaN and infinity are numbers.
pub(crate) fn number(name: impl Fn() -> String, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    let expected = || {
        refuse(format!(
            "{}: expected a number, found {}",
            name(),
            shown(value)
        ))
    };
    if is_text(value) || !is_real(value) {
        Err(expected())
    } else {
        value.extract().map_err(|_| expected())
    }
}

/// The numbers of a list, an array, a series: anything with `tolist` or `to_list`, or that can be
/// iterated.
pub(crate) fn numbers(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let items = items(name, value)?;
    let items = items.iter().enumerate();
    items
        .map(|(k, item)| number(|| format!("{name}[{k}]"), item))
        .collect()
}

/// The items of a list, an array, a series.
fn items<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let expected = || {
        refuse(format!(
            "{name}: expected a sequence of numbers, found {}",
            shown(value)
        ))
    };
    if is_text(value) || value.is_instance_of::<PyDict>() {
        return Err(expected());
    }
    let list = ["tolist", "to_list"]
        .into_iter()
        .find(|method| value.hasattr(*method).unwrap_or(false));
    let list = list.map_or_else(|| Ok(value.clone()), |method| value.call_method0(method))?;
    list.try_iter().map_err(|_| expected())?.collect()
}

/// The levels, coarse to fine, given in any order.
pub(crate) fn levels(
    h: &Bound<'_, PyAny>,
    name: &str,
    errors: &Bound<'_, PyAny>,
) -> PyResult<Vec<Level>> {
    let (steps, errors) = (numbers("h", h)?, numbers(name, errors)?);
    if steps.is_empty() {
        return Err(refuse("h: expected the step of each level, found none"));
    }
    if steps.len() != errors.len() {
        let (found, expected) = (errors.len(), steps.len());
        return Err(refuse(format!(
            "{name}: expected as many numbers as h has, {expected}; found {found}"
        )));
    }
    if let Some(k) = steps
        .iter()
        .position(|step| !(*step > 0.0 && step.is_finite()))
    {
        return Err(refuse(format!(
            "h[{k}]: expected a finite number > 0, found {}",
            steps[k]
        )));
    }
    let mut levels: Vec<Level> = steps
        .into_iter()
        .zip(errors)
        .map(|(step, error)| Level { step, error })
        .collect();
    levels.sort_by(|a, b| b.step.total_cmp(&a.step));
    match levels.windows(2).find(|pair| pair[0].step == pair[1].step) {
        Some(pair) => Err(refuse(format!(
            "h: expected each step once, found {} twice",
            pair[0].step
        ))),
        None => Ok(levels),
    }
}

/// Round-off, in the unit of the errors.
pub(crate) fn floor_of(floor: f64) -> PyResult<Floor> {
    Floor::new(floor).map_err(refuse)
}

/// Refuses tolerances that the rule cannot use.
pub(crate) fn check_tolerance(tolerance: Option<f64>) -> PyResult<()> {
    tolerance.map_or(Ok(()), |tolerance| {
        Judge::new(tolerance).map(|_| ()).map_err(refuse)
    })
}

/// An order as Python writes it: a number, or a text such as `">=2.0"`.
#[derive(IntoPyObject)]
pub(crate) enum Order {
    Number(f64),
    Text(String),
}

/// The order of a claim.
pub(crate) fn order_of(claim: &Claim) -> Order {
    let order = claim.order;
    match claim.bound {
        ClaimBound::Both => Order::Number(order),
        bound => Order::Text(bound.written(format_args!("{order:?}"))),
    }
}

/// The claim about an error, if there is an order.
pub(crate) fn optional_claim(
    order: Option<&Bound<'_, PyAny>>,
    tolerance: Option<f64>,
) -> PyResult<Option<Claim>> {
    check_tolerance(tolerance)?;
    order.map(|order| claim(order, tolerance)).transpose()
}

/// The claim about an error.
fn claim(order: &Bound<'_, PyAny>, tolerance: Option<f64>) -> PyResult<Claim> {
    let expected = || refuse(format!("order: expected {ORDER}, found {}", shown(order)));
    let (order, bound) = match order.extract::<String>() {
        Ok(text) => order_from_text(&text).ok_or_else(expected)?,
        Err(_) => (
            number(|| "order".to_owned(), order).map_err(|_| expected())?,
            ClaimBound::Both,
        ),
    };
    if !(order > 0.0 && order.is_finite()) {
        return Err(expected());
    }
    let usual = Claim::usual(order, bound);
    let tolerance = tolerance.unwrap_or(usual.tolerance);
    if tolerance >= order {
        return Err(refuse(format!(
            "tolerance: expected a number less than the order {order}, found {tolerance}"
        )));
    }
    Ok(Claim { tolerance, ..usual })
}

/// Claims by name, or one for all names, which may be none.
pub(crate) enum Claims {
    ForAll(Option<Claim>),
    Named(Vec<(String, Claim)>),
}

impl Claims {
    /// The highest order that is claimed; 0 without one.
    pub(crate) fn highest_order(&self) -> f64 {
        let named = match self {
            Self::Named(named) => &named[..],
            Self::ForAll(_) => &[],
        };
        let for_all = match self {
            Self::ForAll(claim) => claim.as_ref(),
            Self::Named(_) => None,
        };
        let claims = named.iter().map(|(_, claim)| claim).chain(for_all);
        claims.map(|claim| claim.order).fold(0.0, f64::max)
    }

    pub(crate) fn read(order: Option<&Bound<'_, PyAny>>, tolerance: Option<f64>) -> PyResult<Self> {
        let Some(by_name) = order.and_then(|order| order.cast::<PyDict>().ok()) else {
            return Ok(Self::ForAll(optional_claim(order, tolerance)?));
        };
        check_tolerance(tolerance)?;
        let named = by_name
            .iter()
            .map(|(name, order)| Ok((name.extract()?, claim(&order, tolerance)?)));
        Ok(Self::Named(named.collect::<PyResult<_>>()?))
    }

    pub(crate) fn names(&self) -> Vec<String> {
        match self {
            Self::ForAll(_) => vec![],
            Self::Named(named) => named.iter().map(|(name, _)| name.clone()).collect(),
        }
    }
}

/// The columns of a data frame or a dict of lists, by name; `None` for other types.
pub(crate) fn columns(table: &Bound<'_, PyAny>) -> PyResult<Option<Vec<FrameColumn>>> {
    let names = match table.cast::<PyDict>() {
        Ok(table) => table.keys().into_any(),
        Err(_) if table.hasattr("columns")? => table.getattr("columns")?,
        Err(_) => return Ok(None),
    };
    let mut columns = vec![];
    let mut known = BTreeSet::new();
    for name in names.try_iter()? {
        let name = name?;
        let text = name.str()?.to_string();
        if !known.insert(text.clone()) {
            return Err(refuse(format!(
                "expected each name of a column once, found `{text}` twice"
            )));
        }
        let cells = items(&text, &table.get_item(&name)?)?;
        columns.push(FrameColumn {
            name: text,
            cells: cells.iter().map(cell).collect::<PyResult<_>>()?,
        });
    }
    Ok(Some(columns))
}

/// A number, or the words of anything else: what is no number may be a level that has failed.
fn cell(item: &Bound<'_, PyAny>) -> PyResult<FrameCell> {
    match number(String::new, item) {
        Ok(number) => Ok(FrameCell::Number(number)),
        Err(_) => Ok(FrameCell::Word(item.str()?.to_string())),
    }
}
