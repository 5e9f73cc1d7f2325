//! Solver for a dynamic, thermoviscoelastic, nonlinear Timoshenko beam between two obstacles.

pub mod assembly;
mod block_tridiagonal;
mod bracket;
pub mod contact;
pub mod contraction;
pub mod energy;
pub mod ensemble;
pub mod equilibrium;
pub mod error;
pub mod kirchhoff;
pub mod lanes;
pub mod mesh;
pub mod norms;
pub mod parameters;
pub mod scheme;
pub mod simulation;
pub mod solve;
mod stumpff;
pub mod tridiagonal;
pub mod vibration;
