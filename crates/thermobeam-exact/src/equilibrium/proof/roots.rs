//! The roots of f in an interval in which it is concave: their number by signs of enclosures,
//! their place by interval Newton.

use super::law::{IntervalLaw, pole_function};
use super::{Undecided, UndecidedReason};
use crate::equilibrium::law::{free_buckling, free_pole};
use crate::interval::Interval;

/// Halvings towards an end at which f → -∞, and of a bracket.
const HALVINGS: i32 = 120;

/// Steps of interval Newton, which at least halves the width in each, or ends.
const NEWTON_STEPS: usize = 60;

/// Relative distances at which the sign of h next to a pole is tried.
const POLE_GAPS: i32 = 20;

/// What is known of an interval.
pub(super) type Roots = Result<Vec<Interval>, Undecided>;

/// Encloses the zero of h near `guess`: h falls through 0 there, and by the interlacing of the
/// values nowhere else between the same two free values.
///
/// * `bounds`: the free values on both sides, or -∞ and 0.
pub(super) fn supported_pole(epsilon: f64, guess: f64, bounds: Interval) -> Option<Interval> {
    let mut enclosure = Interval::ENTIRE;
    for power in 0..POLE_GAPS {
        let gap = guess.abs() * f64::EPSILON * 4.0_f64.powi(power);
        let [lo, hi] = [guess - gap, guess + gap];
        if enclosure.lo == f64::NEG_INFINITY
            && pole_function(epsilon, Interval::from(lo)).is_positive()
        {
            enclosure.lo = lo;
        }
        if enclosure.hi == f64::INFINITY && pole_function(epsilon, Interval::from(hi)).is_negative()
        {
            enclosure.hi = hi;
        }
    }
    (bounds.lo < enclosure.lo && enclosure.hi < bounds.hi && enclosure.width().is_finite())
        .then_some(enclosure)
}

impl IntervalLaw {
    /// The only root above the largest pole: f increases there from -∞ to ∞.
    pub(super) fn root_above(&self, pole: f64) -> Roots {
        let scale = pole.max(self.rest.hi.abs());
        let far = (1..HALVINGS).map(|j| scale * 2.0_f64.powi(j));
        let Some(high) = far.into_iter().find(|&s| self.sign_is(s, 1.0)) else {
            return Err(self.undecided(UndecidedReason::Pole, pole, f64::INFINITY));
        };
        let Some(low) = self.negative_towards(high, pole) else {
            return Err(self.undecided(UndecidedReason::Pole, pole, high));
        };
        self.crossing(low, high).map(|root| vec![root])
    }

    /// The roots between two ends between which f is concave: none, or two.
    ///
    /// Proof of none: a concave function lies below each of its tangents. Of two: f is negative,
    /// positive and negative again at three points.
    ///
    /// * `left`, `right`: each encloses an end, such as a pole. The tangent is negative on all of
    ///   them, so that no root hides next to a pole.
    pub(super) fn roots_between(
        &self,
        left: impl Into<Interval>,
        right: impl Into<Interval>,
    ) -> Roots {
        let (left, right) = (left.into(), right.into());
        let top = self.top(left.hi, right.lo);
        let solution = self.at(Interval::from(top));
        if solution.f.is_positive() {
            let before = self.negative_towards(top, left.hi);
            let after = self.negative_towards(top, right.lo);
            let (Some(before), Some(after)) = (before, after) else {
                return Err(self.undecided(UndecidedReason::Pole, left.lo, right.hi));
            };
            return Ok(vec![
                self.crossing(before, top)?,
                self.crossing(after, top)?,
            ]);
        }
        let is_below = |end: Interval| (solution.f + solution.slope * (end - top)).is_negative();
        if is_below(left) && is_below(right) {
            Ok(vec![])
        } else {
            Err(self.undecided_by(UndecidedReason::Fold, left.lo, right.hi, solution.f.width()))
        }
    }

    /// The only root in (-∞, 0) of the free beam if f(0⁻) > 0: f is concave there, and negative at
    /// a point to the left.
    pub(super) fn root_rising_to_zero(&self) -> Roots {
        let left = 2.0 * self.rest.lo;
        let near = (1..HALVINGS).map(|j| self.rest.lo * 2.0_f64.powi(-j));
        let Some(right) = near.into_iter().find(|&s| self.sign_is(s, 1.0)) else {
            return Err(self.undecided(UndecidedReason::MinusOne, self.rest.lo, 0.0));
        };
        self.crossing(left, right).map(|root| vec![root])
    }

    /// Whether the sign of f at s is this one, for certain.
    fn sign_is(&self, s: f64, sign: f64) -> bool {
        let f = self.at(Interval::from(s)).f;
        if sign > 0.0 {
            f.is_positive()
        } else {
            f.is_negative()
        }
    }

    /// A point between `from` and `end`, where f → -∞ or is negative, at which f < 0.
    fn negative_towards(&self, from: f64, end: f64) -> Option<f64> {
        (0..HALVINGS)
            .map(|j| end + (from - end) * 2.0_f64.powi(-j))
            .find(|&s| s != end && self.sign_is(s, -1.0))
    }

    /// About where f' = 0, by bisection of the middles of its enclosures: a hint, not a proof.
    fn top(&self, a: f64, b: f64) -> f64 {
        let (mut lo, mut hi) = (a, b);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (lo + hi);
            if self.at(Interval::from(middle)).slope.midpoint() > 0.0 {
                lo = middle;
            } else {
                hi = middle;
            }
        }
        let top = 0.5 * (lo + hi);
        if a < top && top < b {
            top
        } else {
            0.5 * (a + b)
        }
    }

    /// Encloses the root between a point with f < 0 and one with f > 0.
    fn crossing(&self, negative: f64, positive: f64) -> Result<Interval, Undecided> {
        let (mut below, mut above) = (negative, positive);
        for _ in 0..HALVINGS {
            // Off the middle if the sign there is not certain.
            let places = [0.5, 0.25, 0.75, 0.1, 0.9].map(|part| below + part * (above - below));
            let certain = places
                .into_iter()
                .filter(|&s| s != below && s != above)
                .find_map(|s| {
                    let f = self.at(Interval::from(s)).f;
                    (f.is_positive() || f.is_negative()).then_some((s, f.is_negative()))
                });
            match certain {
                Some((s, true)) => below = s,
                Some((s, false)) => above = s,
                None => break,
            }
        }
        let bracket = Interval {
            lo: below.min(above),
            hi: below.max(above),
        };
        self.sharpened(bracket)
            .ok_or_else(|| self.undecided(UndecidedReason::Fold, negative, positive))
    }

    /// Interval Newton, `X ∩ (m - f(m)/f'(X))`; `None` if nothing is left, which contradicts the
    /// signs at the ends.
    fn sharpened(&self, bracket: Interval) -> Option<Interval> {
        let mut root = bracket;
        for _ in 0..NEWTON_STEPS {
            let middle = Interval::from(root.midpoint());
            let slope = self.at(root).slope;
            let next = (middle - self.at(middle).f / slope).intersection(root)?;
            let is_done = next.width() > 0.5 * root.width();
            root = next;
            if is_done {
                break;
            }
        }
        Some(root)
    }

    /// What is given up between two values of s.
    fn undecided(&self, reason: UndecidedReason, from: f64, to: f64) -> Undecided {
        self.undecided_by(reason, from, to, (to - from).abs())
    }

    fn undecided_by(&self, reason: UndecidedReason, from: f64, to: f64, width: f64) -> Undecided {
        let s = Interval {
            lo: from.min(to),
            hi: from.max(to),
        };
        Undecided::new(reason, s, width)
    }
}

/// The poles of a law above N = -1, in decreasing order: one for each free value.
pub(super) fn poles_above(
    law: &crate::equilibrium::law::ForceLaw,
    count: usize,
) -> Result<Vec<Interval>, Undecided> {
    let mut poles = Vec::new();
    for k in 1..=count {
        let pole = match law.support {
            None => free_pole(k),
            Some(support) => {
                let bounds = Interval {
                    lo: free_pole(k + 1).hi,
                    hi: free_pole(k).lo,
                };
                let s = Interval::from(free_buckling(k));
                supported_pole(support.epsilon, law.buckling(k), bounds)
                    .ok_or_else(|| Undecided::new(UndecidedReason::Pole, s, bounds.width()))?
            }
        };
        poles.push(pole);
        // f <= s - (1 + β) < 0 below.
        if pole.hi < (1.0 + law.beta).next_down() {
            break;
        }
    }
    Ok(poles)
}
