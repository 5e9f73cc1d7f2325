//! The tests of the beam's studies, in one program.

#![allow(clippy::disallowed_methods, reason = "steps are tested one by one")]

mod accuracy;
mod charts;
mod fuzz;
mod input;
mod kinds;
mod simulate;
mod sweep;

use std::path::Path;

use convergence_study::{InputError, KindRow, Study};
use thermobeam_study::kinds::KINDS;

/// Reads a study file of the repository.
fn read_study(path: &Path) -> Result<Box<dyn Study>, InputError> {
    KindRow::read_any(&KINDS, path)
}
