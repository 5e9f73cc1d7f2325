//! The tests of the solver, in one program.

#![allow(clippy::disallowed_methods, reason = "steps are tested one by one")]

mod allocation;
mod dense;
mod dg;
mod drawn;
mod lanes;
mod motion;
mod norms;
mod random_scenes;
mod scenes;
mod solver;
