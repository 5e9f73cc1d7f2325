//! The grid convergence index, because reviewers ask for it.

use super::estimate::{Refusal, Value};
use super::growth;

/// Factor of safety if the observed order confirms theory.
pub const SAFETY_CONFIRMED: f64 = 1.25;

/// Factor of safety if it does not.
pub const SAFETY_UNCONFIRMED: f64 = 3.0;

/// The index never uses an order lower than this: the bar of a lower one would be a multiple of the differences.
pub const LOWEST_ORDER: f64 = 0.5;

/// Upper end of the search for the observed order: no scheme has a higher one.
const HIGHEST_ORDER: f64 = 64.0;

/// Roache's index of the finest of three values: `F |q_(m-1) - q_m| / (ρ^p - 1)`.
///
/// Sources: ASME V&V 20-2009, section 2; P. J. Roache, *Verification and Validation in Computational Science and Engineering*, Hermosa 1998. W. L. Oberkampf,
/// C. J. Roy, *Verification and Validation in Scientific Computing*, Cambridge 2010, section 8.6, use the formal order with F = 1.25 where the observed order
/// confirms it, and `min(max(1/2, observed), order)` with F = 3 otherwise. Here that minimum is used in both cases, which is never less cautious.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gci {
    /// Observed order of the three finest values.
    pub observed: f64,
    /// Order that the index was computed with.
    pub order: f64,
    /// F: [`SAFETY_CONFIRMED`] or [`SAFETY_UNCONFIRMED`].
    pub factor: f64,
    /// Half-width of the bar about the finest value, in its unit. Usually it is quoted as a share of that value.
    pub half_width: f64,
}

impl Gci {
    /// * `values`: at least three, finite, steps decreasing.
    pub(super) fn of(values: &[Value], order: f64, tolerance: f64) -> Result<Self, Refusal> {
        let observed = observed_order(values)?;
        let confirmed = (observed - order).abs() <= tolerance;
        let factor = if confirmed { SAFETY_CONFIRMED } else { SAFETY_UNCONFIRMED };
        let used = observed.max(LOWEST_ORDER).min(order);
        let [.., middle, fine] = values else { return Err(Refusal::TooFewValues(values.len())) };
        let half_width = factor * (middle.value - fine.value).abs() / growth(middle.step / fine.step, used);
        Ok(Self { observed, order: used, factor, half_width })
    }
}

/// The order p of the three finest values, from the equation of V&V 20 for unequal ratios,
///
/// ```text
///     p = [ log(d_coarse / d_fine) + log((ρ_fine^p - 1) / (ρ_coarse^p - 1)) ] / log ρ_fine.
/// ```
///
/// The iteration that the standard suggests, right side into left, diverges if the coarse ratio is much the larger (4 and 1.2 with p = 1). The equation is equivalent to
/// `ρ_fine^p (ρ_coarse^p - 1) / (ρ_fine^p - 1) = d_coarse / d_fine`; its left side grows with p, from `log ρ_coarse / log ρ_fine` at p = 0, so bisection finds p.
pub(super) fn observed_order(values: &[Value]) -> Result<f64, Refusal> {
    let [.., coarse, middle, fine] = values else { return Err(Refusal::TooFewValues(values.len())) };
    let quotient = (coarse.value - middle.value) / (middle.value - fine.value);
    let [wide, narrow] = [coarse.step / middle.step, middle.step / fine.step];
    if !quotient.is_finite() {
        return Err(Refusal::NoChange);
    }
    if quotient < 0.0 {
        return Err(Refusal::Oscillating);
    }
    let excess = |p: f64| narrow.powf(p) * growth(wide, p) / growth(narrow, p) - quotient;
    if quotient <= wide.ln() / narrow.ln() {
        return Err(Refusal::Diverging);
    }
    let (mut low, mut high) = (0.0, HIGHEST_ORDER);
    // 60 halvings of 64 reach the spacing of doubles.
    for _ in 0..60 {
        let p = 0.5 * (low + high);
        if excess(p) < 0.0 { low = p } else { high = p }
    }
    Ok(0.5 * (low + high))
}
