//! The fixed-point iteration (4.1)-(4.5) of a step, linearised at a state.
//!
//! Let δV, δW be small errors of one iterate, so that u has the error dt δV. θ of the previous
//! iterate does not enter (4.2). With σ = ζ + dt/2, the matrices `A_θ = 2/dt M + K`,
//! `A_φ = (κ + σ) M + σ K` and `A_u = κ M + (ζ + dt (1 + m)/2) K` of (4.2), and e the last unit
//! vector, the errors of the next iterate are
//!
//! ```text
//! A_θ δΘ' = -a Cᵀ δW
//! A_φ δW' =  σ Cᵀ δV + a C δΘ'
//! A_u δV' =  σ C δW' - δm K u - dt g' δV_n e,     δm = ρ dt (K u)ᵀ δV.
//! ```
//!
//! All four loops of [`contraction`](crate::contraction) act at once: the iteration converges near
//! the state if the spectral radius of (δV, δW) -> (δV', δW') is below 1. The four factors are
//! those of one loop each; two loops that act on the same vectors can add or cancel.

use crate::contraction::{ShiftedOperator, coupling, stiffness_times, transposed_coupling};
use crate::norms::slope_squared;
use crate::scheme::SteppedBeam;

/// The linear map of the errors (δV, δW) of one iterate to those of the next.
pub struct LinearizedIteration {
    of_u: ShiftedOperator,
    of_phi: ShiftedOperator,
    /// `None` where nothing couples to the temperature.
    of_theta: Option<ShiftedOperator>,
    lengths: Vec<f64>,
    /// σ = ζ + dt/2.
    sigma: f64,
    a: f64,
    /// ρ dt: an error δV changes the mean axial force by `ρ dt (K u)ᵀ δV`.
    axial: f64,
    /// `K u`, with a zero at the clamped end.
    bent: Vec<f64>,
    /// dt g'(u(1)); 0 without contact.
    contact: f64,
    theta: Vec<f64>,
    right: Vec<f64>,
}

impl SteppedBeam {
    /// The iteration linearised at a state with the displacement u at the old and at the new level.
    ///
    /// * `u`: n + 1 nodal values; the state is in contact if the contact force of u(1) is not zero.
    /// * Returns `None` if a matrix of (4.2) is not positive definite: then the iteration cannot
    ///   perform the step.
    pub fn linearized_iteration(&self, u: &[f64]) -> Option<LinearizedIteration> {
        let Self {
            beam,
            obstacles,
            scheme,
            dt,
            lengths,
        } = self;
        let n = lengths.len();
        let axial_force = beam.axial_force(slope_squared(lengths, u));
        let kappa = scheme.inertia / dt;
        let sigma = beam.zeta + 0.5 * dt;
        let is_coupled = n > 1 && beam.a != 0.0;
        let of_theta = if is_coupled {
            Some(ShiftedOperator::new(n - 1, lengths, 2.0 / dt, 1.0)?)
        } else {
            None
        };
        let touched = obstacles.filter(|obstacles| obstacles.force(u[n]) != 0.0);
        let slope = touched.map_or(0.0, |obstacles| obstacles.slope(scheme.contact));
        Some(LinearizedIteration {
            of_u: ShiftedOperator::new(n, lengths, kappa, sigma + 0.5 * dt * axial_force)?,
            of_phi: ShiftedOperator::new(n, lengths, kappa + sigma, sigma)?,
            of_theta,
            lengths: lengths.clone(),
            sigma,
            a: beam.a,
            axial: beam.rho * dt,
            bent: stiffness_times(lengths, u),
            contact: dt * slope,
            theta: vec![0.0; n + 1],
            right: vec![0.0; n + 1],
        })
    }
}

impl LinearizedIteration {
    /// Number of elements n.
    pub fn elements(&self) -> usize {
        self.lengths.len()
    }

    /// Replaces the errors of one iterate by those of the next.
    ///
    /// * `v`, `w`: δV and δW at the n + 1 nodes, zero at the clamped end.
    pub fn apply(&mut self, v: &mut [f64], w: &mut [f64]) {
        let n = self.lengths.len();
        let axial_force = self.axial
            * self
                .bent
                .iter()
                .zip(&*v)
                .map(|(bent, v)| bent * v)
                .sum::<f64>();
        let contact_force = self.contact * v[n];
        self.theta.fill(0.0);
        if let Some(of_theta) = &self.of_theta {
            transposed_coupling(-self.a, w, &mut self.theta);
            of_theta.solve(&mut self.theta);
        }
        transposed_coupling(self.sigma, v, w);
        coupling(self.a, &self.theta, &mut self.right);
        w.iter_mut()
            .zip(&self.right)
            .for_each(|(w, moment)| *w += moment);
        self.of_phi.solve(w);
        coupling(self.sigma, w, v);
        v.iter_mut()
            .zip(&self.bent)
            .for_each(|(v, bent)| *v -= axial_force * bent);
        v[n] -= contact_force;
        self.of_u.solve(v);
    }
}
