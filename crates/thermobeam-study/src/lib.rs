//! Convergence studies for the `thermobeam` solver.

pub mod accuracy;
pub mod atomic;
pub mod calibration;
pub mod design;
pub mod document;
pub mod exact;
pub mod expression;
pub mod fit;
pub mod free_vibration;
pub mod march;
mod nearest;
pub mod outcome;
pub mod plots;
mod quadrature;
mod random;
pub mod scene;
mod shared_tables;
pub mod simulate;
pub mod study;
pub mod study_file;
pub mod verdict;
pub mod yardstick;
