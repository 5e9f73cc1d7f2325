//! Printed digits: the part that rounding hides decides nothing.

use crate::judge::claims::Claim;
use crate::judge::fit::{Level, asymptotic_range, pairwise_rates};
use crate::judge::richardson::{Estimate, Estimator, Value};
use crate::judge::verdict::{Cause, Judge, RateVerdict, Reason, Verdict};
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
    /// Judges the errors. The interval, whatever is claimed, is wider by as much as rounding moves
    /// the finest rate. If without rounding there would be a verdict, or if other digits could turn
    /// another verdict into a pass, the reason is missing digits.
    pub fn judge(&self, judge: &Judge, claim: &Claim) -> RateVerdict {
        let used = asymptotic_range(&self.levels, judge.floor()).end;
        let finest_rate = pairwise_rates(&self.levels[..used])
            .last()
            .copied()
            .unwrap_or(0.0);
        let share = |k: usize| {
            self.half(k, finest_rate) / self.levels[k].error.abs().max(f64::MIN_POSITIVE)
        };
        let is_exact = (0..self.levels.len()).all(|k| share(k) < NOTHING);
        let finest = self.levels[..used].windows(2).enumerate().next_back();
        let doubt = finest.map_or(0.0, |(k, pair)| {
            (share(k) + share(k + 1)) / (pair[0].step / pair[1].step).ln()
        });
        let doubt = if is_exact || !doubt.is_finite() {
            0.0
        } else {
            doubt
        };
        let mut judged = claim.judge_rounded(judge, &self.levels, doubt);
        let is_told = matches!(
            judged.kind,
            Reason::NonFiniteError | Reason::NegativeError | Reason::TooFewLevels
        );
        if is_exact || is_told || claim.order.is_nan() || judged.verdict == Verdict::Pass {
            return judged;
        }
        judged.cause = judged
            .cause
            .or_else(|| Cause::of(&self.levels[..used], claim.order, share));
        let corners = self.corners(finest_rate);
        let may_be = |verdict: Verdict| {
            corners
                .iter()
                .any(|levels| claim.judge(judge, levels).verdict == verdict)
        };
        let is_undone = judged.verdict == Verdict::Inconclusive
            && claim.judge(judge, &self.levels).verdict != Verdict::Inconclusive;
        let is_poor = doubt > judge.tolerance()
            && (judged.verdict != Verdict::Fail || may_be(Verdict::Inconclusive));
        if is_undone || is_poor || may_be(Verdict::Pass) {
            self.without_digits(judged)
        } else {
            judged
        }
    }

    /// Judges the differences of the values, and estimates their limit.
    pub fn estimate(&self, estimator: &Estimator, order: f64) -> Estimate {
        let estimate = |levels: &Vec<Level>| {
            let value = |level: &Level| Value {
                step: level.step,
                value: level.error,
            };
            estimator.estimate(&levels.iter().map(value).collect::<Vec<_>>(), order)
        };
        let mut found = estimate(&self.levels);
        let rate = found.judged.finest_rate().unwrap_or(0.0);
        let corners: Vec<Estimate> = self.corners(rate).iter().map(estimate).collect();
        let verdict = found.judged.verdict;
        if !order.is_nan()
            && corners
                .iter()
                .any(|corner| corner.judged.verdict != verdict)
        {
            found.judged = self.without_digits(found.judged);
        }
        if let Ok(bar) = &mut found.bar {
            for other in corners.iter().filter_map(|corner| corner.bar.as_ref().ok()) {
                bar.limit = [
                    bar.limit[0].min(other.limit[0]),
                    bar.limit[1].max(other.limit[1]),
                ];
            }
        }
        found
    }

    /// Uncertainty from the last places of an error and of its step, in the unit of the error.
    ///
    /// * `rate`: with which the error changes with the step.
    fn half(&self, k: usize, rate: f64) -> f64 {
        let Level { step, error } = self.levels[k];
        self.halves[k] + error.abs() * rate.max(0.0) * self.step_halves[k] / step
    }

    /// The numbers that may have been rounded to the finest ones: each unchanged, or half a unit
    /// more or less.
    fn corners(&self, rate: f64) -> Vec<Vec<Level>> {
        let mut corners = vec![self.levels.clone()];
        for k in self.levels.len().saturating_sub(FINEST)..self.levels.len() {
            let half = self.half(k, rate);
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
        let rate = judged.finest_rate().unwrap_or(0.0);
        let is_step = rate * self.step_halves[last] / self.levels[last].step > share;
        let what = if is_step {
            "the steps have too few digits".to_owned()
        } else {
            counted(digits, "digit")
        };
        judged.with_reason(Reason::Digits, &format!("{what}: print more"))
    }
}
