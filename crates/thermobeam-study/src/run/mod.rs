//! Scenes and problems, stepped: one driver, and what is recorded, repeated or run side by side with it.

pub mod driver;
pub(crate) mod patience;
pub mod refinable;
pub(crate) mod rerun;
pub mod simulate;
