//! One program for all tests.

mod answers;
#[path = "../../convergence-study-tests/src/rows.rs"]
#[allow(unreachable_pub, reason = "it is a library's")]
mod rows;
