//! What a study has found: the one form in which studies of every kind reach record, baseline and report.

use crate::judge::verdict::{RateVerdict, Verdict};

/// The result of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The worst verdict of checks and rates; inconclusive where there is nothing that was judged.
    pub verdict: Verdict,
    /// The verdict in a sentence.
    pub summary: String,
    /// The numbers to read first, in a few words; empty where the rates are what was claimed.
    pub headline: String,
    /// Errors of each level of a convergence study.
    pub levels: Vec<LevelErrors>,
    /// Rates judged, each with its norm.
    pub rates: Vec<(String, RateVerdict)>,
    /// Everything judged that is not a rate.
    pub checks: Vec<Check>,
    /// Tables of the report.
    pub tables: Vec<Table>,
    /// Figures of the report.
    pub figures: Vec<Figure>,
    /// Numbers that the baseline guards.
    pub quantities: Vec<Quantity>,
}

/// The errors at one level of refinement, one for each norm.
#[derive(Debug, Clone, PartialEq)]
pub struct LevelErrors {
    /// Its parameters by name, such as elements and steps.
    pub parameters: Vec<(String, f64)>,
    /// The step that the errors are judged over; nothing where they are not.
    pub step: Option<f64>,
    /// What the level cost, in a unit of the study's choice, where that is known.
    pub work: Option<f64>,
    /// Errors by name; NaN where there is no result.
    pub errors: Vec<(String, f64)>,
    /// The names of those errors for which the level has no result.
    pub without: Vec<String>,
}

impl LevelErrors {
    /// The parameter of that name.
    pub fn parameter(&self, name: &str) -> Option<f64> {
        self.parameters.iter().find(|(known, _)| known == name).map(|(_, value)| *value)
    }

    /// The error of that name; NaN where there is none.
    pub fn error(&self, name: &str) -> f64 {
        self.errors.iter().find(|(known, _)| known == name).map_or(f64::NAN, |(_, error)| *error)
    }
}

/// Something judged.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Check {
    /// What is claimed.
    pub claim: String,
    /// The outcome.
    pub verdict: Verdict,
    /// The evidence, with numbers.
    pub evidence: String,
}

impl Check {
    /// Passes or fails on a condition; `holds` must be false for NaN.
    pub fn that(holds: bool, claim: impl Into<String>, evidence: impl Into<String>) -> Self {
        let verdict = if holds { Verdict::Pass } else { Verdict::Fail };
        Self { claim: claim.into(), verdict, evidence: evidence.into() }
    }
}

/// A table, printed with its columns lined up.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Table {
    /// What it shows.
    pub title: String,
    /// Column heads.
    pub head: Vec<String>,
    /// Rows of cells, as many as heads.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// * `head`: a word for each cell of a row.
    pub fn new<H: Into<String>>(
        title: impl Into<String>,
        head: impl IntoIterator<Item = H>,
        rows: impl IntoIterator<Item = Vec<String>>,
    ) -> Self {
        let head = head.into_iter().map(Into::into).collect();
        Self { title: title.into(), head, rows: rows.into_iter().collect() }
    }
}

/// A picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// File name without folder, `<id>-<what>.svg`.
    pub file: String,
    /// What is to be seen, in a sentence: caption and alternative text.
    pub caption: String,
    /// The picture.
    pub svg: String,
}

impl Figure {
    /// A picture of the study `id`, in the file `<id>-<what>.svg`.
    pub fn new(id: &str, what: &str, caption: impl Into<String>, svg: String) -> Self {
        Self { file: format!("{id}-{what}.svg"), caption: caption.into(), svg }
    }
}

/// A number that must not move unnoticed.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Quantity {
    /// Name, unique within the study.
    pub name: String,
    /// Value.
    #[serde(deserialize_with = "null_is_nan")]
    pub value: f64,
    /// Relative change that is tolerated.
    #[serde(deserialize_with = "null_is_nan")]
    pub tolerance: f64,
}

impl Quantity {
    /// * `tolerance`: relative change that is tolerated.
    pub fn new(name: impl Into<String>, value: f64, tolerance: f64) -> Self {
        Self { name: name.into(), value, tolerance }
    }
}

/// A number of a record; `null` is NaN.
pub(crate) fn null_is_nan<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    serde::Deserialize::deserialize(deserializer).map(|number: Option<f64>| number.unwrap_or(f64::NAN))
}

impl Outcome {
    /// Puts an outcome together; the verdict is the worst of all rates and checks.
    pub fn new(summary: impl Into<String>, rates: Vec<(String, RateVerdict)>, checks: Vec<Check>) -> Self {
        let verdicts = rates.iter().map(|(_, rate)| rate.verdict).chain(checks.iter().map(|check| check.verdict));
        Self {
            verdict: Verdict::worst(verdicts),
            summary: summary.into(),
            headline: String::new(),
            levels: vec![],
            rates,
            checks,
            tables: vec![],
            figures: vec![],
            quantities: vec![],
        }
    }
}
