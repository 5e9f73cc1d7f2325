//! One error, or one value, over steps: of a table, or answered by a program or a function. All are
//! judged here. The part of printed numbers that rounding hides decides nothing.

use crate::text::number::counted;
use convergence_judge::Interval;
use convergence_judge::claims::Claim;
use convergence_judge::fit::{Level, asymptotic_range, pairwise_rates};
use convergence_judge::richardson::{Estimate, Estimator, StepValue};
use convergence_judge::verdict::{
    self, Cause, Floor, Printed, RateVerdict, Reason, Samples, Verdict,
};

#[cfg(test)]
mod tests;
mod together;

pub(crate) use together::{BoundaryLoss, EqualPair, INSIDE, MAX};

/// Rounding below this share of a number changes no verdict.
const NOTHING: f64 = 1e-9;
/// Changes of the finest levels, in half units, that move the finest rate, its change, the growth
/// of that, and the slope of a line most: a verdict that none of them changes is that of all
/// digits.
const SLOPES: [[f64; 4]; 4] = [
    [0.0, 0.0, 1.0, -1.0],
    [0.0, 1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0, -1.0],
    [1.0, 1.0, -1.0, -1.0],
];

/// A column of errors or of values, coarsest level first.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Column {
    /// Its name as shown.
    pub name: String,
    /// Steps and numbers.
    pub levels: Vec<Level>,
    /// Half a unit of the last printed place of each number; 0 if it is exact.
    pub halves: Vec<f64>,
    /// The same for the steps.
    pub step_halves: Vec<f64>,
    /// Whether an order that is claimed for all columns is claimed for it: the caller names it, or
    /// no other column.
    pub is_chosen: bool,
    /// The samples of which the numbers are errors, if they are.
    pub samples: Option<Samples>,
    /// Whether trailing zeros of the numbers may be lost, as those of answers are: then no number is
    /// known to repeat another one in more digits than it shows.
    pub(crate) may_lack_zeros: bool,
}

/// What rounding does to the rate of a column.
struct Rounding {
    /// Levels above the floor.
    used: usize,
    /// The rate between the finest of them.
    finest_rate: f64,
    /// Whether rounding changes nothing.
    is_exact: bool,
    /// By how much it may change the finest rate.
    doubt: f64,
}

impl Column {
    /// Numbers without rounding, as of functions.
    pub(crate) fn exact(name: &str, levels: Vec<Level>) -> Self {
        Self {
            name: name.to_owned(),
            halves: vec![0.0; levels.len()],
            step_halves: vec![0.0; levels.len()],
            levels,
            is_chosen: true,
            samples: None,
            may_lack_zeros: false,
        }
    }

    /// Numbers that a program has answered, of which trailing zeros are lost.
    pub(crate) fn of_answers(name: &str, levels: Vec<Level>) -> Self {
        let numbers: Vec<f64> = levels.iter().map(|level| level.error).collect();
        Self {
            halves: verdict::halves_of_answers(&numbers),
            may_lack_zeros: true,
            ..Self::exact(name, levels)
        }
    }

    /// Judges the errors. The interval, whatever is claimed, is wider by as much as rounding moves
    /// the finest rate. If without rounding there would be a verdict, or if other digits could turn
    /// another verdict into a pass, the reason is missing digits. Where the finest errors may be
    /// round-off, a floor that makes it pass is [offered](RateVerdict::offered_floor).
    pub fn judge(&self, claim: &Claim, floor: Floor) -> RateVerdict {
        if let Some(samples) = &self.samples {
            let steps: Vec<f64> = self.levels.iter().map(|level| level.step).collect();
            return claim.judge_samples(&steps, samples);
        }
        let judge = |floor: Floor| self.judge_above(claim, floor);
        judge(floor).offering(&self.levels, floor, judge)
    }

    fn judge_above(&self, claim: &Claim, floor: Floor) -> RateVerdict {
        let Rounding {
            used,
            finest_rate,
            is_exact,
            doubt,
        } = self.rounding(floor);
        let digits = self.digits();
        let printed = Printed {
            doubt,
            digits: &digits,
        };
        let mut judged = claim.judge_printed(&self.levels, floor, printed);
        let needs_no_digits = matches!(
            judged.code,
            Reason::NonFiniteError
                | Reason::NegativeError
                | Reason::TooFewLevels
                | Reason::Identical
                | Reason::Repeats
                | Reason::Alternates
                | Reason::NothingTested
        );
        if is_exact || needs_no_digits || judged.verdict == Verdict::Pass {
            return judged;
        }
        judged.cause = judged.cause.or_else(|| {
            Cause::of(&self.levels[..used], claim.order, |k| {
                self.share(k, finest_rate)
            })
        });
        let unprinted = |levels: &[Level]| claim.judge_printed(levels, floor, Printed::default());
        let possible: Vec<Verdict> = self
            .otherwise(used, finest_rate)
            .map(|levels| unprinted(&levels).verdict)
            .collect();
        let is_undone = judged.verdict == Verdict::Inconclusive
            && unprinted(&self.levels).verdict != Verdict::Inconclusive;
        let is_poor = doubt > claim.tolerance
            && (judged.verdict != Verdict::Fail || possible.contains(&Verdict::Inconclusive));
        if is_undone || is_poor || possible.contains(&Verdict::Pass) {
            self.without_digits(judged)
        } else {
            judged
        }
    }

    /// The rate of the errors where nothing is claimed: nothing is confirmed.
    pub fn observe(&self, floor: Floor) -> RateVerdict {
        let doubt = self.rounding(floor).doubt;
        verdict::observe_printed(&self.levels, floor, Printed { doubt, digits: &[] })
    }

    /// What rounding does to the rate of the errors above the floor.
    fn rounding(&self, floor: Floor) -> Rounding {
        let used = asymptotic_range(&self.levels, floor.value()).end;
        let finest_rate = pairwise_rates(&self.levels[..used])
            .last()
            .copied()
            .unwrap_or(0.0);
        let share = |k: usize| self.share(k, finest_rate);
        let is_exact = (0..self.levels.len()).all(|k| share(k) < NOTHING);
        let doubt = verdict::doubt_of_finest(&self.levels[..used], share);
        Rounding {
            used,
            finest_rate,
            is_exact,
            doubt: if is_exact { 0.0 } else { doubt },
        }
    }

    /// Judges the differences of the values, and estimates their limit. Both intervals hold those of
    /// other numbers that may have been rounded to the finest ones.
    ///
    /// * `order`: claimed by theory; without one, nothing is confirmed.
    pub fn estimate(&self, estimator: &Estimator, order: Option<f64>) -> Estimate {
        let mut estimate = estimated(estimator, &self.levels, order);
        let rate = estimate.judged.finest_rate().unwrap_or(0.0);
        let others: Vec<Estimate> = self
            .otherwise(self.levels.len(), rate)
            .map(|levels| estimated(estimator, &levels, order))
            .collect();
        let intervals = others.iter().filter_map(|other| other.judged.interval);
        if let Some(widest) = intervals.reduce(Interval::hull) {
            estimate.judged = estimate.judged.wider(widest);
        }
        let verdict = estimate.judged.verdict;
        if order.is_some() && others.iter().any(|other| other.judged.verdict != verdict) {
            estimate.judged = self.without_digits(estimate.judged);
        }
        if let Ok(bar) = &mut estimate.bar {
            for other in others.iter().filter_map(|other| other.bar.as_ref().ok()) {
                bar.rate_interval = bar.rate_interval.hull(other.rate_interval);
                bar.error_interval = bar.error_interval.hull(other.error_interval);
                bar.limit = bar.limit.hull(other.limit);
            }
        }
        estimate
    }

    /// The uncertainty of an error from its last place and that of its step, relative to the error.
    fn share(&self, k: usize, rate: f64) -> f64 {
        self.half(k, rate) / self.levels[k].error.abs().max(f64::MIN_POSITIVE)
    }

    /// The uncertainty from the last places of an error and of its step, in the unit of the error.
    ///
    /// * `rate`: how fast the error changes with the step.
    fn half(&self, k: usize, rate: f64) -> f64 {
        let Level { step, error } = self.levels[k];
        self.halves[k] + error.abs() * rate.max(0.0) * self.step_halves[k] / step
    }

    /// Numbers that may have been rounded to the finest of the levels up to `end`: along each of
    /// [`SLOPES`], to either side.
    fn otherwise(&self, end: usize, rate: f64) -> impl Iterator<Item = Vec<Level>> {
        let finest = end.saturating_sub(SLOPES.len())..end;
        let slopes = SLOPES
            .iter()
            .flat_map(|slope| [(slope, 1.0), (slope, -1.0)]);
        slopes.map(move |(slope, side)| {
            let mut levels = self.levels.clone();
            for (k, change) in finest.clone().rev().zip(slope.iter().rev()) {
                let half = Some(self.half(k, rate)).filter(|half| half.is_finite());
                levels[k].error += side * change * half.unwrap_or(0.0);
            }
            levels
        })
    }

    /// Whether another column has the same numbers, in all digits, and should not.
    fn equals(&self, other: &Self) -> bool {
        !together::may_be_equal(&self.name, &other.name)
            && verdict::are_equal(&self.levels, &other.levels, |level| self.digits_at(level))
    }

    /// The number of printed digits of each number; none where they are not known.
    fn digits(&self) -> Vec<usize> {
        let levels = 0..self.levels.len();
        let known = levels.filter(|_| !self.may_lack_zeros);
        known.map(|level| self.digits_at(level)).collect()
    }

    fn digits_at(&self, level: usize) -> usize {
        /// Against the rounding of a logarithm that is a whole number.
        const ROUND_OFF: f64 = 1e-9;
        let error = self.levels[level].error.abs();
        if self.halves[level] == 0.0 {
            return verdict::significant_digits(error);
        }
        let share = self.halves[level] / error;
        let digits = -(2.0 * share).log10() + ROUND_OFF;
        digits.clamp(0.0, 16.0).floor() as usize + 1
    }

    fn without_digits(&self, judged: RateVerdict) -> RateVerdict {
        let last = self.levels.len() - 1;
        let share = self.halves[last] / self.levels[last].error.abs();
        let digits = self.digits_at(last);
        let rate = judged.finest_rate().unwrap_or(0.0);
        let is_step = rate * self.step_halves[last] / self.levels[last].step > share;
        let what = if is_step {
            "the steps have too few digits".to_owned()
        } else {
            counted(digits, "digit")
        };
        judged.with_few_digits(&what)
    }
}

/// The limit of levels that hold values, for a claimed order or for the observed one.
fn estimated(estimator: &Estimator, levels: &[Level], order: Option<f64>) -> Estimate {
    let values = as_values(levels);
    match order {
        Some(order) => estimator.estimate(&values, order),
        None => estimator.estimate_unclaimed(&values),
    }
}

/// Levels that hold values in place of errors.
fn as_values(levels: &[Level]) -> Vec<StepValue> {
    levels
        .iter()
        .map(|level| StepValue {
            step: level.step,
            value: level.error,
        })
        .collect()
}
