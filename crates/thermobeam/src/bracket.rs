//! Bisection for a root in a bracket.
//!
//! It is slow and cannot fail. It is used where the bracket comes from a proof; a faster method
//! would save only microseconds and need safeguards.

/// More bisections than any bracket of two floats allows: exponent range and mantissa.
const HALVINGS: usize = 2200;

/// The point between `lo` and `hi` where f changes sign, to two neighbouring floats.
///
/// * f must be positive at one end and zero or negative at the other. Zero counts as negative: for
///   a function that vanishes on one side of the point, the boundary of the zero set is returned.
/// * `lo` may be larger than `hi`. f is evaluated at `lo` and inside the bracket, not at `hi`.
/// * Returns one of the two floats between which the sign changes.
pub fn bisect(mut f: impl FnMut(f64) -> f64, mut lo: f64, mut hi: f64) -> f64 {
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
}
