//! Loads for which a manufactured solution is the exact solution.
//!
//! From the strong form (1.1), with N = N(u(t)) of (2.3):
//!
//! ```text
//! f_u = u_tt - (1 + N) u_xx + φ_x - ζ (u_xxt - φ_xt)
//! f_φ = φ_tt - φ_xx - u_x + φ - ζ (φ_xxt + u_xt - φ_t) + a θ_x
//! f_θ = θ_t - θ_xx + a φ_xt
//! ```
//!
//! multiplied by the hat functions and integrated, plus the boundary loads at x = 1 from (1.3):
//! `σ(1, t) + g(u(1, t))` in the first equation and `φ_x + ζ φ_xt` in the second. The solver
//! discretises the weak form, and N and g are those of [`formulas`](crate::formulas): the two
//! computations share only the problem. θ is the physical temperature. Its lifting θ_A (1 - x) is
//! harmonic and does not contribute to f_θ; its contribution `-a θ_A` to `a θ_x` is a term of the
//! solver's equation as well.

mod term;
mod vectors;

use crate::assembly::{coupling, mass, stiffness};
use crate::defect::{Defect, axial_force_with, contact_with};
use crate::formulas::{SchemeFormulas, contact_force};
use crate::quadrature::RULE;
use crate::solution::{Factors, FieldFactors, Manufactured, Product};
use term::{ProductTerms, SourceTerm};
use thermobeam::dg::{Field, Space};
use thermobeam::mesh::Mesh;
use thermobeam::one_step::InitialValues;
use thermobeam::parameters::{Beam, Obstacles};
use vectors::Vectors;

/// Number of panels of the quadrature for ∫ X_j' X_k' over [0, 1], independent of the mesh.
const PANELS: usize = 256;

/// The nonlinear terms of the exact solution, at one time or as a scheme takes them over a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forces {
    /// The axial force N(u), (2.3).
    pub axial: f64,
    /// The contact force g(u(1)), (1.3).
    pub contact: f64,
}

/// The space vectors of a manufactured solution on a mesh, with their time coefficients.
#[derive(Debug, Clone)]
pub struct Sources {
    beam: Beam,
    terms: Vec<SourceTerm>,
    /// ∫ X_j' X_k', row by row.
    gram: Vec<f64>,
    /// X_j(1).
    tip: Vec<f64>,
    /// Index of the boundary loads at x = 1: the last node, or its block.
    tip_index: usize,
    /// X_j'(1), Y_k(1) and Y_k'(1) for the boundary loads; slopes are zero if the space vectors
    /// contain them.
    boundary: [Vec<f64>; 3],
}

/// X of a product at the n + 1 nodes, exactly zero at x = 0 if it is zero there up to its rounding
/// error.
pub fn nodal(product: &Product, mesh: &Mesh) -> Vec<f64> {
    let mut values: Vec<f64> = mesh.nodes().iter().map(|&x| product.x.eval(x)).collect();
    // u and φ satisfy X(0) = 0 up to round-off; θ may start at θ_A.
    if values[0].abs() < product.x.roundoff(1.0) {
        values[0] = 0.0;
    }
    values
}

/// The products of a manufactured solution at the nodes of a mesh.
#[derive(Debug, Clone)]
pub struct Nodal {
    /// X_j of the displacement, n + 1 values for each product.
    pub u: Vec<Vec<f64>>,
    /// Y_k of the rotation.
    pub phi: Vec<Vec<f64>>,
    /// Z_l of the temperature.
    pub theta: Vec<Vec<f64>>,
}

impl Nodal {
    /// Evaluates each product once at each node.
    pub fn of(exact: &Manufactured, mesh: &Mesh) -> Self {
        let [u, phi, theta] = [&exact.u, &exact.phi, &exact.theta].map(|products| {
            products
                .iter()
                .map(|product| nodal(product, mesh))
                .collect()
        });
        Self { u, phi, theta }
    }

    /// The initial data (3.6); the temperature is adjusted to the solver's own θ_A.
    ///
    /// * `mesh`: the mesh of these products; `factors`: their factors at t = 0.
    /// * `exact_theta_a`: θ_A of the exact solution; `theta_a`: the solver's own.
    pub fn initial(
        &self,
        mesh: &Mesh,
        factors: &Factors,
        exact_theta_a: f64,
        theta_a: f64,
    ) -> InitialValues {
        let nodes = mesh.nodes().len();
        let mut theta = sum(nodes, &self.theta, &factors.theta.value);
        for (theta, x) in theta.iter_mut().zip(mesh.nodes()) {
            *theta += (theta_a - exact_theta_a) * (1.0 - x);
        }
        let last = theta.len() - 1;
        // Checked up to round-off when the study was read.
        (theta[0], theta[last]) = (theta_a, 0.0);
        InitialValues {
            u: sum(nodes, &self.u, &factors.u.value),
            u_t: sum(nodes, &self.u, &factors.u.rate),
            phi: sum(nodes, &self.phi, &factors.phi.value),
            phi_t: sum(nodes, &self.phi, &factors.phi.rate),
            theta,
        }
    }
}

/// The sum of products at the nodes, with their factors.
pub(crate) fn sum(nodes: usize, products: &[Vec<f64>], factors: &[f64]) -> Vec<f64> {
    let mut values = vec![0.0; nodes];
    for (product, factor) in products.iter().zip(factors) {
        for (value, x) in values.iter_mut().zip(product) {
            *value += factor * x;
        }
    }
    values
}

impl Sources {
    /// The loads from the strong form (1.1) and the boundary conditions (1.3).
    pub fn strong(exact: &Manufactured, beam: &Beam, mesh: &Mesh) -> Self {
        Self::assemble(
            exact,
            beam,
            |product| alike(Vectors::strong(product, mesh)),
            continuous_gram(&exact.u),
            mesh.elements(),
        )
    }

    /// The loads from the strong form (1.1) and the boundary conditions (1.3), for elements of any
    /// degree.
    pub fn any_order(exact: &Manufactured, beam: &Beam, space: &Space) -> Self {
        Self::assemble(
            exact,
            beam,
            |product| {
                [Field::U, Field::Phi, Field::Theta]
                    .map(|field| Vectors::any_order(product, space, field))
            },
            continuous_gram(&exact.u),
            space.mesh().elements(),
        )
    }

    /// The loads from the matrices of (3.7), applied to the nodal interpolant: the space error is
    /// then exactly zero.
    pub fn discrete(exact: &Manufactured, beam: &Beam, mesh: &Mesh) -> Self {
        let matrices = [mass(mesh), stiffness(mesh), coupling(mesh).transpose()];
        let nodal: Vec<_> = exact.u.iter().map(|product| nodal(product, mesh)).collect();
        let mut gram = vec![];
        for left in &nodal {
            let image = matrices[1].multiply(left);
            gram.extend(
                nodal
                    .iter()
                    .map(|right| right.iter().zip(&image).map(|(a, b)| a * b).sum::<f64>()),
            );
        }
        Self::assemble(
            exact,
            beam,
            |product| alike(Vectors::discrete(product, &matrices, mesh)),
            gram,
            mesh.elements(),
        )
    }

    fn assemble(
        exact: &Manufactured,
        beam: &Beam,
        vectors: impl Fn(&Product) -> [Vectors; 3],
        gram: Vec<f64>,
        tip_index: usize,
    ) -> Self {
        let [u, phi, theta]: [Vec<[Vectors; 3]>; 3] = [&exact.u, &exact.phi, &exact.theta]
            .map(|products| products.iter().map(&vectors).collect());
        let [tip, tip_phi] =
            [&u, &phi].map(|field| field.iter().map(|[vectors, ..]| vectors.tip).collect());
        let [slope, slope_phi] = [&u, &phi].map(|field| {
            let slopes = field.iter().map(|[vectors, ..]| vectors.boundary_slope);
            slopes.collect()
        });
        let boundary = [slope, tip_phi, slope_phi];
        let mut terms = ProductTerms::new(beam);
        for (j, vectors) in u.iter().enumerate() {
            terms.add_displacement(j, vectors);
        }
        for (k, vectors) in phi.iter().enumerate() {
            terms.add_rotation(k, vectors);
        }
        for (l, vectors) in theta.iter().enumerate() {
            terms.add_temperature(l, vectors);
        }
        Self {
            beam: *beam,
            terms: terms.list,
            gram,
            tip,
            tip_index,
            boundary,
        }
    }

    /// N(u) of the exact solution with the factors T_j, (2.3).
    fn axial(&self, factors: &[f64], defect: Option<Defect>) -> f64 {
        let n = factors.len();
        let mut slope_squared = 0.0;
        for j in 0..n {
            for k in 0..n {
                slope_squared += self.gram[j * n + k] * factors[j] * factors[k];
            }
        }
        axial_force_with(defect, &self.beam, slope_squared)
    }

    /// u(1) of the exact solution with the factors T_j.
    pub fn tip(&self, factors: &[f64]) -> f64 {
        factors.iter().zip(&self.tip).map(|(t, x)| t * x).sum()
    }

    /// N and contact force of the exact solution at one time.
    ///
    /// * `u`: the factors of the displacement at that time.
    /// * `defect`: a mistake in one of them, for a negative control.
    pub fn forces(
        &self,
        u: &FieldFactors,
        obstacles: Option<&Obstacles>,
        defect: Option<Defect>,
    ) -> Forces {
        let tip = self.tip(&u.value);
        Forces {
            axial: self.axial(&u.value, defect),
            contact: contact_with(defect, obstacles, |obstacles| contact_force(obstacles, tip)),
        }
    }

    /// N and contact force as a scheme takes them over a step of the exact solution's time
    /// sequence: the mean of N at both levels, and the contact force of the scheme.
    ///
    /// * `old`, `new`: the factors of the displacement at both levels; `defect` as in
    ///   [`Self::forces`].
    pub fn forces_of_step(
        &self,
        scheme: SchemeFormulas,
        [old, new]: [&FieldFactors; 2],
        obstacles: Option<&Obstacles>,
        defect: Option<Defect>,
    ) -> Forces {
        let axial = match defect {
            Some(Defect::ForceAtNewLevel) => self.axial(&new.value, defect),
            Some(Defect::ForceOfMeanState) => {
                let mean: Vec<f64> = old
                    .value
                    .iter()
                    .zip(&new.value)
                    .map(|(old, new)| 0.5 * (old + new))
                    .collect();
                self.axial(&mean, defect)
            }
            _ => 0.5 * (self.axial(&old.value, defect) + self.axial(&new.value, defect)),
        };
        let u_old = self.tip(&old.value);
        let u = self.tip(&new.value);
        let contact = contact_with(defect, obstacles, |obstacles| match defect {
            Some(Defect::ContactAtMiddle) => contact_force(obstacles, 0.5 * (u + u_old)),
            _ => scheme.contact_force(obstacles, u, u_old),
        });
        Forces { axial, contact }
    }

    /// Writes the loads `(F_u, F_φ, F_θ)`.
    ///
    /// * `factors`: the time factors.
    /// * `forces`: N and contact force of the exact solution.
    /// * `defect`: a mistake in the loads, for a negative control; mistakes in the forces are in
    ///   `forces`.
    /// * `load`: overwritten, n + 1 entries.
    pub fn fill(
        &self,
        factors: &Factors,
        forces: Forces,
        defect: Option<Defect>,
        load: &mut [[f64; 3]],
    ) {
        load.fill([0.0; 3]);
        for term in &self.terms {
            let mut coefficient = term.coefficient(factors, forces.axial);
            if defect == Some(Defect::HalfOfCoupling) && term.is_thermal_moment() {
                coefficient *= 0.5;
            }
            for (load, entry) in load.iter_mut().zip(&term.vector) {
                load[term.equation] += coefficient * entry;
            }
        }
        let tip = self.tip_index;
        if defect != Some(Defect::StressDropped) {
            load[tip][0] += self.tip_stress(factors, forces.axial) + forces.contact;
        }
        if defect != Some(Defect::MomentDropped) {
            load[tip][1] += self.tip_moment(factors);
        }
    }

    /// σ(1, t).
    fn tip_stress(&self, factors: &Factors, n_value: f64) -> f64 {
        let Factors { u, phi, .. } = factors;
        let zeta = self.beam.zeta;
        let [u_slopes, phi_values, _] = &self.boundary;
        let mut stretch = 0.0;
        for (j, slope) in u_slopes.iter().enumerate() {
            stretch += slope * ((1.0 + n_value) * u.value[j] + zeta * u.rate[j]);
        }
        stretch - with_rates(phi_values, phi, zeta)
    }

    /// φ_x(1, t) + ζ φ_xt(1, t).
    fn tip_moment(&self, Factors { phi, .. }: &Factors) -> f64 {
        with_rates(&self.boundary[2], phi, self.beam.zeta)
    }
}

/// `Σ_k c_k (T_k + ζ T_k')`.
fn with_rates(coefficients: &[f64], factors: &FieldFactors, zeta: f64) -> f64 {
    let mut sum = 0.0;
    for (k, coefficient) in coefficients.iter().enumerate() {
        sum += coefficient * (factors.value[k] + zeta * factors.rate[k]);
    }
    sum
}

/// Test functions that are the same in every equation.
fn alike(vectors: Vectors) -> [Vectors; 3] {
    [vectors.clone(), vectors.clone(), vectors]
}

/// `∫ X_j' X_k'` over [0, 1].
fn continuous_gram(products: &[Product]) -> Vec<f64> {
    let n = products.len();
    let mut gram = vec![0.0; n * n];
    let h = 1.0 / PANELS as f64;
    for panel in 0..PANELS {
        for (s, weight) in RULE {
            let x = (panel as f64 + s) * h;
            let slopes: Vec<f64> = products
                .iter()
                .map(|product| product.x.derivatives(x)[1])
                .collect();
            for j in 0..n {
                for k in 0..n {
                    gram[j * n + k] += weight * h * slopes[j] * slopes[k];
                }
            }
        }
    }
    gram
}
