//! Dense P1 matrices, written from the weak form (2.2) and independently of the solver.

use nalgebra::DMatrix;
use thermobeam::mesh::Mesh;

/// M, K and C over all nodes.
pub(crate) fn over_all_nodes(mesh: &Mesh) -> [DMatrix<f64>; 3] {
    let nodes = mesh.nodes().len();
    let mut full = [(); 3].map(|()| DMatrix::zeros(nodes, nodes));
    for (e, h) in mesh.lengths().enumerate() {
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let slope = |k: usize| if k == 0 { -1.0 / h } else { 1.0 / h };
            full[0][(e + i, e + j)] += if i == j { h / 3.0 } else { h / 6.0 };
            full[1][(e + i, e + j)] += slope(i) * slope(j) * h;
            full[2][(e + i, e + j)] += slope(i) * h / 2.0;
        }
    }
    full
}

/// The matrices for the unknowns (u_1..u_n, φ_1..φ_n); node 0 is clamped.
pub(crate) struct P1Matrices {
    pub(crate) elements: usize,
    pub(crate) mass: DMatrix<f64>,
    pub(crate) stiffness: DMatrix<f64>,
    /// `C_ij = (N_j, N_i')`.
    pub(crate) coupling: DMatrix<f64>,
}

impl P1Matrices {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let n = mesh.elements();
        let [mass, stiffness, coupling] =
            over_all_nodes(mesh).map(|m| m.view((1, 1), (n, n)).into_owned());
        Self {
            elements: n,
            mass,
            stiffness,
            coupling,
        }
    }

    /// M for u and φ.
    pub(crate) fn mass_of_both(&self) -> DMatrix<f64> {
        let zero = DMatrix::zeros(self.elements, self.elements);
        blocks([[&self.mass, &zero], [&zero, &self.mass]])
    }

    /// The matrix of `(1 + N)‖u'‖² - 2(u', φ) + ‖φ‖² + ‖φ'‖²`.
    pub(crate) fn stiffness_form(&self, axial: f64) -> DMatrix<f64> {
        let coupling = -&self.coupling;
        blocks([
            [&(&self.stiffness * (1.0 + axial)), &coupling],
            [&coupling.transpose(), &(&self.stiffness + &self.mass)],
        ])
    }
}

/// A matrix of four.
pub(crate) fn blocks(parts: [[&DMatrix<f64>; 2]; 2]) -> DMatrix<f64> {
    let [[first, _], [_, last]] = parts;
    let (rows, columns) = (first.nrows() + last.nrows(), first.ncols() + last.ncols());
    let mut whole = DMatrix::zeros(rows, columns);
    for (i, row) in parts.into_iter().enumerate() {
        for (j, part) in row.into_iter().enumerate() {
            let place = (i * first.nrows(), j * first.ncols());
            whole.view_mut(place, part.shape()).copy_from(part);
        }
    }
    whole
}
