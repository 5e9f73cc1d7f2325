//! The integrals of one product of a manufactured solution, tested with basis functions.

use super::nodal;
use crate::assembly::Tridiagonal;
use crate::quadrature::RULE;
use crate::solution::Product;
use thermobeam::dg::{Field, Space};
use thermobeam::mesh::Mesh;

/// Additional quadrature points per element beyond the degree p: the loads are exact to round-off
/// for smooth functions.
const EXTRA_POINTS: usize = 12;

/// The space integrals of one product, tested with the functions of an equation: (X, N_i), (X',
/// N_i), and the weak second derivative.
#[derive(Clone)]
pub(super) struct Vectors {
    pub(super) value: Vec<f64>,
    pub(super) slope: Vec<f64>,
    /// `-(X'', N_i)`, equal to `(X', N_i') - X'(1) δ_in`.
    pub(super) curvature: Vec<f64>,
    /// X(1).
    pub(super) tip: f64,
    /// X'(1) for the boundary loads; zero if the curvature contains it.
    pub(super) boundary_slope: f64,
}

impl Vectors {
    /// The integrals by quadrature.
    pub(super) fn strong(product: &Product, mesh: &Mesh) -> Self {
        let nodes = mesh.nodes();
        let zeros = vec![0.0; nodes.len()];
        let mut value = zeros.clone();
        let mut slope = zeros.clone();
        let mut curvature = zeros;
        for (i, ends) in nodes.windows(2).enumerate() {
            let h = ends[1] - ends[0];
            for (s, weight) in RULE {
                let [x, x1, x2] = product.x.derivatives(ends[0] + s * h);
                for (node, hat) in [(i, 1.0 - s), (i + 1, s)] {
                    let weight = weight * h * hat;
                    value[node] += weight * x;
                    slope[node] += weight * x1;
                    curvature[node] -= weight * x2;
                }
            }
        }
        let [tip, tip_slope, _] = product.x.derivatives(1.0);
        Self {
            value,
            slope,
            curvature,
            tip,
            boundary_slope: tip_slope,
        }
    }

    /// The integrals by quadrature, with the basis functions of one equation on elements of any
    /// degree.
    pub(super) fn any_order(product: &Product, space: &Space, field: Field) -> Self {
        let points = Space::gauss(space.degree() + EXTRA_POINTS);
        let tested = |f: &dyn Fn([f64; 3]) -> f64| {
            let mut load = vec![[0.0; 3]; space.blocks()];
            space.add_load(field, &points, |x| f(product.x.derivatives(x)), &mut load);
            let equation = match field {
                Field::U | Field::V => 0,
                Field::Phi | Field::W => 1,
                Field::Theta => 2,
            };
            load.into_iter().map(|entry| entry[equation]).collect()
        };
        let [tip, tip_slope, _] = product.x.derivatives(1.0);
        Self {
            value: tested(&|[x, _, _]| x),
            slope: tested(&|[_, x1, _]| x1),
            curvature: tested(&|[_, _, x2]| -x2),
            tip,
            boundary_slope: tip_slope,
        }
    }

    /// The integrals of the nodal interpolant, by the scheme's own matrices: M, K and Cᵀ of (3.7).
    pub(super) fn discrete(
        product: &Product,
        [mass, stiffness, slope]: &[Tridiagonal; 3],
        mesh: &Mesh,
    ) -> Self {
        let nodal = nodal(product, mesh);
        let tip = nodal[nodal.len() - 1];
        Self {
            value: mass.multiply(&nodal),
            slope: slope.multiply(&nodal),
            curvature: stiffness.multiply(&nodal),
            // Y(1) is a boundary load here too: -C φ = Cᵀ φ - φ(1) e for P1 functions.
            tip,
            // K u contains the derivative at the end.
            boundary_slope: 0.0,
        }
    }
}
