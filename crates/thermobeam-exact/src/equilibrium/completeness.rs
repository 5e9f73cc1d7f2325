//! Whether the list of steady states is complete.
//!
//! The list lacks only states with 0 < s < s*, where s = 1 + N and s* is the last free buckling
//! value searched. Such a state is a root of `f(s) = s - (1 + β) - ρS(s)`, S = ‖u'‖², so there is
//! none if `ρS >= s* - (1 + β)` for all these s. With D = aθ_A, k² = (1 - s)/s, τ = tan(k)/k and
//! b = s - εs(1 - s), the law of the state gives
//!
//! ```text
//! u' = A (cos(k(1 - x))/cos k - s) - D,      u(1) = A (τ - s) - D,      S = u(1)² + A² V(τ),
//! V(τ) = ½ + τ/2 + (k²/2 - 1) τ²,
//! A = D/(1 - s) without a support,           A = G/(τ - b),  G = g + D (1 + εs),  with one at g.
//! ```
//!
//! *Without a support* the least S over τ is `D² (3/2 - 9/(8k²))/(1 - s)²`, at least 3/2 D². It is
//! reached between any two buckling values and tends to 3/2 D² for s → 0, so that for 1 + β + 3/2
//! ρD² < 0 infinitely many intervals have roots. There u(1) → -D: only obstacles with g₁ <= -D <=
//! g₂ admit these states. Without a load, D = 0, the pairs of bent states at all N_k > β are
//! states, and u(1) → 0.
//!
//! *With a support* the least quotient `V(τ)/(τ - b)²` over τ is `(k² - 9/4)/(4 V(b))`, so S is at
//! least G² times that: it grows like (g + D)²/(2s) for s → 0, and the number of states is finite
//! unless g = -D.

use super::law::{ForceLaw, Support, free_pole};
use super::{BUCKLING_VALUES, laws};
use crate::interval::Enclosure;
use thermobeam::contact::Phase;
use thermobeam::parameters::{Beam, Obstacles};

/// What is known about the states that [`equilibria`](super::equilibria) does not list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Completeness {
    /// There are none.
    Complete,
    /// There may be some, all with -1 < N < -0.9996 and unstable.
    Unknown,
    /// There are infinitely many, which accumulate at N = -1; all are unstable.
    Infinite,
}

/// Whether [`equilibria`](super::equilibria) returns every steady state.
///
/// [`Completeness::Complete`] and [`Completeness::Infinite`] are proven; the list is complete for
/// every β > -0.9996.
pub fn completeness(beam: &Beam, obstacles: Option<&Obstacles>) -> Completeness {
    let last = last_value();
    let moment = Enclosure::from(beam.a) * beam.theta_a;
    let (rest, rho) = (Enclosure::from(1.0) + beam.beta, beam.rho);
    let has_none = |(contact, law): &(Phase, ForceLaw)| {
        let is_excluded = *contact == Phase::Free
            && obstacles.is_some_and(|obstacles| law.misses(moment, obstacles));
        (rest + law.least_slope_squared(moment) * rho).lo >= last.hi || is_excluded
    };
    let is_admitted =
        obstacles.is_none_or(|Obstacles { g1, g2, .. }| *g1 < -moment.hi && -moment.lo < *g2);
    // For ρ = 0 there is one N.
    if rho == 0.0 || laws(beam, obstacles).iter().all(has_none) {
        Completeness::Complete
    } else if beam.a * beam.theta_a == 0.0 && beam.beta <= -1.0
        || (rest + moment.square() * (1.5 * rho).next_up()).is_negative() && is_admitted
    {
        Completeness::Infinite
    } else {
        Completeness::Unknown
    }
}

/// s*, the last free buckling value searched.
fn last_value() -> Enclosure {
    free_pole(BUCKLING_VALUES + 1)
}

impl ForceLaw {
    /// A lower bound of S for all 0 < 1 + N < s*.
    fn least_slope_squared(&self, moment: Enclosure) -> Enclosure {
        let last = last_value();
        let Some(Support { epsilon, position }) = self.support else {
            return moment.square() * 1.5;
        };
        // G is linear in s.
        let start = moment + position;
        let end = moment * (last * epsilon + 1.0) + position;
        let load = if start.is_positive() && end.is_positive()
            || start.is_negative() && end.is_negative()
        {
            let least = start.square().lo.min(end.square().lo);
            Enclosure::from(least)
        } else {
            return Enclosure::from(0.0);
        };
        // |b| <= s max(1, ε), and k² < 1/s.
        let widest = Enclosure::from(epsilon.max(1.0));
        let variance = last * widest * 0.5 + last * widest.square() * 0.5 + 0.5;
        load * (Enclosure::from(1.0) / last - 3.25) / (variance * 4.0)
    }

    /// Whether every free state with 0 < 1 + N < s* would cross an obstacle.
    fn misses(&self, moment: Enclosure, obstacles: &Obstacles) -> bool {
        if self.moment == 0.0 {
            return false;
        }
        let last = last_value();
        let squared = moment.square();
        // A² V = S - u(1)² <= S < (s* - (1 + β))/ρ bounds V, and thus τ.
        let curvature = (Enclosure::from(1.0) / last - 1.0) * 0.5 - 1.0;
        let rest = Enclosure::from(1.0) + self.beta;
        let variance = (last - rest) / (squared * self.rho);
        let excess = (variance - 0.5).hi.max(0.0);
        let root = (curvature * 4.0 * excess + 0.25).sqrt();
        let tangent = (root + 0.5) / (curvature * 2.0);
        // u(1) + D = D (τ - s)/(1 - s).
        let spread = squared.sqrt() * (tangent + last) / (Enclosure::from(1.0) - last);
        (-moment - spread.hi).lo > obstacles.g2 || (-moment + spread.hi).hi < obstacles.g1
    }
}
