//! Golden section search for a maximum in a bracket.
//!
//! Like bisection it is slow and cannot fail.

/// Number of golden sections: 0.618^90 is 1e-19, below round-off.
const SECTIONS: usize = 90;

/// Golden section search for the maximum of a unimodal function f between `lo` and `hi`.
///
/// * Returns the point and f there. Near a smooth maximum the point has an error of √ε, the value
///   one of ε.
pub fn maximize(f: impl Fn(f64) -> f64, mut lo: f64, mut hi: f64) -> (f64, f64) {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let mut left = hi - ratio * (hi - lo);
    let mut right = lo + ratio * (hi - lo);
    let mut f_left = f(left);
    let mut f_right = f(right);
    for _ in 0..SECTIONS {
        if f_left > f_right {
            hi = right;
            right = left;
            f_right = f_left;
            left = hi - ratio * (hi - lo);
            f_left = f(left);
        } else {
            lo = left;
            left = right;
            f_left = f_right;
            right = lo + ratio * (hi - lo);
            f_right = f(right);
        }
    }
    (left, f_left)
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
