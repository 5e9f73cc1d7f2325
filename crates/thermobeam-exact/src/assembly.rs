//! The matrices of (3.7) for the P1 hat functions N_0..N_n, tridiagonal, over all n + 1 nodes.
//!
//! The solver works element by element without them. The manufactured solutions that isolate the
//! time error, the studies of vibrations, and tests use them.

use thermobeam::mesh::Mesh;

/// A tridiagonal matrix of n + 1 rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Tridiagonal {
    /// Entries (i, i - 1); entry 0 is unused and zero.
    pub lower: Vec<f64>,
    /// Entries (i, i).
    pub diagonal: Vec<f64>,
    /// Entries (i, i + 1); the last is unused and zero.
    pub upper: Vec<f64>,
}

impl Tridiagonal {
    /// Assembles the 2 x 2 matrices that `local` returns for an element of length h.
    fn assemble(mesh: &Mesh, local: impl Fn(f64) -> [[f64; 2]; 2]) -> Self {
        let zeros = vec![0.0; mesh.nodes().len()];
        let mut matrix = Self {
            lower: zeros.clone(),
            diagonal: zeros.clone(),
            upper: zeros,
        };
        for (i, h) in mesh.lengths().enumerate() {
            let block = local(h);
            matrix.diagonal[i] += block[0][0];
            matrix.upper[i] += block[0][1];
            matrix.lower[i + 1] += block[1][0];
            matrix.diagonal[i + 1] += block[1][1];
        }
        matrix
    }

    /// `A vector`.
    pub fn multiply(&self, vector: &[f64]) -> Vec<f64> {
        let last = self.diagonal.len() - 1;
        let mut product = vec![0.0; vector.len()];
        for i in 0..=last {
            let left = if i > 0 {
                self.lower[i] * vector[i - 1]
            } else {
                0.0
            };
            let right = if i < last {
                self.upper[i] * vector[i + 1]
            } else {
                0.0
            };
            product[i] = left + self.diagonal[i] * vector[i] + right;
        }
        product
    }

    /// The solution of `A y = right` in the rows and columns from `first` to `last`, zero
    /// elsewhere.
    ///
    /// Elimination without pivoting: for a matrix that is positive definite.
    pub fn solve_between(&self, first: usize, last: usize, right: &[f64]) -> Vec<f64> {
        let mut solution = vec![0.0; right.len()];
        let mut pivots = self.diagonal.clone();
        if first <= last {
            solution[first..=last].copy_from_slice(&right[first..=last]);
        }
        for i in first + 1..=last {
            let factor = self.lower[i] / pivots[i - 1];
            pivots[i] -= factor * self.upper[i - 1];
            solution[i] -= factor * solution[i - 1];
        }
        for i in (first..=last).rev() {
            let right = if i < last {
                self.upper[i] * solution[i + 1]
            } else {
                0.0
            };
            solution[i] = (solution[i] - right) / pivots[i];
        }
        solution
    }

    /// Aᵀ.
    pub fn transpose(&self) -> Self {
        let mut lower = self.upper.clone();
        lower.rotate_right(1);
        let mut upper = self.lower.clone();
        upper.rotate_left(1);
        Self {
            lower,
            diagonal: self.diagonal.clone(),
            upper,
        }
    }

    /// Entry (i, j), zero outside the three diagonals.
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        match j as isize - i as isize {
            -1 => self.lower[i],
            0 => self.diagonal[i],
            1 => self.upper[i],
            _ => 0.0,
        }
    }
}

/// Consistent mass matrix, `M_ij = (N_j, N_i)`.
///
/// Symmetric positive definite; its entries sum to 1, the beam's length. Source: first term of
/// (3.7).
pub fn mass(mesh: &Mesh) -> Tridiagonal {
    Tridiagonal::assemble(mesh, |h| [[h / 3.0, h / 6.0], [h / 6.0, h / 3.0]])
}

/// Stiffness matrix, `K_ij = (N_j', N_i')`.
///
/// Symmetric, with the constants in its kernel. Source: `(u_x, w_x)` in (3.7).
pub fn stiffness(mesh: &Mesh) -> Tridiagonal {
    Tridiagonal::assemble(mesh, |h| [[1.0 / h, -1.0 / h], [-1.0 / h, 1.0 / h]])
}

/// Coupling matrix, `C_ij = (N_j, N_i')`.
///
/// `(φ, w_x) = wᵀ C φ` and `(u_x, χ) = χᵀ Cᵀ u`. Source: the coupling terms of (3.7) between u, φ
/// and θ.
pub fn coupling(mesh: &Mesh) -> Tridiagonal {
    Tridiagonal::assemble(mesh, |_| [[-0.5, -0.5], [0.5, 0.5]])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graded() -> Mesh {
        Mesh::mapped(7, |s| 0.3 * s + 0.7 * s * s).unwrap()
    }

    fn interpolate(mesh: &Mesh, slope: f64, offset: f64) -> Vec<f64> {
        mesh.nodes().iter().map(|x| slope * x + offset).collect()
    }

    #[test]
    fn a_part_of_the_mass_matrix_is_solved() {
        let mesh = graded();
        let matrix = mass(&mesh);
        let right = interpolate(&mesh, 1.5, -0.4);
        let solution = matrix.solve_between(1, 5, &right);
        assert_eq!([solution[0], solution[6], solution[7]], [0.0; 3]);
        let product = matrix.multiply(&solution);
        for i in 1..=5 {
            assert!((product[i] - right[i]).abs() < 1e-15, "row {i}");
        }
    }
}
