//! The tests of the exact solutions, in one program.

#![allow(clippy::disallowed_methods, reason = "steps are tested one by one")]

mod drawn;
mod equilibrium;
mod errors;
mod expression;
mod fixtures;
mod loads;
mod p1_matrices;
#[path = "../../convergence-study-tests/src/refusals.rs"]
#[allow(dead_code, unreachable_pub, reason = "it is a library's")]
mod refused;
mod second_derivation;
mod solver;
mod sources;
mod vibration;
