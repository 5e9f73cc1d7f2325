//! The paper's Section 5, sentence by sentence: seven experiments run until they are steady, the claims of the text judged,
//! its figures redrawn.
//!
//! # What is measured, and how
//!
//! | quantity | measured as |
//! | --- | --- |
//! | steady | the energy has fallen by at most `rate` per unit of time over the last `window` |
//! | frequency of u(1) | upward crossings of zero on [0, t_end]: (their number - 1) / (last - first), each interpolated |
//! | amplitude of φ(1) | largest minus smallest value on [0, t_end] |
//! | first contact | when the tip first passes the obstacle, interpolated |
//! | rests on | the contact force of the last step, and the tip's position |
//!
//! t_end is the scene's, the paper's 10: the span of its figures.
//!
//! # Where the paper's text goes too far
//!
//! It takes the experiment at β = -0.8 as evidence that for β < -1/2 there are several steady states. Between
//! -0.7116 and -1/2 there are not. With B = π²/4 / (1 + π²/4) = 0.711600 and without heating, steady states are the critical points of
//!
//! ```text
//! ½ (‖u_x - φ‖² + ‖φ_x‖² + β ‖u_x‖²) + ρ/4 ‖u_x‖⁴ + G(u(1)),
//! ```
//!
//! and `‖u_x - φ‖² + ‖φ_x‖² >= B ‖u_x‖²`: for β > -B this is strictly convex, so that the straight beam is the only one.
//! The study shows it twice: in the list of all exact steady states, and by where moving beams come to rest.

mod cases;
mod file;
mod judge;
mod motion;
mod report;
mod rest;
mod run;

use convergence_study::study::{Case, CaseFailure, Header, Kind, KindRow, Outcome, Ran, reader};
use thermobeam::equilibrium::{Contact, Equilibrium};
use thermobeam::mesh::Mesh;
use thermobeam::solve::Level;

use super::steady;
use crate::scene::Scene;
use convergence_study::text::number::max_or_nan;

pub use cases::{Found, Task};
pub use motion::Frame;
pub use rest::Rest;
pub use run::{Point, Run};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "experiment",
    read: reader::<Experiments>,
    why: "Section 5 of the paper says what its seven experiments show. Each statement is a condition on a run of ours.",
    judged: "One check a statement, with the numbers. Where a statement does not hold as printed, the check says what holds.",
    failure: "Our beam does not do what the paper's does, or the resolution is too coarse to tell.",
};

/// Which of the section's experiments, and so what is claimed of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// θ_A = 0, (5.4): the beam becomes straight.
    First,
    /// θ_A = 20, (5.5): the beam comes to rest in this state of contact.
    Second(Contact),
    /// Beyond buckling: the beam comes to rest bent.
    Third,
}

/// One of the experiments.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// Its part in the section.
    pub group: Group,
    /// The scene, at the study's resolution.
    pub scene: Scene,
}

/// When a run ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Until {
    /// A run that lasts longer fails.
    pub t_max: f64,
    /// Span over which the energy's fall is measured: longer than an oscillation, because at its turning points the beam
    /// stands still.
    pub window: f64,
    /// Fall of the energy per unit of time below which the state is steady.
    pub rate: f64,
}

/// How beams are run that only have to come to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToRest {
    /// Elements of a uniform mesh.
    pub elements: usize,
    /// Time step.
    pub dt: f64,
    /// Largest velocity of a beam at rest.
    pub speed: f64,
    /// A run that lasts longer fails.
    pub t_max: f64,
}

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiments {
    header: Header,
    experiments: Vec<Experiment>,
    until: Until,
    betas: Vec<f64>,
    rest: ToRest,
}

/// The exact steady state nearest to the end of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The state.
    pub state: Equilibrium,
    /// Largest difference over all nodes, in u and φ.
    pub distance: f64,
}

impl Nearest {
    fn of(mesh: &Mesh, level: &Level, states: &[Equilibrium]) -> Option<Self> {
        let (state, (in_u, in_phi)) = steady::nearest(mesh, level, states)?;
        Some(Self { state, distance: max_or_nan(in_u, in_phi) })
    }
}

impl Kind for Experiments {
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
