//! Cost and error before and after a run: time per step, error budgets, the run that an accuracy needs.

pub mod accuracy;
pub mod estimate;
pub mod pace;
