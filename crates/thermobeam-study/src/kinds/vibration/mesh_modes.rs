//! The modes of a mesh: eigenvectors of the P1 matrices, by a dense method that shares nothing with the solver's sweeps.

use nalgebra::{DMatrix, DVector};
use thermobeam::assembly::{Tridiagonal, coupling, mass, stiffness};
use thermobeam::mesh::Mesh;

/// A mode of the mesh: nodal values, node 0 included, and its eigenvalue.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MeshMode {
    /// ω² of a vibration, κ² of a temperature that decays like e^{-κ²t}.
    pub(super) eigenvalue: f64,
    /// U, or the temperature's shape.
    pub(super) first: Vec<f64>,
    /// Φ; zeros for a temperature.
    pub(super) second: Vec<f64>,
}

/// All vibrations `A x = ω² B x`, lowest first, scaled to U(1) = 1 as the exact ones are.
///
/// A and B are the forms `‖u_x - φ‖² + ‖φ_x‖²` and `‖u‖² + ‖φ‖²` on the n free nodes of each field.
pub(super) fn vibrations(mesh: &Mesh) -> Option<Vec<MeshMode>> {
    let n = mesh.elements();
    let (mass, stiffness, coupling) = (mass(mesh), stiffness(mesh), coupling(mesh));
    let (mut a, mut b) = (DMatrix::zeros(2 * n, 2 * n), DMatrix::zeros(2 * n, 2 * n));
    add(&mut a, [0, 0], &stiffness, 1.0, 1..=n);
    add(&mut a, [n, n], &stiffness, 1.0, 1..=n);
    add(&mut a, [n, n], &mass, 1.0, 1..=n);
    add(&mut a, [0, n], &coupling, -1.0, 1..=n);
    add(&mut a, [n, 0], &coupling.transpose(), -1.0, 1..=n);
    add(&mut b, [0, 0], &mass, 1.0, 1..=n);
    add(&mut b, [n, n], &mass, 1.0, 1..=n);
    let mode = |(eigenvalue, x): (f64, DVector<f64>)| {
        let tip = x[n - 1];
        let field = |from: usize| std::iter::once(0.0).chain((from..from + n).map(|i| x[i] / tip)).collect();
        MeshMode { eigenvalue, first: field(0), second: field(n) }
    };
    Some(eigenpairs(&a, &b)?.into_iter().map(mode).collect())
}

/// All temperatures `K x = κ² M x` that vanish at both ends, lowest first, scaled to a largest value of 1.
pub(super) fn temperatures(mesh: &Mesh) -> Option<Vec<MeshMode>> {
    let n = mesh.elements();
    let (mut a, mut b) = (DMatrix::zeros(n - 1, n - 1), DMatrix::zeros(n - 1, n - 1));
    add(&mut a, [0, 0], &stiffness(mesh), 1.0, 1..=n - 1);
    add(&mut b, [0, 0], &mass(mesh), 1.0, 1..=n - 1);
    let mode = |(eigenvalue, x): (f64, DVector<f64>)| {
        let largest = x
            .iter()
            .copied()
            .fold(0.0, |largest: f64, value| if value.abs() > largest.abs() { value } else { largest });
        let inner = x.iter().map(|value| value / largest);
        let first = std::iter::once(0.0).chain(inner).chain(std::iter::once(0.0)).collect();
        MeshMode { eigenvalue, first, second: vec![0.0; n + 1] }
    };
    Some(eigenpairs(&a, &b)?.into_iter().map(mode).collect())
}

/// Adds `factor` times the rows and columns `nodes` of a tridiagonal matrix at `corner`.
fn add(
    into: &mut DMatrix<f64>,
    corner: [usize; 2],
    from: &Tridiagonal,
    factor: f64,
    nodes: std::ops::RangeInclusive<usize>,
) {
    let (first, last) = (*nodes.start(), *nodes.end());
    for i in nodes {
        let mut put = |j: usize, value: f64| into[(corner[0] + i - first, corner[1] + j - first)] += factor * value;
        put(i, from.diagonal[i]);
        if i > first {
            put(i - 1, from.lower[i]);
        }
        if i < last {
            put(i + 1, from.upper[i]);
        }
    }
}

/// Eigenpairs of `A x = λ B x`, increasing, by Cholesky of B; `None` where B is not positive definite.
fn eigenpairs(a: &DMatrix<f64>, b: &DMatrix<f64>) -> Option<Vec<(f64, DVector<f64>)>> {
    let factor = b.clone().cholesky()?.l();
    let half = factor.solve_lower_triangular(a)?;
    let standard = factor.solve_lower_triangular(&half.transpose())?;
    let eigen = (0.5 * (&standard + standard.transpose())).symmetric_eigen();
    let mut order: Vec<usize> = (0..a.nrows()).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let pair = |index: usize| {
        let x = factor.transpose().solve_upper_triangular(&eigen.eigenvectors.column(index).clone_owned())?;
        // Rayleigh's quotient: its error is the square of the eigenvector's.
        Some(((a * &x).dot(&x) / (b * &x).dot(&x), x))
    };
    order.into_iter().map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;
    use thermobeam::vibration::discrete_frequencies;

    #[test]
    fn frequencies_are_those_of_the_bisection_on_any_mesh() {
        for mesh in [Mesh::uniform(12), Mesh::mapped(9, |s| 0.4 * s + 0.6 * s * s)] {
            let mesh = mesh.expect("a mesh");
            let modes = vibrations(&mesh).expect("a positive mass");
            let expected = discrete_frequencies(&mesh, 1, modes.len()).expect("all of them");
            for (mode, expected) in modes.iter().zip(expected) {
                assert!((mode.eigenvalue.sqrt() - expected).abs() < 1e-11 * expected.max(1.0), "{expected}");
            }
        }
    }

    #[test]
    fn temperatures_on_a_uniform_mesh_are_sines() {
        let n = 10;
        let modes = temperatures(&Mesh::uniform(n).expect("a mesh")).expect("a positive mass");
        for (k, mode) in modes.iter().enumerate() {
            let angle = PI * (k + 1) as f64 / n as f64;
            let exact = 6.0 * (n * n) as f64 * (1.0 - angle.cos()) / (2.0 + angle.cos());
            assert!((mode.eigenvalue - exact).abs() < 1e-11 * exact, "{k}");
            // No sign and no scale: the sine's ratio of neighbours.
            let ratio = mode.first[2] / mode.first[1];
            assert!((ratio - 2.0 * angle.cos()).abs() < 1e-10, "{k}: {ratio}");
        }
    }
}
