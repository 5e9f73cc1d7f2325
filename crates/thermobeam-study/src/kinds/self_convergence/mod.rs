//! Rates where no exact solution is known: the paper's own data, contact included.
//!
//! Two readings of the same runs, each with an interval by the rule that all rates are judged by:
//!
//! * *successive* (three-level Richardson): with `q_h = q + C h^p` the difference of neighbouring levels is
//!   `q_h - q_{h/2} = C (1 - 2^-p) h^p`: it falls with the order, and two of them (three levels) give a rate;
//! * *reference*: the difference to a run of any order, see [`crate::error::reference`]. Where h and dt are refined together it is
//!   the error against the equations themselves, contact included; where time alone is refined, against the semi-discrete
//!   system of the mesh. A second reference of other degrees and steps tells how well the first is known.
//!
//! A fault of the scheme that does not vanish with h and dt, such as a wrong coefficient, falls with no order in the second
//! reading, while the first does not see it.
//!
//! What the contact does is not assumed. The contact force is Lipschitz, so where the tip enters or leaves an obstacle it
//! has a kink in time. That costs one step a local error of dt² instead of dt³, once for each event: first and second order
//! should survive at fixed times, with a constant that depends on where in its step the event falls, so that rates scatter.
//! The largest displacement over all levels has no such claim: it sits beside the true maximum by a share of a step.
//! Only what the file claims under `[[expect]]` is judged; the rest is shown with the verdict that it would get.

mod cases;
mod figures;
mod file;
mod judge;
mod observable;

use convergence_study::study::levels::Claim;
use convergence_study::study::{Axis, Case, CaseFailure, Header, Kind, KindRow, Outcome, Ran, reader};
use thermobeam::mesh::Mesh;
use thermobeam::scheme::Scheme;
use thermobeam::solve::Level;

use crate::kinds::tables::Discretisation;
use crate::scene::Scene;
pub use observable::Observable;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "self-convergence",
    read: reader::<SelfConvergence>,
    why: "For the paper's own data there is no closed form: rates come from the differences of three levels (Richardson) and from \
          the distance to a run by another discretisation, elements of high degree and dG(q), contact included.",
    judged: "Each quantity's rate by the rule of every rate. Two references must agree to a hundredth of the finest error.",
    failure: "With contact and rough data the order is lost, or the levels are too coarse for it. Where only the distances to the \
              reference fail, scheme and reference solve different equations.",
};

/// A study of rates without exact solution.
#[derive(Debug, Clone, PartialEq)]
pub struct SelfConvergence {
    header: Header,
    scene: Scene,
    axis: Axis,
    scheme: Scheme,
    /// Coarse to fine; at least two.
    levels: Vec<Resolution>,
    /// dt = c h^power; 1 where time alone is refined.
    power: f64,
    /// The first is what levels are compared with.
    references: [Discretisation; 2],
    t_end: f64,
    /// Times of comparison.
    samples: usize,
    /// Must the tip meet an obstacle?
    contact: bool,
    /// What is claimed of both readings.
    claims: Vec<(Observable, Claim)>,
}

/// A level of refinement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resolution {
    /// Elements.
    pub elements: usize,
    /// Time steps.
    pub steps: usize,
}

/// A run of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Run {
    /// By the scheme of the study.
    Level(Resolution),
    /// The reference of this number.
    Reference(usize),
}

/// A run at a time of comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// The solution.
    pub level: Level,
    /// Its energy (3.9).
    pub energy: f64,
}

/// What is kept of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Traced {
    /// Its mesh, or the one that a reference is kept on.
    pub mesh: Mesh,
    /// Smallest and largest u(1) over all time levels.
    pub tip_range: [f64; 2],
    /// (t, u(1, t)), thinned to what a figure shows.
    pub tip: Vec<(f64, f64)>,
    /// At equidistant times, t = 0 left out.
    pub samples: Vec<Sample>,
}

impl Sample {
    fn tip(&self) -> f64 {
        self.level.u.last().copied().unwrap_or(f64::NAN)
    }

    fn rotation(&self) -> f64 {
        self.level.phi.last().copied().unwrap_or(f64::NAN)
    }
}

impl Kind for SelfConvergence {
    type Data = Run;
    type Found = Traced;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<Run>> {
        cases::cases(self)
    }

    fn run(&self, run: &Run) -> Result<Traced, CaseFailure> {
        cases::run(self, *run)
    }

    fn judge(&self, ran: &[Ran<Run, Traced>]) -> Outcome {
        judge::judge(self, ran)
    }
}
