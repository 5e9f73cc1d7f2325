//! The laws of the solver, each held against something that knows nothing of how it computes.

mod scenes;

mod agreement;
mod balance;
mod contraction;
mod dense;
mod dense_step;
mod failure;
mod linear;
mod linear_exact;
mod nonlinear_exact;
mod reference;
mod robustness;
mod steady;
mod temperature;
mod tolerance;
mod work;
