//! All roots N of `f(N) = N - β - ρ‖u'(N)‖²` for one law, with a proof that none is missed.
//!
//! Write the law as `(B + N K) w = ℓ`, with B the elastic form (support included, positive definite) and K that of
//! ‖u'‖². In the eigenbasis of K against B,
//!
//! `S(N) = ‖u'‖² = Σ_j a_j / (N - N_j)²`, a_j >= 0,
//!
//! with the buckling values N_j as poles (an integral over the spectrum in general, all of whose points
//! but the N_j sit at N = -1). So S is convex and f strictly concave between two neighbouring poles:
//!
//! * above the largest pole S falls, f rises to ∞: exactly one root;
//! * between two poles, and in each interval below N = -1: none, two, or one double root, told by the largest value of f;
//! * below β none, since ρS >= 0.
//!
//! Moreover dS/dN = -2 bᵀ(B + NK)⁻¹b with b = Kw. The second variation of the energy is B + NK + 2ρ b bᵀ, so by
//! Sylvester's law it has as many negative directions as there are poles above N, less one where f' = 1 - ρS' < 0.

use super::law::Law;
use crate::bracket::{bisect, maximize};

/// A root closer to a pole than this, relative to `1 + N`, is sought by its amplitude instead of by N.
///
/// Far above round-off, so that f's sign is certain at this distance; far below any distance that matters,
/// so that the amplitude follows from the pole's N alone to eleven digits.
const POLE_GAP: f64 = 1e-11;

/// How many units of round-off of its largest term f may be from zero at its maximum to count as a double root.
const FOLD: f64 = 32.0 * f64::EPSILON;

/// s closest to 0 from below that is told apart from N = -1.
const MINUS_ONE_GAP: f64 = 1e-14;

/// Where a root is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Place {
    /// At this `s = 1 + N`.
    Between(f64),
    /// So close to the buckling value s that only the amplitude of its mode is certain, which has this sign.
    Buckling(f64, f64),
}

/// A root and what stability needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Root {
    /// Where.
    pub(super) place: Place,
    /// Negative directions of the second variation; none if there are infinitely many.
    pub(super) unstable_directions: Option<usize>,
    /// f' = 0 too: the second variation is singular.
    pub(super) fold: bool,
}

/// The end of an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
enum End {
    Buckling(f64),
    Plain(f64),
}

/// f for one law, as a function of `s = 1 + N`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scan<'a> {
    /// The linear problem.
    pub(super) law: &'a Law,
    /// β.
    pub(super) beta: f64,
    /// ρ > 0.
    pub(super) rho: f64,
}

impl Scan<'_> {
    /// All roots N > -1 above the `waves`-th buckling value, the largest first.
    pub(super) fn roots_above_minus_one(&self, waves: usize) -> Vec<Root> {
        let rest = 1.0 + self.beta;
        let mut hi = End::Plain(self.upper_end(self.law.buckling(1)));
        let mut roots = Vec::new();
        for above in 0..waves {
            let pole = self.law.buckling(above + 1);
            roots.extend(self.interval(End::Buckling(pole), hi, Some(above)));
            if pole <= rest {
                break;
            }
            hi = End::Buckling(pole);
        }
        roots
    }

    /// All roots N < -1.
    pub(super) fn roots_below_minus_one(&self) -> Vec<Root> {
        let rest = 1.0 + self.beta;
        if rest >= -MINUS_ONE_GAP {
            return Vec::new();
        }
        let upper = End::Plain(-MINUS_ONE_GAP);
        match self.law.buckling_below_minus_one() {
            Some(pole) if rest < pole => {
                let mut roots = self.interval(End::Plain(rest), End::Buckling(pole), None);
                roots.extend(self.interval(End::Buckling(pole), upper, None));
                roots
            }
            _ => self.interval(End::Plain(rest), upper, None),
        }
    }

    fn f(&self, s: f64) -> f64 {
        s - (1.0 + self.beta) - self.rho * self.law.solve(s).slope_squared()
    }

    /// Some s above the largest pole where f > 0.
    ///
    /// Where `s > max(pole, 1 + β)`, `f(s + ρS(s)) >= s - (1 + β) > 0`, because S falls there.
    fn upper_end(&self, pole: f64) -> f64 {
        let s = 2.0 * (pole + (1.0 + self.beta).abs());
        s + self.rho * self.law.solve(s).slope_squared()
    }

    /// The roots of f, concave between `lo` and `hi`, where `above` poles lie above.
    fn interval(&self, lo: End, hi: End, above: Option<usize>) -> Vec<Root> {
        let inside = |end: End, side: f64| match end {
            End::Plain(s) => s,
            End::Buckling(s) => s + side * POLE_GAP * s.abs(),
        };
        let (a, b) = (inside(lo, 1.0), inside(hi, -1.0));
        let (left, right) = (self.f(a) > 0.0, self.f(b) > 0.0);
        let rising = |place| Root { place, unstable_directions: above, fold: false };
        let falling = |place| Root { place, unstable_directions: above.map(|n| n.saturating_sub(1)), fold: false };
        let between = |a, b| Place::Between(bisect(|s| self.f(s), a, b));
        match (left, right) {
            (true, true) => [self.at_pole(lo, 1.0).map(rising), self.at_pole(hi, -1.0).map(falling)],
            (false, true) => [Some(rising(between(a, b))), self.at_pole(hi, -1.0).map(falling)],
            (true, false) => [self.at_pole(lo, 1.0).map(rising), Some(falling(between(a, b)))],
            (false, false) => match self.maximum(a, b) {
                Maximum::Positive(s) => [Some(rising(between(a, s))), Some(falling(between(s, b)))],
                Maximum::Zero(s) => [Some(Root { fold: true, ..falling(Place::Between(s)) }), None],
                Maximum::Negative => [None, None],
            },
        }
        .into_iter()
        .flatten()
        .collect()
    }

    /// f > 0 right beside a pole means that f still falls to -∞ in between: one root, at the pole.
    fn at_pole(&self, end: End, side: f64) -> Option<Place> {
        match end {
            End::Plain(_) => None,
            End::Buckling(s) => Some(Place::Buckling(s, side * self.law.sign_above(s))),
        }
    }

    /// Where f is positive between two points at which it is not.
    fn maximum(&self, a: f64, b: f64) -> Maximum {
        let noise = |s: f64| {
            let tension = self.rho * self.law.solve(s).slope_squared();
            FOLD * (s.abs() + (1.0 + self.beta).abs() + tension)
        };
        let (s, value) = maximize(|s| self.f(s), a, b);
        if value > noise(s) {
            Maximum::Positive(s)
        } else if value >= -noise(s) {
            Maximum::Zero(s)
        } else {
            Maximum::Negative
        }
    }
}

enum Maximum {
    Positive(f64),
    Zero(f64),
    Negative,
}

#[cfg(test)]
mod tests {
    use super::super::HALF_WAVES;
    use super::super::law::Support;
    use super::*;

    fn laws() -> [Law; 4] {
        let support = |epsilon, position| Some(Support { epsilon, position });
        [(0.5, None), (0.5, support(0.5, 0.125)), (-0.25, support(0.01, -0.5)), (0.0, support(2.0, 0.25))]
            .map(|(moment, support)| Law { moment, support })
    }

    #[test]
    fn the_scan_finds_a_root_placed_at_any_axial_force() {
        let mut below = 0;
        for law in laws() {
            for s in [5.0, 1.5, 0.9, 0.5, 0.15, 0.06, 0.011, -0.02, -0.3, -0.9, -2.0, -6.0, -40.0, -200.0] {
                for rho in [0.25, 30.0] {
                    // β that has a root at this s.
                    let beta = s - 1.0 - rho * law.solve(s).slope_squared();
                    let scan = Scan { law: &law, beta, rho };
                    let roots =
                        if s > 0.0 { scan.roots_above_minus_one(HALF_WAVES + 1) } else { scan.roots_below_minus_one() };
                    let is_found = |root: &Root| match root.place {
                        Place::Between(found) => (found / s - 1.0).abs() < 1e-9,
                        Place::Buckling(..) => false,
                    };
                    let found: Vec<&Root> = roots.iter().filter(|root| is_found(root)).collect();
                    assert_eq!(found.len(), 1, "{s}, rho {rho} of {law:?}: {roots:?}");
                    below += usize::from(found[0].unstable_directions.is_none());
                }
            }
        }
        assert_eq!(below, 4 * 7 * 2, "no count of unstable directions below N = -1");
    }

    #[test]
    fn the_upper_end_of_the_scan_lies_above_the_largest_root() {
        for (law, moment) in laws().into_iter().flat_map(|law| [0.01, 1.0, 60.0, 1e4].map(|moment| (law, moment))) {
            let law = Law { moment, ..law };
            for beta in [-40.0, -1.0, -0.9, -0.3, 0.0, 5.0, 100.0, 1e6] {
                for rho in [1e-6, 1.0, 400.0, 1e6] {
                    let scan = Scan { law: &law, beta, rho };
                    let pole = law.buckling(1);
                    let end = scan.upper_end(pole);
                    assert!(end > pole && scan.f(end) > 0.0, "{law:?}, beta {beta}, rho {rho}: {end}");
                }
            }
        }
    }

    #[test]
    fn roots_below_minus_one_exist_only_for_beta_below_minus_one() {
        for law in laws() {
            for beta in [3.0, -0.5, -1.0, -1.0 + f64::EPSILON] {
                assert_eq!(Scan { law: &law, beta, rho: 1.0 }.roots_below_minus_one(), []);
            }
        }
    }

    /// At a fold f touches zero from below; what round-off allows is 32 units of the sum of its terms.
    #[test]
    fn zero_one_and_two_roots_are_distinguished_to_round_off() {
        for (law, rho) in laws().into_iter().zip([6.0, 4.0, 3.0, 20.0]) {
            let (low, high) = (law.buckling(2), law.buckling(1));
            let (a, b) = (low + 1e-3 * (high - low), high - 1e-3 * (high - low));
            // f = without_beta - β, highest at the fold.
            let without_beta = |s: f64| s - 1.0 - rho * law.solve(s).slope_squared();
            let (mut left, mut right) = (a, b);
            while right - left > 1e-9 {
                let (c, d) = (left + (right - left) / 3.0, right - (right - left) / 3.0);
                if without_beta(c) < without_beta(d) { left = c } else { right = d }
            }
            let (s, beta) = (left, without_beta(left));
            let terms = s + (1.0 + beta).abs() + rho * law.solve(s).slope_squared();
            let allowed = 32.0 * f64::EPSILON * terms;
            for (shift, expected) in [(-1.3, 2), (-0.7, 1), (0.7, 1), (1.3, 0)] {
                let scan = Scan { law: &law, beta: beta + shift * allowed, rho };
                let found = match scan.maximum(a, b) {
                    Maximum::Positive(_) => 2,
                    Maximum::Zero(_) => 1,
                    Maximum::Negative => 0,
                };
                assert_eq!(found, expected, "{shift} of {allowed:e}, {law:?}, s = {s}, beta = {beta}");
            }
            let fold = Scan { law: &law, beta, rho }.interval(End::Buckling(low), End::Buckling(high), Some(1));
            let [Root { place: Place::Between(at), unstable_directions: Some(0), fold: true }] = fold[..] else {
                panic!("{fold:?} of {law:?}");
            };
            assert!((at - s).abs() < 1e-6);
            let apart =
                Scan { law: &law, beta: beta - 1e-6, rho }.interval(End::Buckling(low), End::Buckling(high), Some(1));
            let told = apart.iter().map(|root| (root.unstable_directions, root.fold)).collect::<Vec<_>>();
            assert_eq!(told, [(Some(1), false), (Some(0), false)], "{law:?}");
        }
    }
}
