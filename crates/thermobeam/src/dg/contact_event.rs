//! The contact phase of the free end, and where in a step it changes.
//!
//! Between events the contact force is zero or linear in u(1). In a step u(1, t) is a polynomial of
//! degree q + 1, so its first crossing of an obstacle is found exactly, including extrema: between
//! neighbouring zeros of its derivative it is monotone.

use super::legendre;
use super::time::MAX_STAGES;
use crate::bracket::bisect;
use crate::contact::Phase;
use crate::parameters::Obstacles;

/// A polynomial of degree q + 1 <= 6 on [0, 1] by its Legendre coefficients.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Polynomial {
    pub(super) coefficients: [f64; MAX_STAGES + 1],
    pub(super) degree: usize,
}

impl Polynomial {
    pub(super) fn at(&self, s: f64) -> f64 {
        legendre::sum(&self.coefficients[..=self.degree], s)
    }

    /// `L_j' = 2 Σ (2k + 1) L_k` over k = j - 1, j - 3, ...
    pub(super) fn derivative(&self) -> Self {
        let mut coefficients = [0.0; MAX_STAGES + 1];
        for j in 1..=self.degree {
            for k in (0..j).rev().step_by(2) {
                coefficients[k] += 2.0 * (2 * k + 1) as f64 * self.coefficients[j];
            }
        }
        Self {
            coefficients,
            degree: self.degree.saturating_sub(1),
        }
    }

    /// The zeros in (0, 1) at which the sign changes, in increasing order, and their number.
    pub(super) fn sign_changes(&self) -> ([f64; MAX_STAGES + 1], usize) {
        let (mut zeros, mut count) = ([0.0; MAX_STAGES + 1], 0);
        if self.degree == 0 {
            return (zeros, count);
        }
        let (extrema, extremum_count) = self.derivative().sign_changes();
        let mut left = 0.0;
        for right in extrema[..extremum_count].iter().copied().chain([1.0]) {
            let (at_left, at_right) = (self.at(left), self.at(right));
            if (at_left < 0.0) != (at_right < 0.0) {
                zeros[count] = bisect(|s| self.at(s), left, right);
                count += 1;
            }
            left = right;
        }
        (zeros, count)
    }

    /// Where a polynomial that should stay above zero first falls below `-slack`.
    pub(super) fn first_fall(&self, slack: f64) -> Option<Fall> {
        let spread: f64 = self.coefficients[1..=self.degree]
            .iter()
            .map(|c| c.abs())
            .sum();
        // |L_j| <= 1 on [0, 1].
        if self.coefficients[0] - spread >= -slack {
            return None;
        }
        let (extrema, count) = self.derivative().sign_changes();
        let mut left = 0.0;
        for right in extrema[..count].iter().copied().chain([1.0]) {
            if self.at(right) < -slack {
                let crossing = if self.at(left) > slack {
                    bisect(|s| self.at(s), left, right)
                } else {
                    left
                };
                return Some(Fall {
                    crossing,
                    below: right,
                });
            }
            left = right;
        }
        None
    }
}

/// Where in a step, from 0 to 1, the free end crosses an obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fall {
    /// The crossing; 0 if the polynomial falls from the start.
    pub(super) crossing: f64,
    /// A later point at which it is clearly below.
    pub(super) below: f64,
}

/// For each bound of the phase, the distance of the free end from it as a polynomial in time,
/// positive inside the phase; and the phase beyond that bound.
pub(super) fn bounds(
    phase: Phase,
    tip: &Polynomial,
    obstacles: &Obstacles,
) -> [Option<(Polynomial, Phase)>; 2] {
    let Obstacles { g1, g2, .. } = *obstacles;
    let narrow = g1 == g2;
    match phase {
        Phase::Free => [
            Some((depth_below(tip, g2), Phase::Upper)),
            Some((height_above(tip, g1), Phase::Lower)),
        ],
        Phase::Upper => [
            Some((
                height_above(tip, g2),
                if narrow { Phase::Lower } else { Phase::Free },
            )),
            None,
        ],
        Phase::Lower => [
            Some((
                depth_below(tip, g1),
                if narrow { Phase::Upper } else { Phase::Free },
            )),
            None,
        ],
    }
}

/// `u(1) - g`.
fn height_above(tip: &Polynomial, g: f64) -> Polynomial {
    let mut height = *tip;
    height.coefficients[0] -= g;
    height
}

/// `g - u(1)`.
fn depth_below(tip: &Polynomial, g: f64) -> Polynomial {
    let mut depth = height_above(tip, g);
    depth.coefficients.iter_mut().for_each(|c| *c = -*c);
    depth
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Legendre coefficients of a product of (s - root) and a sign.
    fn with_roots(sign: f64, roots: &[f64]) -> Polynomial {
        let value = |s: f64| sign * roots.iter().map(|root| s - root).product::<f64>();
        let mut coefficients = [0.0; MAX_STAGES + 1];
        for (xi, weight) in legendre::gauss(8) {
            let mut legendre = [0.0; MAX_STAGES + 1];
            legendre::values_into(xi, &mut legendre);
            for (j, coefficient) in coefficients.iter_mut().enumerate().take(roots.len() + 1) {
                *coefficient +=
                    0.5 * (2 * j + 1) as f64 * weight * value(0.5 * (1.0 + xi)) * legendre[j];
            }
        }
        Polynomial {
            coefficients,
            degree: roots.len(),
        }
    }

    #[track_caller]
    fn falls_at(polynomial: Polynomial, expected: Option<f64>) {
        let fall = polynomial.first_fall(1e-14);
        match (fall, expected) {
            (Some(fall), Some(at)) => {
                assert!((fall.crossing - at).abs() < 1e-10, "{fall:?}, not {at}");
                assert!(fall.below > at && polynomial.at(fall.below) < 0.0);
            }
            (fall, expected) => assert_eq!(fall.is_some(), expected.is_some(), "{fall:?}"),
        }
    }

    #[test]
    fn the_first_crossing_is_found_between_extrema_too() {
        falls_at(with_roots(-1.0, &[0.3]), Some(0.3));
        falls_at(with_roots(1.0, &[-0.3]), None);
        // Down and up again, within the step.
        falls_at(with_roots(1.0, &[0.4, 0.401]), Some(0.4));
        falls_at(with_roots(1.0, &[0.2, 0.5, 0.7, 0.9]), Some(0.2));
        falls_at(with_roots(-1.0, &[-0.1, 1.2]), None);
        // Starting from zero: rising at first, or falling from the start.
        falls_at(with_roots(-1.0, &[0.0, 0.6]), Some(0.6));
        falls_at(with_roots(1.0, &[0.0, 0.6]), Some(0.0));
        falls_at(with_roots(1.0, &[0.0, 0.0, 0.9, 1.5, 2.0, 3.0]), Some(0.9));
        falls_at(with_roots(1.0, &[0.0, 0.0, 1.1, 1.5, 2.0, 3.0]), None);
        falls_at(with_roots(1.0, &[0.5, 0.5]), None);
    }
}
