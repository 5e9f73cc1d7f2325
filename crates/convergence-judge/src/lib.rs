//! The judge of `convergence-study`: from steps and errors to a rate with an interval, and from a rate and a claim to a verdict.
//!
//! [`judge`] is the rule and how often it errs; it writes numbers with [`text`], and its calibrations ask
//! [`time_limit`] for the time left. `convergence-study` re-exports all three. It is a crate of its own because only
//! this part is worth optimising: the rest of the harness reads, draws and writes.

pub mod judge;
pub mod text;
pub mod time_limit;
