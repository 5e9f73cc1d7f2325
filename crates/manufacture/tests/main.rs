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
mod poles;
mod properties;
mod public;
mod random;
mod refusals;
mod threads;
mod variants;
