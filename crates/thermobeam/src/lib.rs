//! Solver for a dynamic, thermoviscoelastic, nonlinear Timoshenko beam between two obstacles.

pub mod mesh;
pub mod parameters;
pub mod scheme;
pub mod solve;
