//! Modes superposed, of the beam or of a mesh, and how they move.

use std::f64::consts::PI;

use thermobeam::mesh::Mesh;
use thermobeam::parameters::ParameterError;
use thermobeam::vibration::Mode;

use super::clock::{Clock, Path, TimeLevels};
use super::mesh_modes;
use super::{Cooling, Vibrating, Vibration};
use crate::error::free_vibration::{self, PiecewiseLinear};
use crate::exact::factors::Factors;
use crate::exact::function::Factor;
use crate::kinds::tables::{Manufactured, Product};

/// Why there are no modes to start from.
#[derive(Debug, thiserror::Error)]
pub(super) enum NoModes {
    /// The mass matrix of the mesh is not positive definite.
    #[error("the mesh has no modes")]
    OfMesh,
    /// The viscosity is no such number.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
}

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
    pub(super) fn of_beam(study: &Vibration) -> Result<Self, NoModes> {
        let mut modes = Self::none(study.beam.zeta);
        for &Vibrating { index, start } in &study.modes {
            free_vibration::add_mode(&mut modes.exact, index, modes.zeta, start)?;
            modes.vibrations.push((Mode::new(index).omega().powi(2), start));
        }
        for &Cooling { k, amplitude } in &study.heat {
            free_vibration::add_temperature(&mut modes.exact, k, amplitude);
            modes.temperatures.push(((k as f64 * PI).powi(2), amplitude));
        }
        Ok(modes)
    }

    /// The modes of the mesh itself, P1 functions that move by their own frequencies.
    pub(super) fn of_mesh(study: &Vibration, mesh: &Mesh) -> Result<Self, NoModes> {
        let mut modes = Self::none(study.beam.zeta);
        let shape = |values: &[f64]| Factor::new(PiecewiseLinear::new(mesh, values.to_vec()));
        let vibrations = mesh_modes::vibrations(mesh).ok_or(NoModes::OfMesh)?;
        for &Vibrating { index, start } in &study.modes {
            let mode = vibrations.get(index).ok_or(NoModes::OfMesh)?;
            let t = free_vibration::damped(mode.eigenvalue.sqrt(), modes.zeta, start)?;
            modes.exact.u.push(Product { x: shape(&mode.first), t: t.clone() });
            modes.exact.phi.push(Product { x: shape(&mode.second), t });
            modes.vibrations.push((mode.eigenvalue, start));
        }
        let temperatures = if study.heat.is_empty() { Some(vec![]) } else { mesh_modes::temperatures(mesh) };
        let temperatures = temperatures.ok_or(NoModes::OfMesh)?;
        for &Cooling { k, amplitude } in &study.heat {
            let mode = temperatures.get(k - 1).ok_or(NoModes::OfMesh)?;
            let t = free_vibration::decay(mode.eigenvalue, amplitude);
            modes.exact.theta.push(Product { x: shape(&mode.first), t });
            modes.temperatures.push((mode.eigenvalue, amplitude));
        }
        Ok(modes)
    }

    /// The motion of each mode over the time levels.
    pub(super) fn motion(&self, clock: Clock, levels: TimeLevels) -> Motion {
        let exact = |products: &[Product]| products.iter().map(|product| levels.exact(&product.t)).collect();
        match clock {
            Clock::Exact => Motion { vibrations: exact(&self.exact.u), temperatures: exact(&self.exact.theta) },
            Clock::Scheme(scheme) => Motion {
                vibrations: self
                    .vibrations
                    .iter()
                    .map(|&(square, q)| levels.vibration(scheme, square, self.zeta, q))
                    .collect(),
                temperatures: self.temperatures.iter().map(|&(square, q)| levels.temperature(square, q)).collect(),
            },
        }
    }
}

/// The path of each mode.
pub(super) struct Motion {
    vibrations: Vec<Path>,
    temperatures: Vec<Path>,
}

impl Motion {
    /// Sets the time factors of the modes to those at time level n.
    pub(super) fn at(&self, n: usize, factors: &mut Factors) {
        for field in [&mut factors.u, &mut factors.phi] {
            set(&mut field.value, self.vibrations.iter().map(|path| path[n][0]));
            set(&mut field.rate, self.vibrations.iter().map(|path| path[n][1]));
        }
        set(&mut factors.theta.value, self.temperatures.iter().map(|path| path[n][0]));
    }
}

fn set(values: &mut Vec<f64>, new: impl Iterator<Item = f64>) {
    values.clear();
    values.extend(new);
}
