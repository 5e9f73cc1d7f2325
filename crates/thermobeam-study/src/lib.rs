//! Convergence studies for the `thermobeam` solver.

pub mod atomic;
pub mod calibration;
pub mod document;
pub mod expression;
pub mod fit;
pub mod plots;
pub mod scene;
pub mod simulate;
pub mod study_file;
pub mod verdict;

pub mod design;
pub mod exact;
mod nearest;
pub mod outcome;
mod quadrature;
mod random;
mod shared_tables;
pub mod simulate;
pub mod study;
