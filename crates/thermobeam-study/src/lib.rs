//! Convergence studies for the `thermobeam` solver.

pub mod calibration;
pub mod fit;
pub mod verdict;
pub mod plots;
pub mod expression;
mod nearest;
