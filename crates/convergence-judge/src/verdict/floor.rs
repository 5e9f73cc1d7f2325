//! Round-off: what the caller knows of it, and the floor that would make a claim pass, which is
//! offered and never taken.

use super::{JudgeError, Level, RateVerdict, Reason};
use crate::text::number::significant;

/// Floors that are offered, in units of round-off of the solution.
const OFFERED: [f64; 4] = [1e2, 1e3, 1e4, 1e5];
/// The finest error that is not zero is at most this many units where a floor is offered: a wrong
/// limit lies higher, and above a level that is its own reference nothing is near round-off.
const NEAR: f64 = 1e4;

/// Round-off, in the unit of the errors: fine levels with errors up to it are not used.
///
/// If the round-off is known, pass [`FLOOR_MARGIN`](crate::fit::FLOOR_MARGIN) times as much.
/// [`asymptotic_range`](crate::fit::asymptotic_range) says why it is not estimated from the
/// data. [`RateVerdict::set_aside`] names the levels.
///
/// ```
/// use convergence_judge::{Claim, Floor, JudgeError, Level, Reason};
///
/// let errors = [3.2e-8, 5.0e-10, 7.8e-12, 1.2e-13, 4.4e-16, 6.7e-16];
/// let level = |(k, error)| Level { step: 0.5_f64.powi(k), error };
/// let levels: Vec<Level> = (0..).zip(errors).map(level).collect();
/// let judged = Claim::new(6.0, 0.25).judge(&levels, Floor::NONE);
/// assert_eq!(judged.code, Reason::RoundOff);
/// let offered = Floor::new(judged.offered_floor.expect("a floor"))?;
/// assert!(Claim::new(6.0, 0.25).judge(&levels, offered).verdict.is_pass());
/// // The solution is small, and such errors are none of round-off.
/// let small = Floor::NONE.of_scale(1e-9)?;
/// assert_ne!(Claim::new(6.0, 0.25).judge(&levels, small).code, Reason::RoundOff);
/// # Ok::<(), JudgeError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    value: f64,
    /// The size of the solution.
    scale: f64,
    /// The relative round-off of a number.
    epsilon: f64,
}

impl Default for Floor {
    fn default() -> Self {
        Self::NONE
    }
}

impl Floor {
    /// Every level is used; the solution is of size 1, in double precision.
    pub const NONE: Self = Self {
        value: 0.0,
        scale: 1.0,
        epsilon: f64::EPSILON,
    };

    /// # Errors
    /// [`JudgeError::Floor`] for a number that is negative, infinite or NaN.
    pub const fn new(floor: f64) -> Result<Self, JudgeError> {
        if floor >= 0.0 && floor.is_finite() {
            Ok(Self {
                value: floor,
                ..Self::NONE
            })
        } else {
            Err(JudgeError::Floor(floor))
        }
    }

    /// The same for a solution of another size.
    ///
    /// # Errors
    /// [`JudgeError::RoundOff`] for a size that is not positive and finite.
    pub fn of_scale(self, scale: f64) -> Result<Self, JudgeError> {
        let scale = positive("scale", scale)?;
        Ok(Self { scale, ..self })
    }

    /// The same for numbers of another precision.
    ///
    /// # Errors
    /// [`JudgeError::RoundOff`] for a number that is not positive and finite.
    pub fn of_epsilon(self, epsilon: f64) -> Result<Self, JudgeError> {
        let epsilon = positive("eps", epsilon)?;
        Ok(Self { epsilon, ..self })
    }

    /// In the unit of the errors.
    pub fn value(self) -> f64 {
        self.value
    }

    /// The round-off of a number of the size of the solution.
    pub(super) fn unit(self) -> f64 {
        self.epsilon * self.scale
    }
}

fn positive(name: &'static str, number: f64) -> Result<f64, JudgeError> {
    if number > 0.0 && number.is_finite() {
        Ok(number)
    } else {
        Err(JudgeError::RoundOff(name, number))
    }
}

impl RateVerdict {
    /// The same rate where a floor would make it pass, by errors near the round-off of the
    /// solution: inconclusive, with the least such floor.
    ///
    /// * `judge`: of the same levels with another floor.
    pub fn offering(self, levels: &[Level], floor: Floor, judge: impl Fn(Floor) -> Self) -> Self {
        let unit = floor.unit();
        let finest = levels.iter().rev().find(|level| level.error != 0.0);
        let is_near = finest.is_some_and(|finest| finest.error <= NEAR * unit);
        if self.verdict.is_pass() || !is_near {
            return self;
        }
        let values = OFFERED.map(|units| significant(units * unit, 2));
        let mut floors = values.into_iter().filter(|value| *value > floor.value);
        let passing = floors.find_map(|value| {
            let judged = judge(Floor { value, ..floor });
            judged.verdict.is_pass().then_some((value, judged))
        });
        let Some((value, judged)) = passing else {
            return self;
        };
        let words = format!(
            "round-off, if the solution is of size {}: with a floor of {value:.1e} the rate is {}",
            floor.scale,
            judged.rate_in_words(4),
        );
        Self {
            offered_floor: Some(value),
            ..self.with_reason(Reason::RoundOff, &words)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims::{Bound, Claim};
    use crate::random::SplitMix;
    use crate::tests;
    use crate::verdict::Verdict;

    /// Levels of halved steps from 1/2 on.
    fn halved(count: usize, mut error: impl FnMut(f64) -> f64) -> Vec<Level> {
        tests::halved(0.5, count, |h| error(h).abs())
    }

    const CLAIM: Claim = Claim::new(4.0, 0.25);

    /// The least that is to be known of an offer: with it, and with no floor below, the claim
    /// passes.
    fn is_kept(judged: &RateVerdict, claim: Claim, levels: &[Level], floor: Floor) -> bool {
        let Some(value) = judged.offered_floor else {
            return judged.code != Reason::RoundOff;
        };
        let offered = Floor { value, ..floor };
        judged.code == Reason::RoundOff
            && judged.verdict == Verdict::Inconclusive
            && claim.judge(levels, offered).verdict.is_pass()
    }

    #[test]
    fn errors_that_end_in_round_off_are_offered_a_floor_which_passes() {
        let mut random = SplitMix::new(75);
        let [mut offered, mut others, mut passed] = [0; 3];
        for _ in 0..1000 {
            let levels = halved(12, |h| 0.3 * h.powi(4) + 2e-14 * random.normal());
            let judged = CLAIM.judge(&levels, Floor::NONE);
            assert!(is_kept(&judged, CLAIM, &levels, Floor::NONE), "{levels:?}");
            passed += i32::from(judged.verdict.is_pass());
            offered += i32::from(judged.code == Reason::RoundOff);
            // Half an order off.
            for order in [3.5, 4.5] {
                let claim = Claim::new(order, 0.25);
                let judged = claim.judge(&levels, Floor::NONE);
                others += i32::from(judged.offered_floor.is_some());
            }
        }
        assert!(
            offered > 980 && passed < 20 && others == 0,
            "{offered} {passed} {others}"
        );
    }

    #[test]
    fn no_floor_is_offered_above_a_wrong_limit() {
        let mut random = SplitMix::new(76);
        for scale in [1.0, 1e-6, 1e5] {
            let floor = Floor::NONE.of_scale(scale).expect("a size");
            for share in [1e-10, 1e-9, 1e-8, 1e-6] {
                for bound in [Bound::Both, Bound::AtLeast, Bound::AnyAbove] {
                    for _ in 0..50 {
                        let noise = 1e-15 * scale;
                        let levels = halved(12, |h| {
                            0.3 * scale * h.powi(4) + share * scale + noise * random.normal()
                        });
                        let claim = Claim { bound, ..CLAIM };
                        let judged = claim.judge(&levels, floor);
                        assert_eq!(judged.offered_floor, None, "{share} {levels:?}");
                        assert!(!judged.verdict.is_pass());
                    }
                }
            }
        }
    }

    #[test]
    fn precision_and_size_say_what_is_round_off() {
        let mut random = SplitMix::new(77);
        let mut single = |h: f64| 30.0 * h.powi(4) + 1e-7 * random.normal();
        let levels = halved(9, &mut single);
        let judged = |floor: Floor| CLAIM.judge(&levels, floor);
        assert_eq!(judged(Floor::NONE).offered_floor, None);
        let single = Floor::NONE.of_epsilon(1.2e-7).expect("a precision");
        let found = judged(single);
        assert!(found.offered_floor.is_some(), "{}", found.reason);
        assert!(is_kept(&found, CLAIM, &levels, single));
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Floor::NONE.of_scale(wrong).is_err() && Floor::NONE.of_epsilon(wrong).is_err());
        }
    }

    #[test]
    fn zeros_and_broken_levels_are_no_round_off() {
        let floor = Floor::NONE;
        let mut levels = halved(8, |h| 0.3 * h.powi(4));
        assert!(CLAIM.judge(&levels, floor).verdict.is_pass());
        for broken in [f64::NAN, -1e-16, f64::INFINITY] {
            levels[7].error = broken;
            let judged = CLAIM.judge(&levels, floor);
            assert_eq!(
                (judged.offered_floor, judged.verdict),
                (None, Verdict::Fail)
            );
        }
        // A reference that is its own level is no round-off; zeros below a level that is, are.
        levels[7].error = 0.0;
        assert_eq!(CLAIM.judge(&levels, floor).code, Reason::ZeroError);
        let mut levels = halved(12, |h| 0.3 * h.powi(4) + 1e-14);
        levels[11].error = 0.0;
        let judged = CLAIM.judge(&levels, floor);
        assert!(judged.code == Reason::RoundOff && is_kept(&judged, CLAIM, &levels, floor));
    }
}
