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
//!    than [`WITHIN`], negative or not finite is worse. If the levels differ, the old error is
//!    interpolated linearly in logarithms; with Δ the change of the pairwise rate there and x the
//!    distance of the neighbours in log h, this is off by at most Δ x / 8 for smooth data, and
//!    twice as much is allowed. Errors are better if every level is better, and the same if every
//!    level is the same.
//! 4. *Work* for the smallest error of both, interpolated likewise: it may differ by `WORK_WITHIN`,
//!    as seconds are not counts.
//!
//! A study with a worse verdict is worse even if none of its errors is. What only the new record
//! has is named, and changes nothing. Errors below the floor of the comparison count as that floor;
//! levels that a study has set aside at its own are not compared.

use serde::Serialize;

use crate::judge::fit::Level;
use crate::judge::verdict::{Aside, Judge, JudgeError, RateVerdict, Verdict};
use crate::run::Finished;
use crate::store::Record;
use crate::study::LevelErrors;
use crate::study::outcome::Outcome;
use crate::text::lists::distinct;
use crate::text::number::plain_text;

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

/// The rule by which errors are compared.
///
/// * `floor`: errors not above it count as the floor.
///
/// # Errors
/// [`JudgeError`] for an invalid floor.
pub fn rule(floor: f64) -> Result<Judge, JudgeError> {
    // The tolerance decides nothing here: the runs have judged the claims.
    Judge::new(ORDER_SHIFT)?.with_floor(floor)
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
    /// Rate and interval in the old and in the new record; `None` with too few levels.
    pub orders: [Option<Order>; 2],
}

/// An observed order.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Order {
    /// The rate.
    pub order: f64,
    /// Its interval.
    pub interval: [f64; 2],
}

/// Two records side by side.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
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
/// * `rule`: see [`rule()`].
/// * `within`: errors that differ by less, as a share, are the same.
pub fn compare(old: &Record, new: &Record, rule: &Judge, within: f64) -> Comparison {
    let mut found = Comparison {
        within,
        change: Shift::Same,
        studies: 0,
        findings: vec![],
        gained: vec![],
    };
    for was in &old.studies {
        let id = &was.header.id;
        match new.studies.iter().find(|study| study.header.id == *id) {
            Some(is) => found.add(was, is, rule),
            None => {
                found.findings.push(whole(
                    id,
                    Shift::Lost,
                    "the new record does not have the study".to_owned(),
                ));
            }
        }
    }
    let is_new = |id: &&String| old.studies.iter().all(|study| study.header.id != **id);
    let gained = new
        .studies
        .iter()
        .map(|study| &study.header.id)
        .filter(is_new);
    found
        .gained
        .extend(gained.map(|id| format!("the study {id}")));
    found.change = found
        .findings
        .iter()
        .map(|finding| finding.change)
        .max()
        .unwrap_or(Shift::Same);
    found
}

fn whole(study: &str, change: Shift, reason: String) -> Finding {
    Finding {
        study: study.to_owned(),
        norm: None,
        change,
        reason,
        orders: [None; 2],
    }
}

impl Comparison {
    /// Adds a study that both records have.
    fn add(&mut self, was: &Finished, is: &Finished, rule: &Judge) {
        self.studies += 1;
        let id = &was.header.id;
        let [known, found] = [was, is].map(|study| names(&study.outcome));
        self.gained.extend(
            found
                .iter()
                .filter(|name| !known.contains(name))
                .map(|name| format!("{id}: {name}")),
        );
        let before = self.findings.len();
        for name in known {
            let [old, new] = [was, is].map(|study| ErrorSequence::new(&study.outcome, name, rule));
            let orders = [old.order, new.order];
            let (change, reason) = Both {
                old,
                new,
                floor: rule.floor(),
                within: self.within,
            }
            .judged();
            self.findings.push(Finding {
                study: id.clone(),
                norm: Some(name.clone()),
                change,
                reason,
                orders,
            });
        }
        let own = self.findings[before..]
            .iter()
            .map(|finding| finding.change)
            .max();
        let [before, after] = [was, is].map(|study| study.outcome.verdict);
        let change = match (before, after) {
            _ if after > before && own < Some(Shift::Worse) => Shift::Worse,
            (Verdict::Fail, Verdict::Pass) if own < Some(Shift::Better) => Shift::Better,
            _ => return,
        };
        let reason = format!(
            "the verdict was {before}, is {after}: {}",
            is.outcome.summary
        );
        self.findings.push(whole(id, change, reason));
    }
}

/// The errors of all levels and the rates, each name once.
fn names(outcome: &Outcome) -> Vec<&String> {
    let errors = outcome
        .levels
        .iter()
        .flat_map(|level| level.errors.iter().map(|(name, _)| name));
    distinct(errors.chain(outcome.rates.iter().map(|(name, _)| name)))
}

/// One error on the levels of one record that have it, and its rate.
struct ErrorSequence<'r> {
    points: Vec<(&'r LevelErrors, Level)>,
    /// Whether the steps fall from level to level; a grid of parameters has no single step.
    is_sequence: bool,
    rate: Option<&'r RateVerdict>,
    /// The rate that was judged, or one computed from the errors.
    order: Option<Order>,
}

impl<'r> ErrorSequence<'r> {
    fn new(outcome: &'r Outcome, name: &str, rule: &Judge) -> Self {
        let rate = outcome
            .rates
            .iter()
            .find(|(known, _)| known == name)
            .map(|(_, rate)| rate);
        let point = |level: &'r LevelErrors| {
            let (_, error) = level.errors.iter().find(|(known, _)| known == name)?;
            Some((
                level,
                Level {
                    step: level.step.unwrap_or(f64::NAN),
                    error: *error,
                },
            ))
        };
        let points: Vec<(&LevelErrors, Level)> = outcome.levels.iter().filter_map(point).collect();
        let levels: Vec<Level> = points.iter().map(|(_, level)| *level).collect();
        let is_sequence = levels.iter().all(|level| level.step > 0.0)
            && levels.windows(2).all(|pair| pair[1].step < pair[0].step);
        let read = || {
            is_sequence
                .then(|| rule.judge(&levels, 1.0))
                .and_then(|rate| order_of(&rate))
        };
        Self {
            points,
            is_sequence,
            rate,
            order: rate.and_then(order_of).or_else(read),
        }
    }

    /// Whether the study's own floor sets the level with these parameters aside.
    fn is_at_floor(&self, level: &LevelErrors) -> bool {
        let place = self
            .points
            .iter()
            .position(|(known, _)| known.parameters == level.parameters);
        let mut set_aside = self.rate.into_iter().flat_map(|rate| &rate.set_aside);
        set_aside.any(|aside| Some(aside.level) == place && aside.because == Aside::AtFloor)
    }

    /// The error at the level with these parameters.
    fn at(&self, level: &LevelErrors) -> Option<f64> {
        self.points
            .iter()
            .find(|(known, _)| known.parameters == level.parameters)
            .map(|(_, level)| level.error)
    }

    /// Interpolates linearly in logarithms: y over x, and its uncertainty.
    fn interpolated(
        &self,
        place: impl Fn(&LevelErrors, &Level) -> Option<[f64; 2]>,
        x: f64,
    ) -> Option<[f64; 2]> {
        let place = |(level, at): &(&LevelErrors, Level)| Some(place(level, at)?.map(f64::ln));
        between(
            &self.points.iter().map(place).collect::<Option<Vec<_>>>()?,
            x.ln(),
        )
    }

    /// The logarithm of the work that an error takes, and its uncertainty.
    fn work_at(&self, error: f64) -> Option<[f64; 2]> {
        self.interpolated(|level, at| Some([at.error, work(level)?]), error)
    }
}

fn order_of(rate: &RateVerdict) -> Option<Order> {
    let (order, interval) = (rate.fitted?, rate.interval?);
    order.is_finite().then_some(Order { order, interval })
}

fn work(level: &LevelErrors) -> Option<f64> {
    level.work.filter(|work| *work > 0.0)
}

fn label(level: &LevelErrors) -> String {
    level
        .parameters
        .iter()
        .map(|(name, value)| format!("{name} = {value}"))
        .collect::<Vec<_>>()
        .join(", ")
}

/// Linear interpolation between points with decreasing x, and its uncertainty.
fn between(points: &[[f64; 2]], x: f64) -> Option<[f64; 2]> {
    if let Some([_, y]) = points
        .iter()
        .find(|[known, _]| (known - x).abs() <= SAME_STEP)
    {
        return Some([*y, 0.0]);
    }
    let k = points
        .windows(2)
        .position(|pair| pair[0][0] > x && x > pair[1][0])?;
    let slope = |k: usize| {
        points
            .get(k + 1)
            .map(|next| (next[1] - points[k][1]) / (next[0] - points[k][0]))
    };
    let here = slope(k)?;
    let neighbours = [k.checked_sub(1).and_then(slope), slope(k + 1)];
    let change = neighbours
        .into_iter()
        .flatten()
        .map(|slope| (slope - here).abs())
        .fold(0.0, f64::max);
    Some([
        points[k][1] + here * (x - points[k][0]),
        0.25 * change * (points[k][0] - points[k + 1][0]),
    ])
}

/// One error in both records.
struct Both<'r> {
    old: ErrorSequence<'r>,
    new: ErrorSequence<'r>,
    /// Smaller errors count as this.
    floor: f64,
    /// As for [`compare`].
    within: f64,
}

impl Both<'_> {
    /// What became of it, and why.
    fn judged(&self) -> (Shift, String) {
        let worse = |reason| (Shift::Worse, reason);
        let lost = self.lost().map(|reason| (Shift::Lost, reason));
        let order = self.order();
        let lower = order.clone().filter(|(change, _)| *change == Shift::Worse);
        let found = lost
            .or(lower)
            .or_else(|| self.broken().map(worse))
            .or_else(|| self.larger().map(worse))
            .or(order);
        found.unwrap_or_else(|| self.cost())
    }

    /// What the new record lacks.
    fn lost(&self) -> Option<String> {
        let Self { old, new, .. } = self;
        if new.points.is_empty() && !old.points.is_empty() {
            return Some("the new record does not have the error".to_owned());
        }
        if old.rate.is_some() && new.rate.is_none() {
            return Some("the new record does not judge its rate".to_owned());
        }
        let ((level, finest), (_, reached)) = (old.points.last()?, new.points.last()?);
        let is_lost = if old.is_sequence && new.is_sequence {
            (reached.step / finest.step).ln() > SAME_STEP
        } else {
            new.at(level).is_none()
        };
        is_lost.then(|| {
            format!(
                "the new record does not have the finest level, {}",
                label(level)
            )
        })
    }

    fn order(&self) -> Option<(Shift, String)> {
        let Self { old, new, .. } = self;
        if let (Some(old), Some(new)) = (old.order, new.order) {
            let apart = old.interval[1] < new.interval[0] || new.interval[1] < old.interval[0];
            if apart && (new.order - old.order).abs() > ORDER_SHIFT {
                let change = if new.order < old.order {
                    Shift::Worse
                } else {
                    Shift::Better
                };
                let words =
                    |Order {
                         order,
                         interval: [low, high],
                     }| format!("{order:.3} ({low:.3} to {high:.3})");
                return Some((change, format!("order {} → {}", words(old), words(new))));
            }
        }
        let (old, new) = (old.rate?, new.rate?);
        let failed = old.verdict == Verdict::Pass && new.verdict != Verdict::Pass;
        failed.then(|| {
            (
                Shift::Worse,
                format!(
                    "the claimed order was pass, is {}: {}",
                    new.verdict, new.reason
                ),
            )
        })
    }

    /// Levels whose error has become negative, infinite or NaN.
    fn broken(&self) -> Option<String> {
        let is_error = |error: f64| error >= 0.0 && error.is_finite();
        let broken =
            self.new.points.iter().filter(|(level, at)| {
                !is_error(at.error) && self.old.at(level).is_some_and(is_error)
            });
        let broken: Vec<String> = broken.map(|(level, _)| label(level)).collect();
        (!broken.is_empty())
            .then(|| format!("no longer a finite number >= 0 at {}", broken.join("; ")))
    }

    /// For each level of the new record: the logarithm of the new error over the old one at the
    /// same place, and its uncertainty.
    fn ratios(&self) -> Vec<(&LevelErrors, [f64; 2])> {
        let floor = self.floor;
        let ratio = |(level, at): &(&'_ LevelErrors, Level)| {
            let same = self.old.at(level).map(|error| [error.max(floor).ln(), 0.0]);
            let over_step = || {
                self.old
                    .interpolated(|_, at| Some([at.step, at.error.max(floor)]), at.step)
            };
            let [before, doubt] = same.or_else(over_step)?;
            let ratio = at.error.max(floor).ln() - before;
            // Two zeros without a floor are the same.
            Some([if ratio.is_nan() { 0.0 } else { ratio }, doubt])
        };
        let is_known = |level: &LevelErrors| {
            ![&self.old, &self.new]
                .iter()
                .any(|sequence| sequence.is_at_floor(level))
        };
        let sound = self
            .new
            .points
            .iter()
            .filter(|(level, at)| at.error >= 0.0 && is_known(level));
        sound
            .filter_map(|point| Some((point.0, ratio(point)?)))
            .collect()
    }

    fn larger(&self) -> Option<String> {
        let (ratios, limit) = (self.ratios(), self.within.ln_1p());
        let larger: Vec<_> = ratios
            .iter()
            .filter(|(_, [ratio, doubt])| ratio - doubt > limit)
            .collect();
        let (level, [ratio, _]) = larger.iter().max_by(|a, b| a.1[0].total_cmp(&b.1[0]))?;
        let levels = format!("{} of {} levels that both have", larger.len(), ratios.len());
        Some(format!(
            "errors larger at {levels}: {}: {} times",
            label(level),
            plain_text(ratio.exp())
        ))
    }

    fn cost(&self) -> (Shift, String) {
        let (ratios, limit) = (self.ratios(), self.within.ln_1p());
        let count = ratios.len();
        if count == 0 {
            let is_empty = self.old.points.is_empty() && self.new.points.is_empty();
            let why = if is_empty {
                "no errors are recorded, only rates"
            } else {
                "no level is at a step that both have reached"
            };
            return (
                Shift::NotProven,
                format!("no difference of orders is proven; {why}"),
            );
        }
        if ratios
            .iter()
            .all(|(_, [ratio, doubt])| ratio + doubt < -limit)
        {
            let most = ratios
                .iter()
                .map(|(_, [ratio, _])| *ratio)
                .fold(f64::NEG_INFINITY, f64::max);
            let times = plain_text(most.exp());
            return (
                Shift::Better,
                format!("errors smaller: {times} times or less at {count} levels"),
            );
        }
        if !ratios
            .iter()
            .all(|(_, [ratio, doubt])| ratio.abs() + doubt <= limit)
        {
            return (
                Shift::NotProven,
                format!("no difference of errors is proven at {count} levels"),
            );
        }
        let work = self
            .work()
            .filter(|[ratio, doubt]| ratio.abs() - doubt > WORK_WITHIN.ln_1p());
        let Some([ratio, _]) = work else {
            return (Shift::Same, format!("errors the same at {count} levels"));
        };
        let change = if ratio > 0.0 {
            Shift::Worse
        } else {
            Shift::Better
        };
        (
            change,
            format!("the same error takes {:.3} times the work", ratio.exp()),
        )
    }

    /// The logarithm of the new work over the old one for the smallest error that both have
    /// reached, and its uncertainty: errors within the limit count as equal, so the work is
    /// uncertain by its growth over that share of the error.
    fn work(&self) -> Option<[f64; 2]> {
        let error = self
            .old
            .points
            .last()?
            .1
            .error
            .max(self.new.points.last()?.1.error);
        if !(error > self.floor) {
            return None;
        }
        let [before, after] = [self.old.work_at(error)?, self.new.work_at(error)?];
        let [.., (coarse, large), (fine, small)] = self.new.points.as_slice() else {
            return None;
        };
        let growth = (work(fine)? / work(coarse)?).ln() / (large.error / small.error).ln();
        Some([
            after[0] - before[0],
            before[1] + after[1] + self.within.ln_1p() * growth.abs(),
        ])
    }
}
