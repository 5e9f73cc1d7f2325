//! One mesh with one time step a case: its error in each norm, the maximum over the time levels.

use convergence_study::study::{Case, CaseFailure};

use super::Convergence;
use crate::error::design::{Disagreement, Prepared};
use crate::kinds::tables::{Norms, Refine};

/// Steps that cost as much as the space vectors of a mesh.
const PREPARATION: f64 = 50.0;

pub(super) fn cases(study: &Convergence) -> Vec<Case<(usize, usize)>> {
    let case = |(elements, steps): (usize, usize)| Case {
        label: Refine::label(elements, steps),
        cost: elements as f64 * (steps as f64 + PREPARATION),
        data: (elements, steps),
    };
    study.refine.cases().into_iter().map(case).collect()
}

pub(super) fn run(study: &Convergence, (elements, steps): (usize, usize)) -> Result<Norms, CaseFailure> {
    let (beam, obstacles) = study.solver_coefficients();
    Prepared::new(study, elements)?.run(steps, Disagreement { beam, obstacles, defect: None })
}
