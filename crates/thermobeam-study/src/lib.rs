//! Convergence studies for the `thermobeam` solver.

pub mod atomic;
pub mod baseline;
pub mod calibration;
pub mod columns;
pub mod contract;
pub mod document;
pub mod expression;
pub mod fit;
pub mod junit;
pub mod plots;
pub mod provenance;
pub mod record;
pub mod report;
pub mod runner;
pub mod scene;
pub mod shelf;
pub mod study_file;
pub mod verdict;
pub mod verification;

mod nearest;
pub mod outcome;
mod shared_tables;
pub mod study;
