//! Gauss-Legendre quadrature on each element, for errors against functions that are not piecewise linear.

use thermobeam::mesh::Mesh;

/// Number of points per element.
pub const POINTS: usize = 5;

/// Gauss-Legendre with 5 points, exact to degree 9: `(s, weight)` on [0, 1], weights adding up to 1.
///
/// On [-1, 1] the points are 0 and ±⅓√(5 ∓ 2√(10/7)), the weights 128/225 and (322 ± 13√70)/900; here they are
/// transformed to [0, 1]. The relative error of ∫ e² for e = O(h²) is O(h^10), negligible for the errors that are
/// measured.
pub const RULE: [(f64, f64); POINTS] = [
    (0.046_910_077_030_668_004, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// The quadrature points of a mesh in increasing order, [`POINTS`] per element.
pub fn points(mesh: &Mesh) -> Vec<f64> {
    let on_element = |ends: &[f64]| RULE.map(|(s, _)| ends[0] + s * (ends[1] - ends[0]));
    mesh.nodes().windows(2).flat_map(on_element).collect()
}

/// `∫₀¹ f dx`.
///
/// * `lengths`: the element lengths.
/// * `f(element, s, point)`: the integrand at s in (0, 1) of an element; `point` is the index into [`points`].
pub fn integrate(lengths: &[f64], mut f: impl FnMut(usize, f64, usize) -> f64) -> f64 {
    let mut sum = 0.0;
    for (element, &h) in lengths.iter().enumerate() {
        for (k, (s, weight)) in RULE.into_iter().enumerate() {
            sum += h * weight * f(element, s, element * POINTS + k);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degree_nine_is_exact_and_degree_ten_is_not() {
        let mesh = Mesh::from_nodes(vec![0.0, 0.3, 1.0]).expect("a mesh");
        let (lengths, at): (Vec<f64>, Vec<f64>) = (mesh.lengths().collect(), points(&mesh));
        for degree in 0..10 {
            let found = integrate(&lengths, |_, _, point| at[point].powi(degree));
            assert!((found - 1.0 / f64::from(degree + 1)).abs() < 4.0 * f64::EPSILON, "{degree}: {found}");
        }
        // The rule's error on one element of length 1 is (5!)^4 / (11 (10!)^3) f^(10) = 1.4e-6 for x^10.
        let found = integrate(&[1.0], |_, s, _| s.powi(10));
        assert!((1.0 / 11.0 - found - 1.4e-6).abs() < 1e-7, "{found}");
    }

    #[test]
    fn the_quadrature_points_are_those_of_the_formula() {
        let far = (5.0 + 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
        let near = (5.0 - 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
        for (k, x) in [-far, -near, 0.0, near, far].into_iter().enumerate() {
            assert!((RULE[k].0 - 0.5 * (1.0 + x)).abs() < f64::EPSILON);
        }
    }
}
