//! Failure as a value: bad input, and steps that could not be done.

use crate::parameters::ParameterError;
use thiserror::Error;

/// Input that is no problem to be solved.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SetupError {
    /// A coefficient out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A setting out of range.
    #[error("{name}: expected {allowed}, found {found}")]
    Setting {
        /// Which setting.
        name: &'static str,
        /// The value.
        found: f64,
        /// The values allowed, in words.
        allowed: String,
    },
    /// Initial data that are not finite.
    #[error("initial {field} between x = {from} and x = {to}: expected finite numbers, found {found}")]
    NotFinite {
        /// Which field.
        field: &'static str,
        /// The projection's coefficient that is not finite.
        found: f64,
        /// Left end of the element.
        from: f64,
        /// Right end of the element.
        to: f64,
    },
    /// Initial data that break a boundary condition.
    #[error("initial {field} at x = {x}: expected {allowed}, found {found}")]
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
}

/// A step that could not be done. Everything up to the level before it stands.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("step {step} (from t = {t}, length {dt:e}): {failure}")]
pub struct StepError {
    /// Number of the step, counted from 1.
    pub step: usize,
    /// The time at which the step starts.
    pub t: f64,
    /// Its length.
    pub dt: f64,
    /// What went wrong.
    pub failure: StepFailure,
}

/// What went wrong in a step.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StepFailure {
    /// The increments of the iteration for the axial force do not shrink.
    #[error(
        "the iteration diverges: increment {increment:.3e} after {iterations} iterations, {contraction:.3e} times the \
         one before (take a smaller dt)"
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
        "increment {increment:.3e} is still above the tolerance after {iterations} iterations (allow more iterations, or \
         take a larger tolerance or a smaller dt)"
    )]
    IterationLimit {
        /// Iterations done.
        iterations: usize,
        /// The last increment.
        increment: f64,
    },
    /// An infinity or a NaN turned up.
    #[error("the solution is not finite after {iterations} iterations")]
    NonFinite {
        /// Iterations done.
        iterations: usize,
    },
    /// The matrix of the step is not positive definite.
    #[error(
        "the matrix of the step has lost its definiteness: pivot {pivot:.3e} at node {node} for the axial force \
         {n_value:.6} (take a smaller dt; or the beam is loaded beyond its buckling force)"
    )]
    Indefinite {
        /// Node of the pivot, or the node on the right of its element.
        node: usize,
        /// The pivot.
        pivot: f64,
        /// The axial force that the matrix was built with.
        n_value: f64,
    },
    /// More contact events within the smallest step than an impact explains.
    #[error(
        "{events} contact events within {within:.3e} (take a smaller restart_dt: the tip's motion is not resolved)"
    )]
    EventsTooClose {
        /// How many.
        events: usize,
        /// In which time.
        within: f64,
    },
    /// A contact event that the step's own polynomial shows, and that no length of the step meets.
    #[error("no step ends on the obstacle: the tip misses it by {miss:.3e} (take a smaller dt)")]
    EventNotFound {
        /// Distance of the tip from the obstacle at the end of the last attempt.
        miss: f64,
    },
    /// What the free end touches contradicts its motion: closed contact pulls, or the open free end penetrates.
    #[error(
        "contact contradicts the motion of the free end by a force of {force:.3e}: it pulls where it is closed, or penetrates \
         where it is open (rounding errors of the position are a force of {noise:.3e}: take a larger epsilon)"
    )]
    WrongContact {
        /// The force with the wrong sign.
        force: f64,
        /// Rounding errors of the position, divided by ε.
        noise: f64,
    },
}
