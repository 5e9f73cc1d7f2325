//! Steady states over the axial force at rest: all branches, stable and unstable, and where moving beams come to rest.
//!
//! The branches are exact: they are continued from β to β by what stays the same along them, the state of contact, the side
//! and the number of unstable directions. Three independent answers are compared at the buckling point: where the number of
//! exact steady states changes, the buckling force of P1 elements as the mesh is refined, and `-(π²/4)/(1 + π²/4)`.

mod branches;
mod buckling;
mod cases;
mod file;
mod judge;
mod report;

use convergence_study::study::{Case, CaseFailure, Header, Kind, KindRow, Outcome, Ran, reader};

use crate::scene::Scene;

pub use branches::{Branch, Diagram};
pub use cases::{Found, Rest, Task};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "bifurcation",
    read: reader::<BifurcationStudy>,
    why: "Below the buckling force -(pi^2/4)/(1 + pi^2/4) the straight beam is unstable and bent states appear; the branches are \
          followed over beta, and stability is an exact count.",
    judged: "The buckling point, found by counting states and by elements alone; and that moving beams end on stable branches.",
    failure: "Steady states are missed or invented, or the dynamics end where no stable state is.",
};

/// Half the width of the picture of a fork.
const CLOSE: f64 = 0.025;

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct BifurcationStudy {
    header: Header,
    /// One diagram each; their β is overridden.
    scenes: Vec<Scene>,
    /// β of the diagrams.
    grid: Vec<f64>,
    /// Meshes of the discrete buckling force.
    meshes: Vec<usize>,
    /// Of its rate about the order 2.
    tolerance: f64,
    /// β at which beams move and come to rest.
    betas: Vec<f64>,
    elements: usize,
    dt: f64,
    speed: f64,
    t_max: f64,
    /// How far from an exact steady state they may be.
    distance: f64,
}

impl Kind for BifurcationStudy {
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
