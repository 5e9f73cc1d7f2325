//! Before a run: the resolution that an accuracy needs, and what it costs. After it: the error budget.

pub mod accuracy;
pub mod any_order;
pub mod estimate;
