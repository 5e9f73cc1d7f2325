//! Norms of errors of one level.

use convergence_study::internal::study::norms::{INSIDE, all_norms, largest_inside};
use pyo3::prelude::*;

use crate::values::refuse;

/// L1, L2 and the maximum, and with a boundary the maximum inside.
///
/// # Errors
/// `ValueError` with the argument that does not fit.
#[pyfunction]
pub(crate) fn norms(
    errors: Vec<f64>,
    weights: Vec<f64>,
    boundary: Option<Vec<bool>>,
) -> PyResult<Vec<(&'static str, f64)>> {
    let mut found = all_norms(&errors, &weights).map_err(refuse)?.to_vec();
    if let Some(boundary) = boundary {
        let inside = largest_inside(&errors, &boundary).map_err(refuse)?;
        found.push((INSIDE, inside));
    }
    Ok(found)
}
