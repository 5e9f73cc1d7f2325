//! Errors of one-step schemes in every norm, which manufactured solutions and vibrations measure.

use crate::kinds::prelude::*;
use crate::{
    exact::{
        formulas::SchemeFormulas,
        norm::{Norm, Norms},
    },
    kinds::tables::{Layout, Refine},
    run::{RunError, driver::Driver, run_to},
    scene::Coefficients,
};
use convergence_study::{ErrorColumn, Levels};
use thermobeam::scheme::Scheme;

/// Errors in each norm over the levels of a refinement: a column for each norm, with the expected
/// order.
///
/// * `runs`: elements and steps of each level, coarse to fine, with its errors; `None` if the case
///   failed.
pub(super) fn levels<'r>(
    refine: &Refine,
    expect: &[(Norm, Claim)],
    runs: impl Iterator<Item = ((usize, usize), Option<&'r Norms>)> + Clone,
) -> Levels {
    let mut refinements = vec![];
    for ((elements, steps), _) in runs.clone() {
        refinements.push(Refine::level(
            elements,
            steps,
            refine.step_of(elements, steps),
        ));
    }
    let mut columns = vec![];
    for norm in Norm::ALL {
        let runs = runs.clone();
        let errors = runs.map(|(_, errors)| errors.map(|errors| errors[norm]));
        columns.push(ErrorColumn {
            symbol: Some(norm.symbol().to_owned()),
            claim: expect
                .iter()
                .find(|(claimed, _)| *claimed == norm)
                .map(|(_, claim)| *claim),
            style: norm as usize,
            ..ErrorColumn::without_claim(norm.name(), errors)
        });
    }
    Levels::new(refine.axis, refinements, columns)
}

/// What the runs of a refinement are made of.
pub(super) fn parts(solver: &Coefficients, refine: &Refine, against: Known) -> Parts {
    let is_uniform = refine.layout == Layout::default();
    Parts::new(&solver.beam, solver.obstacles.as_ref())
        .on(is_uniform)
        .by(refine.scheme, refine.settings.solver)
        .against(against)
}

/// Steps to `until` and returns the largest error in each norm over the steps; NaN stays.
///
/// * `measure`: the errors at the end of a step.
///
/// # Errors
/// [`RunError`] of a step that fails.
pub(super) fn largest_errors(
    driver: &mut Driver<'_>,
    until: f64,
    mut measure: impl FnMut(&Driver<'_>) -> Norms,
) -> Result<Norms, RunError> {
    let mut largest = Norms::ZERO;
    run_to(driver, until, |driver, _| {
        largest = largest.max(&measure(driver));
    })?;
    Ok(largest)
}

/// The formulas of a scheme on the side of the exact solutions.
///
/// # Errors
/// [`CaseFailure`] if it has none there.
pub(super) fn formulas_of(scheme: Scheme) -> Result<SchemeFormulas, CaseFailure> {
    SchemeFormulas::of(scheme.name).ok_or_else(|| {
        CaseFailure::new(format!(
            "no formulas of the scheme {} to compare with",
            scheme.name
        ))
    })
}
