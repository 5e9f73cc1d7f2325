//! The order of three values at three steps, and the limit that it gives.

use crate::richardson::NoErrorBar;

/// A value at a step; NaN if there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepValue {
    /// Step size, h or dt; positive, and smaller from level to level.
    pub step: f64,
    /// The value computed.
    pub value: f64,
}

/// Upper end of the search for the observed order: no scheme has a higher one.
const HIGHEST_ORDER: f64 = 64.0;

/// `r^p - 1`: the difference of two values over the error at the finer step.
pub fn growth(ratio: f64, order: f64) -> f64 {
    ratio.powf(order) - 1.0
}

/// The number to add to the value at the finer step to get the limit, for steps of this ratio.
pub fn correction(coarse: f64, fine: f64, ratio: f64, order: f64) -> f64 {
    (fine - coarse) / growth(ratio, order)
}

/// The order p of three values, coarse to fine, from the equation of ASME V&V 20 for unequal
/// ratios,
///
/// ```text
///     p = [ log(d_coarse / d_fine) + log((ρ_fine^p - 1) / (ρ_coarse^p - 1)) ] / log ρ_fine.
/// ```
///
/// The iteration that the standard suggests, right side into left, diverges if the coarse ratio is
/// much the larger (4 and 1.2 with p = 1). The equation is equivalent to
/// `ρ_fine^p (ρ_coarse^p - 1) / (ρ_fine^p - 1) = d_coarse / d_fine`; its left side grows with p,
/// from `log ρ_coarse / log ρ_fine` at p = 0, so bisection finds p.
pub(crate) fn observed_order([coarse, middle, fine]: [StepValue; 3]) -> Result<f64, NoErrorBar> {
    let quotient = (coarse.value - middle.value) / (middle.value - fine.value);
    let [wide, narrow] = [coarse.step / middle.step, middle.step / fine.step];
    if !quotient.is_finite() {
        return Err(NoErrorBar::NoChange);
    }
    if quotient < 0.0 {
        return Err(NoErrorBar::Oscillating);
    }
    let excess = |p: f64| narrow.powf(p) * growth(wide, p) / growth(narrow, p) - quotient;
    if quotient <= wide.ln() / narrow.ln() {
        return Err(NoErrorBar::Diverging);
    }
    let mut low = 0.0;
    let mut high = HIGHEST_ORDER;
    // 60 halvings of 64 reach the spacing of doubles.
    for _ in 0..60 {
        let p = 0.5 * (low + high);
        if excess(p) < 0.0 { low = p } else { high = p }
    }
    Ok(0.5 * (low + high))
}

/// The first level, from 0, that has the value of the level before, though of this order it differs
/// from it by more than the floor: no round-off makes two such values one.
pub(crate) fn repeated_value(values: &[StepValue], order: f64, floor: f64) -> Option<usize> {
    /// Largest share of the difference that the order makes.
    const SHARE: f64 = 1e-3;
    let repeats = |three: &[StepValue]| {
        let [first, second] = [0, 1].map(|k| (three[k].value - three[k + 1].value).abs());
        let [wide, narrow] = [0, 1].map(|k| three[k].step / three[k + 1].step);
        let expected = first * growth(narrow, order) / growth(wide, order) * narrow.powf(-order);
        expected > floor && second <= floor && second <= SHARE * expected
    };
    values.windows(3).position(repeats).map(|k| k + 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 + h² at steps with the ratios 2 and ρ, the last of which has the value before: h² would
    /// make it differ by (1 - ρ^-2)/4.
    #[test]
    fn a_value_repeats_only_if_its_order_makes_a_difference_above_the_floor() {
        for ratio in [1.25, 2.0, 4.0_f64] {
            let values = [1.0, 0.5, 0.5 / ratio].map(|step: f64| StepValue {
                step,
                value: 1.0 + step.max(0.5).powi(2),
            });
            let expected = 0.25 * (1.0 - ratio.powi(-2));
            let found = |floor: f64| repeated_value(&values, 2.0, floor * expected);
            assert_eq!([found(0.99), found(1.01)], [Some(2), None], "{ratio}");
        }
    }
}
