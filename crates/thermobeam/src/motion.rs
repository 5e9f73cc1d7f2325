//! A beam in motion, by whatever method: what [`OneStep`](crate::one_step::OneStep) and
//! [`Dg`](crate::dg::Dg) have in common.
//!
//! ```
//! use thermobeam::dg::{Dg, DgProblem, DgStepping, InitialFunctions};
//! use thermobeam::error::StepError;
//! use thermobeam::mesh::Mesh;
//! use thermobeam::motion::Motion;
//! use thermobeam::one_step::{InitialValues, OneStep, Problem, Stepping};
//! use thermobeam::parameters::Beam;
//! use thermobeam::scheme::MIDPOINT;
//! use thermobeam::solve::Settings;
//!
//! /// The largest displacement of the free end up to `t_end`.
//! fn largest(motion: &mut dyn Motion, t_end: f64) -> Result<f64, StepError> {
//!     let mut largest = motion.tip_range().high;
//!     while motion.step(t_end)?.is_some() {
//!         largest = largest.max(motion.tip_range().high);
//!     }
//!     Ok(largest)
//! }
//!
//! let beam = Beam::default();
//! let mesh = Mesh::uniform(200)?;
//! let mut initial = InitialValues::at_rest(&mesh, 0.0);
//! initial.u_t = mesh.nodes().to_vec();
//! let problem = Problem { beam, obstacles: None, mesh, initial };
//! let stepping = Stepping { scheme: MIDPOINT, settings: Settings::default(), dt: 1e-3, loaded: false };
//! let mut one_step = OneStep::new(problem, stepping)?;
//!
//! let initial = InitialFunctions { u_t: Box::new(|x| x), ..InitialFunctions::at_rest(0.0) };
//! let problem = DgProblem { beam, obstacles: None, mesh: Mesh::uniform(2)?, degree: 6, initial };
//! let mut dg = Dg::new(problem, DgStepping::default())?;
//!
//! let difference = largest(&mut one_step, 1.0)? - largest(&mut dg, 1.0)?;
//! assert!(difference.abs() < 1e-4, "{difference}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::contact::ContactEvent;
use crate::error::StepError;

/// A beam at one time level, which does one step at a time.
pub trait Motion {
    /// Does one step, which ends at `limit` at the latest; `None` if the motion has reached
    /// `limit`.
    ///
    /// A one-step scheme does not shorten its steps: it ends at the multiple of δt that is closest
    /// to `limit`.
    ///
    /// # Errors
    /// [`StepError`] with step, time and cause; the motion then remains at its old level.
    fn step(&mut self, limit: f64) -> Result<Option<StepReport>, StepError>;

    /// Does steps until the motion has reached `t_end`.
    ///
    /// # Errors
    /// [`StepError`] of the step that failed; the motion then remains at the start of that step.
    fn advance(&mut self, t_end: f64) -> Result<(), StepError> {
        while self.step(t_end)?.is_some() {}
        Ok(())
    }

    /// Whether [`Self::step`] with this limit would do nothing.
    fn has_reached(&self, limit: f64) -> bool;

    /// The time t of the current level.
    fn t(&self) -> f64;

    /// Number of steps done.
    fn steps(&self) -> usize;

    /// Counts of the work done so far.
    fn work(&self) -> Work;

    /// Smallest and largest u(1) in the last step; for a one-step scheme, and at the start, twice
    /// its value at the current level.
    fn tip_range(&self) -> TipRange;

    /// Whether loads act on the beam. Its energy may then rise.
    fn is_loaded(&self) -> bool;

    /// Whether the temperature is computed.
    fn is_heated(&self) -> bool;
}

/// Smallest and largest u(1) over some time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TipRange {
    /// The smallest.
    pub low: f64,
    /// The largest.
    pub high: f64,
}

impl TipRange {
    /// That of one instant.
    pub fn at(u: f64) -> Self {
        Self { low: u, high: u }
    }
}

/// A completed step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// Its length.
    pub dt: f64,
    /// Number of iterations, each at least one solve of the linear system; for dG, of the last
    /// attempt.
    pub iterations: usize,
    /// Fixed point and dG: the last increment. Newton: an upper bound on the increment of one more
    /// iteration.
    pub increment: f64,
    /// Fixed point: ratio of the last two increments, `None` after a single iteration. Newton and
    /// dG: `None`.
    pub contraction: Option<f64>,
    /// Whether the free end was in contact: for a one-step scheme, whether the contact force of the
    /// step is not zero; for dG, throughout the step.
    pub in_contact: bool,
    /// dG: the contact event at the end of the step, if any.
    pub event: Option<ContactEvent>,
}

/// Counts of the work done. Unlike run times they are exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Work {
    /// Solves of the linear system of the whole step: passes of Newton's method, or iterations of
    /// the fixed point or of dG.
    pub passes: usize,
    /// Factorisations of that system; for the fixed point, of the equation of u.
    pub factorizations: usize,
}
