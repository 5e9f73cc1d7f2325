//! Errors without an exact solution: what the values themselves say of their limit.
//!
//! # Derivation
//!
//! Let a value at the step h be `q(h) = Q + C h^p (1 + c h^r + ...)`, Q the limit, and the steps decrease, `h_1 > h_2 > ... > h_m`, with the
//! ratios `ρ_k = h_k / h_(k+1)`, any. The differences of neighbours and Richardson's estimate of the error of the finer one are
//!
//! ```text
//!     d_k = q_k - q_(k+1) = (ρ_k^p - 1) C h_(k+1)^p (1 + c K h_(k+1)^r + ...),        K = (ρ^(p+r) - 1) / (ρ^p - 1)
//!     q_(k+1) - Q  ≈  d_k / (ρ_k^p - 1).
//! ```
//!
//! *Rate.* So the numbers `|d_k| (ρ_m^p - 1) / (ρ_k^p - 1)` at the steps `h_(k+1)`, here called reduced differences, are a sequence of errors of
//! order p, polluted by the same powers as q. [The rule](crate::judge::verdict) reads their rate with its interval, and says whether they are asymptotic.
//! With one ratio for all levels they are the differences. Otherwise they depend on p itself: p is the number for which the rate read is p.
//!
//! *Error bar.* Each rate in the interval `[p_1, p_2]` has its estimate: the error of the finest value is between `d / (ρ^p_2 - 1)` and `d / (ρ^p_1 - 1)`,
//! d and ρ being the last. This answers for pollution, too: the finest pairwise rate of the differences is off p by
//! `Δ ≈ c K h_m^r (ρ^r - 1) / log ρ`, and so much the interval allows for on either side of p. A change of the rate by Δ changes the estimate by the share
//! `Δ log ρ ρ^p / (ρ^p - 1)`, which is `c h_m^r K (ρ^r - 1) ρ^p / (ρ^p - 1)`; what pollution does to it is
//! `c h_m^r (K - 1) = c h_m^r ρ^p (ρ^r - 1) / (ρ^p - 1)`, smaller by the factor K > 1.
//!
//! *Scatter.* Where e_k scatters by the share σ, the logarithm of the last difference scatters by `S = σ √(ρ^2p + 1) / (ρ^p - 1)`, which is what the rule's
//! fits leave unexplained, and the estimate is off the error by the share `σ √2 ρ^p / (ρ^p - 1) = S √2 ρ^p / √(ρ^2p + 1)`: the bar is longer by this factor on
//! either end. And it is longer by the round-off of both values.
//!
//! *Three values* give one rate, and nothing in them tells its doubt; the order claimed has to help. All rates are then taken for possible from
//! [`DOUBT_OF_A_SINGLE_RATE`] below the lower to as much above the higher of the two.
//!
//! How often the bars hold the error is [measured](crate::judge::calibration): 97 times in 100; of five values that scatter, whose two rates may agree by chance, 9 times in 10.
//!
//! # What no difference can see
//!
//! A limit that is the wrong one. The bar is about the distance to what the values tend to.

use crate::text::number::max_or_nan;

mod estimate;
mod gci;

pub use estimate::{Bar, DOUBT_OF_A_SINGLE_RATE, Estimate, Estimator, Refusal, Value};
pub(crate) use estimate::{RATES, crossing};
pub use gci::{Gci, LOWEST_ORDER, SAFETY_CONFIRMED, SAFETY_UNCONFIRMED};

/// Below this an observed rate says that the sequence does not converge yet.
const LOWEST_RATE: f64 = 0.5;

/// `r^p - 1`: how many times the error at the finer step the difference of the two is.
pub fn growth(ratio: f64, order: f64) -> f64 {
    ratio.powf(order) - 1.0
}

/// The same in a norm in which the interpolation error is orthogonal to all the rest, so that squares add: `√(r^2p - 1)`.
pub fn orthogonal_growth(ratio: f64, order: f64) -> f64 {
    growth(ratio * ratio, order).sqrt()
}

/// What has to be added to the value at the finer step for the limit, steps being of the given ratio.
pub fn correction(coarse: f64, fine: f64, ratio: f64, order: f64) -> f64 {
    (fine - coarse) / growth(ratio, order)
}

/// The error at h from the differences of h against 2h (`fine`) and of 2h against 4h (`coarse`), and the observed rate.
///
/// A rate above the `order` of theory is not used: near a zero of `fine` it would promise an error of nothing. It is
/// cut at the order, and the error is then read off `coarse`. Below ½ it is cut too.
pub fn error_and_rate(fine: f64, coarse: f64, order: f64) -> (f64, Option<f64>) {
    let rate = Some((coarse / fine).log2()).filter(|rate| rate.is_finite());
    let p = rate.map_or(order, |rate| rate.clamp(LOWEST_RATE, order));
    (max_or_nan(fine, coarse / 2f64.powf(p)) / growth(2.0, p), rate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clean_sequence_gives_its_error() {
        for p in [1.0_f64, 1.5, 2.0] {
            let q = |h: f64| 1.0 + 0.3 * h.powf(p);
            let (error, rate) = error_and_rate((q(0.2) - q(0.1)).abs(), (q(0.4) - q(0.2)).abs(), 2.0);
            assert!((error - 0.3 * 0.1_f64.powf(p)).abs() < 1e-12);
            assert!((rate.unwrap() - p).abs() < 1e-10);
            for ratio in [2.0, 3.0] {
                let limit = q(0.1) + correction(q(0.1 * ratio), q(0.1), ratio, p);
                assert!((limit - 1.0).abs() < 1e-14, "{limit}");
            }
        }
    }

    #[test]
    fn orthogonal_errors_add_by_their_squares() {
        // An error 3 h^p at h, orthogonal to that of the other mesh's interpolation: differences by Pythagoras.
        let (coarse, fine) = (3.0 * 4.0_f64, 3.0_f64);
        let difference = (coarse * coarse - fine * fine).sqrt();
        assert!((difference / orthogonal_growth(2.0, 2.0) - fine).abs() < 1e-14);
    }

    #[test]
    fn an_accidental_agreement_promises_nothing() {
        let (error, _) = error_and_rate(1e-9, 1e-3, 1.0);
        assert!(error > 4e-4, "{error}");
        let (error, rate) = error_and_rate(1e-3, 1e-3, 2.0);
        assert!(error > 2e-3 && rate == Some(0.0), "{error}");
    }

    #[test]
    fn nothing_moves_and_nothing_is_hidden() {
        assert_eq!(error_and_rate(0.0, 0.0, 2.0), (0.0, None));
        assert!(error_and_rate(f64::NAN, 1.0, 2.0).0.is_nan());
        assert!(error_and_rate(1.0, f64::NAN, 2.0).0.is_nan());
    }
}
