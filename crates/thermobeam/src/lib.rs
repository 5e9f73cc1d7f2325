//! Solver for a dynamic, thermoviscoelastic, nonlinear Timoshenko beam between two obstacles.

pub mod assembly;
mod block_tridiagonal;
pub mod contact;
pub mod energy;
pub mod error;
pub mod kirchhoff;
pub mod lanes;
mod bracket;
pub mod equilibrium;
pub mod mesh;
pub mod norms;
pub mod parameters;
pub mod scheme;
pub mod simulation;
pub mod solve;
pub mod tridiagonal;
mod stumpff;
pub mod vibration;
