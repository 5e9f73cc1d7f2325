//! The kinds of study of the beam: one file each, or a folder if the mathematics is long.
//!
//! A study is data in a TOML file. Its kind takes the file as a struct (`from_file`), lists and
//! computes its cases, and judges their results: checks with verdicts, rates, tables, figures, and
//! the numbers that the baseline guards.

pub mod orders;
pub(crate) mod prelude;
pub mod runs;
pub mod solvers;
pub mod tables;
pub mod work_precision;

pub use tables::TERMS;

use convergence_study::{InputError, KindRow, Study};
use orders::ErrorSource;
use orders::any_order::AnyOrder;
use orders::frequencies::Frequencies;
use orders::manufactured::Convergence;
use orders::self_convergence::SelfConvergence;
use orders::vibration::Vibration;
use std::path::Path;

/// One row for each kind; the first is the default, for a file without `kind`.
pub const KINDS: [KindRow; 10] = [
    Convergence::ROW,
    AnyOrder::ROW,
    runs::energy::ROW,
    runs::scenes::ROW,
    solvers::ROW,
    Vibration::ROW,
    Frequencies::ROW,
    SelfConvergence::ROW,
    work_precision::ROW,
    KindRow::PROGRAM,
];

/// Reads a study file of any of the beam's kinds.
///
/// # Errors
/// [`InputError`] with file, line, field, the value found and the values allowed.
pub fn read(path: &Path) -> Result<Box<dyn Study>, InputError> {
    KindRow::read_any(&KINDS, path)
}
