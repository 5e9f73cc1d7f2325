//! Judges tables of errors.

use std::collections::BTreeMap;

use convergence_judge::{
    fit::Level,
    shown::{self, MOST_PLACES, Shown},
    text::number::decimals,
};
use convergence_study::{
    Claim, ErrorColumn, Floor, Interval, Levels, NamedRate, RateVerdict, Reason, RefinedIn,
    Refinement, Verdict, observe,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::values::{self, Order};

/// The arguments that make a [`Judgement`] again.
type Arguments = (
    String,
    String,
    Vec<f64>,
    Vec<f64>,
    Option<Order>,
    Option<f64>,
    f64,
    BTreeMap<String, String>,
);

/// The judgement of one error: the verdict, and the numbers behind it.
///
/// verdict: "pass", "fail" or "inconclusive"; rate: the order observed at h = 0, or None; interval:
/// its two ends, or None; pairwise: the rates between neighbouring levels, one fewer than levels,
/// NaN if there is none; code, reason, advice: why, and what to do (None for a pass); order: the
/// claimed order, or None; left_out: the columns of its table that are not judged, by name with the
/// reason; table(): step, error and rate of each level, coarse to fine, as a pandas DataFrame if
/// pandas is available, otherwise as a dict of lists; to_dict(): all of it in types that JSON
/// knows. It has no truth value. In a notebook it is shown as a table and a picture.
#[pyclass(frozen, module = "convergence_study")]
pub(crate) struct Judgement {
    pub(crate) name: String,
    pub(crate) step: String,
    pub(crate) levels: Vec<Level>,
    pub(crate) claim: Option<Claim>,
    pub(crate) tolerance: Option<f64>,
    pub(crate) floor: Floor,
    pub(crate) rate: RateVerdict,
    /// The columns of its table that are not judged, each with the reason.
    pub(crate) left_out: BTreeMap<String, String>,
}

/// Decimals of the rate in the first line of a failing test.
const FEW_PLACES: usize = 3;

impl Judgement {
    fn shown(&self) -> Shown<'_> {
        Shown {
            name: &self.name,
            levels: &self.levels,
            rate: &self.rate,
            late: 0,
        }
    }

    /// `error: fail: 1.000, claimed 2 ± 0.25: too low`, for a rate in words.
    fn line(&self, rate: &str) -> String {
        let words = match &self.claim {
            Some(claim) => claim.answer(&self.rate, rate),
            None => format!("{rate}: {}", self.rate.because),
        };
        format!("{}: {}: {words}", self.name, self.rate.verdict)
    }

    /// The line with few decimals: the summary of a failing test.
    fn headline(&self) -> String {
        let rate = self.rate.fitted.map_or_else(
            || self.rate.rate_in_words(FEW_PLACES),
            |rate| decimals(rate, FEW_PLACES),
        );
        self.line(&rate)
    }

    /// A picture of the errors over the steps, with the rate and the claimed order.
    fn picture(&self) -> String {
        let refinements = self.levels.iter().map(|level| Refinement {
            label: String::new(),
            parameters: vec![],
            step: level.step,
        });
        let errors = self.levels.iter().map(|level| Some(level.error));
        let axis = if self.step == "dt" {
            RefinedIn::Time
        } else {
            RefinedIn::Space
        };
        let columns = [ErrorColumn {
            claim: self.claim,
            ..ErrorColumn::without_claim(&self.name, errors)
        }];
        let levels = Levels::new(axis, refinements, columns);
        levels
            .figure(
                "",
                None,
                String::new(),
                &[NamedRate::new(&self.name, self.rate.clone())],
            )
            .svg()
            .to_owned()
    }
}

#[pymethods]
impl Judgement {
    /// Judges levels, coarse to fine; `copy` and `pickle` repeat the judgement.
    #[new]
    #[pyo3(signature = (name, step, h, errors, order=None, tolerance=None, floor=0.0, left_out=BTreeMap::new()))]
    #[allow(
        clippy::too_many_arguments,
        reason = "the arguments of the constructor in Python"
    )]
    fn new(
        name: String,
        step: String,
        h: &Bound<'_, PyAny>,
        errors: &Bound<'_, PyAny>,
        order: Option<&Bound<'_, PyAny>>,
        tolerance: Option<f64>,
        floor: f64,
        left_out: BTreeMap<String, String>,
    ) -> PyResult<Self> {
        let claim = values::optional_claim(order, tolerance)?;
        let floor = values::floor_of(floor)?;
        let levels = values::levels(h, "errors", errors)?;
        let rate = match &claim {
            Some(claim) => claim.judge(&levels, floor),
            None => observe(&levels, floor),
        };
        Ok(Self {
            rate,
            name,
            step,
            levels,
            claim,
            tolerance,
            floor,
            left_out,
        })
    }

    fn __getnewargs__(&self) -> Arguments {
        (
            self.name.clone(),
            self.step.clone(),
            self.levels.iter().map(|level| level.step).collect(),
            self.levels.iter().map(|level| level.error).collect(),
            self.claim.as_ref().map(values::order_of),
            self.tolerance,
            self.floor.value(),
            self.left_out.clone(),
        )
    }

    /// Whether the steps must be counts, as for `rates`: whole numbers, and where they grow, errors
    /// fall more often than they grow.
    fn _are_counts(&self) -> bool {
        let is_whole = |level: &Level| level.step >= 1.0 && level.step.fract() == 0.0;
        let grows = |pair: &[Level]| match pair[1].error.partial_cmp(&pair[0].error) {
            Some(order) => order as i32,
            None => 0,
        };
        self.levels.iter().all(is_whole) && self.levels.windows(2).map(grows).sum::<i32>() > 0
    }

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
        self.rate.order()
    }

    #[getter]
    fn rate(&self) -> Option<f64> {
        self.rate.fitted
    }

    #[getter]
    fn interval(&self) -> Option<(f64, f64)> {
        self.rate.interval.map(|Interval { low, high }| (low, high))
    }

    #[getter]
    fn pairwise(&self) -> Vec<f64> {
        self.rate.pairwise.clone()
    }

    #[getter]
    fn left_out(&self) -> BTreeMap<String, String> {
        self.left_out.clone()
    }

    #[getter]
    fn code(&self) -> &'static str {
        self.rate.code.name()
    }

    #[getter]
    fn reason(&self) -> String {
        self.rate.reason.to_string()
    }

    #[getter]
    fn advice(&self) -> Option<String> {
        if self.claim.is_some() {
            self.rate.advice()
        } else {
            Some("Claim what theory says: order=2, for example.".to_owned())
        }
    }

    pub(crate) fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let fields = [
            "name", "verdict", "order", "rate", "interval", "code", "reason", "advice", "left_out",
        ];
        let dict = attributes(slf, &fields)?;
        let own = slf.get();
        let pairwise = own.rate.pairwise.iter().copied().map(finite);
        dict.set_item("pairwise", pairwise.collect::<Vec<_>>())?;
        let steps = own.levels.iter().map(|level| finite(level.step));
        dict.set_item("steps", steps.collect::<Vec<_>>())?;
        let errors = own.levels.iter().map(|level| finite(level.error));
        dict.set_item("errors", errors.collect::<Vec<_>>())?;
        Ok(dict)
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
        explained(&[self])
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

/// The attributes of an object by name.
pub(crate) fn attributes<'py, T>(
    object: &Bound<'py, T>,
    names: &[&str],
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(object.py());
    for name in names {
        dict.set_item(name, object.as_any().getattr(*name)?)?;
    }
    Ok(dict)
}

/// A number for JSON, which has none for NaN and infinity.
pub(crate) fn finite(number: f64) -> Option<f64> {
    Some(number).filter(|number| number.is_finite())
}

/// The table of errors with their rates, and a line with advice for each.
pub(crate) fn explained(judgements: &[&Judgement]) -> String {
    let first = judgements.first();
    let step = first.map_or("h", |judgement| &judgement.step);
    let floor = first.map_or(0.0, |judgement| judgement.floor.value());
    let columns: Vec<Shown<'_>> = judgements.iter().map(|one| one.shown()).collect();
    let mut text = shown::table(step, &columns, floor);
    for judgement in judgements {
        let rate = judgement.rate.rate_in_words(MOST_PLACES);
        text += &(judgement.line(&rate) + "\n");
        if let Some(advice) = judgement.advice() {
            let code = if judgement.claim.is_some() {
                judgement.code()
            } else {
                "order"
            };
            text += &format!("  {code}: {advice}\n");
        }
    }
    text
}

/// The verdict that a failing test is about, in a line: the first failure, else the first that is
/// no pass; `None` if all pass.
pub(crate) fn headline(judgements: &[&Judgement]) -> Option<String> {
    let open = judgements
        .iter()
        .filter(|judgement| !judgement.rate.verdict.is_pass());
    let first_of_the_worst = open.min_by_key(|judgement| judgement.rate.verdict != Verdict::Fail);
    Some(first_of_the_worst?.headline())
}

/// The message of a failed assertion on judgements; `None` if it holds.
#[pyfunction]
pub(crate) fn failure(
    judgements: Vec<PyRef<'_, Judgement>>,
    allow_inconclusive: bool,
) -> Option<String> {
    let judgements: Vec<&Judgement> = judgements.iter().map(|judgement| &**judgement).collect();
    let Some(headline) = headline(&judgements) else {
        return judgements
            .is_empty()
            .then(|| Reason::NotClaimed.text().to_owned());
    };
    let verdict = Verdict::worst(judgements.iter().map(|judgement| judgement.rate.verdict));
    let is_allowed = allow_inconclusive && verdict == Verdict::Inconclusive;
    (!is_allowed).then(|| format!("{headline}\n{}", explained(&judgements)))
}
