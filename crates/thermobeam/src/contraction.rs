//! Contraction factors of the paper's fixed-point iteration (4.1)-(4.5).
//!
//! The paper does not analyse the convergence of its iteration. An error returns to its field by
//! four loops, and each multiplies it by a factor, which is that of the loop alone. The iteration
//! converges with the spectral radius of their combination. That is near the largest factor if the
//! others are small; two loops that act on the same fields may add (contact and axial force) or
//! damp each other (rotation and heat). Write A_u, A_φ and A_θ for the matrices of (4.2).
//!
//! | loop | quantity of the previous iterate | factor | for dt ≪ ζ, on fine meshes |
//! | --- | --- | --- | --- |
//! | [`Loop::Contact`] | g(u) in the first equation | [`SteppedBeam::contact_contraction`] | g' dt^{3/2}/√(Iζ) |
//! | [`Loop::Rotation`] | u and û in the second | [`SteppedBeam::coupling_contraction`] | ζ dt/(2I) |
//! | [`Loop::Heat`] | φ̂ in the third | [`SteppedBeam::heat_contraction`] | a² dt/(√I + √(2ζ))² |
//! | [`Loop::AxialForce`] | N(u) in the first | [`SteppedBeam::axial_contraction`] | ρ u_x(1)² dt^{3/2}/√(Iζ) |
//!
//! I is the inertia of the scheme, and g' the slope of the contact force: 1 and 1/ε for the paper's
//! scheme, 2 and 1/(2ε) for `midpoint`.

pub use crate::error::Loop;
use crate::norms::{l2_squared, slope_squared};
use crate::scheme::SteppedBeam;
use crate::tridiagonal::TridiagonalFactor;

/// Largest number of power iterations, and the relative change of the quotient at which they stop.
const ITERATIONS: usize = 300;
const RELATIVE_CHANGE: f64 = 1e-13;

/// In all of these, `n_value` is the mean axial force ½(N(u) + N(u0)) of the step.
impl SteppedBeam {
    /// κ = inertia/dt and σ = ζ + dt/2.
    fn kappa_and_sigma(&self) -> (f64, f64) {
        (
            self.scheme.inertia / self.dt,
            self.beam.zeta + 0.5 * self.dt,
        )
    }

    /// `A_u = κ M + (ζ + dt (1 + N)/2) K`, the matrix of the first equation of (4.2); `None` if it
    /// is not positive definite.
    fn matrix_of_u(&self, n_value: f64) -> Option<ShiftedOperator> {
        let stiffness = self.beam.zeta + 0.5 * self.dt * (1.0 + n_value);
        ShiftedOperator::new(
            self.lengths.len(),
            &self.lengths,
            self.scheme.inertia / self.dt,
            stiffness,
        )
    }

    /// Contraction factor of the fixed point while the tip is in contact, `α = dt g' [A_u⁻¹]_nn`; 0
    /// without obstacles.
    ///
    /// g' is the slope of the contact force: 1/ε, or half of it for the discrete gradient. The
    /// contact force of the previous iterate enters the right-hand side at the tip only, so an
    /// error e of u(1) becomes -α e.
    ///
    /// * Returns infinity if A_u is not positive definite: then the fixed point cannot perform the
    ///   step.
    pub fn contact_contraction(&self, n_value: f64) -> f64 {
        let Some(obstacles) = &self.obstacles else {
            return 0.0;
        };
        let slope = obstacles.slope(self.scheme.contact);
        self.matrix_of_u(n_value).map_or(f64::INFINITY, |of_u| {
            self.dt * slope * of_u.factor.last_of_inverse()
        })
    }

    /// Contraction factor of the fixed point due to the coupling of rotation and displacement.
    ///
    /// An error of V enters the second equation of (4.2) as `σ Cᵀ V`, and the resulting error of W
    /// enters the first as `σ C W`. The factor is therefore the largest eigenvalue of
    /// `σ² A_u⁻¹ C A_φ⁻¹ Cᵀ`, with
    ///
    /// ```text
    /// A_u = κ M + σ' K,   A_φ = (κ + σ) M + σ K,   κ = inertia/dt,   σ = ζ + dt/2,   σ' = σ + dt N/2.
    /// ```
    ///
    /// A wave of wavenumber k in the interior has the factor `σ²k²/((κ + σ' k²)(κ + σ (1 + k²)))`,
    /// at most about σ/(4κ). A layer at the free end has a larger one,
    /// `σ²/(σ' (κ + σ) + √(σ σ' κ (κ + σ)))` if it is thin, about σ/(2κ). For N = 0 the factor is
    /// below `1/(1 + π²/4) = 0.2884` for all dt, its limit for dt → ∞.
    ///
    /// * Returns infinity if A_u is not positive definite.
    pub fn coupling_contraction(&self, n_value: f64) -> f64 {
        let lengths = &self.lengths;
        let n = lengths.len();
        let (kappa, sigma) = self.kappa_and_sigma();
        let of_u = ShiftedOperator::new(n, lengths, kappa, sigma + 0.5 * self.dt * n_value);
        let of_phi = ShiftedOperator::new(n, lengths, kappa + sigma, sigma);
        of_u.zip(of_phi).map_or(f64::INFINITY, |(of_u, of_phi)| {
            round_trip(lengths, sigma, &of_u, &of_phi)
        })
    }

    /// Contraction factor of the fixed point due to the coupling of rotation and temperature.
    ///
    /// An error of W enters the third equation of (4.2) as `-a Cᵀ W`, and the resulting error of Θ
    /// enters the second as `a C Θ`. The factor is therefore the largest eigenvalue of
    /// `a² A_φ⁻¹ C A_θ⁻¹ Cᵀ` with `A_θ = 2/dt M + K`, and the error changes sign. A wave of
    /// wavenumber k has the factor `a²k²/((2/dt + k²)(κ + σ (1 + k²)))`, at most about
    /// `a² dt/(√I + √(2σ))²` with the inertia I: larger than that of rotation and displacement
    /// where `a² > σ (1 + √(2σ))²/2` (I = 1), and above 1 for a large a.
    pub fn heat_contraction(&self) -> f64 {
        let lengths = &self.lengths;
        let n = lengths.len();
        let (kappa, sigma) = self.kappa_and_sigma();
        if n == 1 || self.beam.a == 0.0 {
            return 0.0;
        }
        let of_phi = ShiftedOperator::new(n, lengths, kappa + sigma, sigma);
        let of_theta = ShiftedOperator::new(n - 1, lengths, 2.0 / self.dt, 1.0);
        match of_phi.zip(of_theta) {
            Some((of_phi, of_theta)) => round_trip(lengths, self.beam.a, &of_phi, &of_theta),
            None => f64::INFINITY,
        }
    }

    /// Contraction factor of the fixed point due to the axial force of the previous iterate,
    /// `ρ dt (K u)ᵀ A_u⁻¹ K u`.
    ///
    /// An error of V changes the mean axial force ½(N(u) + N(u0)) by `ρ dt (K u)ᵀ V`, and the first
    /// equation by that times `K u`: a rank-one map, whose only nonzero eigenvalue is -1 times the
    /// factor.
    ///
    /// * `u`: the displacement at the nodes, used for both the old and the new level.
    /// * Returns infinity if A_u is not positive definite.
    pub fn axial_contraction(&self, n_value: f64, u: &[f64]) -> f64 {
        let Some(of_u) = self.matrix_of_u(n_value) else {
            return f64::INFINITY;
        };
        let bent = stiffness_times(&self.lengths, u);
        let mut moved = bent.clone();
        of_u.factor.solve_in_place(&mut moved);
        self.beam.rho
            * self.dt
            * bent
                .iter()
                .zip(&moved)
                .map(|(bent, moved)| bent * moved)
                .sum::<f64>()
    }

    /// The largest factor of the four loops: about the contraction factor of the fixed point if the
    /// others are small.
    ///
    /// * `u`: the displacement at the nodes, which determines the axial force.
    pub fn contraction(&self, u: &[f64]) -> (f64, Loop) {
        let n_value = self.beam.axial_force(slope_squared(&self.lengths, u));
        let loops = [
            (self.contact_contraction(n_value), Loop::Contact),
            (self.coupling_contraction(n_value), Loop::Rotation),
            (self.heat_contraction(), Loop::Heat),
            (self.axial_contraction(n_value, u), Loop::AxialForce),
        ];
        loops.into_iter().fold((0.0, Loop::Contact), |most, next| {
            if next.0 > most.0 { next } else { most }
        })
    }
}

/// `K u` at the nodes, with a zero at the clamped end.
pub(crate) fn stiffness_times(lengths: &[f64], u: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; u.len()];
    for (i, h) in lengths.iter().enumerate() {
        let slope = (u[i + 1] - u[i]) / h;
        product[i] -= slope;
        product[i + 1] += slope;
    }
    product[0] = 0.0;
    product
}

/// `mass M + stiffness K`, with its factorisation.
pub(crate) struct ShiftedOperator {
    mass: f64,
    stiffness: f64,
    factor: TridiagonalFactor,
}

impl ShiftedOperator {
    /// For the nodes 1..=last; `None` if it is not positive definite.
    pub(crate) fn new(last: usize, lengths: &[f64], mass: f64, stiffness: f64) -> Option<Self> {
        let mut factor = TridiagonalFactor::new(last);
        factor
            .factorize(lengths, mass, stiffness, 0.0)
            .ok()
            .map(|()| Self {
                mass,
                stiffness,
                factor,
            })
    }

    /// Solves for the nodes, zero where the value is prescribed.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        x[0] = 0.0;
        let last = x.len() - 1;
        self.factor.solve_in_place(x);
        if self.factor.last() < last {
            x[last] = 0.0;
        }
    }
}

/// The largest eigenvalue of `b² outer⁻¹ C inner⁻¹ Cᵀ`, by power iteration.
fn round_trip(lengths: &[f64], b: f64, outer: &ShiftedOperator, inner: &ShiftedOperator) -> f64 {
    let n = lengths.len();
    // A load at the tip starts in the layer there and contains every mode.
    let mut v = vec![0.0; n + 1];
    v[n] = 1.0;
    outer.solve(&mut v);
    let (mut w, mut image) = (vec![0.0; n + 1], vec![0.0; n + 1]);
    let mut factor = 0.0;
    for _ in 0..ITERATIONS {
        let size = (outer.mass * l2_squared(lengths, &v)
            + outer.stiffness * slope_squared(lengths, &v))
        .sqrt();
        v.iter_mut().for_each(|v| *v /= size);
        transposed_coupling(b, &v, &mut w);
        inner.solve(&mut w);
        coupling(b, &w, &mut image);
        // The quotient (v, b C w)/(v, outer v).
        let quotient: f64 = v.iter().zip(&image).map(|(v, image)| v * image).sum();
        outer.solve(&mut image);
        std::mem::swap(&mut v, &mut image);
        let change = (quotient - factor).abs();
        factor = quotient;
        if change <= RELATIVE_CHANGE * factor {
            break;
        }
    }
    factor
}

/// `w = σ Cᵀ v`.
pub(crate) fn transposed_coupling(sigma: f64, v: &[f64], w: &mut [f64]) {
    w.fill(0.0);
    for i in 0..v.len() - 1 {
        let shear = 0.5 * sigma * (v[i + 1] - v[i]);
        w[i] += shear;
        w[i + 1] += shear;
    }
}

/// `v = σ C w`.
pub(crate) fn coupling(sigma: f64, w: &[f64], v: &mut [f64]) {
    v.fill(0.0);
    for i in 0..w.len() - 1 {
        let stress = 0.5 * sigma * (w[i] + w[i + 1]);
        v[i] -= stress;
        v[i + 1] += stress;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::{Beam, Obstacles};

    #[test]
    fn the_largest_loop_is_named() {
        let largest = |beam: Beam, obstacles: Option<Obstacles>, slope: f64| {
            let u: Vec<f64> = (0..=50).map(|i| slope * f64::from(i) / 50.0).collect();
            SteppedBeam {
                obstacles,
                ..SteppedBeam::free(beam, 1e-2, &[0.02; 50])
            }
            .contraction(&u)
        };
        let beam = |a: f64, rho: f64| Beam {
            a,
            rho,
            ..Beam::default()
        };
        let obstacles = Some(Obstacles::default());
        for (beam, obstacles, slope, factor, of) in [
            (Beam::default(), obstacles, 0.0, 3.038, Loop::Contact),
            (Beam::default(), None, 0.0, 5.08e-4, Loop::Rotation),
            (beam(20.0, 1.0), None, 0.0, 1.843, Loop::Heat),
            (beam(0.017, 1e3), None, 1.0, 0.44232, Loop::AxialForce),
        ] {
            let (found, named) = largest(beam, obstacles, slope);
            assert!(
                named == of && (found - factor).abs() <= 1e-3 * factor,
                "{named}: {found} for {factor}"
            );
        }
    }

    #[test]
    fn the_contraction_factor_of_an_indefinite_operator_is_infinite() {
        let case = SteppedBeam {
            obstacles: Some(Obstacles::default()),
            ..SteppedBeam::free(Beam::default(), 10.0, &[0.1; 10])
        };
        assert_eq!(
            [
                case.contact_contraction(-3.0),
                case.coupling_contraction(-3.0)
            ],
            [f64::INFINITY; 2]
        );
    }
}
