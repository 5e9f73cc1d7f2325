//! Bisection for a root in a bracket, and golden section search for a maximum in a bracket.
//!
//! Both methods are slow and cannot fail. They are used where the bracket comes from a proof; faster methods would save
//! only microseconds and need safeguards.

/// More bisections than any bracket of two floats allows: exponent range and mantissa.
const HALVINGS: usize = 2200;

/// Number of golden sections: 0.618^90 is 1e-19, below round-off.
const SECTIONS: usize = 90;

/// The point between `lo` and `hi` where f changes sign, to two neighbouring floats.
///
/// * f must be positive at one end and zero or negative at the other. Zero counts as negative: for a function that
///   vanishes on one side of the point, the boundary of the zero set is returned.
/// * `lo` may be larger than `hi`. f is evaluated at `lo` and inside the bracket, not at `hi`.
/// * Returns one of the two floats between which the sign changes.
pub(crate) fn bisect(mut f: impl FnMut(f64) -> f64, mut lo: f64, mut hi: f64) -> f64 {
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

/// Golden section search for the maximum of a unimodal function f between `lo` and `hi`.
///
/// * Returns the point and f there. Near a smooth maximum the point has an error of √ε, the value one of ε.
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
            assert!(
                (bisect(above, lo, hi) - 1.0).abs() <= 2.0 * f64::EPSILON,
                "{lo} {hi}"
            );
        }
    }

    #[test]
    fn golden_section_finds_a_maximum_close_to_a_pole() {
        // x - 1e-24 / x² is largest where x³ = -2e-24 from the left: x = -1.26e-8.
        let (x, _) = maximize(|x| x - 1e-24 / (x * x), -1.0, -1e-11);
        assert!((x + 2e-24_f64.cbrt()).abs() < 1e-11, "{x}");
    }
}
