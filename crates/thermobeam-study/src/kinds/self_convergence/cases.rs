//! One resolution of the scene a case, the reference last.

use convergence_study::study::{Case, CaseFailure};

use super::{Resolution, Sample, SelfConvergence, Traced};
use crate::kinds::tables::Refine;
use crate::run::rerun::{Rerun, resampled};

/// Points of a curve in a figure: more than pixels.
const CURVE_POINTS: usize = 2000;

pub(super) fn cases(study: &SelfConvergence) -> Vec<Case<Resolution>> {
    let case = |&data: &Resolution| Case {
        label: Refine::label(data.elements, data.steps),
        cost: data.elements as f64 * data.steps as f64,
        data,
    };
    study.runs.iter().map(case).collect()
}

pub(super) fn run(study: &SelfConvergence, resolution: Resolution) -> Result<Traced, CaseFailure> {
    let Resolution { elements, steps, scheme } = resolution;
    let mesh = resampled(&study.scene.mesh, elements)?;
    let rerun = Rerun { mesh: mesh.clone(), steps, t_end: study.t_end, scheme, ..Rerun::of(&study.scene) };
    // As many points as fit a figure, and all the times that are compared.
    let per_sample = (CURVE_POINTS / study.samples).max(1);
    let stride = largest_divisor(steps / study.samples, per_sample);
    let (mut tip, mut samples) = (vec![], vec![]);
    let trace = rerun.run(study.samples * stride, |simulation, level| {
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
