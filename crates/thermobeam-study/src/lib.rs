//! Convergence studies for the `thermobeam` solver.

pub mod fit;
pub mod verdict;
