//! A scene by dG(q), as a reference for one-step schemes: exact to many digits, and by another discretisation, so that a fault
//! that all runs of one scheme share shows.
//!
//! * On one element of high degree: the solution of the equations themselves.
//! * On linear elements of a mesh: the solution of that mesh's semi-discrete system, since elements of degree 1 are those of
//!   (3.7)-(3.8) and their initial data the same.

use std::ops::ControlFlow;

use convergence_study::study::CaseFailure;
use convergence_study::text::number::max_or_nan;
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::solve::Level;

use super::levels::distance;
use crate::run::motion::{Motion, Report};
use crate::run::rerun::resampled;
use crate::run::simulate::{Recording, Simulator};
use crate::scene::Scene;

/// Elements on which polynomials are kept as linear functions, for one of the finest mesh compared. What they leave out is
/// orthogonal to that mesh's error in slopes, and of its square a 16th squared: a 512th of the error.
pub(crate) const FINER: usize = 16;

/// The mesh on which the polynomials of a scene are kept for comparison with runs on `finest` elements and fewer.
///
/// # Errors
/// [`MeshError`] where its elements are too small.
pub fn fine_mesh(scene: &Scene, finest: usize) -> Result<Mesh, MeshError> {
    resampled(&scene.mesh, FINER * finest)
}

/// A run kept at equidistant times by its values at the nodes of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Traced {
    /// The mesh; where it is finer than that of a run of any order, its linear functions stand for the run's polynomials.
    pub mesh: Mesh,
    /// At `t_end k / samples`, k = 1 ...; of a run of any order without contact force.
    pub levels: Vec<Level>,
    /// Energies (3.9) at the same times, of a run of any order those of the polynomials.
    pub energies: Vec<f64>,
    /// (t, u(1, t)) at equidistant times, as many as a figure shows.
    pub tip: Vec<(f64, f64)>,
    /// Smallest and largest u(1) over all time levels.
    pub tip_range: [f64; 2],
}

impl Traced {
    /// Runs a scene by dG over [0, t_end].
    ///
    /// * `mesh`: where its values are kept; a mesh that contains the nodes of all that is compared.
    /// * `samples`: times of comparison, each the end of a step.
    /// * `curve`: points of the curve of u(1, t), at least.
    ///
    /// # Errors
    /// [`CaseFailure`] where the run does not come to its end.
    pub fn compute(scene: &Scene, mesh: Mesh, samples: usize, curve: usize) -> Result<Self, CaseFailure> {
        let t_end = scene.t_end;
        let time = |k: usize| if k == samples { t_end } else { t_end * k as f64 / samples as f64 };
        let times: Vec<f64> = (1..=samples).map(time).collect();
        let (mut levels, mut energies) = (vec![], vec![]);
        let mut observe = |motion: &mut dyn Motion, _: &Report| {
            let t = motion.t();
            if times.contains(&t) {
                levels.push(motion.on(&mesh));
                energies.push(motion.at(t).energy);
            }
            Ok(ControlFlow::Continue(()))
        };
        let run = Simulator::new(scene)?.watched(Recording::Curve(curve), &times, &mut observe);
        let run = run.finished()?;
        let tip_range = [run.extremes.u_tip_min, run.extremes.u_tip_max];
        Ok(Self { tip: run.tip(), mesh, levels, energies, tip_range })
    }

    /// The largest distance of two references at their times, in the norm of Theorem 3.4; NaN where they cannot be compared.
    pub fn distance(&self, other: &Self) -> f64 {
        if self.mesh != other.mesh || self.levels.len() != other.levels.len() || self.levels.is_empty() {
            return f64::NAN;
        }
        let lengths: Vec<f64> = self.mesh.lengths().collect();
        let pairs = self.levels.iter().zip(&other.levels);
        pairs.map(|(one, other)| distance(&lengths, one, other)).fold(0.0, max_or_nan)
    }
}
