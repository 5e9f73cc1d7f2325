//! All roots of f between neighbouring poles: their number by signs of enclosures, their places by
//! interval Newton.

use super::law::{IntervalLaw, pole_function};
use super::{Undecided, UndecidedReason};
use crate::equilibrium::law::{Support, free_pole};
use crate::interval::Enclosure;

/// Halvings towards an end of an interval, and of a bracket.
pub(super) const HALVINGS: i32 = 120;

/// Steps of interval Newton, which at least halves the width in each, or ends.
const NEWTON_STEPS: usize = 60;

/// Relative distances at which the sign of h next to a pole is tried.
const POLE_GAPS: i32 = 20;

/// Fractions of an interval at which a sign is tried: off the middle if it is not certain there.
const PARTS: [f64; 5] = [0.5, 0.25, 0.75, 0.1, 0.9];

/// An interval without poles, in which f is concave and negative towards the left end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gap {
    /// Encloses the left end: a pole, or a point at which f < 0.
    pub(super) left: Enclosure,
    /// Encloses the right end.
    pub(super) right: Enclosure,
    /// Whether the right end is a point with f > 0; otherwise f is negative towards that, too.
    pub(super) rises: bool,
}

impl Gap {
    /// Between two ends towards which f is negative.
    pub(super) fn between(left: Enclosure, right: Enclosure) -> Self {
        Self {
            left,
            right,
            rises: false,
        }
    }
}

/// Moves the ends of an interval towards the place between a certain yes and a certain no.
///
/// * `ends`: where the answer is yes, and where it is no.
pub(super) fn narrowed<E>(
    ends: [f64; 2],
    answer: impl Fn(f64) -> Result<Option<bool>, E>,
) -> Result<[f64; 2], E> {
    let [mut yes, mut no] = ends;
    'narrower: loop {
        for part in PARTS {
            let middle = yes + part * (no - yes);
            if middle == yes || middle == no {
                continue;
            }
            match answer(middle)? {
                Some(true) => yes = middle,
                Some(false) => no = middle,
                None => continue,
            }
            continue 'narrower;
        }
        return Ok([yes, no]);
    }
}

impl IntervalLaw {
    /// All roots in a gap: one if f rises to the right end, and none or two otherwise.
    ///
    /// Proof of none: a concave function lies below each of its tangents. The tangent is negative
    /// on the whole of both ends, so that no root hides next to a pole. Of two: f is negative,
    /// positive and negative again at three points.
    pub(super) fn roots(&self, gap: Gap) -> Result<Vec<Enclosure>, Undecided> {
        let Gap { left, right, rises } = gap;
        let top = if rises {
            right.lo
        } else {
            self.top(left.hi, right.lo)
        };
        let solution = self.at(Enclosure::from(top));
        if solution.f.is_positive() {
            let mut roots = vec![self.crossing(left.hi, top)?];
            if !rises {
                roots.push(self.crossing(right.lo, top)?);
            }
            return Ok(roots);
        }
        let is_below = |end: Enclosure| (solution.f + solution.slope * (end - top)).is_negative();
        if !rises && is_below(left) && is_below(right) {
            return Ok(vec![]);
        }
        let s = Enclosure {
            lo: left.lo,
            hi: right.hi,
        };
        Err(self.undecided(UndecidedReason::Fold, s, solution.f.width()))
    }

    /// About where f is largest, by bisection of the middles of f': a hint, not a proof.
    fn top(&self, left: f64, right: f64) -> f64 {
        let (mut lo, mut hi) = (left, right);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (lo + hi);
            if self.at(Enclosure::from(middle)).slope.midpoint() > 0.0 {
                lo = middle;
            } else {
                hi = middle;
            }
        }
        let top = 0.5 * (lo + hi);
        if left < top && top < right {
            top
        } else {
            0.5 * (left + right)
        }
    }

    /// Encloses the only root between an end towards which f is negative and a point with f > 0.
    fn crossing(&self, end: f64, positive: f64) -> Result<Enclosure, Undecided> {
        let s = Enclosure::between(end, positive);
        let sign = |s: f64| self.at(Enclosure::from(s)).f;
        let near = (0..HALVINGS).map(|j| end + (positive - end) * 2.0_f64.powi(-j));
        let mut near = near.filter(|&s| s != end);
        let Some(below) = near.find(|&s| sign(s).is_negative()) else {
            return Err(self.undecided(UndecidedReason::Pole, s, s.width()));
        };
        let is_negative = |s: f64| {
            let f = sign(s);
            Ok((f.is_negative() || f.is_positive()).then_some(f.is_negative()))
        };
        let [below, above] = narrowed([below, positive], is_negative)?;
        self.sharpened(Enclosure::between(below, above))
            .ok_or_else(|| self.undecided(UndecidedReason::Fold, s, s.width()))
    }

    /// Interval Newton, `X ∩ (m - f(m)/f'(X))`; `None` if nothing is left, which contradicts the
    /// signs at the ends.
    fn sharpened(&self, bracket: Enclosure) -> Option<Enclosure> {
        let mut root = bracket;
        for _ in 0..NEWTON_STEPS {
            let middle = Enclosure::from(root.midpoint());
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

    /// A gap in which f has one root, up to the first of some points at which it is positive.
    pub(super) fn rising(
        &self,
        left: Enclosure,
        mut points: impl Iterator<Item = f64>,
    ) -> Result<Gap, Undecided> {
        let right = points.find(|&s| self.at(Enclosure::from(s)).f.is_positive());
        match right.map(Enclosure::from) {
            Some(right) => Ok(Gap {
                left,
                right,
                rises: true,
            }),
            None => Err(self.undecided(UndecidedReason::Pole, left, f64::INFINITY)),
        }
    }

    /// The poles of the law above N = -1, in decreasing order, down to the first below 1 + β: at
    /// most `count`, one for each free value.
    pub(super) fn poles_above(&self, count: usize) -> Result<Vec<Enclosure>, Undecided> {
        let mut poles = Vec::new();
        for k in 1..=count {
            let free = free_pole(k);
            let bounds = Enclosure {
                lo: free_pole(k + 1).hi,
                hi: free.lo,
            };
            let pole = match self.force.support {
                None => free,
                Some(support) => self.supported_pole(support, self.force.buckling(k), bounds)?,
            };
            poles.push(pole);
            // f <= s - (1 + β) < 0 below.
            if pole.hi < self.rest.lo {
                break;
            }
        }
        Ok(poles)
    }

    /// The only pole below N = -1; none without a support.
    pub(super) fn pole_below(&self) -> Option<Result<Enclosure, Undecided>> {
        let bounds = Enclosure {
            lo: f64::NEG_INFINITY,
            hi: 0.0,
        };
        let guess = self.force.buckling_below_minus_one()?;
        Some(self.supported_pole(self.force.support?, guess, bounds))
    }

    /// Encloses the zero of h near `guess`: h falls through 0 there, and by the interlacing of the
    /// values nowhere else between the same two free values.
    ///
    /// * `bounds`: the free values on both sides, or -∞ and 0.
    fn supported_pole(
        &self,
        support: Support,
        guess: f64,
        bounds: Enclosure,
    ) -> Result<Enclosure, Undecided> {
        let h = |s: f64| pole_function(support.epsilon, Enclosure::from(s));
        let gaps = (0..POLE_GAPS).map(|power| guess.abs() * f64::EPSILON * 4.0_f64.powi(power));
        let lo = gaps
            .clone()
            .map(|gap| guess - gap)
            .find(|&s| h(s).is_positive());
        let hi = gaps.map(|gap| guess + gap).find(|&s| h(s).is_negative());
        match (lo, hi) {
            (Some(lo), Some(hi)) if bounds.lo < lo && hi < bounds.hi => Ok(Enclosure { lo, hi }),
            _ => Err(self.undecided(
                UndecidedReason::Pole,
                Enclosure::from(guess),
                bounds.width(),
            )),
        }
    }
}
