//! Errors of runs against what is known: manufactured solutions in their three designs, exact vibrations, runs of any order.

pub(crate) mod curve;
pub mod design;
pub mod evaluator;
pub mod free_vibration;
pub mod levels;
pub mod reference;
