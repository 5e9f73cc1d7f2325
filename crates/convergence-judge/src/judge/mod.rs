//! From steps and errors to a rate with an interval, and from a rate and a claim to a verdict.

pub mod calibration;
pub mod claims;
pub mod fit;
pub mod grid;
pub mod power_law;
pub mod random;
pub mod richardson;
pub mod shown;
pub mod verdict;
