//! Norms of errors of one level.

use convergence_study::LevelErrors;
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
    LevelErrors::norms(&errors, &weights, boundary.as_deref()).map_err(refuse)
}
