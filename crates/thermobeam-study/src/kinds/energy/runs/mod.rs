//! Scenes run one by one: the energy of every step.

mod judge;
mod log;

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::study::{Case, CaseFailure, FromFile, Header, Kind, Outcome, Ran};
use thermobeam::mesh::Mesh;
use thermobeam::simulation::{Problem, Stepping};

use super::{End, Worst, beams, file};
use crate::run::simulate;
use crate::scene::Scene;

/// A study of this kind.
#[derive(Debug, Clone)]
pub struct Runs {
    pub(super) header: Header,
    pub(super) runs: Vec<Run>,
    pub(super) figures: Figures,
}

/// What the figures show of the runs that are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Figures {
    /// Energy and residual over time.
    Histories,
    /// The sum of the residuals over the steps.
    Drift,
}

/// A run, and what is claimed of it.
#[derive(Debug, Clone)]
pub(super) struct Run {
    pub(super) name: String,
    pub(super) origin: Origin,
    pub(super) stepping: Stepping,
    pub(super) steps: usize,
    /// In words.
    pub(super) claim: String,
    pub(super) end: End,
    /// Of rise and residual in a step.
    pub(super) bound: Bound,
    /// Bound of the sum of all residuals, in units of the energy.
    pub(super) drift: Option<f64>,
    pub(super) is_drawn: bool,
}

/// Where the problem of a run comes from.
#[derive(Debug, Clone)]
pub(super) enum Origin {
    Scene(Box<Scene>),
    /// A beam with random coefficients and smooth random data.
    Smooth {
        mesh: Mesh,
        seed: u64,
    },
}

/// What rise and residual of a step may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Bound {
    /// That share of the energy.
    Share(f64),
    /// 1e-12 of the energy, or the bound on the rounding errors of the step.
    Rounding,
}

/// What a run finds.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// How it ended.
    pub end: End,
    /// Steps done.
    pub steps: usize,
    /// Steps that ended in contact.
    pub contact_steps: usize,
    /// Most iterations in a step.
    pub most_iterations: usize,
    /// Size of the energy at t = 0: its terms without their signs.
    pub initial_energy: f64,
    /// Largest rise and residual of a step.
    pub worst: Worst,
    /// Sum of all residuals with their signs, in units of the energy.
    pub drift: f64,
    /// Samples for the figures.
    pub samples: Vec<Sample>,
}

/// A run after so many steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Number of the step.
    pub step: usize,
    /// Its time.
    pub t: f64,
    /// The energy.
    pub energy: f64,
    /// Largest residual of a step since the sample before, in units of the initial energy.
    pub residual: f64,
    /// Sum of all residuals so far, in units of the energy.
    pub drift: f64,
}

impl Run {
    fn elements(&self) -> usize {
        match &self.origin {
            Origin::Scene(scene) => scene.mesh.elements(),
            Origin::Smooth { mesh, .. } => mesh.elements(),
        }
    }

    fn problem(&self) -> Problem {
        match &self.origin {
            Origin::Scene(scene) => simulate::problem(scene),
            Origin::Smooth { mesh, seed } => beams::smooth(mesh, *seed),
        }
    }
}

impl FromFile for Runs {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        file::read(header, root, folder)
    }
}

impl Kind for Runs {
    /// Number of the run.
    type Data = usize;
    type Found = Found;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<usize>> {
        // Observing a step costs three times its solution, and a step some 100 ns beside its elements.
        let cost = |run: &Run| run.steps as f64 * (4.0 * run.elements() as f64 + 4.0);
        let case = |(data, run): (usize, &Run)| Case { label: run.name.clone(), cost: cost(run), data };
        self.runs.iter().enumerate().map(case).collect()
    }

    fn run(&self, index: &usize) -> Result<Found, CaseFailure> {
        log::run(&self.runs[*index])
    }

    fn judge(&self, ran: &[Ran<usize, Found>]) -> Outcome {
        judge::judge(self, ran)
    }
}
