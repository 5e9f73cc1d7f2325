//! One resolution of the scene a case, then the two references.

use convergence_study::study::{Axis, Case, CaseFailure};
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::simulation::Stepping;

use super::{Resolution, Run, Sample, SelfConvergence, Traced};
use crate::error::reference::{Reference, fine_mesh};
use crate::kinds::tables::Refine;
use crate::run::rerun::{at, resampled, traced};
use crate::scene::{Method, Scene};

/// Points of a curve in a figure: more than pixels.
const CURVE_POINTS: usize = 2000;

pub(super) fn cases(study: &SelfConvergence) -> Vec<Case<Run>> {
    let level = |&level: &Resolution| Case {
        label: Refine::label(level.elements, level.steps),
        cost: level.elements as f64 * level.steps as f64,
        data: Run::Level(level),
    };
    let reference = |k: usize| Case {
        label: format!("reference, {}", study.references[k].label()),
        cost: study.references[k].cost(study.t_end),
        data: Run::Reference(k),
    };
    study.levels.iter().map(level).chain((0..study.references.len()).map(reference)).collect()
}

pub(super) fn run(study: &SelfConvergence, run: Run) -> Result<Traced, CaseFailure> {
    match run {
        Run::Level(level) => by_the_scheme(study, level),
        Run::Reference(k) => reference(study, k),
    }
}

fn reference(study: &SelfConvergence, k: usize) -> Result<Traced, CaseFailure> {
    let how = &study.references[k];
    let found = Reference::compute(&study.scene, how, common_mesh(study)?, study.t_end, study.samples, CURVE_POINTS)?;
    let sample = |(level, energy)| Sample { level, energy };
    let samples = found.levels.into_iter().zip(found.energies).map(sample).collect();
    Ok(Traced { mesh: found.mesh, tip_range: found.tip_range, tip: found.tip, samples })
}

/// The mesh on which levels are compared with a reference.
fn common_mesh(study: &SelfConvergence) -> Result<Mesh, MeshError> {
    let finest = study.levels.last().map_or(0, |level| level.elements);
    if study.axis == Axis::Time { resampled(&study.scene.mesh, finest) } else { fine_mesh(&study.scene, finest) }
}

fn by_the_scheme(study: &SelfConvergence, level: Resolution) -> Result<Traced, CaseFailure> {
    let Resolution { elements, steps } = level;
    let mesh = resampled(&study.scene.mesh, elements)?;
    let scene = at(&study.scene, mesh.clone(), steps, study.t_end);
    let method = Method::OneStep(Stepping { scheme: study.scheme, ..scene.one_step()? });
    let scene = Scene { method, ..scene };
    // As many points as fit a figure, and all the times that are compared.
    let per_sample = (CURVE_POINTS / study.samples).max(1);
    let stride = largest_divisor(steps / study.samples, per_sample);
    let (mut tip, mut samples) = (vec![], vec![]);
    let trace = traced(&scene, study.samples * stride, |simulation, level| {
        tip.push((simulation.t(), level.u[elements]));
        if tip.len() % stride == 0 {
            samples.push(Sample { level: level.clone(), energy: simulation.energy(level).total() });
        }
    })?;
    Ok(Traced { mesh, tip_range: trace.tip, tip, samples })
}

/// The largest divisor of `n` that is at most `limit`.
fn largest_divisor(n: usize, limit: usize) -> usize {
    (1..=limit.min(n)).rev().find(|&divisor| n.is_multiple_of(divisor)).unwrap_or(1)
}
