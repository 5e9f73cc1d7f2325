//! Gauss-Legendre quadrature on each element, for errors against functions that are not piecewise
//! linear.

/// Gauss-Legendre with 5 points, exact to degree 9: `(s, weight)` on [0, 1], with weights that sum
/// to 1.
///
/// On [-1, 1] the points are 0 and ±⅓√(5 ∓ 2√(10/7)), the weights 128/225 and (322 ± 13√70)/900;
/// here they are transformed to [0, 1]. The relative error of ∫ e² for e = O(h²) is O(h^10),
/// negligible for the measured errors.
pub const RULE: [(f64, f64); 5] = [
    (0.046_910_077_030_668_004, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degree_nine_is_exact_and_degree_ten_is_not() {
        let integral = |degree: i32| {
            RULE.iter()
                .map(|(s, weight)| weight * s.powi(degree))
                .sum::<f64>()
        };
        for degree in 0..10 {
            let found = integral(degree);
            assert!(
                (found - 1.0 / f64::from(degree + 1)).abs() < 4.0 * f64::EPSILON,
                "{degree}: {found}"
            );
        }
        // The rule's error on one element of length 1 is (5!)^4 / (11 (10!)^3) f^(10) = 1.4e-6 for
        // x^10.
        assert!(
            (1.0 / 11.0 - integral(10) - 1.4e-6).abs() < 1e-7,
            "{}",
            integral(10)
        );
    }
}
