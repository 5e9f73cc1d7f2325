//! Tables of files and texts, judged by the command `rates`.

use convergence_study::{
    Claim, Project,
    rates::{Argument, Claimed, Request, Tables},
};
use pyo3::prelude::*;

use crate::call::{Call, literal};
use crate::table::Chosen;
use crate::values::{self, Claims, refuse};

/// The object that `rates --format json` prints, as text.
///
/// * `source`: a text with tables, or the path of a file.
/// * `order`: the orders that are claimed, or factors if `by_factor`.
/// * `round_off`: the size of the solution, and the relative round-off of its numbers.
///
/// # Errors
/// `ValueError` with the place in the text, or with the argument.
#[pyfunction]
#[allow(
    clippy::too_many_arguments,
    reason = "the arguments of the function in Python"
)]
pub(crate) fn rates(
    py: Python<'_>,
    source: &str,
    is_text: bool,
    order: Option<&Bound<'_, PyAny>>,
    by_factor: bool,
    tolerance: Option<f64>,
    floor: f64,
    round_off: [Option<f64>; 2],
    chosen: Chosen,
) -> PyResult<String> {
    // Refuses what the rule cannot use.
    let _ = values::floor_of(floor)?;
    let [scale, eps] = round_off;
    let request = Request {
        // The tolerance of a factor is that of its logarithm.
        claims: claimed(py, order, tolerance.filter(|_| !by_factor))?,
        by_factor,
        tolerance,
        floor,
        scale,
        eps,
        choice: chosen.choice()?,
        ..Request::default()
    };
    if let Some([kept, ignored]) = request.ignored() {
        let found = format!("{ignored}: expected none beside {kept}, which leaves it no meaning");
        return Err(refuse(found));
    }
    let (tables, first) = if is_text {
        (Tables::Text(source), "text".to_owned())
    } else {
        (Tables::File(source), literal(py, source))
    };
    let claim = if by_factor {
        "factor"
    } else {
        Argument::Order.name()
    };
    let call = Call::new(py, "rates", &first, (claim, order), &Argument::ALL)?;
    let found = py.detach(|| request.object(Project::PROGRAMS.command, tables));
    let found = found.map_err(|refusal| refuse(refusal.words(&call)))?;
    Ok(found.to_string())
}

/// The claims for columns by name, or for all.
fn claimed(
    py: Python<'_>,
    order: Option<&Bound<'_, PyAny>>,
    tolerance: Option<f64>,
) -> PyResult<Vec<Claimed>> {
    let Some(order) = order else {
        return Ok(vec![]);
    };
    Ok(match Claims::read(Some(order), tolerance)? {
        Claims::ForAll(claim) => {
            let claim = claim.into_iter();
            claim.map(|claim| written(py, None, claim)).collect()
        }
        Claims::Named(named) => {
            let named = named.into_iter();
            named
                .map(|(name, claim)| written(py, Some(name), claim))
                .collect()
        }
    })
}

/// A claim with the text by which Python says it.
fn written(py: Python<'_>, name: Option<String>, claim: Claim) -> Claimed {
    let order = claim.bound.written(claim.order);
    let order = if claim.bound.is_least() {
        format!("'{order}'")
    } else {
        order
    };
    let text = match &name {
        Some(name) => format!("{{{}: {order}}}", literal(py, name)),
        None => order,
    };
    Claimed::new(text, name, claim.order, claim.bound)
}
