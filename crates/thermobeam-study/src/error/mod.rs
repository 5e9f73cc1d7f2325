//! Errors of runs against what is known: manufactured solutions in their three designs, exact vibrations, finer runs.

pub mod design;
pub mod evaluator;
pub mod free_vibration;
