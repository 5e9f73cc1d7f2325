//! The bilinear forms of the weak form on a space, with coefficients given block by block by a
//! closure.

use super::block::Block;
use super::space::{Coupling, Space, degrees};
use super::{element, space::Field};

impl Space {
    /// Sums `entry(coupling, length, row block, column block)` over all couplings of all elements.
    fn sum(&self, entry: impl Fn(&Coupling, f64, usize, usize) -> f64) -> f64 {
        let [sum] = self.sums(|c, length, row, column| [entry(c, length, row, column)]);
        sum
    }

    /// The same for several forms at once.
    fn sums<const N: usize>(
        &self,
        entries: impl Fn(&Coupling, f64, usize, usize) -> [f64; N],
    ) -> [f64; N] {
        let mut sums = [0.0; N];
        for (element, &length) in self.lengths.iter().enumerate() {
            for c in &self.couplings {
                let entries = entries(
                    c,
                    length,
                    self.block(element, c.row),
                    self.block(element, c.column),
                );
                for (sum, entry) in sums.iter_mut().zip(entries) {
                    *sum += entry;
                }
            }
        }
        sums
    }

    /// `(y, z)` of three fields each.
    pub(super) fn mass(&self, y: impl Fn(usize) -> [f64; 3], z: impl Fn(usize) -> [f64; 3]) -> f64 {
        self.sum(|c, length, row, column| {
            let [u, phi, theta] = y(row);
            let [u_z, phi_z, theta_z] = z(column);
            0.5 * length * (c.mass_u * (u * u_z + theta * theta_z) + c.mass_phi * phi * phi_z)
        })
    }

    /// `(u_x - φ, y_x - χ) + (φ_x, χ_x)` for the pairs (u, φ) and (y, χ).
    pub(super) fn strain(
        &self,
        y: impl Fn(usize) -> [f64; 2],
        z: impl Fn(usize) -> [f64; 2],
    ) -> f64 {
        self.sum(|c, length, row, column| strain_entry(c, length, y(row), z(column)))
    }

    /// `‖v_x - w‖² + ‖w_x‖²` and `‖θ~_x‖²` for every coefficient in time of (v, w, θ~).
    pub(super) fn dissipation<const S: usize>(&self, x: &[Block<S>]) -> ([f64; S], [f64; S]) {
        let viscous = self.sums(|c, length, row, column| {
            let [v, w, _] = &x[row];
            let [v_z, w_z, _] = &x[column];
            std::array::from_fn(|i| strain_entry(c, length, [v[i], w[i]], [v_z[i], w_z[i]]))
        });
        let thermal = self.sums(|c, length, row, column| {
            let (theta, theta_z) = (&x[row][2], &x[column][2]);
            std::array::from_fn(|i| 2.0 / length * c.stiff_u * theta[i] * theta_z[i])
        });
        (viscous, thermal)
    }

    /// `(u_x - φ, y_x - χ)`.
    pub(super) fn shear(
        &self,
        y: impl Fn(usize) -> [f64; 2],
        z: impl Fn(usize) -> [f64; 2],
    ) -> f64 {
        self.sum(|c, length, row, column| shear_entry(c, length, y(row), z(column)))
    }

    /// `(y_x, z_x)` for coefficients of u or θ.
    pub(super) fn stiffness(&self, y: impl Fn(usize) -> f64, z: impl Fn(usize) -> f64) -> f64 {
        self.sum(|c, length, row, column| 2.0 / length * c.stiff_u * y(row) * z(column))
    }

    /// `(φ_x, χ_x)` for coefficients of φ.
    pub(super) fn bending(&self, y: impl Fn(usize) -> f64, z: impl Fn(usize) -> f64) -> f64 {
        self.sum(|c, length, row, column| 2.0 / length * c.stiff_phi * y(row) * z(column))
    }

    /// The diagonal of M.
    pub(super) fn diagonal_mass(&self) -> Vec<[f64; 3]> {
        let mut diagonal = vec![[0.0; 3]; self.blocks()];
        for (element, &length) in self.lengths.iter().enumerate() {
            for c in self.couplings.iter().filter(|c| c.row == c.column) {
                let place = &mut diagonal[self.block(element, c.row)];
                place[0] += 0.5 * length * c.mass_u;
                place[1] += 0.5 * length * c.mass_phi;
                place[2] += 0.5 * length * c.mass_u;
            }
        }
        diagonal
    }

    /// `∫ χ` for the basis functions of φ.
    pub(super) fn integrals_of_rotations(&self) -> Vec<f64> {
        let mut integrals = vec![0.0; self.blocks()];
        for (element, &length) in self.lengths.iter().enumerate() {
            for local in 0..2 + self.inner() {
                if let [_, Some(m)] = degrees(local, self.degree()) {
                    integrals[self.place(Field::Phi, element, m).0] +=
                        0.5 * length * element::integral(m);
                }
            }
        }
        integrals
    }
}

#[inline]
fn strain_entry(c: &Coupling, length: f64, [u, phi]: [f64; 2], [u_z, phi_z]: [f64; 2]) -> f64 {
    shear_entry(c, length, [u, phi], [u_z, phi_z]) + 2.0 / length * c.stiff_phi * phi * phi_z
}

#[inline]
fn shear_entry(c: &Coupling, length: f64, [u, phi]: [f64; 2], [u_z, phi_z]: [f64; 2]) -> f64 {
    2.0 / length * c.stiff_u * u * u_z - c.u_phi * u * phi_z - c.phi_u * phi * u_z
        + 0.5 * length * c.mass_phi * phi * phi_z
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;

    #[test]
    fn the_diagonal_of_the_mass_is_that_of_the_form() {
        for degree in [1, 2, 5] {
            let mesh = Mesh::mapped(7, |s| 0.3 * s + 0.7 * s * s).unwrap();
            let space = Space::new(mesh, degree).unwrap();
            for (place, diagonal) in space.diagonal_mass().iter().enumerate() {
                for (field, found) in diagonal.iter().enumerate() {
                    let only = |block: usize| {
                        std::array::from_fn(|k| f64::from(block == place && k == field))
                    };
                    let expected = space.mass(only, only);
                    assert!(
                        (found - expected).abs() <= 2.0 * f64::EPSILON * expected,
                        "{degree}, {place}: {found}, not {expected}"
                    );
                }
            }
        }
    }
}
