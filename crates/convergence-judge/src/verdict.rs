//! [grid]: crate::grid
// The link above is for rustdoc, that at the end of RULE.md for readers of that file.
#![doc = include_str!("verdict/RULE.md")]

use thiserror::Error;

pub use crate::fit::Level;

mod cause;
mod digits;
mod floor;
mod lower_order;
mod outcome;
mod reading;
mod reason;
mod repeats;
mod samples;
mod scatter;
mod tendency;
#[cfg(test)]
mod tests;
mod trend;
mod words;

pub use cause::Cause;
pub(crate) use cause::line;
pub use digits::{doubt_of_finest, halves_of_answers, last_place, significant_digits};
pub use floor::Floor;
pub(crate) use lower_order::squares;
pub use outcome::{Band, PowerLaw, RateVerdict, against_claim, judged_in_words};
pub use reading::{Printed, Reading};
pub use reason::Reason;
pub use repeats::are_equal;
pub use samples::{FEWEST_NUMBERS, Of, Samples};
pub use tendency::Tendency;
pub use trend::Rates;
pub use words::{Aside, SetAside, Verdict};

/// Two rates and one difference of them: with fewer, nothing tells a rate from chance.
pub const FEWEST_LEVELS: usize = 3;

/// Upper bound on tolerances: half the distance between two integer orders would accept either.
pub const WIDEST_TOLERANCE: f64 = 0.5;

/// Half a step between the orders of theory, which are multiples of a half: it tells 2 from 1.5 and
/// from 2.5.
pub const DEFAULT_TOLERANCE: f64 = 0.25;

/// Least ratio of the coarsest step to the finest: on narrower meshes a term of another order
/// changes no rate.
pub const LEAST_SPAN: f64 = 1.5;

/// A setting of [`Judge`] that would make every verdict meaningless.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum JudgeError {
    /// See [`WIDEST_TOLERANCE`].
    #[error("tolerance = {0}: the tolerance is too wide to tell anything, expected less than 0.5")]
    ToleranceTooWide(f64),
    /// Zero, negative or NaN.
    #[error("tolerance = {0}: expected a number > 0")]
    ToleranceNotPositive(f64),
    /// Negative, infinite or NaN.
    #[error("floor = {0}: expected a finite number >= 0")]
    Floor(f64),
    /// Zero, negative, infinite or NaN.
    #[error("{0} = {1}: expected a finite number > 0")]
    RoundOff(&'static str, f64),
}

/// The rule with its settings; make one and use it for many rates.
///
/// ```
/// use convergence_judge::{JudgeError, Level, Reason, verdict::Judge};
///
/// let judge = Judge::new(0.1)?;
/// let steps = [0.4, 0.2, 0.1, 0.05];
/// let levels = steps.map(|step| Level { step, error: 3.0 * step * step });
/// assert_eq!(judge.judge(&levels, 2.0).code, Reason::Agrees);
///
/// // Levels that are read once can be held against several claims.
/// let reading = judge.read(&levels);
/// assert_eq!(judge.judge_read(&reading, 1.5).code, Reason::TooHigh);
/// assert!(!judge.decide(&reading, 3.0).is_pass());
///
/// assert_eq!(Judge::new(0.7), Err(JudgeError::ToleranceTooWide(0.7)));
/// # Ok::<(), JudgeError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[must_use = "a rule decides nothing until it is given errors"]
pub struct Judge {
    tolerance: f64,
    floor: Floor,
}

impl Default for Judge {
    /// The rule with [`DEFAULT_TOLERANCE`] and without a floor.
    fn default() -> Self {
        Self {
            tolerance: DEFAULT_TOLERANCE,
            floor: Floor::NONE,
        }
    }
}

impl Judge {
    /// The rule without a floor: multiplying all errors by a number changes neither verdict nor
    /// interval.
    ///
    /// * `tolerance`: half-width of the band about the order, 0 < tolerance < [`WIDEST_TOLERANCE`].
    pub fn new(tolerance: f64) -> Result<Self, JudgeError> {
        if tolerance >= WIDEST_TOLERANCE {
            return Err(JudgeError::ToleranceTooWide(tolerance));
        }
        if tolerance <= 0.0 || tolerance.is_nan() {
            return Err(JudgeError::ToleranceNotPositive(tolerance));
        }
        Ok(Self {
            tolerance,
            floor: Floor::NONE,
        })
    }

    /// The same rule with another [`Floor`], in the unit of the errors.
    pub fn with_floor(self, floor: f64) -> Result<Self, JudgeError> {
        let floor = Floor::new(floor)?;
        Ok(Self { floor, ..self })
    }

    /// Half-width of the band about the order.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The round-off.
    pub fn as_floor(&self) -> Floor {
        self.floor
    }

    /// Errors up to this one are not used.
    pub fn floor(&self) -> f64 {
        self.floor.value()
    }

    /// Judges the levels, coarsest first, against the order that theory claims.
    pub fn judge(&self, levels: &[Level], order: f64) -> RateVerdict {
        self.judge_read(&self.read(levels), order)
    }

    /// The same for levels that a judge with the same floor has [read](Self::read).
    pub fn judge_read(&self, reading: &Reading<'_>, order: f64) -> RateVerdict {
        self.judge_as(reading, order, reading.reason(order, self.tolerance))
    }

    /// The same with a reason found by another rule.
    pub(crate) fn judge_as(
        &self,
        reading: &Reading<'_>,
        order: f64,
        reason: Reason,
    ) -> RateVerdict {
        let tolerance = self.tolerance;
        RateVerdict::new(reading, Some(Band { order, tolerance }), reason)
    }

    /// What the levels, coarsest first, say by themselves. It depends on neither claim nor
    /// tolerance: [`Judge::judge_read`] and [`Judge::decide`] hold it against any claim, also those
    /// of judges with other tolerances.
    pub fn read<'a>(&self, levels: &'a [Level]) -> Reading<'a> {
        Reading::new(levels, self.floor)
    }

    /// The verdict alone on levels that a judge with the same floor has [read](Self::read).
    #[must_use = "a verdict that is not read lets a wrong claim pass"]
    pub fn decide(&self, reading: &Reading<'_>, order: f64) -> Verdict {
        reading.reason(order, self.tolerance).verdict()
    }
}

/// The rate of the levels, coarsest first, where nothing is claimed: nothing is confirmed.
pub fn observe(levels: &[Level], floor: Floor) -> RateVerdict {
    observe_printed(levels, floor, Printed::default())
}

/// The same for errors that were printed.
pub fn observe_printed(levels: &[Level], floor: Floor, printed: Printed<'_>) -> RateVerdict {
    let reading = Reading::new(levels, floor).printed(printed);
    RateVerdict::new(
        &reading,
        None,
        reading.defect().unwrap_or(Reason::NotClaimed),
    )
}

/// Judges levels, coarsest first, against an order within a tolerance; see [`Claim::judge`].
///
/// ```
/// use convergence_judge::{Level, Verdict, judge};
///
/// let levels = [0.4, 0.2, 0.1, 0.05].map(|step| Level { step, error: 0.3 * step });
/// assert_eq!(judge(&levels, 1.0, 0.1).verdict, Verdict::Pass);
/// assert_eq!(judge(&levels, 2.0, 0.1).verdict, Verdict::Fail);
/// ```
///
/// [`Claim::judge`]: crate::claims::Claim::judge
pub fn judge(levels: &[Level], order: f64, tolerance: f64) -> RateVerdict {
    let band = Band { order, tolerance };
    judge_band(&Reading::new(levels, Floor::NONE), band)
}

/// The verdict on a claim that may be unusable: then it is inconclusive, but the rate is still
/// given.
pub(crate) fn judge_band(reading: &Reading<'_>, band: Band) -> RateVerdict {
    let kind = match Judge::new(band.tolerance) {
        Ok(_) => reading.reason(band.order, band.tolerance),
        Err(JudgeError::ToleranceTooWide(_)) => Reason::ToleranceTooWide,
        Err(_) => Reason::ClaimUnusable,
    };
    RateVerdict::new(reading, Some(band), kind)
}

/// [`judge`] for (step, error) pairs in any order.
///
/// ```
/// use convergence_judge::{Reason, judge_pairs};
///
/// let rate = judge_pairs([(0.1, 0.03), (0.4, 0.48), (0.2, 0.12)], 2.0, 0.1);
/// assert!(rate.verdict.is_pass());
/// let twice = judge_pairs([(0.4, 0.48), (0.2, 0.12), (0.2, 0.12), (0.1, 0.03)], 2.0, 0.1);
/// assert_eq!(twice.code, Reason::StepsNotDecreasing);
/// ```
pub fn judge_pairs(
    pairs: impl IntoIterator<Item = (f64, f64)>,
    order: f64,
    tolerance: f64,
) -> RateVerdict {
    let mut levels: Vec<Level> = pairs
        .into_iter()
        .map(|(step, error)| Level { step, error })
        .collect();
    levels.sort_by(|one, other| other.step.total_cmp(&one.step));
    judge(&levels, order, tolerance)
}
