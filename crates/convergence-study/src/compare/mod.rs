//! Two versions of a program, by their records: has an order, a constant or the cost of an accuracy changed?
//!
//! Every error of every study that both records have is held against itself, by three questions in this order; the first that finds a difference names the
//! reason.
//!
//! 1. *Order.* Both rates are read by [the rule](crate::judge::verdict). They differ where their intervals have no point in common and the rates are more than
//!    [`ORDER_SHIFT`] apart, or where the claim passed and does not pass now.
//! 2. *Constant.* `log(e_new / e_old)` at the same step has a mean and a Student interval over the levels that are asymptotic in both records. Where the levels
//!    differ, the old error is interpolated between its neighbours, linearly in logarithms; with Δ the change of the pairwise rate there and x the distance of
//!    the neighbours in log h, this is off by no more than Δ x / 8 for smooth data, and twice as much is added to the interval. The errors differ
//!    where the whole interval, or the ratio of every level with its doubt, lies on one side of 1 ± [`WITHIN`]; the latter for ratios that scatter too much for
//!    a narrow interval. At a step that both records have, errors are deterministic: one that is larger by more than [`WITHIN`] is worse, whatever the order and the
//!    others say, and is named. They are the same where all of these lie within, or the whole interval does; else no difference is proven, nor that there is none.
//! 3. *Work.* The work that the smallest error takes that both have reached, interpolated likewise, with what the interval of the errors leaves of
//!    doubt. It differs where its whole interval lies beyond 1 ± [`WORK_WITHIN`]: seconds are no counts.
//!
//! An error that was there and is negative or not finite now is worse. So is a study with a worse verdict although no error of it is worse. What only one record
//! has is named, and changes nothing. Errors that are not above the floor have no say, as everywhere.

mod norm;
mod series;

use serde::Serialize;

use crate::judge::verdict::{Judge, JudgeError, Verdict};
use crate::store::record::{Record, StudyRecord};

pub use norm::{Line, Norm, Ratio};

/// Rates that are closer are one order.
pub const ORDER_SHIFT: f64 = 0.05;

/// Errors at the same step that differ by less, as a share, are the same; the default of `--within`.
pub const WITHIN: f64 = 0.01;

/// The same of the work for the same error.
pub const WORK_WITHIN: f64 = 0.05;

/// What has become of something. Ordered, so that the maximum of several is what became of all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Change {
    /// The same.
    Same,
    /// The data prove neither a difference nor that there is none.
    #[serde(rename = "not proven")]
    NotProven,
    /// Better.
    Better,
    /// Worse.
    Worse,
}

impl Change {
    /// `same`, `not proven`, `better` or `worse`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Better => "better",
            Self::Same => "same",
            Self::NotProven => "not proven",
            Self::Worse => "worse",
        }
    }

    fn of_all(changes: impl IntoIterator<Item = Self>) -> Self {
        changes.into_iter().max().unwrap_or(Self::Same)
    }
}

/// When two numbers count as different.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    judge: Judge,
    within: f64,
}

impl Settings {
    /// * `floor`: errors not above it have no say; without it that of [`Judge`].
    /// * `within`: errors that differ by less, as a share, are the same.
    ///
    /// # Errors
    /// [`JudgeError`] for a floor that is none.
    pub fn new(floor: Option<f64>, within: f64) -> Result<Self, JudgeError> {
        // The tolerance decides nothing here: what is claimed was judged in the runs.
        let judge = Judge::new(ORDER_SHIFT)?;
        let judge = match floor {
            Some(floor) => judge.with_floor(floor)?,
            None => judge,
        };
        Ok(Self { judge, within })
    }
}

/// Two records side by side.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// What became of all.
    pub change: Change,
    /// The studies that both have, in the order of the new record.
    pub studies: Vec<Study>,
    /// What only one of them has.
    pub notes: Vec<String>,
}

/// A study in both records.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Study {
    /// Its id.
    pub id: String,
    /// What became of it.
    pub change: Change,
    /// Why, where that is not said of one of its errors.
    pub reason: Option<String>,
    /// Its errors, in the order of the new record.
    pub norms: Vec<Norm>,
    /// What only one of them has, and what could not be compared.
    pub notes: Vec<String>,
}

/// Compares two records; studies are matched by their ids.
pub fn compare(old: &Record, new: &Record, settings: &Settings) -> Comparison {
    let find = |record: &'_ Record, id: &str| record.studies.iter().position(|study| study.id == id);
    let both = new.studies.iter().filter_map(|study| Some((&old.studies[find(old, &study.id)?], study)));
    let studies: Vec<Study> = both.map(|(old, new)| compare_study(old, new, settings)).collect();
    let only = |one: &Record, other: &Record, which: &str| {
        let missing = one.studies.iter().filter(|study| find(other, &study.id).is_none());
        missing.map(|study| format!("the study {} is in the {which} record only", study.id)).collect::<Vec<_>>()
    };
    Comparison {
        change: Change::of_all(studies.iter().map(|study| study.change)),
        notes: [only(old, new, "old"), only(new, old, "new")].concat(),
        studies,
    }
}

fn compare_study(old: &StudyRecord, new: &StudyRecord, settings: &Settings) -> Study {
    let (norms, notes) = norm::compare_all(old, new, settings);
    let own = Change::of_all(norms.iter().map(|norm| norm.change));
    let verdicts = (old.verdict, new.verdict);
    let (change, reason) = match verdicts {
        (was, is) if is > was && own != Change::Worse => {
            (Change::Worse, Some(format!("the verdict was {was}, is {is}: {}", new.summary)))
        }
        (Verdict::Fail, Verdict::Pass) if own < Change::Better => {
            (Change::Better, Some(format!("the verdict was fail, is pass: {}", new.summary)))
        }
        _ => (own, None),
    };
    Study { id: new.id.clone(), change, reason, norms, notes }
}
