//! One-variable search inside a bracket: a root between two signs, the top of a hump between two flanks.
//!
//! Both are the slowest methods with a proof, and are used only where the bracket itself comes from a proof:
//! a faster method would save microseconds here and need a reason why it cannot leave the bracket.

/// More halvings than any bracket of two floats can take: the exponent range and the mantissa.
const HALVINGS: usize = 2200;

/// 0.618^90 is 1e-19: past it the golden section has nothing left to divide.
const SECTIONS: usize = 90;

/// The point between `lo` and `hi` where f changes sign, down to two neighbouring floats.
///
/// * f must have one sign at `lo` and the other, or zero, at `hi`; neither is evaluated again apart from the sign at `lo`.
///   Zero counts with the negative numbers: of a function that is zero on one side, this is where it ceases to be.
/// * Returns one of the two floats between which the sign changes.
pub(crate) fn bisect(f: impl Fn(f64) -> f64, mut lo: f64, mut hi: f64) -> f64 {
    let starts_positive = f(lo) > 0.0;
    for _ in 0..HALVINGS {
        let middle = lo + 0.5 * (hi - lo);
        if middle == lo || middle == hi {
            break;
        }
        if (f(middle) > 0.0) == starts_positive {
            lo = middle;
        } else {
            hi = middle;
        }
    }
    hi
}

/// Golden section search for the top of f, which rises to it and falls behind it.
///
/// * Returns the point and f there. Near a smooth top the point is exact to √ε only, the value to ε.
pub(crate) fn maximize(f: impl Fn(f64) -> f64, mut lo: f64, mut hi: f64) -> (f64, f64) {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let at = |x: f64| (x, f(x));
    let (mut left, mut right) = (at(hi - ratio * (hi - lo)), at(lo + ratio * (hi - lo)));
    for _ in 0..SECTIONS {
        if left.1 > right.1 {
            hi = right.0;
            right = left;
            left = at(hi - ratio * (hi - lo));
        } else {
            lo = left.0;
            left = right;
            right = at(lo + ratio * (hi - lo));
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bisection_ends_at_neighbouring_floats() {
        let root = bisect(|x| x * x - 2.0, 0.0, 2.0);
        assert!((root - 2.0_f64.sqrt()).abs() <= 2.0 * f64::EPSILON);
        let falling = bisect(|x| 1e-200 - x, 0.0, 1e300);
        assert!((falling - 1e-200).abs() <= 1e-215);
    }

    #[test]
    fn bisection_treats_zero_as_negative() {
        let above = |x: f64| (x - 1.0).max(0.0);
        for (lo, hi) in [(0.0, 2.0), (0.0, 3.0), (2.0, 0.0), (3.0, -1.0)] {
            assert!((bisect(above, lo, hi) - 1.0).abs() <= 2.0 * f64::EPSILON, "{lo} {hi}");
        }
    }

    #[test]
    fn golden_section_finds_a_maximum_close_to_a_pole() {
        // x - 1e-24 / x² is largest where x³ = -2e-24 from the left: x = -1.26e-8.
        let (x, _) = maximize(|x| x - 1e-24 / (x * x), -1.0, -1e-11);
        assert!((x + 2e-24_f64.cbrt()).abs() < 1e-11, "{x}");
    }
}
