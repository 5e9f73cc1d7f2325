//! Golden section search for a maximum in a bracket.
//!
//! Like bisection it is slow and cannot fail.

/// Number of golden sections: 0.618^90 is 1e-19, below round-off.
const SECTIONS: usize = 90;

/// Golden section search for the maximum of a unimodal function f between `lo` and `hi`.
///
/// * Returns the point and f there. Near a smooth maximum the point has an error of √ε, the value
///   one of ε.
pub(super) fn maximize(f: impl Fn(f64) -> f64, mut lo: f64, mut hi: f64) -> (f64, f64) {
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
    fn golden_section_finds_a_maximum_close_to_a_pole() {
        // x - 1e-24 / x² is largest where x³ = -2e-24 from the left: x = -1.26e-8.
        let (x, _) = maximize(|x| x - 1e-24 / (x * x), -1.0, -1e-11);
        assert!((x + 2e-24_f64.cbrt()).abs() < 1e-11, "{x}");
    }
}
