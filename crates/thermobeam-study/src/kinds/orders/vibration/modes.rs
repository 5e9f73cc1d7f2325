//! Superposed modes of the beam or of a mesh, and their motion in time: exact, or by a time scheme.
//!
//! A mode of the beam, exact or of a mesh, satisfies `A(x; y) = ω² B(x; y)` for all test functions
//! y in its space. Put `u = U q, φ = Φ q, û = U v, φ̂ = Φ v` into (3.7) with a = β = ρ = 0 and no
//! obstacle: all terms are multiples of the mode, and a step becomes one scalar equation for the
//! velocity V,
//!
//! ```text
//! κ (V - v0) + ω² (q0 + dt V/2 + ζ V) = 0,      κ = inertia/dt,
//! V = (κ v0 - ω² q0) / (κ + ω² (ζ + dt/2)),     q = q0 + dt V,     v = v0 + inertia (V - v0).
//! ```
//!
//! So the time-discrete solution of a mode is known in closed form, with space exact or discrete,
//! and either error of the whole scheme can be isolated:
//!
//! * *space*: the scheme on a mesh against the exact mode advanced by the scheme: the time error
//!   cancels exactly;
//! * *time*: the scheme started from a mode of the mesh against that mode advanced exactly at its
//!   own ω: the space error is exactly zero;
//! * neither: the solver must reproduce a mode of the mesh advanced by the scheme, to round-off.
//!
//! A temperature `sin kπx e^{-κ²t}`, κ = kπ, does not act on the beam for a = 0; Crank-Nicolson
//! multiplies it by `(1 - κ² dt/2)/(1 + κ² dt/2)` per step.

use std::f64::consts::PI;

use nalgebra::DMatrix;
use thermobeam_exact::{
    assembly::{Tridiagonal, coupling, mass, stiffness},
    dense::{Eigenpair, eigenpairs},
    vibration::Mode,
};

use super::Vibration;
use crate::kinds::prelude::*;
use crate::{
    error::free_vibration::{self, piecewise_linear},
    exact::{
        formulas::SchemeFormulas,
        function::Factor,
        solution::{Factors, Manufactured, Product},
    },
};
use thermobeam::mesh::Mesh;

/// Modes, each with the exact motion of its equation in time.
///
/// Each vibration has one product of u and one of φ, in the same order.
#[derive(Default)]
pub(super) struct Modes {
    pub(super) exact: Manufactured,
    /// ω² of each vibration, its position and its velocity at t = 0.
    vibrations: Vec<(f64, [f64; 2])>,
    /// κ² of each temperature, and its amplitude at t = 0.
    temperatures: Vec<(f64, f64)>,
    zeta: f64,
}

impl Modes {
    /// The exact modes.
    pub(super) fn of_beam(study: &Vibration) -> Result<Self, CaseFailure> {
        let mut modes = Self {
            zeta: study.theory.beam.zeta,
            ..Self::default()
        };
        for &(index, start) in &study.modes {
            free_vibration::add_mode(&mut modes.exact, index, modes.zeta, start)?;
            let square = Mode::new(index).omega().powi(2);
            modes.vibrations.push((square, start));
        }
        for &(k, amplitude) in &study.heat {
            free_vibration::add_temperature(&mut modes.exact, k, amplitude);
            let square = (k as f64 * PI).powi(2);
            modes.temperatures.push((square, amplitude));
        }
        Ok(modes)
    }

    /// The modes of the mesh itself: P1 functions that oscillate at their own frequencies.
    pub(super) fn of_mesh(study: &Vibration, mesh: &Mesh) -> Result<Self, CaseFailure> {
        let mut modes = Self {
            zeta: study.theory.beam.zeta,
            ..Self::default()
        };
        let vibrations = vibrations(mesh).ok_or_else(no_modes)?;
        for &(index, start) in &study.modes {
            let Eigenpair { value, vector } = vibrations.get(index).ok_or_else(no_modes)?;
            // Scaled to U(1) = 1, as the exact ones.
            let (u, phi) = vector.as_slice().split_at(mesh.elements());
            let scale = u[u.len() - 1];
            let t = free_vibration::damped(value.sqrt(), modes.zeta, start)?;
            modes.exact.u.push(Product {
                x: shape(mesh, u, scale),
                t: t.clone(),
            });
            modes.exact.phi.push(Product {
                x: shape(mesh, phi, scale),
                t,
            });
            modes.vibrations.push((*value, start));
        }
        let temperatures = if study.heat.is_empty() {
            Some(vec![])
        } else {
            temperatures(mesh)
        };
        let temperatures = temperatures.ok_or_else(no_modes)?;
        for &(k, amplitude) in &study.heat {
            let Eigenpair { value, vector } = temperatures.get(k - 1).ok_or_else(no_modes)?;
            modes.exact.theta.push(Product {
                x: shape(mesh, vector.as_slice(), vector[vector.icamax()]),
                t: free_vibration::decay(*value, amplitude),
            });
            modes.temperatures.push((*value, amplitude));
        }
        Ok(modes)
    }

    /// Sets the time factors to those at a time level: exactly, or by a time scheme, one level
    /// after the other. All schemes treat the temperature by Crank-Nicolson.
    pub(super) fn moved(
        &self,
        scheme: Option<SchemeFormulas>,
        dt: f64,
    ) -> impl FnMut(usize, &mut Factors) {
        let mut level = 0;
        let mut states: Vec<_> = self.vibrations.iter().map(|(_, start)| *start).collect();
        move |n, factors| {
            let Some(scheme) = scheme else {
                return factors.at(&self.exact, n as f64 * dt);
            };
            for _ in level..n {
                for (state, (square, _)) in states.iter_mut().zip(&self.vibrations) {
                    *state = scheme_step(scheme, *square, self.zeta, dt, *state);
                }
            }
            level = n;
            for field in [&mut factors.u, &mut factors.phi] {
                field.value.clear();
                field.value.extend(states.iter().map(|[q, _]| q));
                field.rate.clear();
                field.rate.extend(states.iter().map(|[_, v]| v));
            }
            factors.theta.value.clear();
            for (square, amplitude) in &self.temperatures {
                let half = 0.5 * dt * square;
                let factor = ((1.0 - half) / (1.0 + half)).powi(n as i32);
                factors.theta.value.push(amplitude * factor);
            }
        }
    }
}

/// Position and velocity of a vibration after a step by a scheme.
fn scheme_step(
    scheme: SchemeFormulas,
    omega_squared: f64,
    zeta: f64,
    dt: f64,
    [q, v]: [f64; 2],
) -> [f64; 2] {
    let kappa = scheme.inertia() / dt;
    let carrying = (kappa * v - omega_squared * q) / (kappa + omega_squared * (zeta + 0.5 * dt));
    [q + dt * carrying, v + scheme.inertia() * (carrying - v)]
}

fn no_modes() -> CaseFailure {
    CaseFailure::new("the mesh has no modes")
}

/// The P1 function with these values from the second node on, 0 at the others, over its scale.
fn shape(mesh: &Mesh, values: &[f64], scale: f64) -> Factor {
    let mut nodal = vec![0.0; mesh.nodes().len()];
    let inner = nodal[1..].iter_mut().zip(values);
    inner.for_each(|(node, value)| *node = value / scale);
    piecewise_linear(mesh, nodal)
}

/// All vibrations `A x = ω² B x` of a mesh, lowest first.
///
/// A and B are the forms `‖u_x - φ‖² + ‖φ_x‖²` and `‖u‖² + ‖φ‖²` on the n free nodes of each field.
/// The method is dense and shares nothing with the solver's sweeps.
fn vibrations(mesh: &Mesh) -> Option<Vec<Eigenpair>> {
    let n = mesh.elements();
    let [mass, stiffness, coupling] =
        [mass(mesh), stiffness(mesh), coupling(mesh)].map(|matrix| at_nodes(&matrix, n));
    let [mut a, mut b] = [0, 1].map(|_| DMatrix::zeros(2 * n, 2 * n));
    let block = (n, n);
    a.view_mut((0, 0), block).copy_from(&stiffness);
    a.view_mut((n, n), block).copy_from(&(stiffness + &mass));
    a.view_mut((0, n), block).copy_from(&-&coupling);
    a.view_mut((n, 0), block).copy_from(&-coupling.transpose());
    b.view_mut((0, 0), block).copy_from(&mass);
    b.view_mut((n, n), block).copy_from(&mass);
    eigenpairs(&a, &b)
}

/// All temperatures `K x = κ² M x` of a mesh that vanish at both ends, lowest first.
fn temperatures(mesh: &Mesh) -> Option<Vec<Eigenpair>> {
    let n = mesh.elements();
    let [a, b] = [stiffness(mesh), mass(mesh)].map(|matrix| at_nodes(&matrix, n - 1));
    eigenpairs(&a, &b)
}

/// The entries at the nodes 1 to n.
fn at_nodes(matrix: &Tridiagonal, n: usize) -> DMatrix<f64> {
    DMatrix::from_fn(n, n, |i, j| matrix.entry(i + 1, j + 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermobeam::scheme::SCHEMES;
    use thermobeam_exact::vibration::discrete_frequencies;

    #[test]
    fn the_schemes_paths_converge_at_their_order() {
        let start = [0.5, -1.0];
        let factor = free_vibration::damped(1.7_f64.sqrt(), 0.2, start).expect("a factor");
        for scheme in SCHEMES {
            let formulas = SchemeFormulas::of(scheme.name).expect("formulas of the scheme");
            let error = |steps: usize| {
                let dt = 2.0 / steps as f64;
                let [value, slope, _] = factor.derivatives(steps as f64 * dt);
                let [q, v] =
                    (0..steps).fold(start, |state, _| scheme_step(formulas, 1.7, 0.2, dt, state));
                (value - q).hypot(slope - v)
            };
            let rate = (error(500) / error(1000)).log2();
            assert!(
                (rate - scheme.order).abs() < 0.01,
                "{}: {rate}",
                scheme.name
            );
        }
    }

    #[test]
    fn frequencies_are_those_of_the_bisection_on_any_mesh() {
        for mesh in [
            Mesh::uniform(12),
            Mesh::mapped(9, |s| 0.4 * s + 0.6 * s * s),
        ] {
            let mesh = mesh.expect("a mesh");
            let modes = vibrations(&mesh).expect("a positive mass");
            let expected = discrete_frequencies(&mesh, 1, modes.len()).expect("all of them");
            for (mode, expected) in modes.iter().zip(expected) {
                assert!(
                    (mode.value.sqrt() - expected).abs() < 1e-11 * expected.max(1.0),
                    "{expected}"
                );
            }
        }
    }
}
