//! Tests of the solver against dense matrices, an independent implementation, and conservation
//! laws.

mod agreement;
mod balance;
mod bounds;
mod contraction;
mod failure;
mod reference;
mod robustness;
mod temperature;
mod tolerance;
mod work;
