//! The norm of (3.14), a second time: the solver's own stops its iterations.

use crate::exact::assembly::{Tridiagonal, coupling, mass, stiffness};
use thermobeam::{mesh::Mesh, solve::TimeLevel};

/// The norm by the matrices of (3.7).
pub(super) struct OwnNorm {
    mass: Tridiagonal,
    stiffness: Tridiagonal,
    coupling: Tridiagonal,
}

impl OwnNorm {
    pub(super) fn new(mesh: &Mesh) -> Self {
        Self {
            mass: mass(mesh),
            stiffness: stiffness(mesh),
            coupling: coupling(mesh),
        }
    }

    /// Of the difference of two levels on the mesh.
    pub(super) fn of_difference(&self, one: &TimeLevel, other: &TimeLevel) -> f64 {
        let mut difference = one.clone();
        difference.set_difference(one, other);
        let TimeLevel {
            u,
            v,
            phi,
            w,
            theta,
            ..
        } = &difference;
        // ‖u_x - φ‖² = (u_x, u_x) - 2 (φ, u_x) + (φ, φ)
        let shear = form(&self.stiffness, u, u) - 2.0 * form(&self.coupling, phi, u)
            + form(&self.mass, phi, phi);
        let mut squares = shear + form(&self.stiffness, phi, phi);
        for rate in [v, w, theta] {
            squares += form(&self.mass, rate, rate);
        }
        squares.sqrt()
    }
}

/// yᵀ A x.
fn form(matrix: &Tridiagonal, x: &[f64], y: &[f64]) -> f64 {
    let product = matrix.multiply(x);
    product.iter().zip(y).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::reference::distance;

    #[test]
    fn it_is_the_norm_of_the_solver() {
        let mesh = Mesh::mapped(5, |s| s * s).unwrap();
        let level = |seed: f64| {
            let field = |k: f64| -> Vec<f64> {
                let nodes = mesh.nodes().iter();
                nodes.map(|x| (seed * k + x * (k + seed)).sin()).collect()
            };
            TimeLevel {
                u: field(1.0),
                v: field(2.0),
                phi: field(3.0),
                w: field(4.0),
                theta: field(5.0),
                contact_force: 0.0,
            }
        };
        let lengths: Vec<f64> = mesh.lengths().collect();
        let [one, other] = [level(1.0), level(2.0)];
        let ratio =
            OwnNorm::new(&mesh).of_difference(&one, &other) / distance(&lengths, &one, &other);
        assert!((ratio - 1.0).abs() < 1e-12, "{ratio}");
    }
}
