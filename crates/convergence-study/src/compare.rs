//! Two versions of a program, by their records: is anything lost, has an order, an error or the cost of an accuracy changed?
//!
//! Every error of every study of the old record is held against itself, by four questions; the first that finds a difference names the
//! reason.
//!
//! 1. *Lost*: the new record lacks a study, an error, a judged rate, or ends at a coarser level.
//! 2. *Order*: the intervals of the rates have no point in common and the rates are more than [`ORDER_SHIFT`] apart, or a claim that
//!    passed does not.
//! 3. *Error*: at a level that both have, errors are deterministic; one that is larger by more than [`WITHIN`], negative or not finite
//!    is worse. Where the levels differ, the old error is interpolated linearly in logarithms; with Δ the change of the pairwise rate
//!    there and x the distance of the neighbours in log h, this is off by at most Δ x / 8 for smooth data, and twice as much is allowed
//!    for. Errors are better where every level is, and the same where every level is.
//! 4. *Work* for the smallest error that both have reached, interpolated likewise: more or less by [`WORK_WITHIN`], as seconds are no counts.
//!
//! A study with a worse verdict is worse although no error of it is. What only the new record has is named, and changes nothing. Errors
//! that are not above the floor count as the floor.

use serde::Serialize;

use crate::judge::fit::Level;
use crate::judge::verdict::{Judge, JudgeError, RateVerdict, Verdict};
use crate::run::Finished;
use crate::store::record::Record;
use crate::study::outcome::Outcome;
use crate::text::number::plain_text;

/// Rates that are closer are one order.
pub const ORDER_SHIFT: f64 = 0.05;

/// Errors at the same step that differ by less, as a share, are the same; the default of `--within`.
pub const WITHIN: f64 = 0.01;

/// The same of the work for the same error.
pub const WORK_WITHIN: f64 = 0.05;

/// Logarithms of steps that differ by less are of one step: records may be rounded to six digits.
const SAME_STEP: f64 = 1e-5;

/// What has become of something. Ordered, so that the maximum of several is what became of all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Shift {
    /// The same.
    Same,
    /// The data prove neither a difference nor that there is none.
    #[serde(rename = "not proven")]
    NotProven,
    /// Better.
    Better,
    /// Worse.
    Worse,
    /// There is less to compare than there was.
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
        Ok(Self { judge: floor.map_or(Ok(judge.clone()), |floor| judge.with_floor(floor))?, within })
    }
}

/// What became of one thing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// The study.
    pub study: String,
    /// The error; nothing where it is the study as a whole.
    pub norm: Option<String>,
    /// What became of it.
    pub change: Shift,
    /// Why.
    pub reason: String,
    /// Rate and interval in the old and in the new record; nothing where there are too few levels.
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
    /// Every error and every study that has changed as a whole, in the order of the old record.
    pub findings: Vec<Finding>,
    /// What only the new record has.
    pub gained: Vec<String>,
}

/// Compares two records; studies are matched by their ids.
pub fn compare(old: &Record, new: &Record, settings: &Settings) -> Comparison {
    let find = |record: &'_ Record, id: &str| record.studies.iter().position(|study| study.header.id == id);
    let (mut findings, mut gained, mut studies) = (vec![], vec![], 0);
    for was in &old.studies {
        let id = was.header.id.as_str();
        match find(new, id) {
            Some(place) => {
                studies += 1;
                compare_study(was, &new.studies[place], settings, &mut findings, &mut gained);
            }
            None => findings.push(whole(id, Shift::Lost, "the new record does not have the study".to_owned())),
        }
    }
    let more = new.studies.iter().map(|study| &study.header.id).filter(|id| find(old, id).is_none());
    gained.extend(more.map(|id| format!("the study {id}")));
    let change = findings.iter().map(|finding| finding.change).max().unwrap_or(Shift::Same);
    Comparison { within: settings.within, change, studies, findings, gained }
}

fn whole(study: &str, change: Shift, reason: String) -> Finding {
    Finding { study: study.to_owned(), norm: None, change, reason, orders: [None; 2] }
}

fn compare_study(
    was: &Finished,
    is: &Finished,
    settings: &Settings,
    findings: &mut Vec<Finding>,
    gained: &mut Vec<String>,
) {
    let id = &was.header.id;
    let [known, found] = [was, is].map(|study| names(&study.outcome));
    gained.extend(found.iter().filter(|name| !known.contains(name)).map(|name| format!("{id}: {name}")));
    let before = findings.len();
    for name in known {
        let pair = [was, is].map(|study| ErrorSequence::new(&study.outcome, name));
        let (change, reason) = pair[1].lost(&pair[0]).map_or_else(|| settings.judged(&pair), |why| (Shift::Lost, why));
        let orders = pair.each_ref().map(|series| series.order(settings));
        findings.push(Finding { study: id.clone(), norm: Some(name.clone()), change, reason, orders });
    }
    let own = findings[before..].iter().map(|finding| finding.change).max();
    let words =
        || format!("the verdict was {}, is {}: {}", was.outcome.verdict, is.outcome.verdict, is.outcome.summary);
    match (was.outcome.verdict, is.outcome.verdict) {
        (was, is) if is > was && own < Some(Shift::Worse) => findings.push(whole(id, Shift::Worse, words())),
        (Verdict::Fail, Verdict::Pass) if own < Some(Shift::Better) => {
            findings.push(whole(id, Shift::Better, words()));
        }
        _ => {}
    }
}

/// The errors of all levels and the rates, each name once.
fn names(outcome: &Outcome) -> Vec<&String> {
    let errors = outcome.levels.iter().flat_map(|level| level.errors.iter().map(|(name, _)| name));
    let mut names: Vec<&String> = vec![];
    for name in errors.chain(outcome.rates.iter().map(|(name, _)| name)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// One error on the levels of one record, and its rate.
struct ErrorSequence<'r> {
    points: Vec<AtLevel<'r>>,
    /// Whether the steps fall from level to level; a grid of parameters has no one step.
    is_sequence: bool,
    rate: Option<&'r RateVerdict>,
}

/// One level.
#[derive(Debug, Clone, Copy)]
struct AtLevel<'r> {
    at: &'r [(String, f64)],
    level: Level,
    work: Option<f64>,
}

impl<'r> ErrorSequence<'r> {
    fn new(outcome: &'r Outcome, name: &str) -> Self {
        let point = |level: &'r crate::study::LevelErrors| {
            let (_, error) = level.errors.iter().find(|(known, _)| known == name)?;
            let level_at = Level { step: level.step.unwrap_or(f64::NAN), error: *error };
            Some(AtLevel { at: &level.parameters, level: level_at, work: level.work.filter(|work| *work > 0.0) })
        };
        let points: Vec<AtLevel<'r>> = outcome.levels.iter().filter_map(point).collect();
        let falls = |pair: &[AtLevel<'_>]| pair[1].level.step < pair[0].level.step;
        let is_sequence = points.iter().all(|point| point.level.step > 0.0) && points.windows(2).all(falls);
        Self { points, is_sequence, rate: outcome.rates.iter().find(|(known, _)| known == name).map(|(_, rate)| rate) }
    }

    /// What this series lacks that another has.
    fn lost(&self, old: &Self) -> Option<String> {
        if self.points.is_empty() && !old.points.is_empty() {
            return Some("the new record does not have the error".to_owned());
        }
        if old.rate.is_some() && self.rate.is_none() {
            return Some("the new record does not judge its rate".to_owned());
        }
        let (finest, reached) = (old.points.last()?, self.points.last()?);
        let is_lost = if old.is_sequence && self.is_sequence {
            (reached.level.step / finest.level.step).ln() > SAME_STEP
        } else {
            !self.points.iter().any(|point| point.at == finest.at)
        };
        is_lost.then(|| format!("the new record does not have the finest level, {}", label(finest.at)))
    }

    /// The rate that was judged, or one that is read off the errors.
    fn order(&self, settings: &Settings) -> Option<Order> {
        let levels: Vec<Level> = self.points.iter().map(|point| point.level).collect();
        let read = || self.is_sequence.then(|| settings.judge.judge(&levels, 1.0)).and_then(|rate| interval(&rate));
        self.rate.and_then(interval).or_else(read)
    }

    /// The logarithm of the error at the level of a point, and how far off it may be.
    fn error_at(&self, point: &AtLevel<'_>, floor: f64) -> Option<[f64; 2]> {
        if let Some(same) = self.points.iter().find(|known| known.at == point.at) {
            return Some([same.level.error.max(floor).ln(), 0.0]);
        }
        let place = |known: &AtLevel<'_>| Some([known.level.step.ln(), known.level.error.max(floor).ln()]);
        between(&self.points.iter().map(place).collect::<Option<Vec<_>>>()?, point.level.step.ln())
    }

    /// The logarithm of the work that an error takes, and how far off it may be.
    fn work_at(&self, error: f64) -> Option<[f64; 2]> {
        let place = |point: &AtLevel<'_>| Some([point.level.error.ln(), point.work?.ln()]);
        between(&self.points.iter().map(place).collect::<Option<Vec<_>>>()?, error.ln())
    }
}

fn interval(rate: &RateVerdict) -> Option<Order> {
    let (order, interval) = (rate.fitted?, rate.interval?);
    order.is_finite().then_some(Order { order, interval })
}

fn label(parameters: &[(String, f64)]) -> String {
    let named: Vec<String> = parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    named.join(", ")
}

/// Linear interpolation between points whose x falls, and the doubt about it.
fn between(points: &[[f64; 2]], x: f64) -> Option<[f64; 2]> {
    if let Some([_, y]) = points.iter().find(|[known, _]| (known - x).abs() <= SAME_STEP) {
        return Some([*y, 0.0]);
    }
    let k = points.windows(2).position(|pair| pair[0][0] > x && x > pair[1][0])?;
    let slope = |k: usize| points.get(k + 1).map(|next| (next[1] - points[k][1]) / (next[0] - points[k][0]));
    let here = slope(k)?;
    let neighbours = [k.checked_sub(1).and_then(slope), slope(k + 1)];
    let change = neighbours.into_iter().flatten().map(|slope| (slope - here).abs()).fold(0.0, f64::max);
    Some([points[k][1] + here * (x - points[k][0]), 0.25 * change * (points[k][0] - points[k + 1][0])])
}

impl Settings {
    /// What became of an error that both records have, and why.
    fn judged(&self, pair: &[ErrorSequence<'_>; 2]) -> (Shift, String) {
        let order = self.order(pair);
        let lower = order.clone().filter(|(change, _)| *change == Shift::Worse);
        lower.or_else(|| self.broken(pair)).or_else(|| self.larger(pair)).or(order).unwrap_or_else(|| self.cost(pair))
    }

    fn order(&self, pair: &[ErrorSequence<'_>; 2]) -> Option<(Shift, String)> {
        let orders = pair.each_ref().map(|series| series.order(self));
        if let [Some(old), Some(new)] = orders {
            let apart = old.interval[1] < new.interval[0] || new.interval[1] < old.interval[0];
            if apart && (new.order - old.order).abs() > ORDER_SHIFT {
                let change = if new.order < old.order { Shift::Worse } else { Shift::Better };
                let words = |Order { order, interval: [low, high] }| format!("{order:.3} ({low:.3} to {high:.3})");
                return Some((change, format!("order {} → {}", words(old), words(new))));
            }
        }
        let [old, new] = [pair[0].rate?, pair[1].rate?];
        let failed = old.verdict == Verdict::Pass && new.verdict != Verdict::Pass;
        failed.then(|| (Shift::Worse, format!("the claimed order was pass, is {}: {}", new.verdict, new.reason)))
    }

    /// Levels whose error has become negative, infinite or NaN.
    fn broken(&self, [old, new]: &[ErrorSequence<'_>; 2]) -> Option<(Shift, String)> {
        let is_error = |error: f64| error >= 0.0 && error.is_finite();
        let was =
            |point: &AtLevel<'_>| old.points.iter().any(|known| known.at == point.at && is_error(known.level.error));
        let broken: Vec<String> = new
            .points
            .iter()
            .filter(|point| !is_error(point.level.error) && was(point))
            .map(|point| label(point.at))
            .collect();
        let reason = || format!("no longer a finite number >= 0 at {}", broken.join("; "));
        (!broken.is_empty()).then(|| (Shift::Worse, reason()))
    }

    /// For each level of the new record: the logarithm of the new error over the old one at the same place, and its doubt.
    fn ratios<'p>(&self, [old, new]: &'p [ErrorSequence<'_>; 2]) -> Vec<(&'p AtLevel<'p>, [f64; 2])> {
        let floor = self.judge.floor();
        let ratio = |point: &'p AtLevel<'p>| {
            let [before, doubt] = old.error_at(point, floor)?;
            let ratio = point.level.error.max(floor).ln() - before;
            // Two zeros without a floor are the same.
            Some((point, [if ratio.is_nan() { 0.0 } else { ratio }, doubt]))
        };
        new.points.iter().filter(|point| point.level.error >= 0.0).filter_map(ratio).collect()
    }

    fn larger(&self, pair: &[ErrorSequence<'_>; 2]) -> Option<(Shift, String)> {
        let (ratios, limit) = (self.ratios(pair), self.within.ln_1p());
        let larger: Vec<_> = ratios.iter().filter(|(_, [ratio, doubt])| ratio - doubt > limit).collect();
        let (point, [ratio, _]) = larger.iter().max_by(|a, b| a.1[0].total_cmp(&b.1[0]))?;
        let times = plain_text(ratio.exp());
        let levels = format!("{} of {} levels that both have", larger.len(), ratios.len());
        Some((Shift::Worse, format!("errors larger at {levels}: {}: {times} times", label(point.at))))
    }

    fn cost(&self, pair: &[ErrorSequence<'_>; 2]) -> (Shift, String) {
        let (ratios, limit) = (self.ratios(pair), self.within.ln_1p());
        if ratios.is_empty() {
            let why = if pair.iter().all(|series| series.points.is_empty()) {
                "no errors are recorded, only rates"
            } else {
                "no level is at a step that both have reached"
            };
            return (Shift::NotProven, format!("no difference of orders is proven; {why}"));
        }
        if ratios.iter().all(|(_, [ratio, doubt])| ratio + doubt < -limit) {
            let most = ratios.iter().map(|(_, [ratio, _])| *ratio).fold(f64::NEG_INFINITY, f64::max);
            return (
                Shift::Better,
                format!("errors smaller: {} times or less at {} levels", plain_text(most.exp()), ratios.len()),
            );
        }
        if !ratios.iter().all(|(_, [ratio, doubt])| ratio.abs() + doubt <= limit) {
            return (Shift::NotProven, format!("no difference of errors is proven at {} levels", ratios.len()));
        }
        let work = self.work(pair).filter(|[ratio, doubt]| ratio.abs() - doubt > WORK_WITHIN.ln_1p());
        match work {
            Some([ratio, _]) => {
                let change = if ratio > 0.0 { Shift::Worse } else { Shift::Better };
                (change, format!("the same error takes {:.3} times the work", ratio.exp()))
            }
            None => (Shift::Same, format!("errors the same at {} levels", ratios.len())),
        }
    }

    /// The logarithm of the new work over the old one for the smallest error that both have reached, and its doubt: an error within the
    /// limit is taken for the same, so the work is known no better than it grows with the accuracy.
    fn work(&self, [old, new]: &[ErrorSequence<'_>; 2]) -> Option<[f64; 2]> {
        let error = old.points.last()?.level.error.max(new.points.last()?.level.error);
        if !(error > self.judge.floor()) {
            return None;
        }
        let [before, after] = [old.work_at(error)?, new.work_at(error)?];
        let [.., coarse, fine] = new.points.as_slice() else { return None };
        let growth = (fine.work? / coarse.work?).ln() / (coarse.level.error / fine.level.error).ln();
        Some([after[0] - before[0], before[1] + after[1] + self.within.ln_1p() * growth.abs()])
    }
}
