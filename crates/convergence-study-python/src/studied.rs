//! Studies of a Python function, and tables as studies, for reports and baselines.

use std::io::{IsTerminal as _, Write as _, stderr};
use std::path::PathBuf;
use std::time::Instant;

use convergence_harness::program;
use convergence_harness::run::Finished;
use convergence_harness::study::until_decided::{self, FIRST, Next};
use convergence_harness::study::{
    Claim, ErrorsOverLevels, Header, Kind, NamedErrors, STEPS, header::is_name, levels,
    run_cases_here,
};
use convergence_harness::verify;
use pyo3::exceptions::PyAssertionError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::judged::{Judgement, frame, html};
use crate::values::{self, Claims, number, numbers, refuse};

/// A completed study.
///
/// verdict: "pass", "fail" or "inconclusive"; summary: why, in a sentence; rates: a Judgement for
/// each claim, by name; table(): steps, errors and rates as a DataFrame if pandas is available,
/// otherwise as a dict of lists; report(folder): writes index.html, README.md, JUnit and records;
/// assert_passes(): AssertionError unless it passes. It has no truth value. In a notebook it is
/// shown as a table and a picture.
#[pyclass(frozen, module = "convergence_study")]
pub(crate) struct Study {
    pub(crate) finished: Finished,
}

#[pymethods]
impl Study {
    #[getter]
    fn id(&self) -> &str {
        &self.finished.header.id
    }

    #[getter]
    fn verdict(&self) -> &'static str {
        self.finished.outcome.verdict.name()
    }

    #[getter]
    fn summary(&self) -> &str {
        &self.finished.outcome.summary
    }

    #[getter]
    fn rates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let by_name = PyDict::new(py);
        for (name, rate) in &self.finished.outcome.rates {
            let levels = self.finished.outcome.levels_of(name);
            let judgement = Judgement {
                name: name.clone(),
                step: "h".to_owned(),
                levels,
                rate: rate.clone(),
            };
            by_name.set_item(name, Bound::new(py, judgement)?)?;
        }
        Ok(by_name)
    }

    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let levels = &self.finished.outcome.levels;
        let steps = levels
            .iter()
            .map(|level| level.step.unwrap_or(f64::NAN))
            .collect();
        let mut columns: Vec<(String, Vec<f64>)> = vec![("h".to_owned(), steps)];
        for (name, _) in levels.first().map_or(&[][..], |level| &level.errors) {
            columns.push((
                name.clone(),
                levels.iter().map(|level| level.error(name)).collect(),
            ));
            if let Some((_, rate)) = self
                .finished
                .outcome
                .rates
                .iter()
                .find(|(rated, _)| rated == name)
            {
                let rates = std::iter::once(f64::NAN)
                    .chain(rate.pairwise.iter().copied())
                    .collect();
                columns.push((format!("rate {name}"), rates));
            }
        }
        frame(py, &columns)
    }

    fn report(&self, folder: PathBuf) -> PyResult<()> {
        verify::report(
            &program::PROJECT,
            std::slice::from_ref(&self.finished),
            &folder,
        )
        .map_err(refuse)
    }

    fn assert_passes(&self) -> PyResult<()> {
        if self.finished.outcome.verdict.is_pass() {
            Ok(())
        } else {
            Err(PyAssertionError::new_err(self.__repr__()))
        }
    }

    fn __bool__(&self) -> PyResult<bool> {
        Err(pyo3::exceptions::PyTypeError::new_err(
            "a study is no truth value: pass, fail or inconclusive; ask .verdict",
        ))
    }

    fn __repr__(&self) -> String {
        self.finished.explained()
    }

    fn _repr_html_(&self) -> String {
        let pictures: Vec<String> = self
            .finished
            .outcome
            .figures
            .iter()
            .map(|figure| figure.svg.clone())
            .collect();
        html(
            &format!("{}\n{}", self.finished.outcome.summary, self.__repr__()),
            &pictures,
        )
    }
}

/// A text as the id of a study: small letters, digits, `.` and `-`.
fn id_of(name: &str) -> String {
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() || c == '.' {
            c.to_ascii_lowercase()
        } else {
            '-'
        }
    };
    let id: String = name
        .chars()
        .map(plain)
        .skip_while(|c| !c.is_ascii_alphanumeric())
        .take(100)
        .collect();
    if is_name(&id) { id } else { "study".to_owned() }
}

/// The header of a study; the baseline keeps its settings as claims.
fn header(name: &str, claims: &[(String, Claim)], levels: &str) -> Header {
    let orders: Vec<String> = claims
        .iter()
        .map(|(name, claim)| format!("{name} {claim}"))
        .collect();
    let mut header = Header::new(id_of(name), format!("orders: {}", orders.join(", ")));
    for (name, claim) in claims {
        header
            .settings
            .push((format!("expect.{name}.order"), claim.order.to_string()));
        header.settings.push((
            format!("expect.{name}.tolerance"),
            claim.tolerance.to_string(),
        ));
        header.settings.push((
            format!("expect.{name}.at_least"),
            claim.at_least.to_string(),
        ));
    }
    header
        .settings
        .push(("levels".to_owned(), levels.to_owned()));
    header
}

/// A study of computed errors: one function for every claim.
fn study_of<'f>(
    header: Header,
    claims: &[(String, Claim)],
    counts: &[usize],
    found: &'f [NamedErrors],
) -> ErrorsOverLevels<impl Fn(usize) -> NamedErrors + use<'f>> {
    let known = counts.to_vec();
    let solve = move |n: usize| {
        known
            .iter()
            .position(|count| *count == n)
            .map_or(vec![], |at| found[at].clone())
    };
    let study = levels(counts.iter().copied(), solve).described(header);
    claims
        .iter()
        .fold(study, |study, (name, claim)| study.claiming(name, *claim))
}

/// A table of errors as a study, for reports and baselines.
#[pyfunction]
#[pyo3(signature = (name, h, errors, order=None, tolerance=0.25))]
pub(crate) fn of_table(
    py: Python<'_>,
    name: &str,
    h: &Bound<'_, PyAny>,
    errors: &Bound<'_, PyAny>,
    order: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
) -> PyResult<Study> {
    let claims = [("error".to_owned(), values::claim(order, tolerance)?)];
    let levels = values::levels(h, "errors", errors)?;
    let found: Vec<NamedErrors> = levels
        .iter()
        .map(|level| {
            vec![
                ("h".to_owned(), level.step),
                ("error".to_owned(), level.error),
            ]
        })
        .collect();
    let counts: Vec<usize> = (1..=found.len()).collect();
    let study = study_of(
        header(name, &claims, &counts.len().to_string()),
        &claims,
        &counts,
        &found,
    );
    Ok(Study {
        finished: py.detach(|| {
            study
                .counting("level", convergence_harness::study::Axis::Space)
                .run()
        }),
    })
}

/// The errors returned by a level.
fn found(n: usize, returned: &Bound<'_, PyAny>) -> PyResult<NamedErrors> {
    let Ok(by_name) = returned.cast::<PyDict>() else {
        return Ok(vec![(
            "error".to_owned(),
            number(|| format!("solve({n})"), returned)?,
        )]);
    };
    let entry = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let name = name.str()?.to_string();
        let value = number(|| format!("solve({n})[{name:?}]"), &value)?;
        Ok((name, value))
    };
    by_name.iter().map(entry).collect()
}

/// The listed counts; `None` for `"auto"`.
fn listed(n: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Vec<usize>>> {
    let Some(n) = n.filter(|n| n.extract::<String>().map_or(true, |text| text != "auto")) else {
        return Ok(None);
    };
    let mut counts = vec![];
    for (k, number) in numbers("n", n)?.into_iter().enumerate() {
        if !(1.0..=1e15).contains(&number) || number.fract() != 0.0 {
            return Err(refuse(format!(
                "n[{k}]: expected a whole number > 0, found {number}"
            )));
        }
        if counts.contains(&(number as usize)) {
            return Err(refuse(format!(
                "n[{k}]: expected each number once, found {number} again"
            )));
        }
        counts.push(number as usize);
    }
    if counts.is_empty() {
        Err(refuse("n: expected \"auto\" or whole numbers, found none"))
    } else {
        Ok(Some(counts))
    }
}

/// Calls `solve` at one level, and reports it on a terminal.
fn solved(solve: &Bound<'_, PyAny>, n: usize, seconds: &mut Vec<f64>) -> PyResult<NamedErrors> {
    let is_shown = stderr().is_terminal();
    if is_shown {
        let so_far = seconds.iter().fold(0.0, |sum, seconds| sum + seconds);
        let _ = write!(
            stderr(),
            "\r\x1b[2Kn = {n}: level {}, {so_far:.1} s so far",
            seconds.len() + 1
        );
    }
    let started = Instant::now();
    let returned = solve.call1((n,));
    seconds.push(started.elapsed().as_secs_f64());
    if is_shown {
        let _ = write!(stderr(), "\r\x1b[2K");
    }
    found(n, &returned?)
}

/// Computes levels and judges the rates of their errors.
///
/// solve: called with a whole number n, level by level, in the thread of the caller; returns a dict
/// of errors by name, or one error. Its step is 1/n, or the value that it returns with the errors
/// as "h" or "dt". n: whole numbers, or "auto": 8, 16, 32, 64, then finer ones until every rate has
/// a verdict, at most 8 levels, while the next one fits the budget (seconds). order: as for judge;
/// a dict has orders by name, and other errors are not judged; one number applies to every error.
/// name: its name in reports.
///
/// Returns a Study. Raises ValueError, which names the argument, and exceptions of solve.
#[pyfunction]
#[pyo3(signature = (solve, n=None, order=None, budget=60.0, tolerance=0.25, name="study"))]
pub(crate) fn study(
    py: Python<'_>,
    solve: &Bound<'_, PyAny>,
    n: Option<&Bound<'_, PyAny>>,
    order: Option<&Bound<'_, PyAny>>,
    budget: f64,
    tolerance: f64,
    name: &str,
) -> PyResult<Study> {
    let (claimed, listed) = (Claims::read(order, tolerance)?, listed(n)?);
    if !(budget > 0.0) {
        return Err(refuse(format!(
            "budget: expected a number of seconds > 0, found {budget}"
        )));
    }
    let is_auto = listed.is_none();
    let mut counts = listed.unwrap_or_else(|| FIRST.to_vec());
    let (mut results, mut seconds) = (vec![], vec![]);
    let mut claims = vec![];
    let mut next = Next::Decided;
    while results.len() < counts.len() {
        results.push(solved(solve, counts[results.len()], &mut seconds)?);
        if results.len() == 1 {
            claims = all_claims(&claimed, &results[0]);
        }
        if is_auto && results.len() == counts.len() {
            let study = study_of(Header::new("levels", ""), &claims, &counts, &results);
            let rates = study.judge(&run_cases_here(&study)).rates;
            next = until_decided::next_by_time(&rates, &seconds, budget);
            if next == Next::Another {
                counts.push(2 * counts[counts.len() - 1]);
            }
        }
    }
    let words: Vec<String> = counts.iter().map(ToString::to_string).collect();
    let header = header(
        name,
        &claims,
        &if is_auto {
            "auto".to_owned()
        } else {
            words.join(", ")
        },
    );
    let study = study_of(header, &claims, &counts, &results);
    let mut finished = py.detach(|| study.run());
    if is_auto {
        finished.outcome = until_decided::conclude(
            finished.outcome,
            next,
            &study.levels(&run_cases_here(&study)),
            budget,
            "s",
        );
    }
    Ok(Study { finished })
}

/// The claims by name: those given, or one for every error of the first level.
fn all_claims(claims: &Claims, first: &NamedErrors) -> Vec<(String, Claim)> {
    match claims {
        Claims::Named(named) => named.clone(),
        Claims::ForAll(claim) if claim.order.is_nan() => vec![],
        Claims::ForAll(claim) => {
            let errors = first
                .iter()
                .filter(|(name, _)| !STEPS.contains(&name.as_str()));
            errors.map(|(name, _)| (name.clone(), *claim)).collect()
        }
    }
}
