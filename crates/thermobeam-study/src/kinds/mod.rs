//! The kinds of study of the beam: one file each, or a folder if the mathematics is long.
//!
//! A study is data in a TOML file. Its kind reads the file (`from_document`), lists and computes
//! its cases, and judges their results: checks with verdicts, rates, tables, figures, and the
//! numbers that the baseline guards.

pub mod any_order;
pub mod bifurcation;
pub mod convergence;
pub mod detects;
pub mod energy;
pub mod equilibrium;
pub mod exact_experiments;
pub mod experiment;
pub mod frequencies;
mod prelude;
pub mod random_errors;
pub mod rigid;
pub mod scenes;
pub mod self_convergence;
pub mod settings;
mod side_by_side;
pub mod solvers;
mod steady;
pub mod tables;
pub mod vibration;
mod watch;
pub mod work_precision;

pub use settings::PLACES;
pub use tables::TERMS;

use convergence_study::input::InputError;
use convergence_study::program;
use convergence_study::study::{KindRow, Study, StudyFile};
use std::path::Path;

/// One row for each kind; the first is the default, for a file without `kind`.
pub const KINDS: [KindRow; 17] = [
    convergence::ROW,
    any_order::ROW,
    detects::ROW,
    energy::ROW,
    scenes::ROW,
    solvers::ROW,
    vibration::ROW,
    frequencies::ROW,
    self_convergence::ROW,
    experiment::ROW,
    exact_experiments::ROW,
    equilibrium::ROW,
    bifurcation::ROW,
    random_errors::ROW,
    rigid::ROW,
    work_precision::ROW,
    KindRow {
        settings: settings::of_harness,
        ..program::ROW
    },
];

/// Reads a study file of any of the beam's kinds.
///
/// # Errors
/// [`InputError`] with file, line, field, the value found and the values allowed.
pub fn read(path: &Path) -> Result<Box<dyn Study>, InputError> {
    StudyFile::read(&KINDS, path).map(|file| file.study)
}
