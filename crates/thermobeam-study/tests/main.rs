//! The tests of the beam's studies, in one program.

mod fuzz;
mod input;
mod kinds;
mod manufactured;
mod one_loop;
mod plots;
mod predict;
mod simulate;
mod sweep;
