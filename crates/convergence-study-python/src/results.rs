//! What a study is made of, and how it is judged.

use std::borrow::Cow;
use std::collections::BTreeSet;

use convergence_study::{
    Bound as ClaimBound, Budget, Claim, ErrorsOverLevels, Finished, Floor, Header, Kind as _,
    Levels, NamedNumber, Of, RefinedIn, Sampled, SampledLevel, levels_of_samples,
};
use pyo3::prelude::*;

use crate::values::{floor_of, refuse};

/// What is said about a study in addition to its levels.
#[derive(Clone, FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Options {
    /// Its name in reports.
    name: String,
    /// The test that it belongs to, for the baseline; empty without one.
    test: String,
    /// Seconds for studies that add levels.
    pub(crate) budget: f64,
    /// Round-off, in the unit of the errors.
    #[pyo3(from_py_with = floor_from, into_py_with = floor_into)]
    pub(crate) floor: Floor,
    pub(crate) allow_inconclusive: bool,
    /// How many samples make a level, if they do.
    pub(crate) samples: Option<usize>,
    /// How they make an error, by its name: `mean`, `rms` or `weak`; the empty name is for all.
    of: Vec<(String, String)>,
    /// Whether it is run with a variant of its solution: levels are added to those requested.
    pub(crate) is_variant: bool,
}

fn floor_from(value: &Bound<'_, PyAny>) -> PyResult<Floor> {
    floor_of(value.extract()?)
}

fn floor_into<'py>(floor: Cow<'_, Floor>, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
    Ok(floor.value().into_pyobject(py)?.into_any())
}

/// A claim as Python keeps it.
#[derive(Clone, FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct NamedClaim {
    pub(crate) name: String,
    order: f64,
    tolerance: f64,
    at_least: bool,
    any_above: bool,
}

impl NamedClaim {
    pub(crate) fn new(name: &str, claim: &Claim) -> Self {
        Self {
            name: name.to_owned(),
            order: claim.order,
            tolerance: claim.tolerance,
            at_least: claim.bound.is_least(),
            any_above: claim.bound == ClaimBound::AnyAbove,
        }
    }

    pub(crate) fn claim(&self) -> Claim {
        let bound = match (self.at_least, self.any_above) {
            (_, true) => ClaimBound::AnyAbove,
            (true, false) => ClaimBound::AtLeast,
            (false, false) => ClaimBound::Both,
        };
        Claim {
            bound,
            ..Claim::new(self.order, self.tolerance)
        }
    }
}

/// The errors of one level by name, as Python holds them.
pub(crate) type NamedErrors = Vec<(String, f64)>;

/// What a study is made of; `copy` and `pickle` judge it again.
#[derive(Clone, FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Results {
    pub(crate) claims: Vec<NamedClaim>,
    /// The word for what distinguishes the levels: `n` or `level`.
    pub(crate) counted: String,
    pub(crate) counts: Vec<usize>,
    /// The levels as requested, which the baseline keeps as a claim.
    pub(crate) levels: String,
    pub(crate) errors: Vec<NamedErrors>,
    /// The errors of the samples of each level, if they make it.
    pub(crate) samples: Vec<Vec<NamedErrors>>,
    /// The time of each level, if levels were added until the verdict.
    pub(crate) seconds: Option<Vec<f64>>,
    pub(crate) options: Options,
}

impl Results {
    /// The name of the step.
    pub(crate) fn step(&self) -> &str {
        let names = self.errors.iter().flatten().map(|(name, _)| name.as_str());
        names
            .into_iter()
            .find(|name| Levels::STEPS.contains(name))
            .unwrap_or("h")
    }

    /// The header; the baseline keeps a hash of its settings.
    fn header(&self) -> Header {
        let orders: Vec<String> = self
            .claims
            .iter()
            .map(|claimed| format!("{} {}", claimed.name, claimed.claim()))
            .collect();
        let claim = format!("orders: {}", orders.join(", "));
        let mut header = Header::new(id_of(&self.options.name), claim);
        let mut set = |key: String, value: String| header.settings.push((key, value));
        for NamedClaim {
            name,
            order,
            tolerance,
            at_least,
            any_above,
        } in &self.claims
        {
            set(format!("expect.{name}.order"), order.to_string());
            set(format!("expect.{name}.tolerance"), tolerance.to_string());
            set(format!("expect.{name}.at_least"), at_least.to_string());
            if *any_above {
                set(format!("expect.{name}.any_above"), any_above.to_string());
            }
        }
        set("levels".to_owned(), self.levels.clone());
        if let Some(count) = self.options.samples {
            set("samples".to_owned(), count.to_string());
            for (name, of) in &self.options.of {
                set(format!("of.{name}"), of.clone());
            }
        }
        let floor = self.options.floor.value();
        if floor > 0.0 {
            set("floor".to_owned(), format!("{floor:e}"));
        }
        if !self.options.test.is_empty() {
            set(TEST.to_owned(), self.options.test.clone());
        }
        header
    }

    /// The study of the computed errors.
    fn study(&self) -> ErrorsOverLevels<impl Fn(usize, usize) -> NamedErrors + use<'_>> {
        let solve = |n: usize, seed: usize| {
            let level = self.counts.iter().position(|count| *count == n);
            level.map_or(vec![], |level| match seed {
                0 => self.errors[level].clone(),
                _ => self.samples[level][seed - 1].clone(),
            })
        };
        let axis = if self.step() == "dt" {
            RefinedIn::Time
        } else {
            RefinedIn::Space
        };
        let study = levels_of_samples(self.counts.iter().copied(), self.options.samples, solve)
            .described(self.header())
            .counting(&*self.counted, axis)
            .with_floor(self.options.floor);
        let study = self.claims.iter().fold(study, |study, claimed| {
            study.claiming(&*claimed.name, claimed.claim())
        });
        let names = self.errors.iter().flatten().map(|(name, _)| name.as_str());
        let names: BTreeSet<&str> = names.collect();
        let made = names
            .into_iter()
            .filter_map(|name| Some((name, self.options.of(name)?)));
        made.fold(study, |study, (name, of)| study.made_of(name, of))
    }

    fn levels(&self) -> Levels {
        let study = self.study();
        study.levels(&study.run_here())
    }

    /// Whether another level is computed.
    pub(crate) fn goes_on(&self, seconds: &[f64]) -> bool {
        let levels = self.levels();
        self.budget(seconds).allows(&levels, &levels.judge())
    }

    fn budget(&self, seconds: &[f64]) -> Budget {
        Budget::of_seconds(seconds, self.options.budget)
    }

    /// The study, run and judged.
    pub(crate) fn finished(&self) -> Finished {
        let mut finished = self.study().run();
        if let Some(seconds) = &self.seconds {
            let levels = self.levels();
            let budget = self.budget(seconds);
            finished.outcome = budget.conclude(finished.outcome, &levels, &levels.judge());
        }
        // The levels that were requested are a setting; of those that were added time decides.
        finished.header.cases.clear();
        finished
    }
}

impl Options {
    /// How samples make the error of a name.
    fn of(&self, name: &str) -> Option<Of> {
        let named = |own: &str| self.of.iter().find(|(known, _)| known == own);
        let (_, of) = named(name).or_else(|| named(""))?;
        of.parse().ok()
    }

    /// The errors of a level by its samples, which have the same step.
    pub(crate) fn made_of(&self, samples: &[NamedErrors]) -> PyResult<NamedErrors> {
        let level = SampledLevel {
            label: String::new(),
            samples: Ok(named(samples)),
        };
        let made = Sampled(vec![level]).errors(&|name| self.of(name));
        let made: Result<Vec<_>, _> = made.into_iter().collect();
        let made = made.map_err(|failure| refuse(format!("solve: {}", failure.reason)))?;
        let made: Vec<NamedNumber> = made.into_iter().flatten().collect();
        let names: Vec<&str> = made.iter().map(|error| error.name.as_str()).collect();
        let mut named = self.of.iter().map(|(name, _)| name.as_str());
        if let Some(name) = named.find(|name| !name.is_empty() && !names.contains(name)) {
            return Err(refuse(format!(
                "of: expected the names of errors that solve returns, found `{name}`"
            )));
        }
        Ok(made
            .into_iter()
            .map(|error| (error.name, error.value))
            .collect())
    }
}

/// The errors of samples, as the harness has them.
fn named(samples: &[NamedErrors]) -> Vec<Vec<NamedNumber>> {
    let named = samples.iter().map(|errors| {
        let numbers = errors.iter();
        let numbers = numbers.map(|(name, value)| NamedNumber::new(name, *value));
        numbers.collect()
    });
    named.collect()
}

/// The setting that names the test of a study.
const TEST: &str = "test";

/// A text as the id of a study: small letters, digits, `.` and `-`.
fn id_of(name: &str) -> String {
    let plain = name.chars().map(|c| {
        if c.is_ascii_alphanumeric() || c == '.' {
            c.to_ascii_lowercase()
        } else {
            '-'
        }
    });
    let id: String = plain
        .skip_while(|c| !c.is_ascii_alphanumeric())
        .take(100)
        .collect();
    if Header::is_id(&id) {
        id
    } else {
        "study".to_owned()
    }
}
