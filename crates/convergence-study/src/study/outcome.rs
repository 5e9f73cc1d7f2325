//! The findings of a study: studies of every kind reach record, baseline and report in this form.
//!
//! Requirements on every outcome, whatever the kind of study: its verdict is not better than those
//! of its rates and checks, nothing passes on numbers that are not finite, and names used as keys
//! by record, baseline and report are unique.

mod check;
mod rate;
mod settle;
mod table;

use super::measured::Sheet;
use super::must::Must;
use super::over_levels::{Levels, summary};
use super::subject::{Sort, Subject};
use crate::text::{json, named::NamedNumber, prose::Prose};
use convergence_judge::fit::Level;
use convergence_judge::random::SplitMix;
use convergence_judge::verdict::{RateVerdict, Verdict};

pub use check::Check;
pub use rate::NamedRate;
pub(crate) use settle::settle;
pub use table::{Figure, Table};

/// The result of a study, which is also its record.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[must_use = "an outcome that is not read lets a failing study pass"]
pub struct Outcome {
    /// The worst verdict of checks and rates; inconclusive if nothing was judged.
    pub verdict: Verdict,
    /// The verdict in a sentence.
    pub summary: Prose,
    /// What the summary says after the rates, if these sum up the study; `None` if it is in the
    /// study's own words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after_rates: Option<Prose>,
    /// The numbers to read first, in a few words; empty if the rates are the claim.
    #[serde(default)]
    pub headline: Prose,
    /// Errors of each level of a convergence study.
    pub levels: Vec<LevelErrors>,
    /// Judged rates.
    pub rates: Vec<NamedRate>,
    /// Everything judged that is not a rate.
    pub checks: Vec<Check>,
    /// Of items that were not all judged: how many were, and why not the others, by
    /// [`left_out`](crate::left_out).
    #[serde(default)]
    pub left_out: Vec<String>,
    /// The numbers of a study in code, of which its checks, tables and guarded numbers are views.
    #[serde(skip)]
    pub sheets: Vec<Sheet>,
    /// Tables of the report.
    #[serde(default)]
    pub tables: Vec<Table>,
    /// Figures of the report.
    #[serde(default)]
    pub figures: Vec<Figure>,
    /// Numbers that the baseline guards.
    pub quantities: Vec<Quantity>,
    /// How many of its cases were not run, but have the answers of an earlier run.
    #[serde(skip)]
    pub reused: usize,
    /// The files that a table was made from, of which the baseline keeps the hashes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sources: Option<TableOrigin>,
}

/// A file, and the hash of its content.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HashedFile {
    /// Its name in the study.
    pub name: String,
    /// The hash of its content, in sixteen hexadecimal digits.
    pub hash: String,
}

impl HashedFile {
    /// * `name`: in the study.
    pub fn new(name: impl Into<String>, content: &[u8]) -> Self {
        Self {
            name: name.into(),
            hash: content_hash(content),
        }
    }
}

/// A 64-bit hash in sixteen hexadecimal digits, the same on every machine and in every version:
/// FNV-1a, mixed by splitmix64.
///
/// Not cryptographic. With FNV alone the low bits of similar texts would be correlated.
pub(crate) fn content_hash(bytes: &[u8]) -> String {
    const OFFSET: u64 = 0xCBF2_9CE4_8422_2325;
    const PRIME: u64 = 0x0000_0100_0000_01B3;
    let fnv = bytes.iter().fold(OFFSET, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(PRIME)
    });
    format!("{:016x}", SplitMix::new(fnv).next_u64())
}

/// A table that exists, and the files that it was made from.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableOrigin {
    /// The table.
    pub table: HashedFile,
    /// The files that it was made from.
    pub inputs: Vec<HashedFile>,
}

impl TableOrigin {
    /// The names of the inputs that are others than these were.
    pub(crate) fn changed_inputs(&self, before: &Self) -> Vec<String> {
        let changed = self
            .inputs
            .iter()
            .filter(|own| !before.inputs.contains(own));
        changed.map(|own| own.name.clone()).collect()
    }
}

/// The errors at one level of refinement, one for each norm.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LevelErrors {
    /// Its parameters by name, such as elements and steps: separate keys in JSON.
    #[serde(flatten, with = "json::counted")]
    pub parameters: Vec<NamedNumber>,
    /// The step over which the errors are judged; `None` if they are not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// The cost of the level, in a unit of the study's choice, if known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub work: Option<f64>,
    /// Errors by name; NaN without a result.
    #[serde(with = "json::named")]
    pub errors: Vec<NamedNumber>,
    /// The names of the errors for which the level has no result.
    #[serde(
        rename = "without_result",
        default,
        skip_serializing_if = "Vec::is_empty"
    )]
    pub without: Vec<String>,
}

impl LevelErrors {
    /// The parameter of that name.
    pub fn parameter(&self, name: &str) -> Option<f64> {
        NamedNumber::find(&self.parameters, name)
    }

    /// The error of that name; NaN if there is none.
    pub fn error(&self, name: &str) -> f64 {
        NamedNumber::find(&self.errors, name).unwrap_or(f64::NAN)
    }
}

/// A number that must not move unnoticed.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Quantity {
    /// Name, unique within the study.
    pub name: String,
    /// What it is about.
    #[serde(default)]
    pub subject: Subject,
    /// Whether it is an error, a rate or another number.
    #[serde(default)]
    pub(crate) sort: Sort,
    /// Value.
    #[serde(deserialize_with = "json::nan")]
    pub value: f64,
    /// Relative change tolerated.
    #[serde(deserialize_with = "json::nan")]
    pub tolerance: f64,
    /// What it must be, which the baseline guards, too; `None` if the study does not claim that of
    /// this number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub claim: Option<Must>,
}

impl Quantity {
    /// A number about the quantity of its name.
    ///
    /// * `tolerance`: relative change tolerated.
    pub(crate) fn new(name: impl Into<String>, value: f64, tolerance: f64) -> Self {
        let name = name.into();
        Self {
            subject: Subject::of(&name),
            name,
            sort: Sort::Value,
            value,
            tolerance,
            claim: None,
        }
    }

    /// The same number, of which this is claimed: the study judges it.
    #[must_use]
    pub(crate) fn claimed(self, claim: impl Into<Option<Must>>) -> Self {
        Self {
            claim: claim.into(),
            ..self
        }
    }

    /// The same about a subject.
    #[must_use]
    pub(crate) fn about(self, subject: Subject) -> Self {
        Self { subject, ..self }
    }
}

/// A number that JSON cannot hold.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct NotFinite {
    /// Where in the study, such as `levels[2].errors.velocity`.
    pub at: String,
    /// `NaN`, `inf` or `-inf`.
    pub value: String,
}

impl Outcome {
    /// The judged rate of that name.
    pub fn rate(&self, name: &str) -> Option<&RateVerdict> {
        let mut rates = self.rates.iter();
        rates.find(|rate| rate.name == name).map(|rate| &rate.rate)
    }

    /// The errors of that name over their steps; NaN on a level without one.
    pub fn levels_of(&self, name: &str) -> Vec<Level> {
        self.levels
            .iter()
            .map(|level| Level {
                step: level.step.unwrap_or(f64::NAN),
                error: level.error(name),
            })
            .collect()
    }

    /// Builds an outcome; the verdict is the worst of all rates and checks.
    pub fn new(summary: impl Into<Prose>, rates: Vec<NamedRate>, checks: Vec<Check>) -> Self {
        Self {
            verdict: worst(&rates, &checks),
            summary: summary.into(),
            after_rates: None,
            headline: Prose::default(),
            levels: vec![],
            rates,
            checks,
            left_out: vec![],
            sheets: vec![],
            tables: vec![],
            figures: vec![],
            quantities: vec![],
            reused: 0,
            sources: None,
        }
    }

    /// The worst verdict of its rates and checks: its own is not better.
    pub(crate) fn verdict_of_parts(&self) -> Verdict {
        worst(&self.rates, &self.checks)
    }

    /// The same, whose summary is that of its rates and these words.
    pub fn summed_up_by_rates(self, more: impl Into<Prose>) -> Self {
        let more = more.into();
        Self {
            summary: Prose::from(summary(&self.rates)).then(&more),
            after_rates: Some(more),
            ..self
        }
    }

    /// The same, summed up by these words, which are also its headline.
    pub fn headed(self, headline: impl Into<Prose>) -> Self {
        let headline = headline.into();
        Self {
            summary: headline.clone(),
            headline,
            ..self
        }
    }

    /// The same with the rates of these errors: guarded, like the errors themselves. They sum it
    /// up if it has no headline.
    pub fn with_orders(mut self, levels: &Levels, rates: Vec<NamedRate>) -> Self {
        self.extend(Self {
            levels: levels.errors(),
            quantities: levels.quantities(&rates),
            ..Self::new("", rates, vec![])
        });
        match self.headline.is_empty() {
            true => self.summed_up_by_rates(""),
            false => self,
        }
    }

    /// Says more in the summary.
    pub(crate) fn add_to_summary(&mut self, words: &str) {
        let words = Prose::from(words);
        self.summary = self.summary.then(&words);
        if let Some(more) = &mut self.after_rates {
            *more = more.then(&words);
        }
    }

    /// The outcome of a study of several parts: their summaries and headlines one after the other.
    ///
    /// * `completion`: the check that all cases of all parts have completed.
    pub fn of_parts(completion: Check, parts: impl IntoIterator<Item = Self>) -> Self {
        let mut all = Self::new("", vec![], vec![completion]);
        for part in parts {
            all.summary = all.summary.then(&part.summary);
            all.headline = all.headline.then(&part.headline);
            all.extend(part);
        }
        all
    }

    /// Adds the findings of another part of the study, except for summary and headline.
    pub fn extend(&mut self, part: Self) {
        self.verdict = Verdict::worst([self.verdict, part.verdict]);
        self.levels.extend(part.levels);
        self.rates.extend(part.rates);
        self.checks.extend(part.checks);
        self.left_out.extend(part.left_out);
        self.sheets.extend(part.sheets);
        self.tables.extend(part.tables);
        self.figures.extend(part.figures);
        self.quantities.extend(part.quantities);
    }

    /// Every number that JSON cannot hold.
    pub fn not_finite(&self) -> Vec<NotFinite> {
        let mut list = NotFiniteList::default();
        for (i, level) in self.levels.iter().enumerate() {
            for NamedNumber { name, value } in &level.errors {
                list.check(*value, || format!("levels[{i}].errors.{name}"));
            }
        }
        for (i, NamedRate { rate, .. }) in self.rates.iter().enumerate() {
            for (j, rate) in rate.pairwise.iter().enumerate() {
                list.check(*rate, || format!("rates[{i}].pairwise[{j}]"));
            }
            for (j, end) in rate
                .interval
                .into_iter()
                .flat_map(<[f64; 2]>::from)
                .enumerate()
            {
                list.check(end, || format!("rates[{i}].interval[{j}]"));
            }
            if let Some(fitted) = rate.fitted {
                list.check(fitted, || format!("rates[{i}].fitted"));
            }
            if let Some(extrapolated) = rate.extrapolated {
                list.check(extrapolated, || format!("rates[{i}].extrapolated"));
            }
        }
        for (i, quantity) in self.quantities.iter().enumerate() {
            list.check(quantity.value, || format!("quantities[{i}].value"));
        }
        list.0
    }
}

fn worst(rates: &[NamedRate], checks: &[Check]) -> Verdict {
    let rates = rates.iter().map(|named| named.rate.verdict);
    Verdict::worst(rates.chain(checks.iter().map(|check| check.verdict)))
}

/// The numbers of an outcome that JSON cannot hold.
#[derive(Default)]
struct NotFiniteList(Vec<NotFinite>);

impl NotFiniteList {
    /// Adds a number, with its place in the study, if JSON cannot hold it.
    fn check(&mut self, value: f64, place: impl FnOnce() -> String) {
        if !value.is_finite() {
            self.0.push(NotFinite {
                at: place(),
                value: value.to_string(),
            });
        }
    }
}
