//! The tests of the solver, in one program.

mod allocation;
mod dg;
mod drawn;
mod lanes;
mod motion;
mod p1_matrices;
mod random_scenes;
mod solver;
