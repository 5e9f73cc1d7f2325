//! The tests of the calibration, in one program.

mod sheets;
mod studies;
