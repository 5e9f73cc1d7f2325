//! Compares two versions of a program by their records: is anything lost, has an order, an error or
//! the cost of an accuracy changed?
//!
//! Four questions are asked about every error of every study of the old record; the first that
//! finds a difference names the reason.
//!
//! 1. *Lost*: the new record lacks a study, an error, a judged rate, or ends at a coarser level.
//! 2. *Order*: the intervals of the rates have no point in common and the rates are more than
//!    `ORDER_SHIFT` apart, or a claim that passed does not.
//! 3. *Error*: errors are deterministic; at a level of both records, one that is larger by more
//!    than [`WITHIN`], negative or not finite is worse. Errors are better if every level is better,
//!    and the same if every level is the same. Levels that only one record has are not compared.
//! 4. *Work* at the finest level of both, whose error is the same: it may differ by `WORK_WITHIN`,
//!    as seconds are not counts.
//!
//! A study with a worse verdict is worse even if none of its errors is. What only the new record
//! has is named, and changes nothing. Errors below the floor of the comparison count as that floor;
//! levels that a study has set aside at its own are not compared.

mod both;
mod sequence;

use std::fmt;

use serde::Serialize;

use crate::interval::Interval;
use crate::judge::verdict::{Floor, Verdict};
use crate::run::Finished;
use crate::store::Record;
use crate::study::outcome::Outcome;
use crate::text::lists::distinct;
use both::{Both, ErrorShift};
use sequence::ErrorSequence;

/// Rates closer than this are the same order.
const ORDER_SHIFT: f64 = 0.05;

/// Errors at the same step that differ by less, as a share, are the same; the default of
/// `--within`.
pub const WITHIN: f64 = 0.01;

/// The same for the work for the same error.
const WORK_WITHIN: f64 = 0.05;

/// Steps whose logarithms differ by less are the same step: records may be rounded to six digits.
const SAME_STEP: f64 = 1e-5;

/// What has become of something. Ordered: the maximum of several is what became of all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Shift {
    /// The same.
    Same,
    /// The data prove neither a difference nor its absence.
    #[serde(rename = "not proven")]
    NotProven,
    /// Better.
    Better,
    /// Worse.
    Worse,
    /// There is less to compare than before.
    Lost,
}

impl Shift {
    /// `same`, `not proven`, `better`, `worse` or `lost`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Same => "same",
            Self::NotProven => "not proven",
            Self::Better => "better",
            Self::Worse => "worse",
            Self::Lost => "lost",
        }
    }
}

/// What became of one thing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// The study.
    pub study: String,
    /// The error; `None` for the study as a whole.
    pub norm: Option<String>,
    /// What became of it.
    pub change: Shift,
    /// Why.
    pub reason: String,
    /// Its observed orders.
    pub orders: ComparedOrders,
}

/// The orders of one error in both records; `None` with too few levels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct ComparedOrders {
    /// In the old record.
    pub old: Option<Order>,
    /// In the new record.
    pub new: Option<Order>,
}

/// An observed order.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Order {
    /// The rate.
    pub order: f64,
    /// Its interval.
    pub interval: Interval,
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Interval { low, high } = self.interval;
        write!(f, "{:.3} ({low:.3} to {high:.3})", self.order)
    }
}

/// Two records side by side.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RecordComparison {
    /// Errors that differ by less, as a share, are the same.
    pub within: f64,
    /// What became of all.
    pub change: Shift,
    /// Studies that both have.
    pub studies: usize,
    /// Every error, and every study that has changed as a whole, in the order of the old record.
    pub findings: Vec<Finding>,
    /// What only the new record has.
    pub gained: Vec<String>,
}

/// Compares two records; studies are matched by their ids.
///
/// * `floor`: errors not above it count as the floor.
/// * `within`: errors that differ by less, as a share, are the same.
pub fn compare(old: &Record, new: &Record, floor: Floor, within: f64) -> RecordComparison {
    let mut comparison = RecordComparison {
        within,
        change: Shift::Same,
        studies: 0,
        findings: vec![],
        gained: vec![],
    };
    for before in &old.studies {
        let id = &before.header.id;
        match new.studies.iter().find(|study| study.header.id == *id) {
            Some(after) => comparison.add(before, after, floor),
            None => {
                comparison.findings.push(finding_on_study(
                    id,
                    Shift::Lost,
                    "the new record does not have the study".to_owned(),
                ));
            }
        }
    }
    for Finished { header, .. } in &new.studies {
        if old.studies.iter().all(|study| study.header.id != header.id) {
            comparison.gained.push(format!("the study {}", header.id));
        }
    }
    comparison.change = comparison
        .findings
        .iter()
        .map(|finding| finding.change)
        .max()
        .unwrap_or(Shift::Same);
    comparison
}

/// What became of a study as a whole.
fn finding_on_study(study: &str, change: Shift, reason: String) -> Finding {
    Finding {
        study: study.to_owned(),
        norm: None,
        change,
        reason,
        orders: ComparedOrders::default(),
    }
}

impl RecordComparison {
    /// Adds a study that both records have.
    fn add(&mut self, old: &Finished, new: &Finished, floor: Floor) {
        self.studies += 1;
        let id = &old.header.id;
        let old_names = names(&old.outcome);
        for name in names(&new.outcome) {
            if !old_names.contains(&name) {
                self.gained.push(format!("{id}: {name}"));
            }
        }
        let first = self.findings.len();
        for name in old_names {
            let [before, after] =
                [old, new].map(|study| ErrorSequence::new(&study.outcome, name, floor));
            let orders = ComparedOrders {
                old: before.order,
                new: after.order,
            };
            let both = Both {
                old: before,
                new: after,
                floor: floor.value(),
                within: self.within,
            };
            let ErrorShift { change, reason } = both.judge();
            self.findings.push(Finding {
                study: id.clone(),
                norm: Some(name.clone()),
                change,
                reason,
                orders,
            });
        }
        let worst = self.findings[first..]
            .iter()
            .map(|finding| finding.change)
            .max();
        let [before, after] = [old, new].map(|study| study.outcome.verdict);
        let is_mended = before == Verdict::Fail && after == Verdict::Pass;
        let change = if after > before && worst < Some(Shift::Worse) {
            Shift::Worse
        } else if is_mended && worst < Some(Shift::Better) {
            Shift::Better
        } else {
            return;
        };
        let reason = format!(
            "the verdict was {before}, is {after}: {}",
            new.outcome.summary
        );
        self.findings.push(finding_on_study(id, change, reason));
    }
}

/// The errors of all levels and the rates, each name once.
fn names(outcome: &Outcome) -> Vec<&String> {
    let errors = outcome
        .levels
        .iter()
        .flat_map(|level| level.errors.iter().map(|error| &error.name));
    distinct(errors.chain(outcome.rates.iter().map(|rate| &rate.name)))
}
