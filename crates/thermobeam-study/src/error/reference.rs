//! A scene by dG(q), as a reference for one-step schemes: it is accurate to many digits, and its
//! discretisation is different, so that it reveals a fault that all runs of one scheme share.
//!
//! * On one element of high degree: the solution of the equations themselves.
//! * On linear elements of a mesh: the solution of that mesh's semi-discrete system, since elements
//!   of degree 1 are those of (3.7)-(3.8), with the same initial data.

use convergence_judge::text::number::max_or_nan;
use convergence_study::CaseFailure;
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::motion::TipRange;
use thermobeam::solve::TimeLevel;

use crate::exact::norm::TheoremSquares;
use crate::run::levels::{equidistant_time, map_fields, on_mesh};
use crate::run::simulate::{Recording, Simulator};
use crate::scene::{Scene, resampled};

/// Polynomials are kept as linear functions, on this many elements for each of the finest mesh
/// compared. The interpolation error is orthogonal to that mesh's error in slopes, its square
/// smaller by 16²: a 512th of the error.
pub(crate) const FINER: usize = 16;

/// The mesh on which the polynomials of a scene are stored, for comparison with runs on at most
/// `finest` elements.
///
/// # Errors
/// [`MeshError`] if its elements are too small.
pub fn fine_mesh(scene: &Scene, finest: usize) -> Result<Mesh, MeshError> {
    resampled(&scene.mesh, FINER * finest)
}

/// A run at some times, stored as its values at the nodes of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Traced {
    /// The mesh; if it is finer than the mesh of a run of any order, its linear functions represent
    /// the polynomials.
    pub mesh: Mesh,
    /// At these times, without the contact force.
    pub levels: Vec<TimeLevel>,
    /// Energies (3.9) at the same times; for a run of any order those of the polynomials.
    pub energies: Vec<f64>,
    /// Smallest and largest u(1) over all time levels.
    pub tip_range: TipRange,
    /// Largest defect of the energy balance in a step of a fixed number of iterations; 0 for solved
    /// steps, whose defect is round-off.
    pub energy_defect: f64,
}

impl Traced {
    /// Runs a scene over [0, t_end], by any method.
    ///
    /// * `mesh`: where the values are stored; it contains the nodes of every mesh compared. For a
    ///   one-step scheme its own mesh.
    /// * `samples`: times of comparison, each the end of a step.
    ///
    /// # Errors
    /// [`CaseFailure`] if the run does not finish.
    pub fn compute(scene: &Scene, mesh: Mesh, samples: usize) -> Result<Self, CaseFailure> {
        let times: Vec<f64> = (1..=samples)
            .map(|k| equidistant_time(scene.t_end, k, samples))
            .collect();
        Self::at(scene, mesh, &times)
    }

    /// The same with steps that end at these times, which increase, the last one `t_end`.
    pub(crate) fn at(scene: &Scene, mesh: Mesh, times: &[f64]) -> Result<Self, CaseFailure> {
        let mut levels = vec![];
        let mut energies = vec![];
        let run = Simulator::new(scene)?.read_at(Recording::Summary, times, |motion| {
            levels.push(motion.on(&mesh));
            energies.push(motion.sample().energy);
        })?;
        let tip_range = TipRange {
            low: run.extremes.u_tip_min,
            high: run.extremes.u_tip_max,
        };
        let is_solved = scene.method.stopping().tolerance().is_some();
        let energy_defect = if is_solved {
            0.0
        } else {
            run.energy.largest_balance_residual
        };
        Ok(Self {
            mesh,
            levels,
            energies,
            tip_range,
            energy_defect,
        })
    }

    /// Distances in the norm of Theorem 3.4 between a level of a coarser mesh, whose nodes are
    /// nodes here, and the level at time `k` (from 0): as functions, since a coarse P1 function is
    /// also one on the fine mesh, and at the nodes of the coarser mesh.
    pub(crate) fn errors_of(&self, level: &TimeLevel, mesh: &Mesh, k: usize) -> [f64; 2] {
        let fine = &self.levels[k];
        let coarse_lengths: Vec<f64> = mesh.lengths().collect();
        let fine_lengths: Vec<f64> = self.mesh.lengths().collect();
        let extended = on_mesh(level, mesh, &self.mesh);
        let stride = self.mesh.elements() / mesh.elements();
        let restricted = map_fields(fine, |y| y.iter().step_by(stride).copied().collect());
        [
            distance(&fine_lengths, &extended, fine),
            distance(&coarse_lengths, level, &restricted),
        ]
    }
}

/// Distance between two levels of one mesh in the norm of Theorem 3.4.
pub fn distance(lengths: &[f64], one: &TimeLevel, other: &TimeLevel) -> f64 {
    let mut difference = one.clone();
    difference.set_difference(one, other);
    norm(lengths, &difference)
}

/// A level in the norm of Theorem 3.4.
pub(crate) fn norm(
    lengths: &[f64],
    TimeLevel {
        u,
        v,
        phi,
        w,
        theta,
        ..
    }: &TimeLevel,
) -> f64 {
    TheoremSquares::of(lengths, v, u, w, phi, theta).norm()
}

/// The largest difference of two runs in any of their numbers; NaN if these cannot be compared.
pub(crate) fn largest_difference(one: &[f64], other: &[f64]) -> f64 {
    if one.len() != other.len() || one.is_empty() {
        return f64::NAN;
    }
    let differences = one.iter().zip(other).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, max_or_nan)
}
