//! The tests of the exact solutions, in one program.

#![allow(clippy::disallowed_methods, reason = "steps are tested one by one")]

mod drawn;
mod equilibrium;
mod errors;
mod expression;
mod fixtures;
mod loads;
mod p1_matrices;
mod second_derivation;
mod solver;
mod sources;
mod vibration;
