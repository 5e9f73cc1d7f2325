//! The rate of the differences, judged by the rule, and the error bar that follows from it.

use std::f64::consts::SQRT_2;

use thiserror::Error;

use super::{Gci, StepValue, growth, observed_order, repeated_value};
use crate::fit::{FLOOR_MARGIN, Level, RateInterval};
use crate::interval::Interval;
use crate::verdict::{FEWEST_LEVELS, Judge, JudgeError, RateVerdict, Reading, Reason, observe};

/// The least uncertainty of the only rate of three values: half the distance between two integer
/// orders.
pub const DOUBT_OF_A_SINGLE_RATE: f64 = 0.5;

/// Round-off of a value of size 1 that was summed over a mesh, like
/// [`ROUND_OFF_FLOOR`](crate::verdict::ROUND_OFF_FLOOR).
const ROUND_OFF: f64 = 1e-13;

/// Ratios that differ by less are equal.
const SAME_RATIO: f64 = 1e-9;

/// Range searched for the rate of values with unequal ratios.
pub(crate) const RATES: Interval = Interval {
    low: 1e-2,
    high: 64.0,
};

/// Why there is no error bar.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum NoErrorBar {
    /// Fewer than three.
    #[error("{0} values; three are the fewest that tell an order")]
    TooFewValues(usize),
    /// NaN or infinite.
    #[error("a value is not finite")]
    NotFinite,
    /// Steps that are not positive, finite and decreasing.
    #[error("{}", Reason::StepsNotDecreasing.text())]
    Steps,
    /// A difference is zero.
    #[error("the values of two neighbouring levels do not differ")]
    NoChange,
    /// The finest difference is at round-off.
    #[error(
        "the finest values differ by {difference:.1e}, no more than the round-off floor of {floor:.1e}"
    )]
    RoundOff {
        /// Size of the finest difference.
        difference: f64,
        /// The floor, which it must exceed.
        floor: f64,
    },
    /// The differences change sign.
    #[error("the values oscillate: their differences change sign")]
    Oscillating,
    /// The differences do not fall.
    #[error("the values diverge: their differences do not fall")]
    Diverging,
    /// The rule says that the differences are not asymptotic.
    #[error("the rule refuses the differences: {}", .0.text())]
    NotAsymptotic(Reason),
    /// Some rate in the interval is not positive, so there may be no limit.
    #[error("the rate may be as low as {0:.3}: nothing bounds the error")]
    RateMayBeZero(f64),
}

/// The error bar of the finest value.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Bar {
    /// Observed rate at h → 0.
    pub rate: f64,
    /// Its interval: that of the rule; for three values [`DOUBT_OF_A_SINGLE_RATE`] below and above
    /// both the rate and the order claimed.
    pub rate_interval: Interval,
    /// Estimated error of the finest value, finest value - limit: it has a sign.
    pub error: f64,
    /// The interval of the error.
    pub error_interval: Interval,
    /// The limit: finest value - error.
    pub extrapolated: f64,
    /// The interval of the limit.
    pub limit: Interval,
}

/// What values say about their limit.
#[derive(Debug, Clone, PartialEq)]
#[must_use = "an estimate that is not read lets a lost order pass"]
pub struct Estimate {
    /// The rule's judgement of the reduced differences. Its level k, from 0, is the difference of
    /// the values k and k + 1.
    pub judged: RateVerdict,
    /// The bar of the finest value.
    pub bar: Result<Bar, NoErrorBar>,
    /// Roache's index for it.
    pub gci: Result<Gci, NoErrorBar>,
}

/// The rule for values, with its settings.
///
/// ```
/// use convergence_judge::{Estimator, JudgeError, StepValue};
///
/// // They tend to 1 with the order 2.
/// let values = [0.4, 0.2, 0.1, 0.05].map(|step| StepValue { step, value: 1.0 + 0.3 * step * step });
/// let estimate = Estimator::new(0.1)?.estimate(&values, 2.0);
/// let bar = estimate.bar.expect("the differences fall");
/// assert!(estimate.judged.verdict.is_pass());
/// assert!(bar.limit.holds(1.0));
/// let gci = estimate.gci.expect("the differences fall");
/// assert!(gci.half_width >= bar.error.abs());
/// # Ok::<(), JudgeError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[must_use = "a rule decides nothing until it is given values"]
pub struct Estimator {
    judge: Judge,
    floor: Option<f64>,
}

impl Estimator {
    /// * `tolerance`: half-width of the band about the order, as for errors.
    ///
    /// # Errors
    /// [`JudgeError`] for a meaningless tolerance.
    pub fn new(tolerance: f64) -> Result<Self, JudgeError> {
        Ok(Self {
            judge: Judge::new(tolerance)?,
            floor: None,
        })
    }

    /// Differences up to this floor are not used. The default is [`FLOOR_MARGIN`] times 1e-13 of
    /// the largest value.
    ///
    /// For values printed with six digits, set a thousand units of the sixth.
    ///
    /// # Errors
    /// [`JudgeError::Floor`] for a negative or infinite one.
    pub fn with_floor(self, floor: f64) -> Result<Self, JudgeError> {
        let judge = self.judge.clone().with_floor(floor)?;
        Ok(Self {
            judge,
            floor: Some(floor),
        })
    }

    /// Estimates the error of the finest of the values, coarsest first.
    ///
    /// * `order`: claimed by theory.
    pub fn estimate(&self, values: &[StepValue], order: f64) -> Estimate {
        let judge = self.judge_of(values);
        let floor = judge.floor();
        let levels = differences(&judge, values, order);
        let mut reading = judge.read(&levels).of_differences();
        let mut judged = judge.judge_read(&reading, order);
        if judged.verdict.is_pass() && values.len() > FEWEST_LEVELS && !have_one_ratio(values) {
            judged = judge_both(&judge, &mut reading, &reduce(values, order), order);
        }
        let repeated = repeated_value(values, order, floor).filter(|_| judged.verdict.is_pass());
        let judged = match repeated {
            Some(level) => judged.with_repeated(level),
            None => judged,
        };
        let scatter = reading.fit.map_or(0.0, |fit| fit.scatter);
        let usable = if order > 0.0 && order.is_finite() {
            check_difference(values, floor)
        } else {
            Err(NoErrorBar::NotAsymptotic(Reason::ClaimUnusable))
        };
        let bar = usable.and_then(|()| bar(values, &judged, scatter, floor / FLOOR_MARGIN));
        let gci = usable.and_then(|()| Gci::of(values, order, judge.tolerance()));
        Estimate { judged, bar, gci }
    }

    /// The same without a claimed order: limit and index use the observed one, and nothing is
    /// confirmed.
    pub fn estimate_unclaimed(&self, values: &[StepValue]) -> Estimate {
        let judge = self.judge_of(values);
        let judged = observe(&differences(&judge, values, 1.0), judge.as_floor());
        let observed = judged.fitted.or_else(|| observed_order(values).ok());
        let observed = observed.filter(|rate| *rate > 0.0).unwrap_or(1.0);
        Estimate {
            judged,
            ..self.estimate(values, observed)
        }
    }

    /// The rule with the floor that is set, or else that of these values.
    fn judge_of(&self, values: &[StepValue]) -> Judge {
        let largest = values
            .iter()
            .map(|level| level.value.abs())
            .filter(|size| size.is_finite())
            .fold(0.0, f64::max);
        let floor = self.floor.unwrap_or(FLOOR_MARGIN * ROUND_OFF * largest);
        // A finite number >= 0, which no judge refuses.
        let judge = self.judge.clone().with_floor(floor);
        judge.unwrap_or_else(|_| self.judge.clone())
    }
}

/// Whether there is a difference to extrapolate from.
fn check_difference(values: &[StepValue], floor: f64) -> Result<(), NoErrorBar> {
    let [.., before, finest] = values else {
        return Err(NoErrorBar::TooFewValues(values.len()));
    };
    let difference = (before.value - finest.value).abs();
    let steps_are_positive = values
        .iter()
        .all(|level| level.step > 0.0 && level.step.is_finite());
    let some_step_grows = values.windows(2).any(|pair| pair[1].step >= pair[0].step);
    if values.iter().any(|level| !level.value.is_finite()) {
        Err(NoErrorBar::NotFinite)
    } else if !steps_are_positive || some_step_grows {
        Err(NoErrorBar::Steps)
    } else if values.len() < FEWEST_LEVELS {
        Err(NoErrorBar::TooFewValues(values.len()))
    } else if difference == 0.0 {
        Err(NoErrorBar::NoChange)
    } else if difference <= floor {
        Err(NoErrorBar::RoundOff { difference, floor })
    } else {
        Ok(())
    }
}

/// The differences as errors of this order at steps between those of the values; see the
/// [module](super). The finest is as it is, at the finest step.
///
/// With one ratio for all levels these are the differences, each at the finer of its steps.
pub(crate) fn reduce(values: &[StepValue], rate: f64) -> Vec<Level> {
    let pairs = || values.windows(2);
    let size = |pair: &[StepValue]| (pair[0].value - pair[1].value).abs();
    if have_one_ratio(values) {
        let at_finer = pairs().map(|pair| Level {
            step: pair[1].step,
            error: size(pair),
        });
        return at_finer.collect();
    }
    // x_k over the finer step, and the difference over the error at x_k.
    let shape = |ratio: f64| {
        let x = growth(ratio, rate + 1.0) / growth(ratio, rate);
        (x, growth(ratio, rate) / x.powf(rate))
    };
    let shapes: Vec<(f64, f64)> = step_ratios(values).into_iter().map(shape).collect();
    let (last_x, last_size) = shapes.last().copied().unwrap_or((1.0, 1.0));
    let levels = pairs().zip(&shapes).map(|(pair, (x, of_error))| Level {
        step: pair[1].step * (x / last_x),
        error: size(pair) * (last_size / of_error),
    });
    levels.collect()
}

/// Whether each step is the same part of the one before.
pub(crate) fn have_one_ratio(values: &[StepValue]) -> bool {
    let ratios = step_ratios(values);
    let mut pairs = ratios.windows(2);
    pairs.all(|pair| (pair[0] / pair[1] - 1.0).abs() <= SAME_RATIO)
}

/// The verdict on a claim of differences reduced with the rate read, where they pass, and with that
/// claimed: both must pass, in the interval that holds both intervals, which the reading then has.
pub(crate) fn judge_both(
    judge: &Judge,
    reading: &mut Reading<'_>,
    at_order: &[Level],
    order: f64,
) -> RateVerdict {
    let mut at_order = judge.read(at_order).of_differences();
    unite([&mut reading.fit, &mut at_order.fit]);
    let judged = judge.judge_read(reading, order);
    let doubted = judge.judge_read(&at_order, order);
    if judged.verdict.is_pass() && !doubted.verdict.is_pass() {
        doubted
    } else {
        judged
    }
}

/// Gives both rates the interval that holds theirs.
fn unite([one, other]: [&mut Option<RateInterval>; 2]) {
    if let (Some(one), Some(other)) = (one, other) {
        let interval = one.interval.hull(other.interval);
        for fit in [one, other] {
            fit.rate = 0.5 * (interval.low + interval.high);
            fit.interval = interval;
        }
    }
}

/// The ratio of each step to the next.
fn step_ratios(values: &[StepValue]) -> Vec<f64> {
    let pairs = values.windows(2);
    pairs.map(|pair| pair[0].step / pair[1].step).collect()
}

/// The reduced differences, reduced with the rate that they then have.
fn differences(judge: &Judge, values: &[StepValue], order: f64) -> Vec<Level> {
    let start = if order > 0.0 { order } else { 1.0 };
    if have_one_ratio(values) {
        return reduce(values, start);
    }
    let excess = |rate: f64| Some(judge.read(&reduce(values, rate)).fit?.rate - rate);
    let rate = match values {
        // Two differences make no fit, but have one rate.
        [_, _, _] => observed_order(values).ok(),
        _ => crossing(excess, RATES),
    };
    reduce(values, rate.unwrap_or(start))
}

/// The zero of a function that falls from above zero to below it, by false position (Illinois);
/// `None` if it has no value.
pub(crate) fn crossing(f: impl Fn(f64) -> Option<f64>, within: Interval) -> Option<f64> {
    let Interval { mut low, mut high } = within;
    let mut above = f(low)?;
    let mut below = f(high)?;
    let mut middle = low;
    for _ in 0..60 {
        let next = low + (high - low) * above / (above - below);
        if (next - middle).abs() <= 1e-12 || !next.is_finite() {
            break;
        }
        middle = next;
        let value = f(middle)?;
        if value > 0.0 {
            low = middle;
            above = value;
            below *= 0.5;
        } else {
            high = middle;
            below = value;
            above *= 0.5;
        }
    }
    Some(middle)
}

/// Whether the interval of the rule means something: its reason may concern the claim, but not the
/// levels.
fn check_reason(reason: Reason) -> Result<(), NoErrorBar> {
    match reason {
        Reason::Agrees
        | Reason::TooLow
        | Reason::TooHigh
        | Reason::IntervalTooWide
        | Reason::AtTheEdge => Ok(()),
        Reason::ErrorGrows => Err(NoErrorBar::Diverging),
        Reason::ZeroError => Err(NoErrorBar::NoChange),
        other => Err(NoErrorBar::NotAsymptotic(other)),
    }
}

/// An observed rate.
struct ObservedRate {
    rate: f64,
    interval: Interval,
}

/// Whether no two neighbouring differences have opposite signs.
fn have_one_sign(differences: &[f64]) -> bool {
    let mut pairs = differences.windows(2);
    pairs.all(|pair| pair[0] * pair[1] >= 0.0)
}

/// The rate of differences that fall as the rule requires, without a change of sign.
fn observed_rate(values: &[StepValue], judged: &RateVerdict) -> Result<ObservedRate, NoErrorBar> {
    let differences: Vec<f64> = values
        .windows(2)
        .map(|pair| pair[0].value - pair[1].value)
        .collect();
    if !have_one_sign(&differences[differences.len() - 2..]) {
        return Err(NoErrorBar::Oscillating);
    }
    let Some(interval) = judged.interval else {
        if values.len() > FEWEST_LEVELS {
            check_reason(judged.code)?;
            return Err(NoErrorBar::NotAsymptotic(judged.code));
        }
        let rate = observed_order(values)?;
        let order = judged.order().unwrap_or(rate);
        return Ok(ObservedRate {
            rate,
            interval: Interval {
                low: rate.min(order) - DOUBT_OF_A_SINGLE_RATE,
                high: rate.max(order) + DOUBT_OF_A_SINGLE_RATE,
            },
        });
    };
    check_reason(judged.code)?;
    if !have_one_sign(&differences[judged.used.clone()]) {
        return Err(NoErrorBar::Oscillating);
    }
    Ok(ObservedRate {
        rate: 0.5 * (interval.low + interval.high),
        interval,
    })
}

/// The bar of the finest value.
///
/// * `scatter`: of the logarithm of the last difference, as in
///   [`RateInterval`](crate::fit::RateInterval).
/// * `round_off`: of a value.
fn bar(
    values: &[StepValue],
    judged: &RateVerdict,
    scatter: f64,
    round_off: f64,
) -> Result<Bar, NoErrorBar> {
    let ObservedRate {
        rate,
        interval: rate_interval,
    } = observed_rate(values, judged)?;
    if rate_interval.low <= 0.0 {
        return Err(NoErrorBar::RateMayBeZero(rate_interval.low));
    }
    let [before, finest] = [values[values.len() - 2], values[values.len() - 1]];
    let difference = before.value - finest.value;
    let ratio = before.step / finest.step;
    let size = |rate: f64| difference.abs() / growth(ratio, rate);
    // If the difference of two values scatters by S, the distance of Richardson's estimate from the
    // error scatters by this.
    let power = ratio.powf(rate);
    let scatter = scatter * SQRT_2 * power / power.hypot(1.0);
    let rounding = round_off * (1.0 + 2.0 / growth(ratio, rate_interval.low));
    // A higher rate gives a smaller error.
    let least = size(rate_interval.high) * (-scatter).exp() - rounding;
    let most = size(rate_interval.low) * scatter.exp() + rounding;
    let error = size(rate).copysign(difference);
    let error_interval = if difference > 0.0 {
        Interval {
            low: least,
            high: most,
        }
    } else {
        Interval {
            low: -most,
            high: -least,
        }
    };
    let limit = Interval {
        low: finest.value - error_interval.high,
        high: finest.value - error_interval.low,
    };
    Ok(Bar {
        rate,
        rate_interval,
        error,
        error_interval,
        extrapolated: finest.value - error,
        limit,
    })
}
