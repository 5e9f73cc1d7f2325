//! All roots N of `f(N) = N - β - ρ‖u'(N)‖²` for one law, and a proof that none is missed.
//!
//! Write the law as `(B + N K) w = ℓ`, with B the elastic form (support included, positive
//! definite) and K that of ‖u'‖². In the eigenbasis of K against B,
//!
//! `S(N) = ‖u'‖² = Σ_j a_j / (N - N_j)²`, a_j >= 0,
//!
//! whose poles are the buckling values N_j (in general an integral over the spectrum, which apart
//! from the N_j is the point N = -1). So S is convex and f strictly concave between neighbouring
//! poles:
//!
//! * above the largest pole S decreases and f increases to ∞: exactly one root;
//! * between two poles: none, two, or one double root, decided by the maximum of f;
//! * in an interval below N = -1: the same. Next to -1, S stays finite for the free law and for a
//!   support at -aθ_A: there exactly one root if f(-1⁻) > 0. For any other support S → ∞, and the
//!   interval is like the others;
//! * below β: none, since ρS >= 0.
//!
//! Moreover dS/dN = -2 bᵀ(B + NK)⁻¹b with b = Kw. The second variation of the energy is B + NK + 2ρ
//! b bᵀ, so by Sylvester's law it has as many negative directions as there are poles above N, less
//! one if f' = 1 - ρS' < 0.

use super::law::ForceLaw;
use super::maximum::maximize;
use std::cmp::Ordering;
use thermobeam::bracket::bisect;

/// A root closer to a pole than this, relative to `1 + N`, is represented by its amplitude instead
/// of N.
///
/// Large against round-off, so that the sign of f is certain at this distance, and small enough
/// that the pole's N gives the amplitude to eleven digits.
const POLE_GAP: f64 = 1e-11;

/// Bound on |max f| for a double root, in units of the largest term of f.
const FOLD: f64 = 32.0 * f64::EPSILON;

/// Distance from N = -1 at which the search below it starts.
const MINUS_ONE_GAP: f64 = 1e-14;

/// Position of a root.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Position {
    /// At this `s = 1 + N`.
    Between(f64),
    /// Within round-off of the buckling value s: the solution is the mode with an amplitude of this
    /// sign.
    Buckling(f64, f64),
}

/// A root and its stability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Root {
    /// Its position.
    pub(super) position: Position,
    /// Number of negative directions of the second variation; `None` if there are infinitely many.
    pub(super) unstable_directions: Option<usize>,
    /// Whether f' = 0 as well: the second variation is singular.
    pub(super) fold: bool,
}

/// An end of an interval: a pole or a regular point.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Endpoint {
    Buckling(f64),
    Regular(f64),
}

impl Endpoint {
    /// The point itself, or one next to the pole on the given side.
    fn inside(self, side: f64) -> f64 {
        match self {
            Self::Regular(s) => s,
            Self::Buckling(s) => s + side * POLE_GAP * s.abs(),
        }
    }
}

/// f is a function of `s = 1 + N`; all of this is for ρ > 0.
impl ForceLaw {
    /// All roots N > -1 above the `count`-th buckling value, in decreasing order.
    pub(super) fn roots_above_minus_one(&self, count: usize) -> Vec<Root> {
        let rest = 1.0 + self.beta;
        let mut hi = Endpoint::Regular(self.upper_end(self.buckling(1)));
        let mut roots = Vec::new();
        for above in 0..count {
            let pole = self.buckling(above + 1);
            roots.extend(self.interval(Endpoint::Buckling(pole), hi, Some(above)));
            if pole <= rest {
                break;
            }
            hi = Endpoint::Buckling(pole);
        }
        roots
    }

    /// All roots N < -1.
    pub(super) fn roots_below_minus_one(&self) -> Vec<Root> {
        let rest = 1.0 + self.beta;
        if rest >= -MINUS_ONE_GAP {
            return Vec::new();
        }
        let upper = Endpoint::Regular(-MINUS_ONE_GAP);
        match self.buckling_below_minus_one() {
            Some(pole) if rest < pole => {
                let mut roots =
                    self.interval(Endpoint::Regular(rest), Endpoint::Buckling(pole), None);
                roots.extend(self.interval(Endpoint::Buckling(pole), upper, None));
                roots
            }
            _ => self.interval(Endpoint::Regular(rest), upper, None),
        }
    }

    fn f(&self, s: f64) -> f64 {
        s - (1.0 + self.beta) - self.rho * self.solve(s).slope_squared()
    }

    /// An s above the largest pole with f(s) > 0.
    ///
    /// For `s > max(pole, 1 + β)`, `f(s + ρS(s)) >= s - (1 + β) > 0`, because S decreases there.
    fn upper_end(&self, pole: f64) -> f64 {
        let s = 2.0 * (pole + (1.0 + self.beta).abs());
        s + self.rho * self.solve(s).slope_squared()
    }

    /// The roots of f in an interval in which it is concave, with `above` poles above the interval.
    fn interval(&self, lo: Endpoint, hi: Endpoint, above: Option<usize>) -> Vec<Root> {
        let a = lo.inside(1.0);
        let b = hi.inside(-1.0);
        let is_positive = [a, b].map(|s| self.f(s) > 0.0);
        // Where f rises through 0, and where it falls.
        let mut rise = None;
        let mut fall = None;
        let mut fold = false;
        match is_positive {
            [true, true] => {
                rise = self.at_pole(lo, 1.0);
                fall = self.at_pole(hi, -1.0);
            }
            [false, true] => {
                rise = Some(self.between(a, b));
                fall = self.at_pole(hi, -1.0);
            }
            [true, false] => {
                rise = self.at_pole(lo, 1.0);
                fall = Some(self.between(a, b));
            }
            [false, false] => match self.maximum(a, b) {
                (Ordering::Greater, s) => {
                    rise = Some(self.between(a, s));
                    fall = Some(self.between(s, b));
                }
                (Ordering::Equal, s) => {
                    fall = Some(Position::Between(s));
                    fold = true;
                }
                (Ordering::Less, _) => {}
            },
        }
        let rise = rise.map(|position| Root {
            position,
            unstable_directions: above,
            fold: false,
        });
        let fall = fall.map(|position| Root {
            position,
            unstable_directions: above.map(|n| n.saturating_sub(1)),
            fold,
        });
        rise.into_iter().chain(fall).collect()
    }

    /// The root of f between two points at which it has opposite signs.
    fn between(&self, a: f64, b: f64) -> Position {
        Position::Between(bisect(|s| self.f(s), a, b))
    }

    /// The root between a pole and the point next to it: f > 0 there, and f → -∞ at the pole.
    fn at_pole(&self, end: Endpoint, side: f64) -> Option<Position> {
        match end {
            Endpoint::Regular(_) => None,
            Endpoint::Buckling(s) => Some(Position::Buckling(s, side * self.sign_above(s))),
        }
    }

    /// How the maximum of f on [a, b] compares with 0, to round-off, and its position.
    fn maximum(&self, a: f64, b: f64) -> (Ordering, f64) {
        let (s, value) = maximize(|s| self.f(s), a, b);
        let tension = self.rho * self.solve(s).slope_squared();
        let round_off = FOLD * (s.abs() + (1.0 + self.beta).abs() + tension);
        let sign = if value > round_off {
            Ordering::Greater
        } else if value >= -round_off {
            Ordering::Equal
        } else {
            Ordering::Less
        };
        (sign, s)
    }
}

#[cfg(test)]
mod tests {
    use super::super::law::Support;
    use super::*;

    fn laws() -> [ForceLaw; 4] {
        let support = |epsilon, position| Some(Support { epsilon, position });
        [
            (0.5, None),
            (0.5, support(0.5, 0.125)),
            (-0.25, support(0.01, -0.5)),
            (0.0, support(2.0, 0.25)),
        ]
        .map(|(moment, support)| ForceLaw {
            moment,
            support,
            ..ForceLaw::default()
        })
    }

    /// At a fold the maximum of f is zero; the tolerance is 32 units of round-off of the sum of its
    /// terms.
    #[test]
    fn zero_one_and_two_roots_are_distinguished_to_round_off() {
        for (law, rho) in laws().into_iter().zip([6.0, 4.0, 3.0, 20.0]) {
            let (low, high) = (law.buckling(2), law.buckling(1));
            let (a, b) = (low + 1e-3 * (high - low), high - 1e-3 * (high - low));
            // f = without_beta - β; its maximum is the fold.
            let without_beta = |s: f64| s - 1.0 - rho * law.solve(s).slope_squared();
            let (mut left, mut right) = (a, b);
            while right - left > 1e-9 {
                let (c, d) = (left + (right - left) / 3.0, right - (right - left) / 3.0);
                if without_beta(c) < without_beta(d) {
                    left = c;
                } else {
                    right = d;
                }
            }
            let (s, beta) = (left, without_beta(left));
            let terms = s + (1.0 + beta).abs() + rho * law.solve(s).slope_squared();
            let allowed = 32.0 * f64::EPSILON * terms;
            for (shift, expected) in [(-1.3, 2), (-0.7, 1), (0.7, 1), (1.3, 0)] {
                let scan = ForceLaw {
                    beta: beta + shift * allowed,
                    rho,
                    ..law
                };
                let found = match scan.maximum(a, b).0 {
                    Ordering::Greater => 2,
                    Ordering::Equal => 1,
                    Ordering::Less => 0,
                };
                assert_eq!(
                    found, expected,
                    "{shift} of {allowed:e}, {law:?}, s = {s}, beta = {beta}"
                );
            }
            let fold = ForceLaw { beta, rho, ..law }.interval(
                Endpoint::Buckling(low),
                Endpoint::Buckling(high),
                Some(1),
            );
            let [
                Root {
                    position: Position::Between(at),
                    unstable_directions: Some(0),
                    fold: true,
                },
            ] = fold[..]
            else {
                panic!("{fold:?} of {law:?}");
            };
            assert!((at - s).abs() < 1e-6);
            let apart = ForceLaw {
                beta: beta - 1e-6,
                rho,
                ..law
            }
            .interval(Endpoint::Buckling(low), Endpoint::Buckling(high), Some(1));
            let kinds = apart
                .iter()
                .map(|root| (root.unstable_directions, root.fold))
                .collect::<Vec<_>>();
            assert_eq!(kinds, [(Some(1), false), (Some(0), false)], "{law:?}");
        }
    }
}
