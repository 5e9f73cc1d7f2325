//! Tables that several kinds of study file have: exact solution, refinement, orders expected, coefficients of a control,
//! two discretisations of any order.

mod discretisation;
mod manufactured;
mod refine;

use super::prelude::*;
use crate::scene::Coefficients;

pub use discretisation::Discretisation;
pub(crate) use discretisation::{DISCRETISATION_KEYS, discretisations};
pub(crate) use manufactured::manufactured;
pub use refine::{Perturbation, Refine};
pub(crate) use refine::{mapped_mesh, mesh_map, refine};

/// All tables `[[expect]]`: in which norm which order.
pub(crate) fn expectations(root: &Section<'_>) -> Result<Vec<(Norm, Claim)>, InputError> {
    claims(root, "norm", &Norm::ALL.map(|norm| (norm.name(), norm)))
}

/// All tables `[[expect]]`: of what which order, each once.
///
/// * `key`: the key that says of what; `choices`: what it may be.
pub(crate) fn claims<T: Copy + PartialEq>(
    root: &Section<'_>,
    key: &str,
    choices: &[(&'static str, T)],
) -> Result<Vec<(T, Claim)>, InputError> {
    let allowed = format!("at least one table [[expect]] with {key}, order and tolerance");
    let names = choices.iter().map(|(name, _)| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
    let field = root.require("expect", &allowed)?;
    let mut claims: Vec<(T, Claim)> = vec![];
    for item in field.items(&allowed)? {
        let section = item.section()?;
        section.allow(&[key, "order", "constant", "tolerance"])?;
        let of = section.require(key, &names)?.choice(choices)?;
        if claims.iter().any(|(earlier, _)| *earlier == of) {
            let name = choices.iter().find(|(_, choice)| *choice == of).map_or("", |(name, _)| name);
            return Err(section.refuse(key, format!("\"{name}\" a second time"), format!("each {key} once")));
        }
        let claim = Claim::read(&section, "order")?;
        claims.push((of, Claim { tolerance: section.positive("tolerance")?, ..claim }));
    }
    if claims.is_empty() { Err(field.refuse_as_written(allowed)) } else { Ok(claims) }
}

/// Errors in each norm over the levels of a refinement: a column for each norm, with the order that is expected in it.
///
/// * `step`: the step that the errors are judged over, of elements and steps.
/// * `ran`: elements and steps of each level, coarse to fine, with its errors; `None` where the case failed.
pub(crate) fn norm_levels<'r>(
    refine: &Refine,
    expect: &[(Norm, Claim)],
    step: impl Fn(usize, usize) -> f64,
    ran: impl Iterator<Item = ((usize, usize), Option<&'r Norms>)> + Clone,
) -> Levels {
    let refinement = |((elements, steps), _)| Refine::level(elements, steps, step(elements, steps));
    let column = |norm: Norm| ErrorColumn {
        name: norm.name().to_owned(),
        errors: ran.clone().map(|(_, errors)| errors.map(|errors| errors[norm])).collect(),
        claim: expect.iter().find(|(of, _)| *of == norm).map(|(_, claim)| *claim),
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

/// The table `[control]`: coefficients in which the solver differs from `theory`; without it the solver has the same.
pub(crate) fn control(root: &Section<'_>, theory: Coefficients) -> Result<Coefficients, InputError> {
    let Some(section) = root.section("control")? else { return Ok(theory) };
    let names: Vec<&str> = Coefficients::names().collect();
    section.allow(&names)?;
    let mut solver = theory;
    for name in names {
        let Some(field) = section.get(name) else { continue };
        let value = field.number()?;
        let Some(coefficient) = solver.get_mut(name) else {
            let found = format!("{} without a table [obstacles]", field.as_written());
            return Err(field.refuse(found, tables::BEAM_KEYS.join(", ")));
        };
        // A control that changes nothing can only pass where it has to fail.
        if *coefficient == value {
            let found = format!("{}, which is the value of the sources", field.as_written());
            return Err(field.refuse(found, "another value"));
        }
        *coefficient = value;
    }
    if solver == theory {
        return Err(root.refuse("control", "an empty table", "a table that changes at least one coefficient"));
    }
    solver.check(&section)?;
    Ok(solver)
}
