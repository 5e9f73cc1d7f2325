//! The tests of the exact solutions, in one program.

mod errors;
mod expression;
mod sources;
