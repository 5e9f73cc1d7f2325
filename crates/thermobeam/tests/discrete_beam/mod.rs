//! The beam at rest on P1 elements, dense: residual, second variation and Newton's method, written from the weak form.

use nalgebra::{DMatrix, DVector};
use thermobeam::parameters::{Beam, Obstacles};

/// Uniform mesh, unknowns (u_1..u_n, φ_1..φ_n); node 0 is clamped.
pub(crate) struct DiscreteBeam {
    pub(crate) elements: usize,
    pub(crate) mass: DMatrix<f64>,
    pub(crate) stiffness: DMatrix<f64>,
    /// `C_ij = (N_j, N_i')`.
    pub(crate) coupling: DMatrix<f64>,
}

impl DiscreteBeam {
    pub(crate) fn new(elements: usize) -> Self {
        let (n, h) = (elements, 1.0 / elements as f64);
        let mut full = [DMatrix::zeros(n + 1, n + 1), DMatrix::zeros(n + 1, n + 1), DMatrix::zeros(n + 1, n + 1)];
        for e in 0..n {
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let slope = |k: usize| if k == 0 { -1.0 / h } else { 1.0 / h };
                full[0][(e + i, e + j)] += if i == j { h / 3.0 } else { h / 6.0 };
                full[1][(e + i, e + j)] += slope(i) * slope(j) * h;
                full[2][(e + i, e + j)] += slope(i) * h / 2.0;
            }
        }
        let [mass, stiffness, coupling] = full.map(|m| m.view((1, 1), (n, n)).into_owned());
        Self { elements, mass, stiffness, coupling }
    }

    pub(crate) fn interpolate(&self, u: impl Fn(f64) -> f64, phi: impl Fn(f64) -> f64) -> DVector<f64> {
        let n = self.elements;
        let node = |i: usize| (i + 1) as f64 / n as f64;
        DVector::from_fn(2 * n, |i, _| if i < n { u(node(i)) } else { phi(node(i - n)) })
    }

    /// Derivative and second derivative of the potential energy.
    pub(crate) fn variations(
        &self,
        beam: &Beam,
        obstacles: Option<&Obstacles>,
        state: &DVector<f64>,
    ) -> (DVector<f64>, DMatrix<f64>) {
        let n = self.elements;
        let (u, phi) = (state.rows(0, n), state.rows(n, n));
        let bend = &self.stiffness * u;
        let axial = beam.beta + beam.rho * bend.dot(&u);
        // The integrals of the hats: h inside, h/2 at the tip.
        let load =
            DVector::from_fn(n, |i, _| (if i + 1 == n { 0.5 } else { 1.0 }) / n as f64) * (beam.a * beam.theta_a);
        let mut first = DVector::zeros(2 * n);
        first.rows_mut(0, n).copy_from(&(&bend * (1.0 + axial) - &self.coupling * phi));
        first
            .rows_mut(n, n)
            .copy_from(&(&self.stiffness * phi + &self.mass * phi - self.coupling.transpose() * u - load));
        let mut second = self.stiffness_form(axial);
        let mut block = second.view_mut((0, 0), (n, n));
        block += &bend * bend.transpose() * (2.0 * beam.rho);
        if let Some(o) = obstacles {
            let tip = u[n - 1];
            first[n - 1] += ((tip - o.g2).max(0.0) - (o.g1 - tip).max(0.0)) / o.epsilon;
            if tip > o.g2 || tip < o.g1 {
                second[(n - 1, n - 1)] += 1.0 / o.epsilon;
            }
        }
        (first, second)
    }

    /// The form `(1 + N)‖u'‖² - 2(u', φ) + ‖φ‖² + ‖φ'‖²`.
    pub(crate) fn stiffness_form(&self, axial: f64) -> DMatrix<f64> {
        let n = self.elements;
        let mut form = DMatrix::zeros(2 * n, 2 * n);
        form.view_mut((0, 0), (n, n)).copy_from(&(&self.stiffness * (1.0 + axial)));
        form.view_mut((0, n), (n, n)).copy_from(&-&self.coupling);
        form.view_mut((n, 0), (n, n)).copy_from(&-self.coupling.transpose());
        form.view_mut((n, n), (n, n)).copy_from(&(&self.stiffness + &self.mass));
        form
    }
}
