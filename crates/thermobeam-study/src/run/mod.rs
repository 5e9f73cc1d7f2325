//! Scenes and problems, stepped: one driver, and what is recorded, repeated or run side by side with it.

pub mod any_order;
pub mod driver;
pub(crate) mod ensemble;
pub mod family;
pub(crate) mod rerun;
pub mod simulate;
pub mod step_time;
pub mod tally;
