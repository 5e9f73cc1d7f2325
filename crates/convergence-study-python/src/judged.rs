//! Judges tables of errors.

use convergence_harness::input::error_table::{Choice, RateTable};
use convergence_harness::judge::fit::Level;
use convergence_harness::judge::richardson::{Estimate, Estimator, Value};
use convergence_harness::judge::shown::{self, Shown};
use convergence_harness::judge::verdict::RateVerdict;
use convergence_harness::study::over_levels::{ErrorColumn, Levels};
use convergence_harness::study::{Axis, Claim, Refinement};
use pyo3::exceptions::{PyAssertionError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::values::{self, Claims, refuse};

/// The judgement of one error: the verdict, and the numbers behind it.
///
/// verdict: "pass", "fail" or "inconclusive"; rate: the order observed at h = 0, or None; interval:
/// its two ends (95 %), or None; pairwise: the rates between neighbouring levels, one fewer than
/// levels, NaN if there is none; code, reason, advice: why, and what to do (None for a pass);
/// order: the claimed order, or None; table(): step, error and rate of each level, coarse to fine,
/// as a pandas DataFrame if pandas is available, otherwise as a dict of lists. It has no truth
/// value. In a notebook it is shown as a table and a picture.
#[pyclass(frozen, module = "convergence_study")]
pub(crate) struct Judgement {
    pub(crate) name: String,
    pub(crate) step: String,
    pub(crate) levels: Vec<Level>,
    pub(crate) rate: RateVerdict,
}

impl Judgement {
    fn shown(&self) -> Shown<'_> {
        Shown {
            name: &self.name,
            levels: &self.levels,
            rate: &self.rate,
            late: 0,
        }
    }

    /// A picture of the errors over the steps, with the rate and the claimed order.
    fn picture(&self) -> String {
        let refinement = |level: &Level| Refinement {
            label: String::new(),
            parameters: vec![],
            step: level.step,
        };
        let claim = Some(Claim::new(self.rate.order, self.rate.tolerance))
            .filter(|claim| claim.order.is_finite());
        let errors = self.levels.iter().map(|level| Some(level.error)).collect();
        let axis = if self.step == "dt" {
            Axis::Time
        } else {
            Axis::Space
        };
        let columns = vec![ErrorColumn {
            name: self.name.clone(),
            symbol: None,
            errors,
            claim,
            look: 0,
        }];
        let levels = Levels::new(axis, self.levels.iter().map(refinement), columns);
        levels
            .figure(
                "",
                None,
                String::new(),
                &[(self.name.clone(), self.rate.clone())],
            )
            .svg
    }
}

#[pymethods]
impl Judgement {
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    #[getter]
    fn verdict(&self) -> &'static str {
        self.rate.verdict.name()
    }

    #[getter]
    fn order(&self) -> Option<f64> {
        Some(self.rate.order).filter(|order| !order.is_nan())
    }

    #[getter]
    fn rate(&self) -> Option<f64> {
        self.rate.fitted
    }

    #[getter]
    fn interval(&self) -> Option<(f64, f64)> {
        self.rate.interval.map(|[low, high]| (low, high))
    }

    #[getter]
    fn pairwise(&self) -> Vec<f64> {
        self.rate.pairwise.clone()
    }

    #[getter]
    fn code(&self) -> &'static str {
        self.rate.kind.code()
    }

    #[getter]
    fn reason(&self) -> &str {
        &self.rate.reason
    }

    #[getter]
    fn advice(&self) -> Option<String> {
        self.rate.advice()
    }

    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rates = std::iter::once(f64::NAN)
            .chain(self.rate.pairwise.iter().copied())
            .collect();
        let column = |value: fn(&Level) -> f64| self.levels.iter().map(value).collect::<Vec<f64>>();
        let columns = [
            (self.step.clone(), column(|level| level.step)),
            (self.name.clone(), column(|level| level.error)),
            ("rate".to_owned(), rates),
        ];
        frame(py, &columns)
    }

    fn __bool__(&self) -> PyResult<bool> {
        Err(PyTypeError::new_err(
            "a judgement is no truth value: pass, fail or inconclusive; ask .verdict",
        ))
    }

    fn __repr__(&self) -> String {
        shown::explained(&self.step, &[self.shown()], 0.0)
    }

    fn _repr_html_(&self) -> String {
        html(&self.__repr__(), &[self.picture()])
    }
}

/// Text and pictures for a notebook.
pub(crate) fn html(text: &str, pictures: &[String]) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    format!(
        "<div><pre style=\"white-space: pre-wrap\">{text}</pre>{}</div>",
        pictures.concat()
    )
}

/// A data frame if the caller has imported pandas, otherwise a dict of lists.
pub(crate) fn frame<'py>(
    py: Python<'py>,
    columns: &[(String, Vec<f64>)],
) -> PyResult<Bound<'py, PyAny>> {
    let table = PyDict::new(py);
    columns
        .iter()
        .try_for_each(|(name, numbers)| table.set_item(name, numbers))?;
    match py.import("pandas") {
        Ok(pandas) => pandas.call_method1("DataFrame", (table,)),
        Err(_) => Ok(table.into_any()),
    }
}

/// The judged errors of one or several columns, and whether they come from a data frame.
fn judged(
    h: &Bound<'_, PyAny>,
    errors: Option<&Bound<'_, PyAny>>,
    order: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
) -> PyResult<(Vec<Judgement>, bool)> {
    let judge = values::judge_with(tolerance)?;
    let judgement = |step: &str, name: &str, levels: Vec<Level>, claim: Claim| {
        let rate = claim.judge(&judge, &levels);
        Judgement {
            name: name.to_owned(),
            step: step.to_owned(),
            levels,
            rate,
        }
    };
    let claims = match errors {
        Some(errors) => {
            let claim = values::claim(order, tolerance)?;
            return Ok((
                vec![judgement(
                    "h",
                    "error",
                    values::levels(h, "errors", errors)?,
                    claim,
                )],
                false,
            ));
        }
        None => Claims::read(order, tolerance)?,
    };
    let table = table(h, &claims.names())?;
    let known = || {
        table
            .columns
            .iter()
            .map(|column| column.name.as_str())
            .collect::<Vec<_>>()
            .join(", ")
    };
    let of = |name: &str, claim: &Claim| {
        let unknown = || {
            refuse(format!(
                "order: expected names of columns of errors, {}; found `{name}`",
                known()
            ))
        };
        let column = table.column(name).ok_or_else(unknown)?;
        Ok(judgement(
            &table.step,
            &column.name,
            column.levels.clone(),
            *claim,
        ))
    };
    let found = match &claims {
        Claims::ForAll(claim) => table
            .columns
            .iter()
            .map(|column| of(&column.name, claim))
            .collect::<PyResult<_>>()?,
        Claims::Named(named) => named
            .iter()
            .map(|(name, claim)| of(name, claim))
            .collect::<PyResult<_>>()?,
    };
    Ok((found, true))
}

/// A data frame, read like text by `convergence-study rates`, with all digits.
fn table(table: &Bound<'_, PyAny>, claimed: &[String]) -> PyResult<RateTable> {
    let Some(columns) = values::columns(table, claimed)? else {
        return Err(refuse(
            "errors: expected the errors at the steps h, or a data frame in place of h",
        ));
    };
    let rows = columns
        .iter()
        .map(|(_, numbers)| numbers.len())
        .max()
        .unwrap_or(0);
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
            .map(|(_, numbers)| format!("{:?}", numbers[row]))
            .collect();
        text += &(cells.join(",") + "\n");
    }
    let choice = Choice {
        claimed: claimed.to_vec(),
        ..Choice::default()
    };
    RateTable::parse_with(&text, "the data frame", &choice).map_err(refuse)
}

/// Judges errors against the order that theory claims.
///
/// h: the steps, in any order, positive; errors: the same number of errors, in any unit. Lists,
/// arrays and series are accepted. Or h is a data frame, or a dict of lists, with a column of steps
/// and columns of errors, which are recognised as `convergence-study rates` does; errors is then
/// None. order: a number > 0, or ">= 2" for a minimum order; for a data frame also a dict of names
/// and orders; None for no claim, which is never a pass. tolerance: allowed deviation of the rate
/// from the order, 0 < tolerance < 0.5.
///
/// Returns a Judgement; for a data frame a dict of them by name. Raises ValueError, which names the
/// argument, if the input is not a table of numbers. NaN among the errors is a finding, not bad
/// input.
#[pyfunction]
#[pyo3(signature = (h, errors=None, order=None, tolerance=0.25))]
pub(crate) fn judge<'py>(
    py: Python<'py>,
    h: &Bound<'py, PyAny>,
    errors: Option<&Bound<'py, PyAny>>,
    order: Option<&Bound<'py, PyAny>>,
    tolerance: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let (found, is_frame) = judged(h, errors, order, tolerance)?;
    let by_name = PyDict::new(py);
    for judgement in found {
        if !is_frame {
            return Ok(Bound::new(py, judgement)?.into_any());
        }
        by_name.set_item(judgement.name.clone(), Bound::new(py, judgement)?)?;
    }
    Ok(by_name.into_any())
}

/// Does nothing if the order is confirmed; arguments as for judge.
///
/// Raises AssertionError with the table, the rate, its interval, the reason and what to do, unless
/// every verdict is a pass: inconclusive is not. Raises ValueError as judge does.
#[pyfunction]
#[pyo3(signature = (h, errors=None, order=None, tolerance=0.25))]
pub(crate) fn assert_order(
    h: &Bound<'_, PyAny>,
    errors: Option<&Bound<'_, PyAny>>,
    order: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
) -> PyResult<()> {
    let (found, _) = judged(h, errors, order, tolerance)?;
    if !found.is_empty()
        && found
            .iter()
            .all(|judgement| judgement.rate.verdict.is_pass())
    {
        return Ok(());
    }
    let step = found.first().map_or("h", |judgement| &judgement.step);
    let columns: Vec<Shown<'_>> = found.iter().map(Judgement::shown).collect();
    let text = shown::explained(step, &columns, 0.0);
    Err(PyAssertionError::new_err(format!(
        "the order is not confirmed\n{text}"
    )))
}

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
    verdict: &'static str,
    reason: String,
}

impl Limit {
    fn new(Estimate { bar, gci, judged }: Estimate) -> Self {
        let reason = bar
            .as_ref()
            .map_or_else(ToString::to_string, |_| judged.reason.clone());
        let bar = bar.ok();
        Self {
            value: bar.as_ref().map(|bar| bar.extrapolated),
            interval: bar.as_ref().map(|bar| bar.limit.into()),
            error: bar.as_ref().map(|bar| bar.error),
            order: judged.fitted,
            gci: gci.ok().map(|gci| gci.half_width),
            verdict: judged.verdict.name(),
            reason,
        }
    }
}

#[pymethods]
impl Limit {
    fn __repr__(&self) -> String {
        match (self.value, self.interval) {
            (Some(value), Some((low, high))) => {
                format!("limit {value:?} ({low:?} to {high:?}): {}", self.reason)
            }
            _ => format!("no limit: {}", self.reason),
        }
    }
}

/// The limit at h = 0 of values without a known exact value, with its interval, the observed order
/// and the grid convergence index.
///
/// h: the steps, in any order, positive; values: the same number of values, at least three, in any
/// unit. order: the theoretical order, or None: then the observed order replaces it. tolerance as
/// for judge. Returns a Limit. Raises ValueError, which names the argument.
#[pyfunction]
#[pyo3(signature = (h, values, order=None, tolerance=0.25))]
pub(crate) fn limit(
    h: &Bound<'_, PyAny>,
    values: &Bound<'_, PyAny>,
    order: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
) -> PyResult<Limit> {
    let claim = values::claim(order, tolerance)?;
    let levels = values::levels(h, "values", values)?;
    let values: Vec<Value> = levels
        .iter()
        .map(|level| Value {
            step: level.step,
            value: level.error,
        })
        .collect();
    let estimator = Estimator::new(tolerance).map_err(refuse)?;
    let estimate = if order.is_none() {
        estimator.estimate_unclaimed(&values)
    } else {
        estimator.estimate(&values, claim.order)
    };
    Ok(Limit::new(estimate))
}
