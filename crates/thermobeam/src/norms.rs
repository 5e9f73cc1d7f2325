//! Exact norms of P1 functions from their nodal values, the norm of Theorem 3.4, and a maximum that
//! keeps NaN.

use crate::lanes::Lane;

/// `∫ p q` over an element, or over one element of each case in lanes, for linear p and q.
///
/// * `sixth`: a sixth of the element's length.
/// * `p`, `q`: the values at both ends.
#[inline(always)]
pub(crate) fn element_product<T: Lane>(sixth: T, p: [T; 2], q: [T; 2]) -> T {
    let two = T::splat(2.0);
    sixth * (p[0] * (two * q[0] + q[1]) + p[1] * (q[0] + two * q[1]))
}

/// `‖y‖²` of a P1 function; `lengths` are the n element lengths, `y` the n + 1 nodal values.
pub(crate) fn l2_squared(lengths: &[f64], y: &[f64]) -> f64 {
    lengths
        .iter()
        .zip(y.windows(2))
        .map(|(&h, y)| element_product(h / 6.0, [y[0], y[1]], [y[0], y[1]]))
        .sum()
}

/// `‖y_x‖²` of a P1 function; arguments as in [`l2_squared`].
pub(crate) fn slope_squared(lengths: &[f64], y: &[f64]) -> f64 {
    lengths
        .iter()
        .zip(y.windows(2))
        .map(|(&h, y)| (y[1] - y[0]) * (y[1] - y[0]) / h)
        .sum()
}

/// `‖u_x - φ‖²` of two P1 functions; arguments as in [`l2_squared`].
pub(crate) fn shear_squared(lengths: &[f64], u: &[f64], phi: &[f64]) -> f64 {
    lengths
        .iter()
        .zip(u.windows(2).zip(phi.windows(2)))
        .map(|(&h, (u, phi))| {
            let slope = (u[1] - u[0]) / h;
            let shear = [slope - phi[0], slope - phi[1]];
            element_product(h / 6.0, shear, shear)
        })
        .sum()
}

/// The larger of two numbers; NaN if either is NaN, which `f64::max` would drop.
pub(crate) fn max_or_nan(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

/// The five squares on the left-hand side of (3.14), Theorem 3.4, in its order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TheoremSquares {
    /// ‖û‖².
    pub velocity: f64,
    /// ‖u_x - φ‖².
    pub shear: f64,
    /// ‖φ̂‖².
    pub rotation_rate: f64,
    /// ‖φ_x‖².
    pub curvature: f64,
    /// ‖θ‖².
    pub temperature: f64,
}

impl TheoremSquares {
    /// Computes them for the P1 functions with these nodal values, n + 1 each.
    pub fn of(
        lengths: &[f64],
        v: &[f64],
        u: &[f64],
        w: &[f64],
        phi: &[f64],
        theta: &[f64],
    ) -> Self {
        Self {
            velocity: l2_squared(lengths, v),
            shear: shear_squared(lengths, u, phi),
            rotation_rate: l2_squared(lengths, w),
            curvature: slope_squared(lengths, phi),
            temperature: l2_squared(lengths, theta),
        }
    }

    /// Root of the sum of the squares: the norm in which (3.14) is stated.
    pub fn norm(&self) -> f64 {
        (self.velocity + self.shear + self.rotation_rate + self.curvature + self.temperature).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norms_of_linear_functions_are_exact() {
        let lengths = [0.1, 0.4, 0.5];
        let nodes = [0.0, 0.1, 0.5, 1.0];
        let line = nodes.map(|x| 3.0 * x);
        assert!((l2_squared(&lengths, &line) - 3.0).abs() < 1e-15);
        assert!((slope_squared(&lengths, &line) - 9.0).abs() < 1e-14);
        // ∫ (3 - x)² = 19/3
        assert!((shear_squared(&lengths, &line, &nodes) - 19.0 / 3.0).abs() < 1e-14);
    }

    #[test]
    fn the_theorems_norm_is_the_root_of_the_sum_of_five_squares() {
        let lengths = [1.0];
        // ‖û‖² = 3, ‖u_x - φ‖² = 27, ‖φ̂‖² = 12, ‖φ_x‖² = 0, ‖θ‖² = 48, from linear functions 3x
        // and the like.
        let v = [0.0, 3.0];
        let u = [0.0, 0.0];
        let w = [0.0, 6.0];
        let phi = [27.0_f64.sqrt(); 2];
        let theta = [0.0, 12.0];
        let squares = TheoremSquares::of(&lengths, &v, &u, &w, &phi, &theta);
        let found = [
            squares.velocity,
            squares.shear,
            squares.rotation_rate,
            squares.curvature,
            squares.temperature,
        ];
        let close = |found: f64, expected: f64| (found - expected).abs() < 1e-13 * (1.0 + expected);
        assert!(
            found
                .iter()
                .zip([3.0, 27.0, 12.0, 0.0, 48.0])
                .all(|(&found, expected)| close(found, expected))
        );
        assert!(close(squares.norm(), 90.0_f64.sqrt()));
        let bent = TheoremSquares {
            curvature: 10.0,
            ..squares
        };
        assert!(close(bent.norm(), 10.0));
    }
}
