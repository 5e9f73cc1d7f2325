//! The Python package `convergence_study`: converts Python values for the crate
//! `convergence-study`, which judges them.
//!
//! There is no rule here: the code that confirms an order is shared with Rust and the command line.

mod call;
mod judged;
mod levels;
mod limit;
mod norms;
mod rates;
mod results;
mod session;
mod studied;
mod table;
mod taylor;
mod values;

use std::ffi::OsString;

use convergence_study::Project;
use pyo3::prelude::*;

/// The program `convergence-study`; returns its exit status.
///
/// * `executable`: the Python interpreter, which starts the guards of processes by
///   `python -m convergence_study guard`.
/// * `arguments`: the program's arguments, without its name.
#[pyfunction]
fn run_program(py: Python<'_>, executable: OsString, arguments: Vec<OsString>) -> u8 {
    Project::is_run_by([executable, "-m".into(), "convergence_study".into()].into());
    let arguments = std::iter::once("convergence-study".into()).chain(arguments);
    py.detach(|| Project::PROGRAMS.status_of(arguments))
}

#[pymodule]
mod _native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::judged::{Judgement, failure};
    #[pymodule_export]
    use super::limit::{Limit, limit};
    #[pymodule_export]
    use super::norms::norms;
    #[pymodule_export]
    use super::rates::rates;
    #[pymodule_export]
    use super::run_program;
    #[pymodule_export]
    use super::session::{finish, guarded};
    #[pymodule_export]
    use super::studied::{Study, study, study_of};
    #[pymodule_export]
    use super::table::judge_table;
    #[pymodule_export]
    use super::taylor::{adjoint, taylor};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
