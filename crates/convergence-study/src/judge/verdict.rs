//! From observed errors to pass, fail or inconclusive, by one rule that knows neither the norm nor the scheme.
//!
//! # The rule
//!
//! An order claimed by theory is confirmed when the rate at h → 0 lies within a tolerance of it. That rate is known as an interval
//! only, [`rate_interval`], so there are three outcomes, and equivalence is what has to be shown:
//!
//! ```text
//!     interval inside   [order - tolerance, order + tolerance]   pass
//!     interval outside  (no point in common)                     fail: too low or too high
//!     otherwise                                                  inconclusive
//! ```
//!
//! So ignorance never passes: fewer levels, more scatter or more pollution widen the interval. It also follows that a scheme
//! whose true order lies outside the band passes only when its interval misses the truth, which happens at most in
//! one of 20 cases, and then only when it errs by enough and to the right side: at a true order 0.1 off and a tolerance of 0.05,
//! less than 1 in 100 ([`calibration`](crate::judge::calibration) measures it). Before the interval is asked, in this order:
//!
//! 1. an error that is NaN, infinite or negative fails: no norm of a sound computation has such a value;
//! 2. an error of exactly zero, steps that do not decrease, an order or a tolerance that mean nothing: inconclusive;
//! 3. fewer than [`FEWEST_LEVELS`] levels: inconclusive;
//! 4. an error that does not fall on the finest refinement above the round-off floor: fail, the scheme does not converge;
//! 5. rates that fall away from the order (see [`falls_away`]): fail, an inconsistency or a term of lower order shows;
//! 6. a pairwise rate more than [`WILD`] away from the order anywhere down to the floor: inconclusive, the levels are not one family;
//! 7. [`asymptotic_range`] leaves fewer than [`FEWEST_LEVELS`]: inconclusive, for the reason that removed more of them;
//! 8. the rates move away on the finest refinement (see [`moves_away`]): inconclusive, whatever the fit says.
//!
//! Why not simply an interval about the slope of a straight line: convergence data are smooth and bend. The rates 0.93, 0.96, 0.98, 0.99
//! have the limit 1, while a straight line says 0.966 ± 0.022, which excludes it.

use thiserror::Error;

pub use crate::judge::fit::Level;
use crate::judge::fit::{
    AsymptoticRange, Quantiles, asymptotic_range, extrapolated_rate, pairwise_rates, rate_interval,
};

mod outcome;

pub use outcome::{RateVerdict, Reason, Verdict};

/// Two rates and one difference of them: with less, nothing tells a rate from chance.
pub const FEWEST_LEVELS: usize = 3;

/// Tolerances must stay below: half the distance between two integer orders accepts either.
pub const WIDEST_TOLERANCE: f64 = 0.5;

/// Distance from the order beyond which a pairwise rate is no pre-asymptotic effect: an error that falls 32 times faster or
/// slower than theory when the step is halved is a different solution, not a worse one.
pub const WILD: f64 = 5.0;

/// Round-off floor of errors of quantities of order 1, some hundred rounding errors: the default of [`Judge`].
pub const ROUND_OFF_FLOOR: f64 = 1e-13;

/// A setting of [`Judge`] under which no verdict would mean anything.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum JudgeError {
    /// See [`WIDEST_TOLERANCE`].
    #[error("tolerance = {0}: the tolerance is too wide to tell anything, allowed is less than 0.5")]
    ToleranceTooWide(f64),
    /// Zero, negative or NaN.
    #[error("tolerance = {0}: allowed is a number > 0")]
    ToleranceNotPositive(f64),
    /// Not between 0 and 1.
    #[error("confidence = {0}: allowed is 0 < confidence < 1")]
    Confidence(f64),
    /// Negative, infinite or NaN.
    #[error("floor = {0}: allowed is a finite number >= 0")]
    Floor(f64),
}

/// The rule with its settings; make one and use it for many rates.
#[derive(Debug, Clone, PartialEq)]
pub struct Judge {
    tolerance: f64,
    floor: f64,
    quantiles: Quantiles,
}

impl Judge {
    /// The rule at 95 % confidence and with the floor [`ROUND_OFF_FLOOR`].
    ///
    /// * `tolerance`: half-width of the band about the order, 0 < tolerance < [`WIDEST_TOLERANCE`].
    pub fn new(tolerance: f64) -> Result<Self, JudgeError> {
        if tolerance >= WIDEST_TOLERANCE {
            return Err(JudgeError::ToleranceTooWide(tolerance));
        }
        if tolerance <= 0.0 || tolerance.is_nan() {
            return Err(JudgeError::ToleranceNotPositive(tolerance));
        }
        let quantiles = Quantiles::new(0.95).ok_or(JudgeError::Confidence(0.95))?;
        Ok(Self { tolerance, floor: ROUND_OFF_FLOOR, quantiles })
    }

    /// The same rule with another confidence of the interval.
    pub fn with_confidence(self, confidence: f64) -> Result<Self, JudgeError> {
        let quantiles = Quantiles::new(confidence).ok_or(JudgeError::Confidence(confidence))?;
        Ok(Self { quantiles, ..self })
    }

    /// The same rule with another round-off floor, in the unit of the errors; 0 drops no level.
    ///
    /// It has to be known beforehand. See [`asymptotic_range`] for why it is not read off the data.
    pub fn with_floor(self, floor: f64) -> Result<Self, JudgeError> {
        if floor >= 0.0 && floor.is_finite() { Ok(Self { floor, ..self }) } else { Err(JudgeError::Floor(floor)) }
    }

    /// Half-width of the band about the order.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Judges the levels, coarsest first, against the order that theory claims.
    pub fn judge(&self, levels: &[Level], order: f64) -> RateVerdict {
        let blank = RateVerdict::blank(levels, order, self.tolerance);
        if let Some(reason) = unusable(levels, order) {
            return blank.because(reason);
        }
        let range = asymptotic_range(levels, self.floor);
        if let Some(reason) = not_convergent(levels, &range, order) {
            return blank.because(reason);
        }
        let used = &levels[range.used.clone()];
        let Some(fit) = rate_interval(used, &self.quantiles) else {
            return blank.because(Reason::TooFewLevels);
        };
        let reason = if moves_away(&pairwise_rates(used), self.tolerance) {
            Reason::NotAsymptotic
        } else {
            self.compare(fit.interval, order)
        };
        let extrapolated = extrapolated_rate(used);
        RateVerdict { fitted: Some(fit.rate), interval: Some(fit.interval), extrapolated, used: range.used, ..blank }
            .because(reason)
    }

    /// The same for (step, error) pairs from anywhere, a CSV file for example.
    pub fn judge_pairs(&self, pairs: impl IntoIterator<Item = (f64, f64)>, order: f64) -> RateVerdict {
        let levels: Vec<Level> = pairs.into_iter().map(|(step, error)| Level { step, error }).collect();
        self.judge(&levels, order)
    }

    /// The interval against the band.
    fn compare(&self, [low, high]: [f64; 2], order: f64) -> Reason {
        let (least, most) = (order - self.tolerance, order + self.tolerance);
        if least <= low && high <= most {
            Reason::Agrees
        } else if high < least {
            Reason::TooLow
        } else if low > most {
            Reason::TooHigh
        } else if high - low > 2.0 * self.tolerance {
            Reason::IntervalTooWide
        } else {
            Reason::AtTheEdge
        }
    }
}

/// Judges with the default settings of [`Judge`]; a tolerance that [`Judge::new`] refuses is inconclusive.
pub fn judge(levels: &[Level], order: f64, tolerance: f64) -> RateVerdict {
    match Judge::new(tolerance) {
        Ok(judge) => judge.judge(levels, order),
        Err(JudgeError::ToleranceTooWide(_)) => {
            RateVerdict::blank(levels, order, tolerance).because(Reason::ToleranceTooWide)
        }
        Err(_) => RateVerdict::blank(levels, order, tolerance).because(Reason::ClaimUnusable),
    }
}

/// [`judge`] for (step, error) pairs.
pub fn judge_pairs(pairs: impl IntoIterator<Item = (f64, f64)>, order: f64, tolerance: f64) -> RateVerdict {
    let levels: Vec<Level> = pairs.into_iter().map(|(step, error)| Level { step, error }).collect();
    judge(&levels, order, tolerance)
}

/// Steps 1 to 3 of the rule: what makes rates impossible to form.
fn unusable(levels: &[Level], order: f64) -> Option<Reason> {
    let step_usable = |level: &Level| level.step > 0.0 && level.step.is_finite();
    let decreasing = levels.iter().all(step_usable) && levels.windows(2).all(|pair| pair[1].step < pair[0].step);
    if levels.iter().any(|level| !level.error.is_finite()) {
        Some(Reason::NonFiniteError)
    } else if levels.iter().any(|level| level.error < 0.0) {
        Some(Reason::NegativeError)
    } else if !(order > 0.0 && order.is_finite()) {
        Some(Reason::ClaimUnusable)
    } else if levels.len() < FEWEST_LEVELS {
        Some(Reason::TooFewLevels)
    } else if levels.iter().any(|level| level.error == 0.0) {
        Some(Reason::ZeroError)
    } else if !decreasing {
        Some(Reason::StepsNotDecreasing)
    } else {
        None
    }
}

/// Steps 4 to 7 of the rule.
fn not_convergent(levels: &[Level], range: &AsymptoticRange, order: f64) -> Option<Reason> {
    let all = pairwise_rates(levels);
    // The step down to the floor is a rate like any other for being wild; those between levels at the floor mean nothing.
    let down_to_floor = &all[..all.len().min(range.used.end)];
    let rates = &all[..range.used.end.saturating_sub(1)];
    if rates.last().is_some_and(|finest| *finest <= 0.0) {
        Some(Reason::ErrorGrows)
    } else if falls_away(rates, order) {
        Some(Reason::FallsAway)
    } else if down_to_floor.iter().any(|rate| (rate - order).abs() > WILD) {
        Some(Reason::WildRate)
    } else if range.used.len() >= FEWEST_LEVELS {
        None
    } else if range.at_floor >= range.pre_asymptotic {
        Some(Reason::RoundOffFloor)
    } else {
        Some(Reason::NotAsymptotic)
    }
}

/// Whether the rates fell on each of the last two refinements and ended more than half an order below the claim.
///
/// Pollution fades, so it does the contrary. Errors that level off above the round-off floor do this, which is what a coefficient that differs
/// between the scheme and the sources leads to; dropping the levels where it shows would hide it.
pub fn falls_away(rates: &[f64], order: f64) -> bool {
    match rates {
        [.., before, middle, finest] => before > middle && middle > finest && *finest < order - 0.5,
        _ => false,
    }
}

/// Whether the finest change of the rate is larger than every earlier one and than half the tolerance.
///
/// Changes shrink by ratio^-r where pollution fades. Where they grow, a term of lower order is emerging from below: the rates 2, 2, 1.98, 1.94
/// are on their way to 1, however well 2 fits.
pub fn moves_away(rates: &[f64], tolerance: f64) -> bool {
    let changes: Vec<f64> = rates.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    match changes.split_last() {
        Some((finest, earlier)) if !earlier.is_empty() => {
            *finest > 0.5 * tolerance && earlier.iter().all(|change| change < finest)
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_is_compared_with_its_ends_and_those_of_the_band() {
        let judge = Judge::new(0.25).expect("a tolerance");
        for (interval, reason) in [
            ([0.75, 1.25], Reason::Agrees),
            ([0.875, 1.0], Reason::Agrees),
            ([0.5, 0.625], Reason::TooLow),
            ([1.375, 1.5], Reason::TooHigh),
            // They share a point with the band.
            ([0.5, 0.75], Reason::AtTheEdge),
            ([1.25, 1.5], Reason::AtTheEdge),
            ([0.5, 1.0], Reason::AtTheEdge),
            ([1.0, 1.5], Reason::AtTheEdge),
            ([0.5, 1.0625], Reason::IntervalTooWide),
            ([0.5, 1.5], Reason::IntervalTooWide),
        ] {
            assert_eq!(judge.compare(interval, 1.0), reason, "{interval:?}");
        }
    }
}
