//! Error norms at one time level, without quadrature in the time loop and without cancellation.
//!
//! The error is `e = d + η`, with the P1 function `d = u_h - I u` and the interpolation error
//! `η = I u - u = Σ T_j η_j`. Both are small and known up to rounding errors of u itself, ε|u|, so
//! `‖e‖² = ‖d‖² + 2 (d, η) + ‖η‖²` does not cancel (unlike ‖u_h‖² - 2 (u_h, u) + ‖u‖²). The moments
//! of η_j on each element and their Gram matrices are computed once.
//!
//! η vanishes at the nodes, so for a constant c on an element `(c, η_x) = 0`, and by parts
//! `(d, η_x) = -(d_x, η)`. Hence `‖e_x‖² = ‖d_x‖² + ‖η_x‖²` and, for the shear with the P1
//! functions d, p and interpolation errors η, ψ of u, φ,
//! `‖(d + η)_x - (p + ψ)‖² = ‖d_x - p‖² + ‖η_x - ψ‖² + 2 [p_x ∫η - d_x ∫ψ + (p, ψ)]`, summed over
//! the elements.

use crate::norm::{Norm, Norms, TheoremSquares, dot, l2_squared};
use crate::quadrature::RULE;
use crate::solution::{Factors, Manufactured, Product};
use crate::sources::nodal;
use thermobeam::mesh::Mesh;
use thermobeam::solve::TimeLevel;

/// Interpolation error of one product on a mesh.
struct Interpolation {
    /// X at the nodes.
    nodal: Vec<f64>,
    /// (η, left hat) and (η, right hat) on each element; empty if the interpolant counts as exact.
    moments: Vec<[f64; 2]>,
}

/// Computes the errors of a level against the exact solution.
pub struct ErrorMeter {
    lengths: Vec<f64>,
    /// The products of u, φ and θ.
    fields: [Vec<Interpolation>; 3],
    /// Gram matrices of η in L², row by row, for u, φ and θ.
    grams: [Vec<f64>; 3],
    /// Gram matrix of η_x for φ.
    gram_curvature: Vec<f64>,
    /// Gram matrix of the shear η_x - ψ, for the products of u followed by those of φ.
    gram_shear: Vec<f64>,
    /// The solver's lifting θ_A (1 - x).
    lifting: Vec<f64>,
    /// d for û, u, φ̂, φ, θ.
    difference: [Vec<f64>; 5],
}

impl ErrorMeter {
    /// For errors against the exact solution, or against its nodal interpolant if `interpolant`.
    ///
    /// The lifting is zero until [`Self::lift`] sets it.
    pub fn new(exact: &Manufactured, mesh: &Mesh, interpolant: bool) -> Self {
        let fields = [&exact.u, &exact.phi, &exact.theta].map(|products| {
            products
                .iter()
                .map(|p| Interpolation {
                    nodal: nodal(p, mesh),
                    moments: vec![],
                })
                .collect::<Vec<_>>()
        });
        let [u, phi, _] = fields.each_ref().map(Vec::len);
        let mut meter = Self {
            lengths: mesh.lengths().collect(),
            grams: fields
                .each_ref()
                .map(|products| zero_square(products.len())),
            gram_curvature: zero_square(phi),
            gram_shear: zero_square(u + phi),
            lifting: vec![0.0; mesh.nodes().len()],
            difference: std::array::from_fn(|_| vec![0.0; mesh.nodes().len()]),
            fields,
        };
        if !interpolant {
            meter.integrate(exact, mesh);
        }
        meter
    }

    /// Sets the solver's lifting θ_A (1 - x), which is added to the temperature of a level.
    pub fn lift(&mut self, mesh: &Mesh, theta_a: f64) {
        for (lifting, x) in self.lifting.iter_mut().zip(mesh.nodes()) {
            *lifting = theta_a * (1.0 - x);
        }
    }

    /// Computes moments and Gram matrices of the interpolation errors by quadrature.
    fn integrate(&mut self, exact: &Manufactured, mesh: &Mesh) {
        for interpolation in self.fields.iter_mut().flatten() {
            interpolation.moments = vec![[0.0; 2]; mesh.elements()];
        }
        for (i, ends) in mesh.nodes().windows(2).enumerate() {
            let h = ends[1] - ends[0];
            for (s, weight) in RULE {
                let x = ends[0] + s * h;
                let mut samples = [vec![], vec![], vec![]];
                let products = [&exact.u, &exact.phi, &exact.theta];
                for ((sample, products), field) in
                    samples.iter_mut().zip(products).zip(&self.fields)
                {
                    for (product, interpolation) in products.iter().zip(field) {
                        sample.push(interpolation_error(product, interpolation, i, h, s, x));
                    }
                }
                self.add_samples(i, s, weight * h, &samples);
            }
        }
    }

    /// Adds the contribution of one quadrature point, given η and η_x of the products of u, φ and θ
    /// there.
    fn add_samples(&mut self, element: usize, s: f64, weight: f64, samples: &[Vec<[f64; 2]>; 3]) {
        for ((field, gram), sample) in self.fields.iter_mut().zip(&mut self.grams).zip(samples) {
            for (interpolation, [eta, _]) in field.iter_mut().zip(sample) {
                interpolation.moments[element][0] += weight * (1.0 - s) * eta;
                interpolation.moments[element][1] += weight * s * eta;
            }
            add_outer(gram, weight, &values(sample));
        }
        let [u, phi, _] = samples;
        let shear: Vec<f64> = slopes(u)
            .into_iter()
            .chain(values(phi).into_iter().map(|psi| -psi))
            .collect();
        add_outer(&mut self.gram_curvature, weight, &slopes(phi));
        add_outer(&mut self.gram_shear, weight, &shear);
    }

    /// The errors of `level` against the exact solution with the given factors.
    pub fn measure(&mut self, level: &TimeLevel, factors: &Factors) -> Norms {
        let Factors { u, phi, theta } = factors;
        let [of_u, of_phi, of_theta] = &self.fields;
        let [gram_u, gram_phi, gram_theta] = &self.grams;
        let [v_d, u_d, w_d, phi_d, theta_d] = &mut self.difference;
        difference_into(&level.v, of_u, &u.rate, v_d);
        difference_into(&level.u, of_u, &u.value, u_d);
        difference_into(&level.w, of_phi, &phi.rate, w_d);
        difference_into(&level.phi, of_phi, &phi.value, phi_d);
        difference_into(&level.theta, of_theta, &theta.value, theta_d);
        for (theta, lifting) in theta_d.iter_mut().zip(&self.lifting) {
            *theta += lifting;
        }
        let [v_d, u_d, w_d, phi_d, theta_d] = &self.difference;
        let nodal = TheoremSquares::of(&self.lengths, v_d, u_d, w_d, phi_d, theta_d);
        let shear_factors: Vec<f64> = u.value.iter().chain(&phi.value).copied().collect();
        let squares = TheoremSquares {
            velocity: nodal.velocity + correction(v_d, of_u, &u.rate, gram_u),
            shear: nodal.shear
                + quadratic(&self.gram_shear, &shear_factors)
                + 2.0 * self.shear_product(factors),
            rotation_rate: nodal.rotation_rate + correction(w_d, of_phi, &phi.rate, gram_phi),
            curvature: nodal.curvature + quadratic(&self.gram_curvature, &phi.value),
            temperature: nodal.temperature
                + correction(theta_d, of_theta, &theta.value, gram_theta),
        };
        let displacement = l2_squared(&self.lengths, u_d) + correction(u_d, of_u, &u.value, gram_u);
        Norms::of(|norm| match norm {
            Norm::Velocity => root(squares.velocity),
            Norm::Shear => root(squares.shear),
            Norm::RotationRate => root(squares.rotation_rate),
            Norm::Curvature => root(squares.curvature),
            Norm::Temperature => root(squares.temperature),
            Norm::Theorem34 => squares.norm(),
            Norm::Displacement => root(displacement),
            Norm::Superclose => nodal.norm(),
        })
    }

    /// `p_x ∫η - d_x ∫ψ + (p, ψ)` over all elements.
    fn shear_product(&self, factors: &Factors) -> f64 {
        let [of_u, of_phi, _] = &self.fields;
        let [_, u, _, phi, _] = &self.difference;
        let mut sum = 0.0;
        for (i, h) in self.lengths.iter().enumerate() {
            let eta = moment(of_u, &factors.u.value, i);
            let psi = moment(of_phi, &factors.phi.value, i);
            let (d_x, p_x) = ((u[i + 1] - u[i]) / h, (phi[i + 1] - phi[i]) / h);
            sum += p_x * (eta[0] + eta[1]) - d_x * (psi[0] + psi[1])
                + phi[i] * psi[0]
                + phi[i + 1] * psi[1];
        }
        sum
    }
}

/// η and η_x of a product at `x = x_i + s h` in element i.
fn interpolation_error(
    product: &Product,
    field: &Interpolation,
    i: usize,
    h: f64,
    s: f64,
    x: f64,
) -> [f64; 2] {
    let [value, slope, _] = product.x.derivatives(x);
    let (left, right) = (field.nodal[i], field.nodal[i + 1]);
    [
        (1.0 - s) * left + s * right - value,
        (right - left) / h - slope,
    ]
}

/// Adds `weight vector vectorᵀ` to a Gram matrix.
fn add_outer(gram: &mut [f64], weight: f64, vector: &[f64]) {
    for (row, a) in gram.chunks_mut(vector.len().max(1)).zip(vector) {
        for (entry, b) in row.iter_mut().zip(vector) {
            *entry += weight * a * b;
        }
    }
}

/// `d = y_h - Σ T_j X_j` at the nodes.
fn difference_into(
    discrete: &[f64],
    field: &[Interpolation],
    factors: &[f64],
    difference: &mut [f64],
) {
    difference.copy_from_slice(discrete);
    for (interpolation, factor) in field.iter().zip(factors) {
        for (difference, value) in difference.iter_mut().zip(&interpolation.nodal) {
            *difference -= factor * value;
        }
    }
}

/// The moments of η = Σ T_j η_j on an element; zero if the interpolant counts as exact.
fn moment(field: &[Interpolation], factors: &[f64], element: usize) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for (interpolation, factor) in field.iter().zip(factors) {
        if let Some(moments) = interpolation.moments.get(element) {
            sum = [sum[0] + factor * moments[0], sum[1] + factor * moments[1]];
        }
    }
    sum
}

/// `2 (d, η) + ‖η‖²`.
fn correction(difference: &[f64], field: &[Interpolation], factors: &[f64], gram: &[f64]) -> f64 {
    let mut product = 0.0;
    for i in 0..difference.len() - 1 {
        let moment = moment(field, factors, i);
        product += difference[i] * moment[0] + difference[i + 1] * moment[1];
    }
    2.0 * product + quadratic(gram, factors)
}

/// The quadratic form of a Gram matrix.
fn quadratic(gram: &[f64], factors: &[f64]) -> f64 {
    gram.chunks(factors.len().max(1))
        .zip(factors)
        .map(|(row, factor)| factor * dot(row, factors))
        .sum()
}

fn zero_square(n: usize) -> Vec<f64> {
    vec![0.0; n * n]
}

/// η of each product.
fn values(sample: &[[f64; 2]]) -> Vec<f64> {
    sample.iter().map(|[eta, _]| *eta).collect()
}

/// η_x of each product.
fn slopes(sample: &[[f64; 2]]) -> Vec<f64> {
    sample.iter().map(|[_, eta_x]| *eta_x).collect()
}

/// The root of a square that rounding errors may have made negative. NaN stays.
fn root(square: f64) -> f64 {
    if square < 0.0 { 0.0 } else { square.sqrt() }
}
