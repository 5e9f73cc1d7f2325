//! Failure as a value: why a step could not be done, when, and the numbers that tell what to change.

use crate::mesh::MeshError;
use crate::parameters::ParameterError;
use thiserror::Error;

/// A step that could not be done. Everything up to the time level before it stands.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("step {step} (to t = {t}): {failure}")]
pub struct StepError {
    /// Number n of the step, counted from 1.
    pub step: usize,
    /// The time t_n that the step should have reached.
    pub t: f64,
    /// What went wrong.
    pub failure: StepFailure,
}

/// What went wrong in a step.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StepFailure {
    /// The increments of the iteration do not shrink.
    #[error(
        "the iteration diverges: increment {increment:.3e} after {iterations} iterations, contraction factor \
         {contraction:.3e} (it must be below 1: take a smaller dt, a larger epsilon, or the solver \"newton\")"
    )]
    Diverged {
        /// Iterations done.
        iterations: usize,
        /// The last increment.
        increment: f64,
        /// Ratio of the last two increments.
        contraction: f64,
    },
    /// The increments shrink, but not below the tolerance within the iterations allowed.
    #[error(
        "increment {increment:.3e} is still above the tolerance after {iterations} iterations, contraction factor \
         {contraction:.3e} (allow more iterations, or take a larger tolerance or a smaller dt)"
    )]
    IterationLimit {
        /// Iterations done.
        iterations: usize,
        /// The last increment.
        increment: f64,
        /// Ratio of the last two increments.
        contraction: f64,
    },
    /// An infinity or a NaN turned up.
    #[error("the solution is not finite after {iterations} iterations (last finite increment {increment:.3e})")]
    NonFinite {
        /// Iterations done.
        iterations: usize,
        /// The last finite increment; NaN where there is none.
        increment: f64,
    },
    /// The operator of the step is not positive definite.
    #[error(
        "the operator of the step has lost its definiteness: pivot {pivot:.3e} at node {node} for the axial force \
         {n_value:.6} (take a smaller dt: the beam is loaded beyond its buckling force)"
    )]
    Indefinite {
        /// Node of the pivot.
        node: usize,
        /// The pivot.
        pivot: f64,
        /// The mean axial force that the operator was built with.
        n_value: f64,
    },
}

/// A simulation that cannot be set up.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SetupError {
    /// A coefficient out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// Nodes that are no mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A vector of initial data with a value for every node was asked for.
    #[error("initial {field}: {found} values for {expected} nodes")]
    Length {
        /// Which field.
        field: &'static str,
        /// Values given.
        found: usize,
        /// Values needed.
        expected: usize,
    },
    /// Initial data that are not finite.
    #[error("initial {field} at node {node} is {found}: allowed is a finite number")]
    NotFinite {
        /// Which field.
        field: &'static str,
        /// At which node.
        node: usize,
        /// The value.
        found: f64,
    },
    /// Initial data that break a boundary condition.
    #[error("initial {field} at x = {x} is {found}: allowed is {allowed}")]
    Boundary {
        /// Which field.
        field: &'static str,
        /// The end of the beam.
        x: f64,
        /// The value.
        found: f64,
        /// The boundary value.
        allowed: f64,
    },
    /// A time step that is not a positive number.
    #[error("dt = {found}: allowed is a finite number > 0")]
    TimeStep {
        /// The value.
        found: f64,
    },
    /// A tolerance or an iteration limit that stops nothing.
    #[error("{name} = {found}: allowed is {allowed}")]
    Setting {
        /// Which setting.
        name: &'static str,
        /// The value.
        found: f64,
        /// The values allowed, in words.
        allowed: &'static str,
    },
}
