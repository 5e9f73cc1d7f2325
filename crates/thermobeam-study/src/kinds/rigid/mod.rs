//! Obstacles becoming rigid, ε → 0: the Signorini limit.
//!
//! # The time scale of an impact
//!
//! When the free end meets an obstacle with velocity v, only a layer of width √(ζt) takes part at first: there the beam is
//! a viscous half-space, whose end resists a change of velocity with the force `√ζ D^½`, a derivative of half an order. With
//! the penetration p = v t* P(t/t*) and the law F = p/ε,
//!
//! ```text
//! P' + I^½ P = 1,   P(0) = 0,      t* = (ε √ζ)^(2/3),
//! ```
//!
//! so that an impact takes the time t*, its peak penetration is 0.858 v (ε √ζ)^(2/3), and the force *grows* like ε^(-1/3). Three orders follow.
//!
//! | quantity | order in ε | why |
//! | --- | --- | --- |
//! | penetration of an impact, resolved in space and time | 2/3 | above |
//! | the same on a fixed mesh with a fixed dt, once t* < dt | 1 | the step averages the force, which then has a limit |
//! | penetration at rest | 1 | the force at rest has a limit |
//!
//! The fixed point contracts by `α = (dt/ε) [A_u⁻¹]_nn ≈ dt^(3/2) / (ε √ζ) = (dt/t*)^(3/2)`: it fails exactly where the time
//! step no longer resolves the impact. Newton's iterations do not depend on ε.

mod cases;
mod file;
mod judge;
mod report;
mod theory;

use convergence_study::judge::verdict::Judge;
use convergence_study::study::{Case, CaseFailure, Header, Kind, KindRow, Outcome, Ran, reader};

use crate::scene::Scene;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "rigid",
    read: reader::<RigidStudy>,
    why: "As epsilon falls the obstacles become rigid: penetration falls like epsilon at rest and on a fixed grid, like \
          epsilon^(2/3) in an impact that the grid resolves.",
    judged: "The observed orders in epsilon, Newton's iterations, and where the fixed point ceases to converge.",
    failure: "The contact law, or its solution in closed form, loses digits or stability for stiff obstacles.",
};

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidStudy {
    header: Header,
    /// Compliances, descending.
    epsilons: Vec<f64>,
    /// The compliance that stands for a rigid obstacle.
    limit: f64,
    judge: Judge,
    /// A beam that bounces, on a fixed mesh with a fixed dt.
    moving: Scene,
    /// Iterations after which the fixed point is given up.
    max_iterations: usize,
    /// A beam that comes to rest on an obstacle.
    resting: Scene,
    speed: f64,
    t_max: f64,
    /// A beam whose free end moves into the upper obstacle at t = 0, on a mesh graded towards that end.
    impact: Scene,
    /// Time steps in t*.
    steps: usize,
}

/// What a case computes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Task {
    /// Compliance of the obstacles.
    pub epsilon: f64,
    /// The computation.
    pub run: RunOf,
}

/// A computation with one compliance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunOf {
    /// The bouncing beam between obstacles that are all but rigid, by Newton's method.
    RigidLimit,
    /// The bouncing beam by Newton's method.
    Bouncing,
    /// The bouncing beam by the fixed point.
    FixedPoint,
    /// The beam that comes to rest on an obstacle.
    Rest,
    /// The impact, resolved in space and time.
    Impact,
}

/// What a case found.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Of [`RunOf::RigidLimit`] and [`RunOf::Bouncing`].
    Bouncing(Bouncing),
    /// Of [`RunOf::FixedPoint`].
    FixedPoint(FixedPointRun),
    /// Of [`RunOf::Rest`].
    Rest(Rest),
    /// Of [`RunOf::Impact`].
    Impact(Impact),
}

/// A bouncing beam by Newton's method. A penetration is ε times the contact force, which keeps the digits that the
/// difference u(1) - g loses.
#[derive(Debug, Clone, PartialEq)]
pub struct Bouncing {
    /// Largest contact force, in absolute value.
    pub force: f64,
    /// Largest penetration.
    pub penetration: f64,
    /// Iterations per step.
    pub mean_iterations: f64,
    /// Iterations of the step that took most.
    pub most_iterations: usize,
    /// (t, u(1, t)) of every level.
    pub tip: Vec<(f64, f64)>,
}

/// The bouncing beam by the fixed point, up to the step that fails.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedPointRun {
    /// Predicted contraction factor in contact.
    pub alpha: f64,
    /// Largest factor measured in contact, or that of the last increments of the step that fails; `None` where no step was
    /// in contact, and where the iterates overflowed.
    pub contraction: Option<f64>,
    /// Iterations per step done.
    pub mean_iterations: f64,
    /// Time of the step that fails, if one does.
    pub failed_at: Option<f64>,
}

/// A beam at rest on an obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// Contact force, in absolute value.
    pub force: f64,
    /// Penetration, ε times the force.
    pub penetration: f64,
}

/// The first impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Velocity of the free end at t = 0.
    pub velocity: f64,
    /// Peak of the contact force.
    pub force: f64,
    /// Peak of the penetration, ε times the force.
    pub penetration: f64,
}

impl Kind for RigidStudy {
    type Data = Task;
    type Found = Found;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<Task>> {
        cases::cases(self)
    }

    fn run(&self, task: &Task) -> Result<Found, CaseFailure> {
        cases::run(self, *task)
    }

    fn judge(&self, ran: &[Ran<Task, Found>]) -> Outcome {
        judge::judge(self, ran)
    }
}
