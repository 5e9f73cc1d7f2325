//! Printed digits: the part that rounding hides decides nothing.

use crate::judge::claims::Claim;
use crate::judge::fit::Level;
use crate::judge::richardson::{Estimate, Estimator, Value};
use crate::judge::verdict::{Judge, RateVerdict, Reason, Verdict};
use crate::text::number::counted;

/// Rounding below this share of a number changes no verdict.
const NOTHING: f64 = 1e-9;
/// The finest levels, which rounding changes most.
const FINEST: usize = 4;

/// A column of errors or of values, coarsest level first.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name as shown.
    pub name: String,
    /// Steps and numbers.
    pub levels: Vec<Level>,
    /// Half a unit of the last printed place of each number; 0 if it is exact.
    pub halves: Vec<f64>,
    /// The same for the steps.
    pub step_halves: Vec<f64>,
}

impl Column {
    /// Judges the errors. The interval is widened by as much as rounding moves the finest rate; if another digit could
    /// turn a verdict into a pass or a pass into another verdict, the reason is missing digits.
    pub fn judge(&self, judge: &Judge, claim: &Claim) -> RateVerdict {
        let (judged, order) = (claim.judge(judge, &self.levels), claim.order);
        let share = |k: usize| self.half(k, order) / self.levels[k].error.abs().max(f64::MIN_POSITIVE);
        let is_told = matches!(judged.kind, Reason::NonFiniteError | Reason::NegativeError | Reason::TooFewLevels);
        if is_told || order.is_nan() || (0..self.levels.len()).all(|k| share(k) < NOTHING) {
            return judged;
        }
        let finest = self.levels.windows(2).enumerate().next_back();
        let wider = finest.map_or(0.0, |(k, pair)| (share(k) + share(k + 1)) / (pair[0].step / pair[1].step).ln());
        if judged.verdict != Verdict::Pass {
            let corners = self.corners(order);
            let may_be = |verdict: Verdict| corners.iter().any(|levels| claim.judge(judge, levels).verdict == verdict);
            let is_poor =
                wider > judge.tolerance() && (judged.verdict != Verdict::Fail || may_be(Verdict::Inconclusive));
            return if is_poor || may_be(Verdict::Pass) { self.without_digits(judged) } else { judged };
        }
        let Some([low, high]) = judged.interval.map(|[low, high]| [low - wider, high + wider]) else { return judged };
        let judged = RateVerdict { interval: Some([low, high]), ..judged };
        let is_above = high > order + judge.tolerance() && !claim.at_least;
        if low < order - judge.tolerance() || is_above { self.without_digits(judged) } else { judged }
    }

    /// Judges the differences of the values, and estimates their limit.
    pub fn estimate(&self, estimator: &Estimator, order: f64) -> Estimate {
        let estimate = |levels: &Vec<Level>| {
            let value = |level: &Level| Value { step: level.step, value: level.error };
            estimator.estimate(&levels.iter().map(value).collect::<Vec<_>>(), order)
        };
        let mut found = estimate(&self.levels);
        let corners: Vec<Estimate> = self.corners(order).iter().map(estimate).collect();
        let verdict = found.judged.verdict;
        if !order.is_nan() && corners.iter().any(|corner| corner.judged.verdict != verdict) {
            found.judged = self.without_digits(found.judged);
        }
        if let Ok(bar) = &mut found.bar {
            for other in corners.iter().filter_map(|corner| corner.bar.as_ref().ok()) {
                bar.limit = [bar.limit[0].min(other.limit[0]), bar.limit[1].max(other.limit[1])];
            }
        }
        found
    }

    /// Uncertainty from the last places of an error and of its step, in the unit of the error.
    fn half(&self, k: usize, order: f64) -> f64 {
        let Level { step, error } = self.levels[k];
        self.halves[k] + error.abs() * order.max(0.0) * self.step_halves[k] / step
    }

    /// The numbers that may have been rounded to the finest ones: each unchanged, or half a unit more or less.
    fn corners(&self, order: f64) -> Vec<Vec<Level>> {
        let mut corners = vec![self.levels.clone()];
        for k in self.levels.len().saturating_sub(FINEST)..self.levels.len() {
            let half = self.half(k, order);
            let moved = |by: f64| {
                let mut levels = corners.clone();
                levels.iter_mut().for_each(|levels| levels[k].error += by);
                levels
            };
            if half > NOTHING * self.levels[k].error.abs() && half.is_finite() {
                corners = [moved(0.0), moved(-half), moved(half)].concat();
            }
        }
        corners
    }

    fn without_digits(&self, judged: RateVerdict) -> RateVerdict {
        let last = self.levels.len() - 1;
        let share = self.halves[last] / self.levels[last].error.abs();
        let digits = (-(2.0 * share).log10()).clamp(0.0, 16.0).floor() as usize + 1;
        let is_step = judged.order * self.step_halves[last] / self.levels[last].step > share;
        let what = if is_step { "the steps have too few digits".to_owned() } else { counted(digits, "digit") };
        judged.with_reason(Reason::Digits, &format!("{what}: print more"))
    }
}
