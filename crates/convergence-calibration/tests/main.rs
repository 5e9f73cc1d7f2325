//! The tests of the calibration, in one program.

mod kind;
mod sheets;
