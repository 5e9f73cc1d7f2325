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

use super::law::{Law, Support, free_buckling};
use super::{BUCKLING_VALUES, laws};
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
    let last = free_buckling(BUCKLING_VALUES + 1);
    let moment = beam.a * beam.theta_a;
    let (rest, rho) = (1.0 + beam.beta, beam.rho);
    let has_none = |(contact, law): &(Phase, Law)| {
        let is_excluded = *contact == Phase::Free
            && obstacles.is_some_and(|obstacles| law.misses(obstacles, last));
        rest + rho * law.least_slope_squared(last) >= last || is_excluded
    };
    let is_admitted =
        obstacles.is_none_or(|Obstacles { g1, g2, .. }| *g1 < -moment && -moment < *g2);
    // For ρ = 0 there is one N.
    if rho == 0.0 || laws(beam, obstacles).iter().all(has_none) {
        Completeness::Complete
    } else if moment == 0.0 && rest <= 0.0
        || rest + 1.5 * rho * moment * moment < 0.0 && is_admitted
    {
        Completeness::Infinite
    } else {
        Completeness::Unknown
    }
}

impl Law {
    /// A lower bound of S for all 0 < 1 + N < `last`.
    fn least_slope_squared(&self, last: f64) -> f64 {
        let Some(Support { epsilon, position }) = self.support else {
            return 1.5 * self.moment * self.moment;
        };
        // G is linear in s.
        let [start, end] = [0.0, last].map(|s| position + self.moment * (1.0 + epsilon * s));
        let load = if start * end <= 0.0 {
            0.0
        } else {
            start.abs().min(end.abs())
        };
        // |b| <= s max(1, ε), and k² < 1/s.
        let widest = epsilon.max(1.0);
        let variance = 0.5 + 0.5 * last * widest + 0.5 * last * widest * widest;
        load * load * (1.0 / last - 1.0 - 2.25) / (4.0 * variance)
    }

    /// Whether every free state with 0 < 1 + N < `last` would cross an obstacle.
    fn misses(&self, obstacles: &Obstacles, last: f64) -> bool {
        let moment = self.moment.abs();
        if moment == 0.0 {
            return false;
        }
        // A² V = S - u(1)² <= S < (last - (1 + β))/ρ bounds V, and thus τ.
        let curvature = 0.5 * (1.0 / last - 1.0) - 1.0;
        let variance = (last - (1.0 + self.beta)) / (self.rho * moment * moment);
        let tangent =
            (0.5 + (0.25 + 4.0 * curvature * (variance - 0.5).max(0.0)).sqrt()) / (2.0 * curvature);
        // u(1) + D = D (τ - s)/(1 - s).
        let spread = moment * (tangent + last) / (1.0 - last);
        -self.moment - spread > obstacles.g2 || -self.moment + spread < obstacles.g1
    }
}
