//! One mesh a case: its discrete frequencies.

use convergence_study::run::time_limit::Patience;
use convergence_study::study::{Case, CaseFailure};
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::vibration::discrete_frequencies_until;

use super::Frequencies;

impl Frequencies {
    pub(super) fn mesh(&self, elements: usize) -> Result<Mesh, MeshError> {
        Mesh::mapped(elements, |s| self.map.as_ref().map_or(s, |map| map.eval(s)))
    }
}

pub(super) fn cases(study: &Frequencies) -> Vec<Case<usize>> {
    // Bisection to the last bit is some 60 counts for each frequency.
    let cost = |n: usize| 60.0 * (n * study.degree.pow(3) * study.count) as f64;
    study.elements.iter().map(|&n| Case { label: format!("n = {n}"), cost: cost(n), data: n }).collect()
}

pub(super) fn run(study: &Frequencies, elements: usize) -> Result<Vec<f64>, CaseFailure> {
    // Each count of the bisection goes over all elements, as a step does.
    let mut patience = Patience::new(elements * study.degree.pow(3));
    let mesh = study.mesh(elements)?;
    Ok(discrete_frequencies_until(&mesh, study.degree, study.count, |known| patience.check(known, || 0.0))??)
}
