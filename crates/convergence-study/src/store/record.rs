//! The record of a run: what was found, as data with a versioned schema, to be read by programs.
//!
//! One form, two precisions. [`Precision::Full`] is for programs that read a run as it happens; [`Precision::Committed`] is for
//! the file under version control, which must not change by a byte when nothing has changed. Times, machine and revision
//! are in neither: they belong to the [`provenance`](crate::store::provenance).
//!
//! A number that is not finite is `null`, and `not_finite` says where and what it was; `failed_cases` says why. Read back, `null` is NaN.

pub(in crate::store) mod form;

use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::judge::verdict::{RateVerdict, Verdict};
use crate::run::{FailedCase, Finished};
use crate::store::regular;
use crate::study::Untested;
use crate::study::outcome::{Check, LevelErrors, Outcome, Quantity};
use crate::text::number::{committed, committed_rate};
use crate::text::visible;
use form::{null_is_nan, null_is_nan_in, null_is_nan_of_pair};

/// Version of the schema; it grows when a field changes its name or its meaning, not when one is added.
pub const SCHEMA: u32 = 1;

/// How many digits a record keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// All of them.
    Full,
    /// Those that are the same from run to run and, mostly, from machine to machine: see [`committed`].
    Committed,
}

/// A whole run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// [`SCHEMA`].
    pub schema: u32,
    /// Version of this crate.
    pub crate_version: String,
    /// What was run, such as `quick`.
    pub scope: String,
    /// The verdict on the run, changes against the baseline included.
    pub verdict: Verdict,
    /// What moved away from the baseline, in words.
    pub baseline_changes: Vec<String>,
    /// One entry for each study.
    pub studies: Vec<StudyRecord>,
}

/// One study of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StudyRecord {
    /// Its id.
    pub id: String,
    /// What it claims.
    pub claim: String,
    /// `quick` or `full`.
    pub tier: String,
    /// The kind of study.
    pub kind: String,
    /// `pass`, `fail` or `inconclusive`.
    pub verdict: Verdict,
    /// The verdict in a sentence.
    pub summary: String,
    /// Errors by level.
    pub levels: Vec<LevelRecord>,
    /// Rates judged.
    pub rates: Vec<RateRecord>,
    /// Everything else that was judged.
    pub checks: Vec<Check>,
    /// Numbers that the baseline guards.
    pub quantities: Vec<Quantity>,
    /// Cases without a result.
    pub failed_cases: Vec<FailedCase>,
    /// The meaning of every `null` that stands for a number.
    pub not_finite: Vec<NotFinite>,
    /// What the study is no test of although it passes; only `study` looks for it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub untested: Vec<Untested>,
}

/// Errors at one level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LevelRecord {
    /// Its parameters, such as elements and steps, as keys of their own.
    #[serde(flatten)]
    pub parameters: Parameters,
    /// The step that the errors are judged over; not there in records of versions before, nor where the errors have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// What the level cost, in a unit of the study's choice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub work: Option<f64>,
    /// Error by norm.
    pub errors: Errors,
}

/// Norms and errors, written as a map in their own order.
#[derive(Debug, Clone, PartialEq)]
pub struct Errors(pub Vec<(String, f64)>);

/// Parameters of a level, written as a map in their own order; whole numbers without a decimal point.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters(pub Vec<(String, f64)>);

/// A rate that was judged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RateRecord {
    /// The norm.
    pub norm: String,
    /// What theory says.
    #[serde(deserialize_with = "null_is_nan")]
    pub order: f64,
    /// Half-width of the band about the order.
    #[serde(deserialize_with = "null_is_nan")]
    pub tolerance: f64,
    /// Rates between neighbouring levels.
    #[serde(deserialize_with = "null_is_nan_in")]
    pub pairwise: Vec<f64>,
    /// The rate fitted over the asymptotic range.
    pub fitted: Option<f64>,
    /// The constant C of error = C step^rate; not there in records of versions before.
    #[serde(default)]
    pub constant: Option<f64>,
    /// Its interval.
    #[serde(deserialize_with = "null_is_nan_of_pair")]
    pub interval: Option<[f64; 2]>,
    /// The limit of the pairwise rates.
    pub extrapolated: Option<f64>,
    /// `pass`, `fail` or `inconclusive`.
    pub verdict: Verdict,
    /// Why, in words.
    pub reason: String,
    /// The code of the reason; not there in records of versions before.
    #[serde(default)]
    pub code: String,
    /// What it means, and what to do; only where it is not a pass.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub advice: String,
}

/// A number that JSON cannot hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NotFinite {
    /// Where in the study, such as `levels[2].errors.velocity`.
    pub at: String,
    /// `NaN`, `inf` or `-inf`.
    pub value: String,
}

/// A record that cannot be read.
#[derive(Debug, Error)]
pub enum RecordError {
    /// The file cannot be read.
    #[error("{}: {error}", visible::path(.path))]
    File {
        /// The file.
        path: PathBuf,
        /// What was wrong.
        error: io::Error,
    },
    /// Not the form of a record.
    #[error("{}: {}; expected a record as `verify` writes it to results.json, or `study --format json` prints it", visible::path(.path), visible::visible(&.error.to_string()))]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What was wrong, with line and column.
        error: serde_json::Error,
    },
    /// Written by a version with another form.
    #[error("{}: schema: found {found}; expected {SCHEMA}", visible::path(.path))]
    Schema {
        /// The file.
        path: PathBuf,
        /// The version found.
        found: u32,
    },
}

impl Record {
    /// Reads a record that [`json`] has written.
    ///
    /// # Errors
    /// [`RecordError`].
    pub fn read(path: &Path) -> Result<Self, RecordError> {
        let path = path.to_owned();
        match regular::read_to_string(&path) {
            Ok(text) => Self::parse(&text, &path),
            Err(error) => Err(RecordError::File { path, error }),
        }
    }

    /// The same from its text.
    ///
    /// # Errors
    /// [`RecordError`], naming `path`.
    pub fn parse(text: &str, path: &Path) -> Result<Self, RecordError> {
        let path = path.to_owned();
        match serde_json::from_str::<Self>(text) {
            Ok(record) if record.schema == SCHEMA => Ok(record),
            Ok(record) => Err(RecordError::Schema { path, found: record.schema }),
            Err(error) => Err(RecordError::Malformed { path, error }),
        }
    }

    /// The record of a run.
    pub fn new<'f>(
        scope: &str,
        verdict: Verdict,
        baseline_changes: Vec<String>,
        finished: impl IntoIterator<Item = &'f Finished>,
        precision: Precision,
    ) -> Self {
        Self {
            schema: SCHEMA,
            crate_version: env!("CARGO_PKG_VERSION").to_owned(),
            scope: scope.to_owned(),
            verdict,
            baseline_changes,
            studies: finished.into_iter().map(|finished| StudyRecord::new(finished, precision)).collect(),
        }
    }
}

impl StudyRecord {
    /// The record of one study.
    pub fn new(Finished { header, outcome, failed_cases, .. }: &Finished, precision: Precision) -> Self {
        Self {
            id: header.id.clone(),
            claim: header.claim.clone(),
            tier: header.tier.name().to_owned(),
            kind: header.kind.clone(),
            verdict: outcome.verdict,
            summary: outcome.summary.clone(),
            levels: outcome.levels.iter().map(|level| precision.level(level)).collect(),
            rates: outcome.rates.iter().map(|(norm, rate)| precision.rate(norm, rate)).collect(),
            checks: outcome.checks.clone(),
            quantities: outcome.quantities.iter().map(|quantity| precision.quantity(quantity)).collect(),
            failed_cases: failed_cases.clone(),
            not_finite: not_finite(outcome),
            untested: vec![],
        }
    }
}

impl Precision {
    fn number(self, value: f64) -> f64 {
        if self == Self::Full { value } else { committed(value) }
    }

    fn rate_number(self, rate: f64) -> f64 {
        if self == Self::Full { rate } else { committed_rate(rate) }
    }

    fn level(self, level: &LevelErrors) -> LevelRecord {
        let errors = level.errors.iter().map(|(norm, error)| (norm.clone(), self.number(*error)));
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite()).map(|value| self.number(value));
        LevelRecord {
            parameters: Parameters(level.parameters.clone()),
            step: finite(level.step),
            work: finite(level.work),
            errors: Errors(errors.collect()),
        }
    }

    fn rate(self, norm: &str, rate: &RateVerdict) -> RateRecord {
        RateRecord {
            norm: norm.to_owned(),
            order: rate.order,
            tolerance: rate.tolerance,
            pairwise: rate.pairwise.iter().map(|rate| self.rate_number(*rate)).collect(),
            fitted: rate.fitted.map(|rate| self.rate_number(rate)),
            constant: rate.constant.map(|constant| self.number(constant)),
            interval: rate.interval.map(|ends| ends.map(|end| self.rate_number(end))),
            extrapolated: rate.extrapolated.map(|rate| self.rate_number(rate)),
            verdict: rate.verdict,
            reason: rate.reason.clone(),
            code: rate.kind.code().to_owned(),
            advice: rate.advice().unwrap_or_default().to_owned(),
        }
    }

    fn quantity(self, quantity: &Quantity) -> Quantity {
        Quantity { value: self.number(quantity.value), ..quantity.clone() }
    }
}

/// Every number of an outcome that JSON cannot hold.
fn not_finite(outcome: &Outcome) -> Vec<NotFinite> {
    let mut found = Vec::new();
    let mut look = |at: String, value: f64| {
        if !value.is_finite() {
            found.push(NotFinite { at, value: value.to_string() });
        }
    };
    for (i, level) in outcome.levels.iter().enumerate() {
        level.errors.iter().for_each(|(norm, error)| look(format!("levels[{i}].errors.{norm}"), *error));
    }
    for (i, (_, rate)) in outcome.rates.iter().enumerate() {
        rate.pairwise.iter().enumerate().for_each(|(j, rate)| look(format!("rates[{i}].pairwise[{j}]"), *rate));
        let interval = rate.interval.into_iter().flatten();
        interval.enumerate().for_each(|(j, end)| look(format!("rates[{i}].interval[{j}]"), end));
        rate.fitted.into_iter().for_each(|fitted| look(format!("rates[{i}].fitted"), fitted));
        rate.extrapolated.into_iter().for_each(|rate| look(format!("rates[{i}].extrapolated"), rate));
    }
    for (i, quantity) in outcome.quantities.iter().enumerate() {
        look(format!("quantities[{i}].value"), quantity.value);
    }
    found
}

/// A record as JSON text with a line end, as it stands in a file.
///
/// # Errors
/// What `serde_json` refuses, which is nothing of this module.
pub fn json(record: &impl Serialize) -> serde_json::Result<String> {
    serde_json::to_string_pretty(record).map(|text| text + "\n")
}
