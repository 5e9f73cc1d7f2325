//! Limits of values without an exact solution.

use convergence_judge::{
    richardson::Estimate, text::number::RATE_PLACES, verdict::DEFAULT_TOLERANCE,
};
use convergence_study::{Estimator, StepValue};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::judged::attributes;
use crate::values::{self, refuse};

/// The limit of values at h = 0.
///
/// value: the limit; interval: its two ends; error: that of the finest value, with its sign; gci:
/// half the width of the grid convergence index about the finest value; all in the unit of the
/// values, and None if there is no such number. order: the observed order; verdict: on the claimed
/// order; reason: why there is no limit, or how the order was found.
#[pyclass(frozen, get_all, module = "convergence_study")]
pub(crate) struct Limit {
    value: Option<f64>,
    interval: Option<(f64, f64)>,
    error: Option<f64>,
    order: Option<f64>,
    gci: Option<f64>,
    verdict: String,
    reason: String,
}

/// The fields of a [`Limit`], in the order of its constructor.
const LIMIT: [&str; 7] = [
    "value", "interval", "error", "order", "gci", "verdict", "reason",
];

impl Limit {
    /// * `is_claimed`: whether theory claims an order; if not, the observed one replaces it.
    fn new(Estimate { bar, gci, judged }: Estimate, is_claimed: bool) -> Self {
        let reason = match &bar {
            Err(refusal) => refusal.to_string(),
            Ok(_) if is_claimed => judged.reason.to_string(),
            Ok(_) => format!("observed order {}", judged.rate_in_words(RATE_PLACES)),
        };
        let bar = bar.ok();
        Self {
            value: bar.as_ref().map(|bar| bar.extrapolated),
            interval: bar.as_ref().map(|bar| (bar.limit.low, bar.limit.high)),
            error: bar.as_ref().map(|bar| bar.error),
            order: judged.fitted,
            gci: gci.ok().map(|gci| gci.half_width),
            verdict: judged.verdict.name().to_owned(),
            reason,
        }
    }
}

#[pymethods]
impl Limit {
    /// `copy` and `pickle` make it again from its fields.
    #[new]
    fn again(
        value: Option<f64>,
        interval: Option<(f64, f64)>,
        error: Option<f64>,
        order: Option<f64>,
        gci: Option<f64>,
        verdict: String,
        reason: String,
    ) -> Self {
        Self {
            value,
            interval,
            error,
            order,
            gci,
            verdict,
            reason,
        }
    }

    fn __getnewargs__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(slf.py(), attributes(slf, &LIMIT)?.values())
    }

    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        attributes(slf, &LIMIT)
    }

    fn __bool__(&self) -> PyResult<bool> {
        Err(PyTypeError::new_err(
            "a limit is no truth value: pass, fail or inconclusive; ask .verdict",
        ))
    }

    fn __repr__(&self) -> String {
        match (self.value, self.interval) {
            (Some(value), Some((low, high))) => {
                format!("limit {value:?} ({low:?} to {high:?}): {}", self.reason)
            }
            _ => format!("no limit: {}", self.reason),
        }
    }
}

/// The limit of levels at h = 0; see the function of this name in Python.
#[pyfunction]
pub(crate) fn limit(
    h: &Bound<'_, PyAny>,
    values: &Bound<'_, PyAny>,
    order: Option<&Bound<'_, PyAny>>,
    tolerance: Option<f64>,
) -> PyResult<Limit> {
    let claim = values::optional_claim(order, tolerance)?;
    let levels = values::levels(h, "values", values)?;
    let values: Vec<StepValue> = levels
        .iter()
        .map(|level| StepValue {
            step: level.step,
            value: level.error,
        })
        .collect();
    let tolerance = claim.map_or(tolerance, |claim| Some(claim.tolerance));
    let estimator = Estimator::new(tolerance.unwrap_or(DEFAULT_TOLERANCE)).map_err(refuse)?;
    let estimate = match claim {
        Some(claim) => estimator.estimate(&values, claim.order),
        None => estimator.estimate_unclaimed(&values),
    };
    Ok(Limit::new(estimate, order.is_some()))
}
