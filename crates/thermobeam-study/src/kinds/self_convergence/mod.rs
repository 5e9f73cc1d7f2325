//! Rates where no exact solution is known: the paper's own data, contact included.
//!
//! Two readings of the same runs, each with an interval by the rule that all rates are judged by:
//!
//! * *successive* (three-level Richardson): with `q_h = q + C h^p` the difference of neighbouring levels is
//!   `q_h - q_{h/2} = C (1 - 2^-p) h^p`: it falls with the order, and two of them (three levels) give a rate;
//! * *reference*: the difference to a much finer run. That run's own error bends the finest rates by the factor
//!   `1 - (h_ref/h)^p`; a reference by another scheme, of higher order, bends less and is an independent witness.
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

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::study::levels::Claim;
use convergence_study::study::{Axis, Case, CaseFailure, FromFile, Header, Kind, KindRow, Outcome, Ran, reader};
use thermobeam::mesh::Mesh;
use thermobeam::scheme::Scheme;
use thermobeam::solve::Level;

use crate::scene::Scene;
pub use observable::Observable;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "self-convergence",
    read: reader::<SelfConvergence>,
    why: "For the paper's own data there is no exact solution: rates come from the differences of three levels (Richardson) and \
          from the distance to a much finer run, contact included.",
    judged: "Each quantity's rate by the rule of every rate. A wrong coefficient cannot be seen in this way; a lost order can.",
    failure: "With contact and rough data the order is lost, or the levels are too coarse for it.",
};

/// A study of rates without exact solution.
#[derive(Debug, Clone, PartialEq)]
pub struct SelfConvergence {
    header: Header,
    scene: Scene,
    axis: Axis,
    /// Coarse to fine, the reference last; at least three.
    runs: Vec<Resolution>,
    t_end: f64,
    /// Times of comparison.
    samples: usize,
    /// Must the tip meet an obstacle?
    contact: bool,
    /// What is claimed of both readings.
    claims: Vec<(Observable, Claim)>,
}

/// What a run of the scene is done with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolution {
    /// Elements.
    pub elements: usize,
    /// Time steps.
    pub steps: usize,
    /// The time scheme.
    pub scheme: Scheme,
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
    /// Its mesh.
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

impl FromFile for SelfConvergence {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        file::read(header, root, folder)
    }
}

impl Kind for SelfConvergence {
    type Data = Resolution;
    type Found = Traced;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<Resolution>> {
        cases::cases(self)
    }

    fn run(&self, resolution: &Resolution) -> Result<Traced, CaseFailure> {
        cases::run(self, *resolution)
    }

    fn judge(&self, ran: &[Ran<Resolution, Traced>]) -> Outcome {
        judge::judge(self, ran)
    }
}
