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
mod properties;
mod public;
mod random;
mod refusals;
#[path = "../../convergence-study-tests/src/refusals.rs"]
#[allow(unreachable_pub, reason = "it is a library's")]
mod refused;
mod threads;
mod variants;
