//! The constants C_h and C_t of Theorem 3.4, known before any run: `error² ≈ (C_h h)² + (C_t dt)²`.
//!
//! The derivation, with the equations that are integrated here, is in THEORY.md, "The constants of
//! Theorem 3.4". C_h is that of interpolated slopes on a uniform mesh. C_t is the largest norm of
//! the solution (e, q, r) of the system linearised on the mesh, with the terms of order dt that the
//! scheme's equations leave: inertia and contact. It is integrated by the classical method of
//! order 4.

use crate::assembly::{Tridiagonal, coupling, mass, stiffness};
use crate::formulas::{axial_force, contact_force};
use crate::norm::{dot, max_or_nan};
use crate::quadrature::RULE;
use crate::solution::{Manufactured, Product};
use crate::sources::{Nodal, sum};
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};

/// Panels of the quadrature of second derivatives over [0, 1].
const PANELS: usize = 64;

/// C_h.
///
/// * `times`: the time levels t_n, n >= 1, over which the theorem takes the maximum.
pub fn in_space(exact: &Manufactured, times: impl Iterator<Item = f64>) -> f64 {
    times.fold(0.0, |largest, t| {
        let square = curvature_squared(&exact.u, t) + curvature_squared(&exact.phi, t);
        max_or_nan(largest, (square / 12.0).sqrt())
    })
}

/// `‖y_xx‖²` of a sum of products.
fn curvature_squared(products: &[Product], t: f64) -> f64 {
    let h = 1.0 / PANELS as f64;
    let mut integral = 0.0;
    for panel in 0..PANELS {
        for (s, weight) in RULE {
            let x = (panel as f64 + s) * h;
            let terms = products.iter().map(|y| y.x.derivatives(x)[2] * y.t.eval(t));
            integral += weight * h * terms.sum::<f64>().powi(2);
        }
    }
    integral
}

/// C_t for the paper's scheme with exact loads on this mesh; NaN or
/// infinite if the steps are too long for the mesh.
///
/// * `steps`: the number of steps of the integration until `t_end`.
pub fn in_time(
    exact: &Manufactured,
    (beam, obstacles): (&Beam, Option<&Obstacles>),
    mesh: &Mesh,
    t_end: f64,
    steps: usize,
) -> f64 {
    let system = ErrorSystem {
        exact,
        nodal: Nodal::of(exact, mesh),
        beam,
        obstacles,
        nodes: mesh.nodes().len(),
        mass: mass(mesh),
        stiffness: stiffness(mesh),
        coupling: coupling(mesh),
        transpose: coupling(mesh).transpose(),
        t_end,
    };
    let dt = t_end / steps as f64;
    let mut error = system.start();
    let mut largest: f64 = 0.0;
    for step in 0..steps {
        let t = step as f64 * dt;
        let k1 = system.rate(t, &error);
        let k2 = system.rate(t + 0.5 * dt, &error.plus(0.5 * dt, &k1));
        let k3 = system.rate(t + 0.5 * dt, &error.plus(0.5 * dt, &k2));
        let k4 = system.rate(t + dt, &error.plus(dt, &k3));
        for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            error = error.plus(weight * dt / 6.0, &k);
        }
        largest = max_or_nan(largest, system.norm(t + dt, &error));
    }
    largest
}

/// The error of order dt at the nodes, or its rate.
#[derive(Clone)]
struct ErrorState {
    /// e, of the displacement.
    u: Vec<f64>,
    /// e'.
    u_rate: Vec<f64>,
    /// q, of the rotation.
    phi: Vec<f64>,
    /// q'.
    phi_rate: Vec<f64>,
    /// r, of the temperature.
    theta: Vec<f64>,
}

impl ErrorState {
    /// `self + factor * other`.
    fn plus(&self, factor: f64, other: &Self) -> Self {
        let add = |a: &[f64], b: &[f64]| combined(a, factor, b);
        Self {
            u: add(&self.u, &other.u),
            u_rate: add(&self.u_rate, &other.u_rate),
            phi: add(&self.phi, &other.phi),
            phi_rate: add(&self.phi_rate, &other.phi_rate),
            theta: add(&self.theta, &other.theta),
        }
    }
}

/// The linear system of THEORY.md.
struct ErrorSystem<'a> {
    exact: &'a Manufactured,
    nodal: Nodal,
    beam: &'a Beam,
    obstacles: Option<&'a Obstacles>,
    nodes: usize,
    mass: Tridiagonal,
    stiffness: Tridiagonal,
    coupling: Tridiagonal,
    transpose: Tridiagonal,
    t_end: f64,
}

impl ErrorSystem<'_> {
    fn start(&self) -> ErrorState {
        let zeros = vec![0.0; self.nodes];
        ErrorState {
            u: zeros.clone(),
            u_rate: self.half_acceleration(&self.exact.u, &self.nodal.u),
            phi: zeros.clone(),
            phi_rate: self.half_acceleration(&self.exact.phi, &self.nodal.phi),
            theta: zeros,
        }
    }

    fn half_acceleration(&self, products: &[Product], space: &[Vec<f64>]) -> Vec<f64> {
        let factors = products.iter().map(|y| 0.5 * y.t.derivatives(0.0)[2]);
        sum(self.nodes, space, &factors.collect::<Vec<_>>())
    }

    /// The time derivative of this order of the exact displacement or rotation at the nodes.
    fn derivative(
        &self,
        products: &[Product],
        space: &[Vec<f64>],
        t: f64,
        order: usize,
    ) -> Vec<f64> {
        let factors = products.iter().map(|product| match order {
            3 => self.third(product, t),
            _ => product.t.derivatives(t)[order],
        });
        sum(self.nodes, space, &factors.collect::<Vec<_>>())
    }

    /// T''' by a difference of T'', within [0, t_end].
    fn third(&self, product: &Product, t: f64) -> f64 {
        let reach = 1e-5 * self.t_end;
        let (before, after) = ((t - reach).max(0.0), (t + reach).min(self.t_end));
        let [low, high] = [before, after].map(|at| product.t.derivatives(at)[2]);
        (high - low) / (after - before)
    }

    fn rate(&self, t: f64, error: &ErrorState) -> ErrorState {
        let Beam { zeta, a, rho, .. } = *self.beam;
        let [m, k, c, ct] = [&self.mass, &self.stiffness, &self.coupling, &self.transpose];
        let of_u = |order| self.derivative(&self.exact.u, &self.nodal.u, t, order);
        let of_phi = |order| self.derivative(&self.exact.phi, &self.nodal.phi, t, order);
        // e + ζ e' and q + ζ q' enter the same terms.
        let stretched = combined(&error.u, zeta, &error.u_rate);
        let turned = combined(&error.phi, zeta, &error.phi_rate);
        let last = self.nodes - 1;

        let (u, u_rate) = (of_u(0), of_u(1));
        let tension = k.multiply(&u);
        let n_value = axial_force(self.beam, dot(&u, &tension));
        let mut forces = combined(&c.multiply(&turned), -1.0, &k.multiply(&stretched));
        forces = combined(&forces, -n_value, &k.multiply(&error.u));
        forces = combined(&forces, -2.0 * rho * dot(&tension, &error.u), &tension);
        forces = combined(&forces, 0.5, &m.multiply(&of_u(3)));
        forces[last] -= self.contact_slope(u[last]) * (error.u[last] + 0.5 * u_rate[last]);

        let mut moments = combined(&ct.multiply(&stretched), -1.0, &k.multiply(&turned));
        moments = combined(&moments, -1.0, &m.multiply(&turned));
        moments = combined(&moments, a, &c.multiply(&error.theta));
        moments = combined(&moments, 0.5, &m.multiply(&of_phi(3)));

        let heat = combined(&k.multiply(&error.theta), a, &ct.multiply(&error.phi_rate));
        let cooling: Vec<f64> = heat.iter().map(|value| -value).collect();
        ErrorState {
            u: error.u_rate.clone(),
            u_rate: m.solve_between(1, last, &forces),
            phi: error.phi_rate.clone(),
            phi_rate: m.solve_between(1, last, &moments),
            theta: m.solve_between(1, last - 1, &cooling),
        }
    }

    /// g'(u(1)).
    fn contact_slope(&self, tip: f64) -> f64 {
        match self.obstacles {
            Some(obstacles) if contact_force(obstacles, tip) != 0.0 => 1.0 / obstacles.epsilon,
            _ => 0.0,
        }
    }

    /// The norm of (3.14) of the error.
    fn norm(&self, t: f64, error: &ErrorState) -> f64 {
        let [m, k] = [&self.mass, &self.stiffness];
        let u_2 = self.derivative(&self.exact.u, &self.nodal.u, t, 2);
        let phi_2 = self.derivative(&self.exact.phi, &self.nodal.phi, t, 2);
        let velocity = combined(&error.u_rate, -0.5, &u_2);
        let rotation_rate = combined(&error.phi_rate, -0.5, &phi_2);
        let square = |matrix: &Tridiagonal, y: &[f64]| dot(y, &matrix.multiply(y));
        let shear = square(k, &error.u) - 2.0 * dot(&error.u, &self.coupling.multiply(&error.phi))
            + square(m, &error.phi);
        let squares = square(m, &velocity)
            + shear
            + square(m, &rotation_rate)
            + square(k, &error.phi)
            + square(m, &error.theta);
        squares.sqrt()
    }
}

/// `a + factor * b`.
fn combined(a: &[f64], factor: f64, b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + factor * b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::{Expression, Variable};

    fn product(x: &str, t: &str) -> Product {
        let parse = |text, variable| Expression::parse(text, variable).unwrap();
        Product {
            x: parse(x, Variable::X).into(),
            t: parse(t, Variable::T).into(),
        }
    }

    /// u = x² cos t and φ = x³: ‖u_xx‖² = 4 cos² t, ‖φ_xx‖² = 12.
    #[test]
    fn the_constant_in_h_is_that_of_interpolated_slopes() {
        let exact = Manufactured {
            u: vec![product("x^2", "cos(t)")],
            phi: vec![product("x^3", "1")],
            theta: vec![],
        };
        let constant = in_space(&exact, [0.5, 1.0].into_iter());
        let expected = ((4.0 * 0.5_f64.cos().powi(2) + 12.0) / 12.0).sqrt();
        assert!(
            (constant - expected).abs() < 1e-13,
            "{constant}, {expected}"
        );
    }

    /// A displacement that is linear in t has no error of order dt without contact; in contact the
    /// force at the new level is one.
    #[test]
    fn only_contact_leaves_an_error_for_uniform_motion() {
        let exact = Manufactured {
            u: vec![product("x", "1 + t")],
            ..Manufactured::default()
        };
        let mesh = Mesh::uniform(4).unwrap();
        let beam = Beam::default();
        let obstacles = Obstacles {
            epsilon: 0.5,
            g1: -1.0,
            g2: 0.0,
        };
        let constant = |obstacles| in_time(&exact, (&beam, obstacles), &mesh, 1.0, 1024);
        assert_eq!(constant(None), 0.0);
        assert!(constant(Some(&obstacles)) > 0.1);
    }
}
