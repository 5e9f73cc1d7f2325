//! Runs of scenes and problems: motions, watches, records, repetition, and runs in lanes.

pub(crate) mod dg;
pub mod driver;
pub mod family;
pub mod history;
pub mod motion;
pub mod object;
pub mod simulate;
pub mod step_time;
pub mod tally;
pub mod together;
