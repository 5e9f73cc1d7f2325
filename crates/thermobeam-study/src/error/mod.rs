//! Errors of runs against what is known: exact vibrations, and runs of any order.

pub mod evaluator;
pub mod free_vibration;
pub mod reference;
