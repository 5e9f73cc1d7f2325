//! The tests of the exact solutions, in one program.

#![allow(clippy::disallowed_methods, reason = "steps are tested one by one")]

#[path = "../../thermobeam/tests/drawn.rs"]
#[allow(dead_code, reason = "it is the solver's, too")]
mod drawn;
mod equilibrium;
mod errors;
mod expression;
mod fixtures;
mod loads;
#[path = "../../thermobeam/tests/dense/p1.rs"]
mod p1;
#[path = "../../convergence-study-tests/src/refusals.rs"]
#[allow(dead_code, unreachable_pub, reason = "it is a library's")]
mod refused;
mod second_derivation;
mod solver;
mod sources;
mod vibration;

/// What most of the tests use.
mod prelude {
    pub(crate) use crate::fixtures::{close, derivative, integral, product, uniform};
    pub(crate) use convergence_judge::random::SplitMix;
    pub(crate) use thermobeam::dg::{Dg, DgProblem, DgStepping, Field, InitialFunctions, Space};
    pub(crate) use thermobeam::mesh::Mesh;
    pub(crate) use thermobeam::parameters::{Beam, Obstacles};
    pub(crate) use thermobeam_exact::equilibrium::{Equilibrium, Phase};
    pub(crate) use thermobeam_exact::expression::{Expression, Variable};
    pub(crate) use thermobeam_exact::solution::{Factors, Manufactured, Product};
    pub(crate) use thermobeam_exact::sources::{Forces, Sources};
}
