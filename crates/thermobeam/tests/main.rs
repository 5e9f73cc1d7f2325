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

/// What most of the tests use.
mod prelude {
    pub(crate) use crate::drawn::*;
    pub(crate) use crate::norms::*;
    pub(crate) use crate::scenes::*;
    pub(crate) use thermobeam::dg::{
        ContactEvent, Dg, DgLevel, DgProblem, DgStepping, Field, InitialFunctions, Phase, Space,
    };
    pub(crate) use thermobeam::energy::Balance;
    pub(crate) use thermobeam::ensemble::Ensemble;
    pub(crate) use thermobeam::error::{Loop, SetupError, StepError, StepFailure, StepMatrix};
    pub(crate) use thermobeam::kirchhoff::BUCKLING;
    pub(crate) use thermobeam::mesh::Mesh;
    pub(crate) use thermobeam::motion::{Motion, TipRange, Work};
    pub(crate) use thermobeam::norms::TheoremSquares;
    pub(crate) use thermobeam::one_step::{
        BYTES_PER_ELEMENT, InitialValues, OneStep, Problem, Stepping,
    };
    pub(crate) use thermobeam::parameters::{Beam, Obstacles, ParameterError};
    pub(crate) use thermobeam::scheme::{
        ContactRule, EULER_CRANK_NICOLSON, MIDPOINT, SCHEMES, Scheme,
    };
    pub(crate) use thermobeam::solve::{Settings, Solver, Start, Stopping, TimeLevel};
}
