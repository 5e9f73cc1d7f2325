//! Errors of runs against known solutions: exact vibrations, and runs of any order.

pub mod evaluator;
pub mod free_vibration;
pub mod reference;
