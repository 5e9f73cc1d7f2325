//! Scenes and problems, stepped: whatever moves, what looks at it, and what is recorded, repeated or run side by side.

pub(crate) mod dg;
pub mod driver;
pub mod family;
pub mod history;
pub mod motion;
pub mod object;
pub(crate) mod rerun;
pub mod simulate;
pub mod step_time;
pub mod tally;
pub mod together;
