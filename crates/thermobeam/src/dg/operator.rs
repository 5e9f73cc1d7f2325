//! The matrix of a step, block by block: mass, stiffness and C of the space times the integrals in
//! time.

use super::block::{Matrix, zero};
use super::space::Coupling;
use super::time::TimeForms;
use crate::parameters::Beam;

/// The linear part of a step of length τ (`h`), with a fixed axial force.
///
/// ```text
/// D ⊗ M + E ⊗ [K, -C; -Cᵀ, K + M] + N τ² S ⊗ K  on (v, w),   E = τζ T + τ² S
/// D ⊗ M + τ T ⊗ K                               on θ~
/// -a τ T ⊗ C  from θ~ to φ,   a τ T ⊗ Cᵀ  from w to θ~
/// ```
///
/// Its symmetric part is positive definite as long as the elastic energy is, and ζ > 0 or q <= 2,
/// by the argument of the energy balance (THEORY.md, "Existence and elimination").
#[derive(Debug, Clone)]
pub(super) struct Operator<const S: usize> {
    inertia: [[f64; S]; S],
    elastic: [[f64; S]; S],
    axial: [[f64; S]; S],
    contact: [[f64; S]; S],
    heat: [f64; S],
    a: f64,
}

impl<const S: usize> Operator<S> {
    /// * `n_value`: the fixed axial force.
    /// * `compliance`: ε of the obstacle; infinite without contact.
    pub(super) fn new(
        forms: &TimeForms<S>,
        beam: &Beam,
        h: f64,
        n_value: f64,
        compliance: f64,
    ) -> Self {
        let (integral, product) = (&forms.integral, &forms.product);
        let mut elastic = scaled(integral, h * h);
        for (i, row) in elastic.iter_mut().enumerate() {
            row[i] += h * beam.zeta * product[i];
        }
        let mut axial = elastic;
        for (axial, integral) in axial
            .as_flattened_mut()
            .iter_mut()
            .zip(integral.as_flattened())
        {
            *axial += h * h * n_value * integral;
        }
        let contact = scaled(integral, h * h / compliance);
        let heat = product.map(|product| h * product);
        Self {
            inertia: forms.derivative,
            elastic,
            axial,
            contact,
            heat,
            a: beam.a,
        }
    }

    /// The matrix between two blocks of an element of the given length.
    pub(super) fn between(&self, coupling: &Coupling, length: f64) -> Matrix<S> {
        let (m, k) = (0.5 * length, 2.0 / length);
        let mut matrix = zero();
        for j in 0..S {
            for i in 0..S {
                let (inertia, elastic) = (m * self.inertia[i][j], self.elastic[i][j]);
                matrix[0][j][0][i] =
                    coupling.mass_u * inertia + coupling.stiff_u * k * self.axial[i][j];
                matrix[1][j][0][i] = -coupling.u_phi * elastic;
                matrix[0][j][1][i] = -coupling.phi_u * elastic;
                matrix[1][j][1][i] =
                    coupling.mass_phi * (inertia + m * elastic) + coupling.stiff_phi * k * elastic;
                matrix[2][j][2][i] = coupling.mass_u * inertia;
            }
            matrix[2][j][1][j] = -self.a * coupling.phi_theta * self.heat[j];
            matrix[1][j][2][j] = self.a * coupling.theta_phi * self.heat[j];
            matrix[2][j][2][j] += coupling.stiff_u * k * self.heat[j];
        }
        matrix
    }

    /// Adds the obstacle's stiffness to the block of the free end.
    pub(super) fn add_contact(&self, tip: &mut Matrix<S>) {
        for j in 0..S {
            for i in 0..S {
                tip[0][j][0][i] += self.contact[i][j];
            }
        }
    }
}

fn scaled<const S: usize>(matrix: &[[f64; S]; S], factor: f64) -> [[f64; S]; S] {
    matrix.map(|row| row.map(|entry| factor * entry))
}
