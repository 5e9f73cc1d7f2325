//! Gauss-Legendre quadrature on an element.

/// Points on [0, 1] and weights of the rule with five points, exact for polynomials up to degree 9.
///
/// `½ (1 ± ξ)` for the zeros ξ of the Legendre polynomial P_5, `ξ² = (5 ± 2√(10/7))/9`, and half their weights
/// `(322 ∓ 13√70)/900`, `128/225`.
pub(crate) const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668_004, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_24),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_24),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_exact_to_degree_nine_and_no_further() {
        let integral = |degree: i32| GAUSS.iter().map(|(x, w)| w * x.powi(degree)).sum::<f64>();
        for degree in 0..=9 {
            assert!((integral(degree) - 1.0 / f64::from(degree + 1)).abs() < 2e-16, "{degree}");
        }
        assert!((integral(10) - 1.0 / 11.0).abs() > 1e-7);
    }
}
