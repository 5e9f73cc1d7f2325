//! Convergence studies for the `thermobeam` solver.

pub mod atomic;
pub mod calibration;
pub mod design;
pub mod document;
pub mod exact;
pub mod expression;
pub mod fit;
mod nearest;
pub mod outcome;
pub mod plots;
mod quadrature;
mod random;
pub mod rates;
pub mod scene;
mod shared_tables;
pub mod simulate;
pub mod study;
pub mod study_file;
pub mod sweep;
pub mod template;
pub mod verdict;

/// The code of the README, held by the doc tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
