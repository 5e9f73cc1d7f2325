//! The static problem for given N: linear, with one law for each state of contact.

use super::shape::{Shape, tanh_ratio};
use crate::interval::Enclosure;
use std::f64::consts::PI;
use thermobeam::bracket::bisect;

/// Axial force and load of the beam, and support of its tip.
///
/// Without a support c = 0. With one, `c = -(u(1) - position)/ε`, in tension as well as in
/// compression: the caller checks whether the state presses the obstacle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct ForceLaw {
    /// The thermal moment aθ_A.
    pub(super) moment: f64,
    /// β.
    pub(super) beta: f64,
    /// ρ.
    pub(super) rho: f64,
    /// The obstacle in contact.
    pub(super) support: Option<Support>,
}

/// An obstacle: a spring of compliance ε, relaxed at u(1) = position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Support {
    /// ε.
    pub(super) epsilon: f64,
    /// g₁ or g₂.
    pub(super) position: f64,
}

/// `1 + N_k = 1/(1 + κ²)`, κ = (k - 1/2)π: the k-th buckling value of the beam without support.
///
/// * `k` counts from 1.
pub(super) fn free_buckling(k: usize) -> f64 {
    let kappa = (k as f64 - 0.5) * PI;
    1.0 / (1.0 + kappa * kappa)
}

/// An enclosure of [`free_buckling`].
pub(super) fn free_pole(k: usize) -> Enclosure {
    let kappa = Enclosure::pi() * (k as f64 - 0.5);
    Enclosure::from(1.0) / (kappa.square() + 1.0)
}

/// Number of [`free_buckling`] values strictly above s > 0.
fn free_buckling_above(s: f64) -> usize {
    let reach = (1.0 / s - 1.0).max(0.0).sqrt() / PI + 0.5;
    // Strictly above: at s = 1 + N_k itself the k-th does not count.
    (reach.ceil() as usize).saturating_sub(1)
}

impl ForceLaw {
    /// Whether nothing loads the beam: then the straight beam solves the law for every N.
    pub(super) fn homogeneous(&self) -> bool {
        self.moment == 0.0 && self.support.is_none_or(|support| support.position == 0.0)
    }

    /// The shape at `s = 1 + N`; s must be neither 0 nor a buckling value of this law.
    pub(super) fn solve(&self, s: f64) -> Shape {
        if s > 0.0 {
            self.solve_above(1.0 / s)
        } else {
            self.solve_below(1.0 / s)
        }
    }

    fn solve_above(&self, q: f64) -> Shape {
        let (rotation, stress) = self.numerators(q);
        let determinant = self.determinant(q);
        Shape {
            q,
            alpha: rotation / determinant,
            stress: stress / determinant,
            moment: self.moment,
        }
    }

    /// Determinant of the two conditions `φ(0) = 0` and `εc + u(1) = g` for (α, c); of the first
    /// for α without a support.
    pub(super) fn determinant(&self, q: f64) -> f64 {
        use crate::stumpff::{c0, c1, c2, c3};
        let x = q - 1.0;
        match self.support {
            None => c0(x),
            Some(Support { epsilon, .. }) => {
                c0(x) * (epsilon + q - q * q * c3(x)) + q * q * c1(x) * c2(x)
            }
        }
    }

    /// Cramer's numerators of (α, c).
    fn numerators(&self, q: f64) -> (f64, f64) {
        use crate::stumpff::{c0, c1, c2, c3};
        let x = q - 1.0;
        match self.support {
            None => (self.moment * c2(x), 0.0),
            Some(Support { epsilon, position }) => (
                c2(x) * (self.moment * (epsilon + q) + q * position),
                c0(x) * (position + q * self.moment * c3(x)) - q * c1(x) * self.moment * c2(x),
            ),
        }
    }

    fn solve_below(&self, q: f64) -> Shape {
        let stress = self.support.map_or(0.0, |Support { epsilon, position }| {
            // Without stress u(1) = q aθ_A (1 - T)/k²; a unit of stress adds the flexibility.
            let loaded = q * self.moment * (1.0 - tanh_ratio(q)) / (1.0 - q);
            (position - loaded) / (epsilon + flexibility(q))
        });
        Shape {
            q,
            alpha: 0.0,
            stress,
            moment: self.moment,
        }
    }

    /// `1 + N` at the k-th buckling value of this law above N = -1, where the linear problem is
    /// singular; k counts from 1.
    ///
    /// A support adds a stiffness of rank one, so its values interlace with those without: the k-th
    /// lies strictly between the k-th and the (k+1)-st of the free beam, strictly because u(1) ≠ 0
    /// in every free buckling mode.
    pub(super) fn buckling(&self, k: usize) -> f64 {
        if self.support.is_none() {
            return free_buckling(k);
        }
        let (from, to) = (1.0 / free_buckling(k), 1.0 / free_buckling(k + 1));
        1.0 / bisect(|q| self.determinant(q), from, to)
    }

    /// `1 + N` at the single buckling value below N = -1, which exists only with a support.
    ///
    /// The flexibility decreases from 0 (N → -∞) to -∞ (N → -1) and equals -ε exactly once.
    pub(super) fn buckling_below_minus_one(&self) -> Option<f64> {
        let Support { epsilon, .. } = self.support?;
        // The flexibility is about 1/s for large -s and -1/√-s near s = 0: the two ends bracket the
        // root.
        let far = -4.0 - 4.0 / epsilon;
        let near = -1e-3 * (1.0 + epsilon).powi(-2);
        Some(bisect(|s| epsilon + flexibility(1.0 / s), far, near))
    }

    /// Number of buckling values of this law strictly above s > 0.
    pub(super) fn buckling_above(&self, s: f64) -> usize {
        let free = free_buckling_above(s);
        if self.support.is_none() || free == 0 || self.buckling(free) > s {
            free
        } else {
            free - 1
        }
    }

    /// The buckling mode at the buckling value s, not normalised.
    pub(super) fn mode(&self, s: f64) -> Shape {
        use crate::stumpff::{c0, c2};
        let q = 1.0 / s;
        let [alpha, stress] = if s < 0.0 {
            [0.0, 1.0]
        } else if self.support.is_none() {
            [1.0, 0.0]
        } else {
            // Null vector of the row φ(0) = 0; for the free beam c0 is zero here up to round-off.
            [q * c2(q - 1.0), c0(q - 1.0)]
        };
        Shape {
            q,
            alpha,
            stress,
            moment: 0.0,
        }
    }

    /// Sign of the mode in the solution just above the buckling value s; just below it is the
    /// opposite.
    pub(super) fn sign_above(&self, s: f64) -> f64 {
        let step = 1e-6 * s.abs();
        let (numerator, slope) = if s > 0.0 {
            let mode = self.mode(s);
            let (rotation, stress) = self.numerators(mode.q);
            let slope = self.determinant(1.0 / (s + step)) - self.determinant(1.0 / (s - step));
            (rotation * mode.alpha + stress * mode.stress, slope)
        } else {
            let change = self.solve(s + step).stress - self.solve(s - step).stress;
            (change, 1.0)
        };
        if numerator * slope < 0.0 { -1.0 } else { 1.0 }
    }
}

/// Tip displacement per unit of stress for N < -1, `q (1 - qT)/k²`.
fn flexibility(q: f64) -> f64 {
    q * (1.0 - q * tanh_ratio(q)) / (1.0 - q)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_amplitude_changes_sign_at_each_buckling_value() {
        let support = |position| {
            let epsilon = 0.3;
            Some(Support { epsilon, position })
        };
        for (moment, support) in [
            (0.4, None),
            (-0.4, None),
            (0.4, support(0.2)),
            (-0.7, support(0.2)),
            (0.7, support(-0.2)),
        ] {
            let law = ForceLaw {
                moment,
                support,
                ..ForceLaw::default()
            };
            let poles = (1..=12).map(|k| law.buckling(k));
            for pole in poles.chain(law.buckling_below_minus_one()) {
                let [below, above] = [-1e-6, 1e-6].map(|step| {
                    let s = pole + step * pole.abs();
                    let (found, mode) = (law.solve(s), law.mode(s));
                    if s > 0.0 {
                        found.alpha / mode.alpha
                    } else {
                        found.stress / mode.stress
                    }
                });
                assert!(
                    above.abs() > 10.0 && above * below < 0.0,
                    "{pole} of {law:?}"
                );
                assert_eq!(law.sign_above(pole), above.signum(), "{pole} of {law:?}");
            }
        }
    }

    #[test]
    fn supported_buckling_values_interlace_with_the_free_ones() {
        for epsilon in [1e-8, 1e-3, 1.0, 1e4] {
            let position = 0.0;
            let law = ForceLaw {
                support: Some(Support { epsilon, position }),
                ..ForceLaw::default()
            };
            for k in 1..=20 {
                let s = law.buckling(k);
                assert!(
                    free_buckling(k + 1) < s && s < free_buckling(k),
                    "{k}, {epsilon}"
                );
                // Strictly above.
                let counts = [1.000001, 1.0, 0.999999].map(|by| law.buckling_above(by * s));
                assert_eq!(counts, [k - 1, k - 1, k]);
            }
        }
    }

    #[test]
    fn free_buckling_values_above_a_number_are_counted() {
        let law = ForceLaw::default();
        for k in 1..=40 {
            let s = free_buckling(k);
            assert_eq!(
                [s * (1.0 + 1e-9), s * (1.0 - 1e-9)].map(|s| law.buckling_above(s)),
                [k - 1, k]
            );
        }
        assert_eq!([0.5, 1.0, 7.0].map(|s| law.buckling_above(s)), [0; 3]);
    }

    #[test]
    fn below_minus_one_the_tip_flexibility_equals_the_compliance_once() {
        for epsilon in [1e-8, 1e-4, 0.01, 0.3, 1.0, 3.0, 100.0, 1e4, 1e8] {
            let law = ForceLaw {
                support: Some(Support {
                    epsilon,
                    position: 0.0,
                }),
                ..ForceLaw::default()
            };
            let s = law.buckling_below_minus_one().unwrap();
            assert!(s * 0.999 < 0.0);
            let flexibility = |s: f64| law.mode(s).u(1.0);
            // A unit of stress moves the tip by -ε there, by less above and by more below.
            assert!(
                (flexibility(s) / -epsilon - 1.0).abs() < 1e-12,
                "{epsilon}: {s}"
            );
            assert!(
                flexibility(s * 1.001) > flexibility(s) && flexibility(s) > flexibility(s * 0.999)
            );
        }
        assert_eq!(ForceLaw::default().buckling_below_minus_one(), None);
    }
}
