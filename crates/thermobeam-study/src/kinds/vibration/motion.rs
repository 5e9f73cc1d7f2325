//! Modes superposed, of the beam or of a mesh, and how they move in time: exactly, or as a time scheme moves them.
//!
//! A mode of the beam, exact or of a mesh, satisfies `A(x; y) = ω² B(x; y)` for all test functions y in its space. Put
//! `u = U q, φ = Φ q, û = U v, φ̂ = Φ v` into (3.7) with a = β = ρ = 0 and no obstacle: everything is a multiple of the
//! mode, and a step becomes one scalar equation for the velocity V that carries it,
//!
//! ```text
//! κ (V - v0) + ω² (q0 + dt V/2 + ζ V) = 0,      κ = inertia/dt,
//! V = (κ v0 - ω² q0) / (κ + ω² (ζ + dt/2)),     q = q0 + dt V,     v = v0 + inertia (V - v0).
//! ```
//!
//! So the time-discrete solution of a mode is known in closed form, in space exact or not, and either error of the
//! whole scheme can be had by itself:
//!
//! * *space*: the scheme on a mesh against the exact mode moved by the scheme: the time error cancels exactly;
//! * *time*: the scheme started from a mode of the mesh against that mode moved exactly at its own ω: the
//!   space error is exactly zero;
//! * neither: a mode of the mesh moved by the scheme is what the solver has to give, to round-off.
//!
//! A temperature `sin kπx e^{-κ²t}`, κ = kπ, lives beside the beam without touching it for a = 0; Crank-Nicolson
//! multiplies it by `(1 - κ² dt/2)/(1 + κ² dt/2)` a step.

use std::f64::consts::PI;

use thermobeam::vibration::Mode;

use super::{Vibration, mesh_modes};
use crate::error::free_vibration::{self, PiecewiseLinear};
use crate::exact::factors::Factors;
use crate::exact::function::Factor;
use crate::kinds::prelude::*;

/// Position and velocity of a mode at each time level n = 0..N.
type Path = Vec<[f64; 2]>;

/// Modes, each with the exact motion of its equation in time.
///
/// Products of u and of φ belong together: one of each for every vibration, in the same order.
pub(super) struct Modes {
    pub(super) exact: Manufactured,
    /// ω² of each vibration, and its position and velocity at t = 0.
    vibrations: Vec<(f64, [f64; 2])>,
    /// κ² of each temperature, and its amplitude at t = 0.
    temperatures: Vec<(f64, f64)>,
    zeta: f64,
}

impl Modes {
    fn none(zeta: f64) -> Self {
        Self { exact: Manufactured::default(), vibrations: vec![], temperatures: vec![], zeta }
    }

    /// The exact modes.
    pub(super) fn of_beam(study: &Vibration) -> Result<Self, CaseFailure> {
        let mut modes = Self::none(study.beam.zeta);
        for &(index, start) in &study.modes {
            free_vibration::add_mode(&mut modes.exact, index, modes.zeta, start)?;
            modes.vibrations.push((Mode::new(index).omega().powi(2), start));
        }
        for &(k, amplitude) in &study.heat {
            free_vibration::add_temperature(&mut modes.exact, k, amplitude);
            modes.temperatures.push(((k as f64 * PI).powi(2), amplitude));
        }
        Ok(modes)
    }

    /// The modes of the mesh itself, P1 functions that move by their own frequencies.
    pub(super) fn of_mesh(study: &Vibration, mesh: &Mesh) -> Result<Self, CaseFailure> {
        let none = || CaseFailure { reason: "the mesh has no modes".to_owned() };
        let mut modes = Self::none(study.beam.zeta);
        let shape = |values: &[f64]| Factor::new(PiecewiseLinear::new(mesh, values.to_vec()));
        let vibrations = mesh_modes::vibrations(mesh).ok_or_else(none)?;
        for &(index, start) in &study.modes {
            let mode = vibrations.get(index).ok_or_else(none)?;
            let t = free_vibration::damped(mode.eigenvalue.sqrt(), modes.zeta, start)?;
            modes.exact.u.push(Product { x: shape(&mode.first), t: t.clone() });
            modes.exact.phi.push(Product { x: shape(&mode.second), t });
            modes.vibrations.push((mode.eigenvalue, start));
        }
        let temperatures = if study.heat.is_empty() { Some(vec![]) } else { mesh_modes::temperatures(mesh) };
        let temperatures = temperatures.ok_or_else(none)?;
        for &(k, amplitude) in &study.heat {
            let mode = temperatures.get(k - 1).ok_or_else(none)?;
            let t = free_vibration::decay(mode.eigenvalue, amplitude);
            modes.exact.theta.push(Product { x: shape(&mode.first), t });
            modes.temperatures.push((mode.eigenvalue, amplitude));
        }
        Ok(modes)
    }

    /// The motion of each mode by its equation in time.
    pub(super) fn exactly(&self, dt: f64, steps: usize) -> ModalPaths {
        let path = |product: &Product| exact_path(&product.t, dt, steps);
        ModalPaths {
            vibrations: self.exact.u.iter().map(path).collect(),
            temperatures: self.exact.theta.iter().map(path).collect(),
        }
    }

    /// The motion of each mode by the time scheme; all schemes take the temperature by Crank-Nicolson.
    pub(super) fn by(&self, scheme: Scheme, dt: f64, steps: usize) -> ModalPaths {
        let temperature = |&(kappa_squared, start): &(f64, f64)| {
            let half = 0.5 * dt * kappa_squared;
            let ratio = (1.0 - half) / (1.0 + half);
            // Its velocity is not asked for.
            (0..=steps).map(|n| [start * ratio.powi(n as i32), 0.0]).collect()
        };
        let vibration = |&(square, start): &(f64, [f64; 2])| scheme_path(scheme, square, self.zeta, start, dt, steps);
        ModalPaths {
            vibrations: self.vibrations.iter().map(vibration).collect(),
            temperatures: self.temperatures.iter().map(temperature).collect(),
        }
    }
}

/// The path of an exact time factor.
fn exact_path(factor: &Factor, dt: f64, steps: usize) -> Path {
    let at = |n: usize| {
        let [value, slope, _] = factor.derivatives(n as f64 * dt);
        [value, slope]
    };
    (0..=steps).map(at).collect()
}

/// The path of a vibration of frequency ω by a scheme, from position and velocity.
fn scheme_path(scheme: Scheme, omega_squared: f64, zeta: f64, start: [f64; 2], dt: f64, steps: usize) -> Path {
    let kappa = scheme.inertia / dt;
    let step = |[q, v]: [f64; 2]| {
        let carrying = (kappa * v - omega_squared * q) / (kappa + omega_squared * (zeta + 0.5 * dt));
        [q + dt * carrying, v + scheme.inertia * (carrying - v)]
    };
    std::iter::successors(Some(start), |&state| Some(step(state))).take(steps + 1).collect()
}

/// The path of each mode.
pub(super) struct ModalPaths {
    vibrations: Vec<Path>,
    temperatures: Vec<Path>,
}

impl ModalPaths {
    /// Sets the time factors of the modes to those at time level n.
    pub(super) fn at(&self, n: usize, factors: &mut Factors) {
        let set = |values: &mut Vec<f64>, paths: &[Path], which: usize| {
            values.clear();
            values.extend(paths.iter().map(|path| path[n][which]));
        };
        for field in [&mut factors.u, &mut factors.phi] {
            set(&mut field.value, &self.vibrations, 0);
            set(&mut field.rate, &self.vibrations, 1);
        }
        set(&mut factors.theta.value, &self.temperatures, 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::free_vibration::damped;
    use thermobeam::scheme::SCHEMES;

    #[test]
    fn the_schemes_paths_converge_at_their_order() {
        let start = [0.5, -1.0];
        let factor = damped(1.7_f64.sqrt(), 0.2, start).expect("a factor");
        for scheme in SCHEMES {
            let error = |steps: usize| {
                let dt = 2.0 / steps as f64;
                let exact = exact_path(&factor, dt, steps)[steps];
                let found = scheme_path(scheme, 1.7, 0.2, start, dt, steps)[steps];
                (exact[0] - found[0]).hypot(exact[1] - found[1])
            };
            let rate = (error(500) / error(1000)).log2();
            assert!((rate - scheme.order).abs() < 0.01, "{}: {rate}", scheme.name);
        }
    }
}
