//! The kinds of study, one file each, behind one interface.
//!
//! A study is a TOML file: data. Its kind says what its cases are (pure computations, run on any thread in any order),
//! and how their results become an [`Outcome`]: checks with verdicts, tables, figures, and the numbers that the baseline
//! guards. The runner knows threads, the report knows Markdown, a study knows neither.

pub mod any_order;
pub mod any_order_cost;
pub mod bifurcation;
pub mod calibration;
pub mod controls;
pub mod convergence;
pub mod energy;
pub mod equilibrium;
pub mod exact_experiments;
pub mod experiment;
pub mod frequencies;
pub mod rigid;
pub mod self_convergence;
pub mod solvers;
mod steady;
mod table;
pub mod tables;
mod terms;
pub mod vibration;
mod watch;
pub mod work_precision;

pub use table::KINDS;
pub use terms::TERMS;

use convergence_study::input::InputError;
use convergence_study::study::{self as harness, StudyFile};
use std::path::Path;

/// Reads a study file of any of the beam's kinds.
///
/// # Errors
/// [`InputError`] with file, line, field, the value found and the values allowed.
pub fn read(path: &Path) -> Result<Box<dyn harness::Study>, InputError> {
    StudyFile::read(&KINDS, path).map(|file| file.study)
}
