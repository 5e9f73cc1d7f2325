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
use crate::bracket::{bisect, climb};

/// A root closer to a pole than this, relative to `1 + N`, is sought by its amplitude instead of by N.
///
/// Far above round-off, so that f's sign is certain at this distance; far below any distance that matters,
/// so that the amplitude follows from the pole's N alone to eleven digits.
const POLE_GAP: f64 = 1e-11;

/// How many units of round-off of its largest term f may be from zero at its top to count as a double root.
const FOLD: f64 = 32.0 * f64::EPSILON;

/// s closest to 0 from below that is told apart from N = -1.
const DEEP_GAP: f64 = 1e-14;

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
    pub(super) fn shallow(&self, waves: usize) -> Vec<Root> {
        let rest = 1.0 + self.beta;
        let mut hi = End::Plain(self.beyond(self.law.buckling(1)));
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
    pub(super) fn deep(&self) -> Vec<Root> {
        let rest = 1.0 + self.beta;
        if rest >= -DEEP_GAP {
            return Vec::new();
        }
        let top = End::Plain(-DEEP_GAP);
        match self.law.deep_buckling() {
            Some(pole) if rest < pole => {
                let mut roots = self.interval(End::Plain(rest), End::Buckling(pole), None);
                roots.extend(self.interval(End::Buckling(pole), top, None));
                roots
            }
            _ => self.interval(End::Plain(rest), top, None),
        }
    }

    fn f(&self, s: f64) -> f64 {
        s - (1.0 + self.beta) - self.rho * self.law.solve(s).stretch()
    }

    /// Some s above the largest pole where f > 0.
    ///
    /// Where `s > max(pole, 1 + β)`, `f(s + ρS(s)) >= s - (1 + β) > 0`, because S falls there.
    fn beyond(&self, pole: f64) -> f64 {
        let s = 2.0 * (pole + (1.0 + self.beta).abs());
        s + self.rho * self.law.solve(s).stretch()
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
            (false, false) => match self.top(a, b) {
                Top::Above(s) => [Some(rising(between(a, s))), Some(falling(between(s, b)))],
                Top::Touching(s) => [Some(Root { fold: true, ..falling(Place::Between(s)) }), None],
                Top::Below => [None, None],
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
    fn top(&self, a: f64, b: f64) -> Top {
        let noise = |s: f64| {
            let stretch = self.rho * self.law.solve(s).stretch();
            FOLD * (s.abs() + (1.0 + self.beta).abs() + stretch)
        };
        let (s, value) = climb(|s| self.f(s), a, b);
        if value > noise(s) {
            Top::Above(s)
        } else if value >= -noise(s) {
            Top::Touching(s)
        } else {
            Top::Below
        }
    }
}

enum Top {
    Above(f64),
    Touching(f64),
    Below,
}

#[cfg(test)]
mod tests {
    use super::super::HALF_WAVES;
    use super::super::law::Support;
    use super::*;

    fn laws() -> [Law; 4] {
        let support = |epsilon, position| Some(Support { epsilon, position });
        [(0.5, None), (0.5, support(0.5, 0.125)), (-0.25, support(0.01, -0.5)), (0.0, support(2.0, 0.25))]
            .map(|(drive, support)| Law { drive, support })
    }

    #[test]
    fn a_root_is_found_wherever_it_is() {
        let mut deep = 0;
        for law in laws() {
            for s in [5.0, 1.5, 0.9, 0.5, 0.15, 0.06, 0.011, -0.02, -0.3, -0.9, -2.0, -6.0, -40.0, -200.0] {
                for rho in [0.25, 30.0] {
                    // β that has a root at this s.
                    let beta = s - 1.0 - rho * law.solve(s).stretch();
                    let scan = Scan { law: &law, beta, rho };
                    let roots = if s > 0.0 { scan.shallow(HALF_WAVES + 1) } else { scan.deep() };
                    let is_found = |root: &Root| match root.place {
                        Place::Between(found) => (found / s - 1.0).abs() < 1e-9,
                        Place::Buckling(..) => false,
                    };
                    let found: Vec<&Root> = roots.iter().filter(|root| is_found(root)).collect();
                    assert_eq!(found.len(), 1, "{s}, rho {rho} of {law:?}: {roots:?}");
                    deep += usize::from(found[0].unstable_directions.is_none());
                }
            }
        }
        assert_eq!(deep, 4 * 7 * 2, "no count of unstable directions below N = -1");
    }

    #[test]
    fn f_is_positive_at_the_end_above_the_root() {
        for (law, drive) in laws().into_iter().flat_map(|law| [0.01, 1.0, 60.0, 1e4].map(|drive| (law, drive))) {
            let law = Law { drive, ..law };
            for beta in [-40.0, -1.0, -0.9, -0.3, 0.0, 5.0, 100.0, 1e6] {
                for rho in [1e-6, 1.0, 400.0, 1e6] {
                    let scan = Scan { law: &law, beta, rho };
                    let pole = law.buckling(1);
                    let end = scan.beyond(pole);
                    assert!(end > pole && scan.f(end) > 0.0, "{law:?}, beta {beta}, rho {rho}: {end}");
                }
            }
        }
    }

    #[test]
    fn nothing_is_sought_below_minus_one_unless_beta_is() {
        for law in laws() {
            for beta in [3.0, -0.5, -1.0, -1.0 + f64::EPSILON] {
                assert_eq!(Scan { law: &law, beta, rho: 1.0 }.deep(), []);
            }
        }
    }

    /// At a fold f touches zero from below; what round-off allows is 32 units of the sum of its terms.
    #[test]
    fn a_double_root_is_told_from_two_and_from_none_to_round_off() {
        for (law, rho) in laws().into_iter().zip([6.0, 4.0, 3.0, 20.0]) {
            let (low, high) = (law.buckling(2), law.buckling(1));
            let (a, b) = (low + 1e-3 * (high - low), high - 1e-3 * (high - low));
            // f = climbed - β, highest at the fold.
            let climbed = |s: f64| s - 1.0 - rho * law.solve(s).stretch();
            let (mut left, mut right) = (a, b);
            while right - left > 1e-9 {
                let (c, d) = (left + (right - left) / 3.0, right - (right - left) / 3.0);
                if climbed(c) < climbed(d) { left = c } else { right = d }
            }
            let (s, beta) = (left, climbed(left));
            let terms = s + (1.0 + beta).abs() + rho * law.solve(s).stretch();
            let allowed = 32.0 * f64::EPSILON * terms;
            for (shift, expected) in [(-1.3, 2), (-0.7, 1), (0.7, 1), (1.3, 0)] {
                let scan = Scan { law: &law, beta: beta + shift * allowed, rho };
                let found = match scan.top(a, b) {
                    Top::Above(_) => 2,
                    Top::Touching(_) => 1,
                    Top::Below => 0,
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
