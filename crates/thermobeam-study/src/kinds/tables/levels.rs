//! Errors in each norm over the levels of a refinement.

use convergence_study::study::levels::{Claim, ErrorColumn, Levels, Refinement};

use super::{Expectation, Norm, Norms, Refine};

/// One column for each norm, with the order that is expected in it.
///
/// * `step`: the step that the errors are judged over, of elements and steps.
/// * `ran`: elements and steps of each level, coarse to fine, with its errors; `None` where the case failed.
pub(crate) fn norm_levels<'r>(
    refine: &Refine,
    expect: &[Expectation],
    step: impl Fn(usize, usize) -> f64,
    ran: impl Iterator<Item = ((usize, usize), Option<&'r Norms>)> + Clone,
) -> Levels {
    let refinement = |((elements, steps), _): ((usize, usize), _)| Refinement {
        label: Refine::label(elements, steps),
        parameters: [("elements", elements), ("steps", steps)]
            .map(|(name, count)| (name.to_owned(), count as f64))
            .into(),
        step: step(elements, steps),
    };
    let claim = |norm: Norm| {
        let expectation = expect.iter().find(|expectation| expectation.norm == norm);
        expectation.map(|&Expectation { order, tolerance, .. }| Claim { order, tolerance })
    };
    let column = |norm: Norm| ErrorColumn {
        name: norm.name().to_owned(),
        errors: ran.clone().map(|(_, errors)| errors.map(|errors| errors[norm])).collect(),
        claim: claim(norm),
        look: norm as usize,
    };
    Levels {
        axis: refine.axis,
        refinements: ran.clone().map(refinement).collect(),
        columns: Norm::ALL.into_iter().map(column).collect(),
    }
}

/// Names of the norms in which the error is not finite.
pub(crate) fn not_finite(errors: &Norms) -> Vec<String> {
    errors.iter().filter(|(_, error)| !error.is_finite()).map(|(norm, _)| norm.name().to_owned()).collect()
}
