//! One error of one study in two records.

use serde::Serialize;

use super::series::{Between, Point, Series, error, has_steps};
use super::{Change, ORDER_SHIFT, Settings, WORK_WITHIN};
use crate::judge::fit::Quantiles;
use crate::judge::verdict::{FEWEST_LEVELS, Verdict};
use crate::store::record::{LevelRecord, RateRecord, StudyRecord};
use crate::text::number::plain_text;

/// An error in both records.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Norm {
    /// Its name.
    pub norm: String,
    /// What became of it.
    pub change: Change,
    /// Why.
    pub reason: String,
    /// Order and constant in the old and in the new record; nothing where there are too few levels.
    pub lines: [Option<Line>; 2],
    /// New error over old error at the same step.
    pub error: Option<Ratio>,
    /// New work over old work for the same error.
    pub work: Option<Ratio>,
}

/// The observed law C h^p.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Line {
    /// p.
    pub order: f64,
    /// Its interval.
    pub order_interval: [f64; 2],
    /// C, by the finest level that was used.
    pub constant: f64,
    /// C for the ends of the interval of p.
    pub constant_interval: [f64; 2],
}

/// New over old.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Ratio {
    /// The ratio, as a geometric mean.
    pub ratio: f64,
    /// Its interval.
    pub interval: [f64; 2],
    /// The least and the largest ratio of a level, each with its doubt; of the work the interval.
    pub extremes: [f64; 2],
    /// Levels that it rests on.
    pub levels: usize,
}

impl Ratio {
    fn words(&self, what: &str) -> String {
        let Self { ratio, interval: [low, high], levels, .. } = self;
        format!("{what} at the same step: {ratio:.4} times, {low:.4} to {high:.4} from {}", counted(*levels))
    }
}

/// Compares all errors and rates of a study.
///
/// * Returns the errors that both records have, and notes on the others.
pub(super) fn compare_all(old: &StudyRecord, new: &StudyRecord, settings: &Settings) -> (Vec<Norm>, Vec<String>) {
    let [known, found] = [old, new].map(names);
    let mut notes = vec![];
    for (names, others, which) in [(&known, &found, "old"), (&found, &known, "new")] {
        let only = names.iter().filter(|name| !others.contains(name));
        notes.extend(only.map(|name| format!("{name}: in the {which} record only")));
    }
    let mut norms = vec![];
    for name in found.iter().filter(|name| known.contains(name)) {
        let pair = Pair::new(name, old, new, settings);
        notes.extend(pair.notes());
        norms.push(pair.compare());
    }
    (norms, notes)
}

/// The errors of all levels and the rates, each name once.
fn names(study: &StudyRecord) -> Vec<String> {
    let errors = study.levels.iter().flat_map(|level| level.errors.0.iter().map(|(name, _)| name));
    let mut names: Vec<String> = vec![];
    for name in errors.chain(study.rates.iter().map(|rate| &rate.norm)) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}

/// A norm in both records.
struct Pair<'a> {
    name: &'a str,
    settings: &'a Settings,
    series: [Series; 2],
    rates: [Option<&'a RateRecord>; 2],
    levels: [&'a [LevelRecord]; 2],
}

impl<'a> Pair<'a> {
    fn new(name: &'a str, old: &'a StudyRecord, new: &'a StudyRecord, settings: &'a Settings) -> Self {
        let recorded = has_steps(&old.levels) && has_steps(&new.levels);
        let both = [old, new];
        Self {
            name,
            settings,
            series: both.map(|study| Series::new(&study.levels, name, recorded)),
            rates: both.map(|study| study.rates.iter().find(|rate| rate.norm == name)),
            levels: both.map(|study| study.levels.as_slice()),
        }
    }

    /// Levels that only one record has, in words.
    fn notes(&self) -> Vec<String> {
        let has =
            |series: &Series, point: &Point| series.points.iter().any(|known| known.parameters == point.parameters);
        let only = |k: usize| {
            let missing = self.series[k].points.iter().filter(|point| !has(&self.series[1 - k], point));
            missing.map(|point| label(&point.parameters)).collect::<Vec<_>>()
        };
        let notes = [(only(0), "old"), (only(1), "new")];
        let some = notes.into_iter().filter(|(levels, _)| !levels.is_empty());
        some.map(|(levels, which)| format!("{}: in the {which} record only: {}", self.name, levels.join("; ")))
            .collect()
    }

    fn compare(&self) -> Norm {
        let lines = [0, 1].map(|k| self.line(k));
        let used = [0, 1].map(|k| self.used(k));
        let error = self.errors(&used);
        let work = self.work(&used, error);
        let order = self.order(&lines);
        let lower = order.clone().filter(|(change, _)| *change == Change::Worse);
        let found = self.lost().or(lower).or_else(|| self.larger(error)).or(order);
        let found = found.unwrap_or_else(|| self.cost(error, work));
        Norm { norm: self.name.to_owned(), change: found.0, reason: found.1, lines, error, work }
    }

    /// Levels whose error was a finite number that is not negative, and is none any more.
    fn lost(&self) -> Option<(Change, String)> {
        let [old, new] = self.levels;
        let value = |levels: &[LevelRecord], level: &LevelRecord| {
            error(levels.iter().find(|known| known.parameters == level.parameters)?, self.name)
        };
        let is_error = |value: f64| value.is_finite() && value >= 0.0;
        let lost = |level: &&LevelRecord| {
            value(old, level).is_some_and(is_error) && value(new, level).is_some_and(|now| !is_error(now))
        };
        let lost: Vec<String> = old.iter().filter(lost).map(|level| label(&level.parameters.0)).collect();
        (!lost.is_empty()).then(|| (Change::Worse, format!("no longer a finite number >= 0 at {}", lost.join("; "))))
    }

    fn order(&self, lines: &[Option<Line>; 2]) -> Option<(Change, String)> {
        if let [Some(old), Some(new)] = lines {
            let words = || {
                format!(
                    "order {} → {}",
                    interval(old.order, old.order_interval),
                    interval(new.order, new.order_interval)
                )
            };
            if old.order - new.order > ORDER_SHIFT && new.order_interval[1] < old.order_interval[0] {
                return Some((Change::Worse, words()));
            }
            if new.order - old.order > ORDER_SHIFT && old.order_interval[1] < new.order_interval[0] {
                return Some((Change::Better, words()));
            }
        }
        let [old, new] = [self.rates[0]?, self.rates[1]?];
        let passed_before = old.verdict == Verdict::Pass && new.verdict != Verdict::Pass;
        let words = || format!("the claimed order was pass, is {}: {}", new.verdict, new.reason);
        passed_before.then(|| (Change::Worse, words()))
    }

    /// The errors at steps that both records have, each as new over old; those that are not above the floor count as the floor.
    ///
    /// Errors are deterministic: at the same step nothing but a change of the program makes them differ.
    fn at_common_steps(&self) -> Vec<(String, f64)> {
        let floor = self.settings.judge.floor();
        let at_least = |error: f64| error.max(floor);
        let one = |point: &Point| {
            let before = self.series[0].same_level(point, &self.series[1])?.level.error;
            let ratio = at_least(point.level.error) / at_least(before);
            // Two zeros without a floor are the same.
            Some((label(&point.parameters), if ratio.is_nan() { 1.0 } else { ratio }))
        };
        let usable = |point: &&Point| point.level.error >= 0.0;
        self.series[1].points.iter().filter(usable).filter_map(one).collect()
    }

    /// Errors that are larger: as a whole, or at one step that both records have.
    fn larger(&self, error: Option<Ratio>) -> Option<(Change, String)> {
        let within = 1.0 + self.settings.within;
        let whole = error.filter(|error| error.interval[0] > within || error.extremes[0] > within);
        if let Some(error) = whole {
            return Some((Change::Worse, error.words("errors larger")));
        }
        let common = self.at_common_steps();
        let larger: Vec<_> = common.iter().filter(|(_, ratio)| *ratio > within).collect();
        let (level, ratio) = larger.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let (count, all) = (larger.len(), counted(common.len()));
        Some((
            Change::Worse,
            format!("errors larger at {count} of {all} that both have: {level}: {} times", plain_text(*ratio)),
        ))
    }

    fn cost(&self, error: Option<Ratio>, work: Option<Ratio>) -> (Change, String) {
        let within = 1.0 + self.settings.within;
        let common = self.at_common_steps();
        let all_within = !common.is_empty() && common.iter().all(|(_, ratio)| *ratio >= 1.0 / within);
        let Some(error) = error else {
            if all_within {
                return (
                    Change::Same,
                    format!("errors the same or not above the floor, from {}", counted(common.len())),
                );
            }
            let why = if self.series.iter().all(|series| series.points.is_empty()) {
                "no errors are recorded, only rates"
            } else {
                "no errors above the floor at steps that both have reached"
            };
            return (Change::NotProven, format!("no difference of orders is proven; {why}"));
        };
        if error.interval[1] < 1.0 / within || error.extremes[1] < 1.0 / within {
            return (Change::Better, error.words("errors smaller"));
        }
        match work {
            Some(Ratio { ratio, interval: [low, _], .. }) if low > 1.0 + WORK_WITHIN => {
                (Change::Worse, format!("the same error takes {ratio:.3} times the work"))
            }
            Some(Ratio { ratio, interval: [_, high], .. }) if high < 1.0 / (1.0 + WORK_WITHIN) => {
                (Change::Better, format!("the same error takes {ratio:.3} times the work"))
            }
            _ if all_within || (error.interval[0] >= 1.0 / within && error.interval[1] <= within) => {
                (Change::Same, error.words("errors the same"))
            }
            _ => (Change::NotProven, error.words("no difference of errors is proven")),
        }
    }

    /// The law of one record: its recorded rate, or one that is read off its errors.
    fn line(&self, k: usize) -> Option<Line> {
        let series = &self.series[k];
        let recorded = self.rates[k].and_then(|rate| Some((rate.fitted?, rate.interval?)));
        let levels = series.levels();
        let judged = series.is_sequence.then(|| self.settings.judge.judge(&levels, self.claimed(k)));
        let read = judged.as_ref().and_then(|judged| Some((judged.fitted?, judged.interval?)));
        let (order, order_interval) = recorded.or(read).filter(|(order, _)| order.is_finite())?;
        let finest = judged.and_then(|judged| levels.get(judged.used)?.last().copied());
        let constant = |order: f64| finest.map_or(f64::NAN, |finest| finest.error / finest.step.powf(order));
        let mut constant_interval = order_interval.map(constant);
        constant_interval.sort_by(f64::total_cmp);
        Some(Line { order, order_interval, constant: constant(order), constant_interval })
    }

    fn claimed(&self, k: usize) -> f64 {
        self.rates[k].map_or(1.0, |rate| rate.order)
    }

    /// The levels that may be compared: the asymptotic range of a sequence, else all that are above the floor.
    fn used(&self, k: usize) -> Vec<Point> {
        let series = &self.series[k];
        let judged = self.settings.judge.judge(&series.levels(), self.claimed(k));
        let floor = self.settings.judge.floor();
        let above = |point: &&Point| point.level.error > floor && point.level.error.is_finite();
        match series.points.get(judged.used.clone()).filter(|_| series.is_sequence && !judged.used.is_empty()) {
            Some(points) => points.to_vec(),
            None => series.points.iter().filter(above).cloned().collect(),
        }
    }

    fn errors(&self, [old, new]: &[Vec<Point>; 2]) -> Option<Ratio> {
        let mut logs: Vec<Between> = if self.series.iter().all(|series| series.is_sequence) {
            let at_new = new.iter().filter_map(|point| {
                let before = Series::at_step(old, point.level.step)?;
                Some(Between { log: point.level.error.ln() - before.log, ..before })
            });
            at_new.collect()
        } else {
            let same = |point: &Point| old.iter().find(|known| known.parameters == point.parameters).cloned();
            let log = |point: &Point| Some(point.level.error.ln() - same(point)?.level.error.ln());
            new.iter().filter_map(log).map(|log| Between { log, doubt: 0.0 }).collect()
        };
        if logs.is_empty() && self.series.iter().all(|series| series.is_sequence) {
            logs = old
                .iter()
                .filter_map(|point| {
                    let after = Series::at_step(new, point.level.step)?;
                    Some(Between { log: after.log - point.level.error.ln(), ..after })
                })
                .collect();
        }
        ratio(&logs)
    }

    /// The work for the smallest error that both have reached. As far as the errors are not known to differ, the work is not either: its interval is that of
    /// the errors, times how fast the work grows with the accuracy.
    fn work(&self, [old, new]: &[Vec<Point>; 2], errors: Option<Ratio>) -> Option<Ratio> {
        let error = old.last()?.level.error.max(new.last()?.level.error);
        let [before, after] = [Series::work_at(old, error)?, Series::work_at(new, error)?];
        let log = after.log - before.log;
        let [.., coarse, fine] = new.as_slice() else { return None };
        let growth = (fine.work? / coarse.work?).ln() / (coarse.level.error / fine.level.error).ln();
        let Ratio { interval: [low, high], levels, .. } = errors?;
        let half = 0.5 * (high / low).ln() * growth.abs() + before.doubt + after.doubt;
        let interval = [log - half, log + half].map(f64::exp);
        Some(Ratio { ratio: log.exp(), interval, extremes: interval, levels })
    }
}

/// Geometric mean and Student interval; of two the span, of one nothing but itself.
fn ratio(logs: &[Between]) -> Option<Ratio> {
    let levels = logs.len();
    let n = levels as f64;
    let mean = logs.iter().map(|log| log.log).sum::<f64>() / n;
    let square = logs.iter().map(|log| (log.log - mean).powi(2)).sum::<f64>();
    let half = if levels < FEWEST_LEVELS {
        square.sqrt()
    } else {
        Quantiles::standard().t(levels - 1) * (square / (n - 1.0) / n).sqrt()
    };
    let doubt = logs.iter().map(|log| log.doubt).fold(0.0, f64::max);
    let ends = [mean - half - doubt, mean + half + doubt];
    let least = logs.iter().map(|log| log.log - log.doubt).fold(f64::INFINITY, f64::min);
    let most = logs.iter().map(|log| log.log + log.doubt).fold(f64::NEG_INFINITY, f64::max);
    let [interval, extremes] = [ends, [least, most]].map(|ends| ends.map(f64::exp));
    mean.is_finite().then(|| Ratio { ratio: mean.exp(), interval, extremes, levels })
}

fn counted(levels: usize) -> String {
    if levels == 1 { "one level".to_owned() } else { format!("{levels} levels") }
}

fn interval(value: f64, [low, high]: [f64; 2]) -> String {
    format!("{value:.3} ({low:.3} to {high:.3})")
}

fn label(parameters: &[(String, f64)]) -> String {
    let named: Vec<String> = parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    named.join(", ")
}
