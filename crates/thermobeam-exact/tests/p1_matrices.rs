//! Dense P1 matrices of the beam from those of `assembly`, which no solver uses.

use nalgebra::DMatrix;
use thermobeam::mesh::Mesh;
use thermobeam_exact::assembly::{Tridiagonal, coupling, mass, stiffness};

/// The matrices on a uniform mesh for the unknowns (u_1..u_n, φ_1..φ_n); node 0 is clamped.
pub(crate) struct P1Matrices {
    pub(crate) elements: usize,
    pub(crate) mass: DMatrix<f64>,
    pub(crate) stiffness: DMatrix<f64>,
    /// `C_ij = (N_j, N_i')`.
    pub(crate) coupling: DMatrix<f64>,
}

/// The matrix at the nodes 1..n.
fn without_node_0(matrix: &Tridiagonal) -> DMatrix<f64> {
    let n = matrix.diagonal.len() - 1;
    DMatrix::from_fn(n, n, |i, j| matrix.entry(i + 1, j + 1))
}

impl P1Matrices {
    pub(crate) fn new(elements: usize) -> Self {
        let mesh = Mesh::uniform(elements).expect("a uniform mesh");
        Self {
            elements,
            mass: without_node_0(&mass(&mesh)),
            stiffness: without_node_0(&stiffness(&mesh)),
            coupling: without_node_0(&coupling(&mesh)),
        }
    }

    /// The matrix of `(1 + N)‖u'‖² - 2(u', φ) + ‖φ‖² + ‖φ'‖²`.
    pub(crate) fn stiffness_form(&self, axial: f64) -> DMatrix<f64> {
        let n = self.elements;
        let mut form = DMatrix::zeros(2 * n, 2 * n);
        form.view_mut((0, 0), (n, n))
            .copy_from(&(&self.stiffness * (1.0 + axial)));
        form.view_mut((0, n), (n, n)).copy_from(&-&self.coupling);
        form.view_mut((n, 0), (n, n))
            .copy_from(&-self.coupling.transpose());
        form.view_mut((n, n), (n, n))
            .copy_from(&(&self.stiffness + &self.mass));
        form
    }
}
