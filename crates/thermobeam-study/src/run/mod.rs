//! Scenes and problems, stepped: one driver, and what is recorded, repeated or run side by side with it.

pub mod any_order;
pub mod driver;
pub mod march;
pub(crate) mod patience;
pub mod rerun;
pub mod simulate;
