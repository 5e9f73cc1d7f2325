//! The projections P_h* and P_h0 of (3.4) and (3.5), by their definition and by their errors.
//!
//! `P_h η` is the piecewise linear function with `((P_h η - η)_x, χ_x) = 0` for all piecewise
//! linear χ that vanish at 0, and for P_h0 also at 1. A program takes the values at the nodes
//! instead. Here the definition itself is evaluated by quadrature, which needs no value of η at a
//! node.
//!
//! Derivation of orders and constants: THEORY.md, "The projection".

use std::f64::consts::PI;

use crate::function::Function;
use crate::norm::max_or_nan;
use crate::quadrature::RULE;
use thermobeam::mesh::Mesh;

/// c of (3.4), the best for all functions: a half wave on each element attains it.
pub const VALUE_BOUND: f64 = 1.0 / PI;

/// c of (3.5), the best for all functions: a half wave on each element attains it.
pub const SMOOTH_BOUND: f64 = 1.0 / (PI * PI) + 1.0 / PI;

/// Parts of an element on each of which [`RULE`] is applied.
const PARTS: usize = 4;

/// The space onto which is projected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// S_h*: zero at x = 0.
    Clamped,
    /// S_h0: zero at both ends.
    Closed,
}

/// How far a piecewise linear function is from a function η, and the norms of η that bound it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projected {
    /// `‖P_h η - η‖`.
    pub value: f64,
    /// `‖(P_h η - η)_x‖`.
    pub slope: f64,
    /// `max_i |((P_h η - η)_x, N_i')|` over the hat functions of the space; 0 for the projection.
    pub residual: f64,
    /// `‖η_x‖`.
    pub function_slope: f64,
    /// `‖η_xx‖`; infinite or wrong for a function that is not in H².
    pub function_curvature: f64,
    /// The leading term of [`value`](Self::value): `(Σ h_K⁴ ∫_K η_xx²/120)^½`.
    pub leading_value: f64,
    /// The leading term of [`slope`](Self::slope): `(Σ h_K² ∫_K η_xx²/12)^½`.
    pub leading_slope: f64,
    /// The longest element h.
    pub h: f64,
}

/// Integrals over one element.
#[derive(Default)]
struct OnElement {
    value_squared: f64,
    slope_squared: f64,
    /// `∫ (P_h η - η)_x`.
    slope: f64,
    function_slope_squared: f64,
    function_curvature_squared: f64,
}

impl Projected {
    /// Measures the piecewise linear function with these nodal values against η = `function`.
    pub fn measure(function: &dyn Function, mesh: &Mesh, nodal: &[f64], target: Target) -> Self {
        let [mut value, mut slope, mut residual, mut h_max] = [0.0; 4];
        let [mut function_slope, mut function_curvature] = [0.0; 2];
        let [mut leading_value, mut leading_slope] = [0.0; 2];
        let mut means = vec![];
        for (x, y) in mesh.nodes().windows(2).zip(nodal.windows(2)) {
            let h = x[1] - x[0];
            let element = OnElement::integrate(function, x[0], h, y);
            value += element.value_squared;
            slope += element.slope_squared;
            function_slope += element.function_slope_squared;
            function_curvature += element.function_curvature_squared;
            leading_value += h.powi(4) / 120.0 * element.function_curvature_squared;
            leading_slope += h.powi(2) / 12.0 * element.function_curvature_squared;
            means.push(element.slope / h);
            h_max = max_or_nan(h_max, h);
        }
        // N_i' is 1/h on the element before node i and -1/h on the one after it.
        for pair in means.windows(2) {
            residual = max_or_nan(residual, (pair[0] - pair[1]).abs());
        }
        if target == Target::Clamped {
            let last = means.last().map_or(f64::NAN, |mean| mean.abs());
            residual = max_or_nan(residual, last);
        }
        Self {
            value: value.sqrt(),
            slope: slope.sqrt(),
            residual,
            function_slope: function_slope.sqrt(),
            function_curvature: function_curvature.sqrt(),
            leading_value: leading_value.sqrt(),
            leading_slope: leading_slope.sqrt(),
            h: h_max,
        }
    }

    /// The share of the bound (3.4) with c = [`VALUE_BOUND`] that is used, at most 1.
    pub fn share_of_value_bound(&self) -> f64 {
        self.value / (VALUE_BOUND * self.h * self.function_slope)
    }

    /// The share of the bound (3.5) with c = [`SMOOTH_BOUND`] that is used, at most 1 in H².
    pub fn share_of_smooth_bound(&self) -> f64 {
        let left = self.value + self.h * self.slope;
        left / (SMOOTH_BOUND * self.h * self.h * self.function_curvature)
    }
}

impl OnElement {
    /// Integrates over `x = start + h s`, 0 <= s <= 1.
    ///
    /// On the first element it is `x = h s⁴`: powers such as x^(3/4), which are in H¹ and not in
    /// H², become polynomials.
    fn integrate(function: &dyn Function, start: f64, h: f64, nodal: &[f64]) -> Self {
        let mut sums = Self::default();
        let mean_slope = (nodal[1] - nodal[0]) / h;
        let power = if start == 0.0 { 4 } else { 1 };
        for part in 0..PARTS {
            for (point, weight) in RULE {
                let s = (part as f64 + point) / PARTS as f64;
                let along = s.powi(power);
                let weight = weight / PARTS as f64 * h * f64::from(power) * s.powi(power - 1);
                let [value, slope, curvature] = function.derivatives(start + h * along);
                let error = nodal[0] + along * (nodal[1] - nodal[0]) - value;
                sums.value_squared += weight * error * error;
                sums.slope_squared += weight * (mean_slope - slope).powi(2);
                sums.slope += weight * (mean_slope - slope);
                sums.function_slope_squared += weight * slope * slope;
                sums.function_curvature_squared += weight * curvature * curvature;
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graded(elements: usize) -> Mesh {
        Mesh::mapped(elements, |s| 0.4 * s + 0.6 * s * s).unwrap()
    }

    fn nodal(mesh: &Mesh, function: &dyn Function) -> Vec<f64> {
        mesh.nodes().iter().map(|&x| function.eval(x)).collect()
    }

    /// The half waves of a uniform mesh of n elements.
    fn half_waves(elements: usize) -> impl Function {
        let k = elements as f64 * PI;
        move |x: f64| [(k * x).sin(), k * (k * x).cos(), -k * k * (k * x).sin()]
    }

    #[test]
    fn half_waves_attain_both_bounds_and_no_other_mesh_exceeds_them() {
        let waves = half_waves(6);
        let mesh = Mesh::uniform(6).unwrap();
        let zeros = vec![0.0; 7];
        let attained = Projected::measure(&waves, &mesh, &zeros, Target::Closed);
        for share in [
            attained.share_of_value_bound(),
            attained.share_of_smooth_bound(),
        ] {
            assert!((share - 1.0).abs() < 1e-5, "{share}");
        }
        for elements in [3, 5, 6, 7, 20] {
            let mesh = graded(elements);
            let values = nodal(&mesh, &waves);
            let other = Projected::measure(&waves, &mesh, &values, Target::Closed);
            assert!(other.share_of_value_bound() < 1.0 && other.share_of_smooth_bound() < 1.0);
        }
    }

    /// η = x² has e = (x - x_i)(x_{i+1} - x) up to its sign: `‖e‖² = Σ h⁵/30`, `‖e_x‖² = Σ h³/3`.
    #[test]
    fn the_errors_of_a_parabola_are_their_leading_terms() {
        let parabola = |x: f64| [x * x, 2.0 * x, 2.0];
        let mesh = graded(9);
        let values = nodal(&mesh, &parabola);
        let found = Projected::measure(&parabola, &mesh, &values, Target::Clamped);
        let sum = |power: i32| mesh.lengths().map(|h| h.powi(power)).sum::<f64>();
        for (found, expected) in [
            (found.value, (sum(5) / 30.0).sqrt()),
            (found.leading_value, (sum(5) / 30.0).sqrt()),
            (found.slope, (sum(3) / 3.0).sqrt()),
            (found.leading_slope, (sum(3) / 3.0).sqrt()),
            (found.function_slope, (4.0_f64 / 3.0).sqrt()),
            (found.function_curvature, 2.0),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-6, "{found}, {expected}");
        }
        assert!(found.residual < 1e-12, "{}", found.residual);
    }

    /// x^(3/4) on one element: `∫ (x - x^¾)² = 1/3 - 2/2.75 + 1/2.5`, `∫ (1 - ¾ x^-¼)² = 1/8`.
    #[test]
    fn a_root_at_the_clamped_end_is_integrated() {
        let root = |x: f64| {
            let power = |exponent: f64| x.powf(exponent);
            [power(0.75), 0.75 * power(-0.25), -0.1875 * power(-1.25)]
        };
        let mesh = Mesh::uniform(1).unwrap();
        let found = Projected::measure(&root, &mesh, &[0.0, 1.0], Target::Clamped);
        let value = (1.0_f64 / 3.0 - 2.0 / 2.75 + 0.4).sqrt();
        assert!((found.value / value - 1.0).abs() < 1e-5, "{}", found.value);
        assert!((found.slope - 0.125_f64.sqrt()).abs() < 1e-9);
        assert!(found.residual < 1e-12, "{}", found.residual);
    }

    /// Values that converge at the same orders, but are no projections.
    #[test]
    fn other_values_than_those_at_the_nodes_leave_a_residual() {
        let sine = |x: f64| {
            [
                (3.0 * x).sin(),
                3.0 * (3.0 * x).cos(),
                -9.0 * (3.0 * x).sin(),
            ]
        };
        for elements in [8, 64] {
            let mesh = graded(elements);
            let h = 1.0 / elements as f64;
            let sound = nodal(&mesh, &sine);
            let residual =
                |values: &[f64]| Projected::measure(&sine, &mesh, values, Target::Clamped).residual;
            let exact = residual(&sound);
            assert!(exact < 1e-11, "{exact}");
            let mut shifted = sound.clone();
            shifted[elements / 2] += 0.1 * h * h;
            assert!(residual(&shifted) > 0.01 * h);
            // Only the last hat function sees a straight line.
            let tilted: Vec<f64> = (mesh.nodes().iter().zip(&sound))
                .map(|(x, y)| y + 0.1 * h * h * x)
                .collect();
            assert!(residual(&tilted) > 0.09 * h * h);
        }
    }
}
