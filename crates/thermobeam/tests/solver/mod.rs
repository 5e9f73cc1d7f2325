//! Tests of the solver against exact solutions, dense matrices, an independent implementation, and
//! conservation laws.

mod scenes;

mod agreement;
mod balance;
mod bounds;
mod contraction;
mod dense;
mod dense_iteration;
mod dense_step;
mod failure;
mod linear;
mod linear_exact;
mod nonlinear_exact;
mod reference;
mod robustness;
mod temperature;
mod tolerance;
mod work;
