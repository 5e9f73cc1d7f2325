//! Tests of the crate, one module a subject.

mod against;
mod checks;
mod closed_forms;
mod domains;
mod drawn;
mod emitted;
mod files;
mod functions;
mod fuzz;
mod mistakes;
mod orders;
mod pages;
mod programs;
mod properties;
mod public;
mod random;
mod refusals;
#[path = "../../convergence-study-tests/src/refusals.rs"]
#[allow(unreachable_pub, reason = "it is a library's")]
mod refused;
mod threads;
mod variants;

/// What most of the tests use.
mod prelude {
    pub(crate) use crate::files::*;
    pub(crate) use crate::programs::*;
    pub(crate) use crate::refused::{each_is_refused, refusals, says};
    pub(crate) use manufacture::{
        Check, Comparison, EmittedFile, Finding, Language, Manufacture, Sampling,
    };
    pub(crate) use std::fs;
    pub(crate) use std::path::Path;
    pub(crate) use std::process::Command;
    pub(crate) use tempfile::TempDir;
}
