//! The tests of the exact solutions, in one program.

mod errors;
mod expression;
mod independence;
mod loads;
mod second_derivation;
mod sources;
