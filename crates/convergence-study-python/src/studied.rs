//! Studies of a Python function, and tables as studies, for reports and baselines.

use std::io::{IsTerminal as _, Write as _, stderr};
use std::path::PathBuf;
use std::time::Instant;

use convergence_study::{
    Finished, Levels, NamedNumber, NamedRate, Project, Sampled, Verdict,
    variants::{Search, WhereLost},
};
use pyo3::exceptions::PyAssertionError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::judged::{self, Judgement, attributes, finite, frame, html};
use crate::levels::LevelChoice;
use crate::results::{NamedClaim, NamedErrors, Options, Results};
use crate::values::{Claims, number, refuse};

/// A completed study.
///
/// verdict: "pass", "fail" or "inconclusive"; summary: why, in a sentence; rates: a Judgement for
/// each claim, by name; table(): steps, errors and rates as a DataFrame if pandas is available,
/// otherwise as a dict of lists; to_dict(): all of it in types that JSON knows; report(folder):
/// writes index.html, README.md, JUnit and records; assert_passes(): AssertionError unless it
/// passes, or is inconclusive and that is allowed; where: if variants of a solution were run, the
/// parts in which the order is lost, as `--where` has them in JSON, otherwise None. It has no truth
/// value. In a notebook it is shown as a table and a picture.
#[pyclass(frozen, module = "convergence_study")]
pub(crate) struct Study {
    pub(crate) results: Results,
    pub(crate) finished: Finished,
}

impl Study {
    /// The study with these results, judged.
    pub(crate) fn judged(results: Results) -> Self {
        let finished = results.finished();
        Self { results, finished }
    }

    fn judgements(&self) -> Vec<Judgement> {
        let outcome = &self.finished.outcome;
        let judgements = outcome.rates.iter().filter_map(|named| {
            let NamedRate { name, rate, .. } = named;
            let claims = self.results.claims.iter();
            let mut claims = claims.filter(|claimed| claimed.name == *name);
            let claim = claims.next()?.claim();
            Some(Judgement {
                name: name.clone(),
                step: self.results.step().to_owned(),
                levels: outcome.levels_of(name),
                claim: Some(claim),
                tolerance: Some(claim.tolerance),
                floor: self.results.options.floor,
                rate: rate.clone(),
                left_out: std::collections::BTreeMap::new(),
            })
        });
        judgements.collect()
    }

    fn with_place(mut self, where_lost: WhereLost) -> Self {
        let Finished {
            header, outcome, ..
        } = &mut self.finished;
        let figure = where_lost.figure(header, outcome);
        outcome.figures.extend(figure);
        self.finished.where_lost = Some(where_lost);
        self
    }

    fn where_lost_as_json(&self) -> PyResult<Option<String>> {
        let where_lost = self.finished.where_lost.as_ref();
        let json = where_lost.map(serde_json::to_string).transpose();
        json.map_err(refuse)
    }

    /// The verdict in a line, then what the text of the study has.
    fn failure(&self) -> String {
        let judgements = self.judgements();
        let judgements: Vec<&Judgement> = judgements.iter().collect();
        let headline = judged::headline(&judgements).unwrap_or_else(|| {
            let verdict = self.finished.outcome.verdict;
            format!("{verdict}: {}", self.finished.outcome.summary)
        });
        format!("{headline}\n{}", self.__repr__())
    }
}

#[pymethods]
impl Study {
    /// Judges the results again; what variants have shown is kept, as JSON.
    #[new]
    #[pyo3(signature = (results, where_lost=None))]
    fn new(results: Results, where_lost: Option<&str>) -> PyResult<Self> {
        let study = Study::judged(results);
        let Some(json) = where_lost else {
            return Ok(study);
        };
        Ok(study.with_place(serde_json::from_str(json).map_err(refuse)?))
    }

    fn __getnewargs__(&self) -> PyResult<(Results, Option<String>)> {
        Ok((self.results.clone(), self.where_lost_as_json()?))
    }

    /// Whether the assertion fails because errors have not the order that is claimed for them.
    fn _has_lost_order(&self) -> bool {
        self.assert_passes().is_err() && Search::is_worthwhile(&self.finished.outcome)
    }

    /// The same study with the place where its order is lost.
    ///
    /// * `variants`: the literal of the module, as JSON; `run`: the study with the variant of a
    ///   name.
    fn _where_lost(&self, variants: &str, run: &Bound<'_, PyAny>) -> PyResult<Study> {
        let variants = serde_json::from_str(variants)
            .map_err(|error| refuse(format!("variants: VARIANTS of the module: {error}")))?;
        let mut search = Search::new(&self.finished.outcome, &variants, None);
        loop {
            let requests = search.next();
            if requests.is_empty() {
                break;
            }
            for request in requests {
                let name = &variants.usable[request.place].name;
                let ran = run.call1((name,))?.cast_into::<Study>()?;
                search.add(request, ran.get().finished.outcome.clone());
            }
            // A function that ignores variants is refused after one.
            if search.is_unnoticed() {
                return Err(refuse(
                    "variants: the errors do not change with the variant: solve does not use it. \
                     Likely reasons: it takes its data from another module; it keeps values that \
                     were computed when it was imported, or in a cache; it runs in processes or \
                     compiled code that were started before",
                ));
            }
        }
        Ok(Study::judged(self.results.clone()).with_place(search.where_lost()))
    }

    #[getter]
    fn r#where<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(json) = self.where_lost_as_json()? else {
            return Ok(None);
        };
        py.import("json")?.call_method1("loads", (json,)).map(Some)
    }

    #[getter]
    fn id(&self) -> &str {
        &self.finished.header.id
    }

    #[getter]
    fn verdict(&self) -> &'static str {
        self.finished.outcome.verdict.name()
    }

    #[getter]
    fn summary(&self) -> String {
        self.finished.outcome.summary.to_string()
    }

    #[getter]
    fn rates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let by_name = PyDict::new(py);
        for judgement in self.judgements() {
            by_name.set_item(judgement.name.clone(), Bound::new(py, judgement)?)?;
        }
        Ok(by_name)
    }

    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let levels = &self.finished.outcome.levels;
        let steps = levels
            .iter()
            .map(|level| level.step.unwrap_or(f64::NAN))
            .collect();
        let mut columns: Vec<(String, Vec<f64>)> = vec![(self.results.step().to_owned(), steps)];
        for NamedNumber { name, .. } in levels.first().map_or(&[][..], |level| &level.errors) {
            columns.push((
                name.clone(),
                levels.iter().map(|level| level.error(name)).collect(),
            ));
            if let Some(rate) = self.finished.outcome.rate(name) {
                let rates = std::iter::once(f64::NAN)
                    .chain(rate.pairwise.iter().copied())
                    .collect();
                columns.push((format!("rate {name}"), rates));
            }
        }
        frame(py, &columns)
    }

    fn report(&self, folder: PathBuf) -> PyResult<()> {
        let finished = std::slice::from_ref(&self.finished);
        Project::PROGRAMS
            .write_report(finished, &folder)
            .map_err(refuse)
    }

    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let dict = attributes(slf, &["id", "verdict", "summary"])?;
        let rates = PyDict::new(slf.py());
        for judgement in slf.get().judgements() {
            let name = judgement.name.clone();
            rates.set_item(name, Judgement::to_dict(&Bound::new(slf.py(), judgement)?)?)?;
        }
        dict.set_item("rates", rates)?;
        let levels = slf.get().finished.outcome.levels.iter().map(|level| {
            let errors = level.errors.iter();
            let errors: Vec<_> = errors
                .map(|error| (&error.name, finite(error.value)))
                .collect();
            let dict = PyDict::new(slf.py());
            dict.set_item(slf.get().results.step(), level.step)?;
            errors
                .into_iter()
                .try_for_each(|(name, error)| dict.set_item(name, error))?;
            Ok(dict)
        });
        dict.set_item("levels", levels.collect::<PyResult<Vec<_>>>()?)?;
        dict.set_item("where", slf.get().r#where(slf.py())?)?;
        Ok(dict)
    }

    fn assert_passes(&self) -> PyResult<()> {
        match self.finished.outcome.verdict {
            Verdict::Pass => Ok(()),
            Verdict::Inconclusive if self.allows_inconclusive() => Ok(()),
            _ => Err(PyAssertionError::new_err(self.failure())),
        }
    }

    /// The baseline of a pytest run has no numbers of such a study.
    #[pyo3(name = "_allows_inconclusive")]
    pub(crate) fn allows_inconclusive(&self) -> bool {
        self.results.options.allow_inconclusive
    }

    fn __bool__(&self) -> PyResult<bool> {
        Err(pyo3::exceptions::PyTypeError::new_err(
            "a study is no truth value: pass, fail or inconclusive; ask .verdict",
        ))
    }

    fn __repr__(&self) -> String {
        let outcome = &self.finished.outcome;
        let judgements = self.judgements();
        let judgements: Vec<&Judgement> = judgements.iter().collect();
        let mut text = format!("{}: {}\n", self.id(), outcome.verdict);
        text += &judged::explained(&judgements);
        for check in &outcome.checks {
            if check.verdict != Verdict::Pass {
                let statement = check.statement();
                text += &format!("{statement}: {}: {}\n", check.verdict, check.evidence);
            }
        }
        if let Some(where_lost) = &self.finished.where_lost {
            text += &where_lost.text();
        }
        text
    }

    fn _repr_html_(&self) -> String {
        let pictures: Vec<String> = self
            .finished
            .outcome
            .figures
            .iter()
            .map(|figure| figure.svg().to_owned())
            .collect();
        html(
            &format!("{}\n{}", self.finished.outcome.summary, self.__repr__()),
            &pictures,
        )
    }
}

/// Judged errors of one table as a study, for reports and baselines.
#[pyfunction]
pub(crate) fn study_of(
    py: Python<'_>,
    judgements: Vec<PyRef<'_, Judgement>>,
    options: Options,
) -> Study {
    let rows = judgements.first().map_or(0, |first| first.levels.len());
    let errors = (0..rows).map(|row| {
        let step = judgements.first().map(|first| {
            let name = if first.step == "dt" { "dt" } else { "h" };
            (name.to_owned(), first.levels[row].step)
        });
        let errors = judgements
            .iter()
            .map(|one| (one.name.clone(), one.levels[row].error));
        step.into_iter().chain(errors).collect()
    });
    let claims = judgements.iter();
    let claims = claims.filter_map(|one| Some(NamedClaim::new(&one.name, one.claim.as_ref()?)));
    let results = Results {
        claims: claims.collect(),
        counted: "level".to_owned(),
        counts: (1..=rows).collect(),
        levels: rows.to_string(),
        errors: errors.collect(),
        samples: vec![],
        seconds: None,
        options,
    };
    py.detach(|| Study::judged(results))
}

/// The errors returned by a level.
fn found(level: &str, returned: &Bound<'_, PyAny>) -> PyResult<NamedErrors> {
    let Ok(by_name) = returned.cast::<PyDict>() else {
        return Ok(vec![(
            "error".to_owned(),
            number(|| format!("solve({level})"), returned)?,
        )]);
    };
    let errors = by_name.iter().map(|(name, value)| {
        let name = name.str()?.to_string();
        let value = number(|| format!("solve({level})[{name:?}]"), &value)?;
        Ok((name, value))
    });
    let errors: NamedErrors = errors.collect::<PyResult<_>>()?;
    let is_repeated = |(k, (name, _)): &(usize, &(String, f64))| {
        errors[..*k].iter().any(|(before, _)| before == name)
    };
    match errors
        .iter()
        .enumerate()
        .find(is_repeated)
        .map(|(_, (name, _))| name)
    {
        // The keys 1 and "1", for example.
        Some(name) => Err(refuse(format!(
            "solve({level}): expected each name of an error once, found `{name}` twice"
        ))),
        None => Ok(errors),
    }
}

/// A level that is computed.
struct Level<'py> {
    /// Whether it is a step, which solve receives in place of a count.
    step: Option<f64>,
    argument: Bound<'py, PyAny>,
}

impl<'py> Level<'py> {
    fn new(py: Python<'py>, choice: &LevelChoice, count: usize) -> PyResult<Self> {
        let step = choice.step(count);
        let argument = match step {
            Some(step) => step.into_pyobject(py)?.into_any(),
            None => count.into_pyobject(py)?.into_any(),
        };
        Ok(Self { step, argument })
    }

    /// Calls `solve`, and reports it on a terminal.
    ///
    /// * `seed`: of a sample.
    fn solved(
        &self,
        solve: &Bound<'py, PyAny>,
        seed: Option<usize>,
        seconds: &mut Vec<f64>,
    ) -> PyResult<NamedErrors> {
        let name = if self.step.is_some() { "h" } else { "n" };
        let seed_in_words = seed.map_or(String::new(), |seed| format!(", {seed}"));
        let argument = format!("{}{seed_in_words}", self.argument);
        let is_shown = stderr().is_terminal();
        if is_shown {
            let so_far = seconds.iter().fold(0.0, |sum, seconds| sum + seconds);
            let _ = write!(
                stderr(),
                "\r\x1b[2K{name} = {argument}: call {}, {so_far:.1} s so far",
                seconds.len() + 1
            );
        }
        let started = Instant::now();
        let returned = match seed {
            Some(seed) => solve.call1((&self.argument, seed)),
            None => solve.call1((&self.argument,)),
        };
        seconds.push(started.elapsed().as_secs_f64());
        if is_shown {
            let _ = write!(stderr(), "\r\x1b[2K");
        }
        let errors = found(&argument, &returned?)?;
        Ok(match self.step {
            Some(step) => with_step(step, errors),
            None => errors,
        })
    }
}

/// Computes levels and judges the rates of their errors; see the function of this name in Python.
#[pyfunction]
pub(crate) fn study(
    py: Python<'_>,
    solve: &Bound<'_, PyAny>,
    n: Option<&Bound<'_, PyAny>>,
    h: Option<&Bound<'_, PyAny>>,
    order: Option<&Bound<'_, PyAny>>,
    tolerance: Option<f64>,
    options: Options,
) -> PyResult<Study> {
    let claims = Claims::read(order, tolerance)?;
    let mut choice = LevelChoice::read(n, h)?;
    if !(options.budget > 0.0) {
        return Err(refuse(format!(
            "budget: expected a number of seconds > 0, found {}",
            options.budget
        )));
    }
    if options.samples.is_some() && choice.is_auto() {
        return Err(refuse(
            "samples: expected levels n=[...] or h=[...] beside samples",
        ));
    }
    let mut results = Results {
        claims: vec![],
        counted: choice.counted().to_owned(),
        counts: vec![],
        levels: choice.words(),
        errors: vec![],
        samples: vec![],
        seconds: None,
        options,
    };
    let mut counts = choice.counts(claims.highest_order());
    let mut seconds = vec![];
    while results.counts.len() < counts.len() {
        let count = counts[results.counts.len()];
        let level = Level::new(py, &choice, count)?;
        let errors = match results.options.samples {
            None => level.solved(solve, None, &mut seconds)?,
            Some(samples) => {
                let before = seconds.len();
                let samples = Sampled::seeds(samples);
                let samples = samples.map(|seed| level.solved(solve, Some(seed), &mut seconds));
                let samples = samples.collect::<PyResult<Vec<_>>>()?;
                let of_level = seconds.drain(before..).sum();
                seconds.push(of_level);
                let errors = results.options.made_of(&samples)?;
                results.samples.push(samples);
                errors
            }
        };
        if results.errors.is_empty() {
            results.claims = all_claims(&claims, &errors);
        }
        results.counts.push(count);
        results.errors.push(errors);
        let is_last = results.counts.len() == counts.len();
        let may_go_on = choice.is_auto() || results.options.is_variant;
        if may_go_on && is_last && results.goes_on(&seconds) {
            counts.push(choice.finer(&counts));
        }
    }
    if choice.is_auto() {
        results.seconds = Some(seconds);
    }
    Ok(py.detach(|| Study::judged(results)))
}

/// The errors of a level with its step, unless it reports one.
fn with_step(step: f64, mut errors: NamedErrors) -> NamedErrors {
    if !errors
        .iter()
        .any(|(name, _)| Levels::STEPS.contains(&name.as_str()))
    {
        errors.insert(0, ("h".to_owned(), step));
    }
    errors
}

/// The claims by name: those given, or one for every error of the first level.
fn all_claims(claims: &Claims, first: &NamedErrors) -> Vec<NamedClaim> {
    match claims {
        Claims::Named(named) => named
            .iter()
            .map(|(name, claim)| NamedClaim::new(name, claim))
            .collect(),
        Claims::ForAll(None) => vec![],
        Claims::ForAll(Some(claim)) => {
            let errors = first
                .iter()
                .filter(|(name, _)| !Levels::STEPS.contains(&name.as_str()));
            errors
                .map(|(name, _)| NamedClaim::new(name, claim))
                .collect()
        }
    }
}
