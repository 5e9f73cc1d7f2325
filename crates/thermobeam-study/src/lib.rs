//! Convergence studies for the `thermobeam` solver.

pub mod accuracy;
pub mod atomic;
pub mod baseline;
pub mod calibration;
pub mod columns;
pub mod contract;
pub mod design;
pub mod document;
pub mod estimate;
pub mod exact;
pub mod expression;
pub mod fit;
pub mod free_vibration;
pub mod junit;
mod limits;
pub mod march;
mod nearest;
pub mod outcome;
pub mod pace;
pub mod plots;
pub mod provenance;
pub mod quadrature;
mod random;
pub mod rates;
pub mod record;
pub mod report;
pub mod rerun;
pub mod runner;
pub mod scene;
mod shared_tables;
pub mod shelf;
pub mod simulate;
pub mod study;
pub mod study_file;
pub mod sweep;
pub mod template;
pub mod time_limit;
pub mod verdict;
pub mod verification;
pub mod writing;
pub mod yardstick;

/// The code of the README, held by the doc tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
