//! Convergence studies for the `thermobeam` solver.

pub mod calibration;
pub mod document;
pub mod estimate;
pub mod expression;
pub mod fit;
pub mod plots;
pub mod quadrature;
pub mod rerun;
pub mod scene;
pub mod study_file;
pub mod verdict;

mod nearest;
pub mod outcome;
mod shared_tables;
pub mod study;
