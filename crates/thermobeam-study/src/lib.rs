//! Convergence studies for the `thermobeam` solver.

pub mod calibration;
pub mod fit;
pub mod verdict;
pub mod plots;
pub mod expression;
pub mod document;
pub mod scene;
pub mod study_file;

mod nearest;
mod shared_tables;
