//! Errors without an exact solution: what the values themselves say about their limit.
//!
//! # Derivation
//!
//! Let a value at the step h be `q(h) = Q + C h^p (1 + c h^r + ...)`, Q the limit, and let the
//! steps decrease, `h_1 > h_2 > ... > h_m`, with any ratios `ρ_k = h_k / h_(k+1)`. The differences
//! of neighbours and Richardson's estimate of the error of the finer one are
//!
//! ```text
//!     d_k = q_k - q_(k+1) = (ρ_k^p - 1) C h_(k+1)^p (1 + c K h_(k+1)^r + ...),        K = (ρ^(p+r) - 1) / (ρ^p - 1)
//!     q_(k+1) - Q  ≈  d_k / (ρ_k^p - 1).
//! ```
//!
//! *Rate.* d_k is C times the difference of h^p over its pair, with the pollution of both ends. In
//!
//! ```text
//!     x_k = (h_k^(p+1) - h_(k+1)^(p+1)) / (h_k^p - h_(k+1)^p),        |d_k| x_k^p / (h_k^p - h_(k+1)^p)  =  |C| x_k^p (1 + c x_k)   if r = 1
//! ```
//!
//! the numbers on the right, here called reduced differences, are errors of order p at the steps
//! x_k, polluted as those of q are at h (exactly for r = 1, otherwise but for a factor of c that
//! depends little on ρ_k). [The rule](crate::verdict) reads their rate with its interval, and says
//! whether they are asymptotic. With one ratio for all levels they are the differences at the finer
//! steps, in other units: those of the finest difference are used. Otherwise they depend on p
//! itself: p is the number for which the rate read is p.
//!
//! If only the sizes are reduced, `|d_k| / (ρ_k^p - 1)` at h_(k+1), a wrong p bends them as much as
//! a lower order does: the number p that is read then absorbs the trend of `h² - b h`, and passes
//! where the errors do not. Here the size is that at a mean step, which p hardly moves. What is
//! left to absorb is found at the claimed order, of which the reduced differences are errors if the
//! claim is true: a pass needs both, in the interval that holds both intervals.
//!
//! *Error bar.* Each rate in the interval `[p_1, p_2]` has its estimate: the error of the finest
//! value is between `d / (ρ^p_2 - 1)` and `d / (ρ^p_1 - 1)`, d and ρ being the last. This allows
//! for pollution, too: the finest pairwise rate of the differences is off p by
//! `Δ ≈ c K h_m^r (ρ^r - 1) / log ρ`, and the interval allows for that much on either side of p.
//! Changing the rate by Δ changes the estimate by the share `Δ log ρ ρ^p / (ρ^p - 1)`, which is
//! `c h_m^r K (ρ^r - 1) ρ^p / (ρ^p - 1)`. Pollution changes it by
//! `c h_m^r (K - 1) = c h_m^r ρ^p (ρ^r - 1) / (ρ^p - 1)`, smaller by the factor K > 1.
//!
//! *Scatter.* If e_k scatters by the share σ, the logarithm of the last difference scatters by
//! `S = σ √(ρ^2p + 1) / (ρ^p - 1)`, which the fits of the rule leave unexplained, and the estimate
//! differs from the error by the share `σ √2 ρ^p / (ρ^p - 1) = S √2 ρ^p / √(ρ^2p + 1)`: the bar is
//! extended by this factor at either end, and by the round-off of both values.
//!
//! *Three values* give one rate, and nothing in them shows how uncertain it is; the order claimed
//! has to help. All rates from [`DOUBT_OF_A_SINGLE_RATE`] below the lower of the two to the same
//! distance above the higher are then considered possible.
//!
//! How often the limit is held if the errors scatter by 2 % is measured by
//! `convergence-calibration`: 9 times in 10 for five values, whose two rates may agree by chance,
//! and more often for any other number.
//!
//! # What no difference can see
//!
//! A wrong limit. The bar measures the distance to the value that the sequence tends to.

mod estimate;
#[cfg(test)]
mod tests;

use super::three_values;
pub(crate) use super::three_values::repeated_value;
pub use super::three_values::{StepValue, correction, growth};
pub use estimate::{Bar, DOUBT_OF_A_SINGLE_RATE, Estimate, Estimator, NoErrorBar};
pub(crate) use estimate::{
    RATES, crossing, have_one_ratio, judge_both, reduce as differences_of_order,
};

/// Factor of safety if the observed order confirms theory.
pub const SAFETY_CONFIRMED: f64 = 1.25;

/// Factor of safety if it does not.
pub const SAFETY_UNCONFIRMED: f64 = 3.0;

/// The index never uses an order lower than this: the bar of a lower one would be a multiple of the
/// differences.
pub const LOWEST_ORDER: f64 = 0.5;

/// Roache's index of the finest of three values: `F |q_(m-1) - q_m| / (ρ^p - 1)`.
///
/// Sources: ASME V&V 20-2009, section 2; P. J. Roache, *Verification and Validation in
/// Computational Science and Engineering*, Hermosa 1998. W. L. Oberkampf, C. J. Roy, *Verification
/// and Validation in Scientific Computing*, Cambridge 2010, section 8.6, use the formal order with
/// F = 1.25 where the observed order confirms it, and `min(max(1/2, observed), order)` with F = 3
/// otherwise. Here that minimum is used in both cases, and the observed order confirms the formal
/// one where it is within the tolerance of the claim: a wider tolerance gives F = 1.25 more often.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Gci {
    /// Observed order of the three finest values.
    pub observed: f64,
    /// Order that the index was computed with.
    pub order: f64,
    /// F: [`SAFETY_CONFIRMED`] or [`SAFETY_UNCONFIRMED`].
    pub factor: f64,
    /// Half-width of the bar about the finest value, in its unit. Usually it is quoted as a share
    /// of that value.
    pub half_width: f64,
}

impl Gci {
    /// * `values`: at least three, finite, steps decreasing.
    fn of(values: &[StepValue], order: f64, tolerance: f64) -> Result<Self, NoErrorBar> {
        let observed = observed_order(values)?;
        let confirmed = (observed - order).abs() <= tolerance;
        let factor = if confirmed {
            SAFETY_CONFIRMED
        } else {
            SAFETY_UNCONFIRMED
        };
        let used = observed.max(LOWEST_ORDER).min(order);
        let [.., middle, fine] = values else {
            return Err(NoErrorBar::TooFewValues(values.len()));
        };
        let half_width =
            factor * (middle.value - fine.value).abs() / growth(middle.step / fine.step, used);
        Ok(Self {
            observed,
            order: used,
            factor,
            half_width,
        })
    }
}

/// The [observed order](three_values::observed_order) of the three finest values.
fn observed_order(values: &[StepValue]) -> Result<f64, NoErrorBar> {
    let [.., coarse, middle, fine] = values else {
        return Err(NoErrorBar::TooFewValues(values.len()));
    };
    three_values::observed_order([*coarse, *middle, *fine])
}
