//! Random scenes by the thousand: every coefficient over its whole range, strongly graded meshes, rough data, steps up to 10.
//!
//! Newton's method runs eight scenes in lanes.
//!
//! A step may be refused for one reason only: its operator is not definite. With `‖V_x - W‖² + ‖W_x‖² >= B ‖V_x‖²`, B the
//! buckling force, it is definite where `B (ζ + dt/2) + m dt/2 > 0`, and the mean axial force m is never below β. So every
//! scene with `β > -B (1 + 2 ζ/dt)` must end with its answer.
//!
//! ```toml
//! [random]
//! batches = 64       # of 256 scenes, with 1 to 32 elements; the scheme changes from batch to batch
//! steps = 20
//! seed = 1
//! ```

mod batch;
mod judge;
mod report;

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::study::{Case, CaseFailure, FromFile, Header, Kind, Outcome, Ran};
use thermobeam::mesh::MeshError;
use thermobeam::scheme::{SCHEMES, Scheme};
use thermobeam::simulation::Problem;

use super::{End, Worst, beams};
use crate::scene::limits;

/// Scenes in the lanes of one solver, all with the same number of elements.
const LANES: usize = 8;
/// Groups of lanes in a batch: one for each number of elements, from 1 on.
const GROUPS: usize = 32;
/// Scenes in a batch.
const BATCH: usize = LANES * GROUPS;

/// A study of random scenes.
#[derive(Debug, Clone)]
pub struct RandomScenes {
    header: Header,
    batches: usize,
    steps: usize,
    seed: u64,
}

/// What a batch finds.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// How its scenes end.
    pub ends: Ends,
    /// Scenes refused though their operators are definite.
    pub refused: usize,
    /// Steps of all scenes.
    pub steps: usize,
    /// Levels accepted by the solver with a number that is not finite.
    pub not_finite_levels: usize,
    /// Largest rise and residual of a step.
    pub worst: Worst,
    /// Scenes with a residual above 1e-12 of the energy.
    pub exceptions: usize,
    /// Those of them with the largest residuals.
    pub largest: Vec<Exception>,
    /// Each scene with its largest residual.
    pub scenes: Vec<Scene>,
}

/// Numbers of scenes by their ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Ends {
    /// With their answers.
    pub answers: usize,
    /// At an indefinite operator.
    pub indefinite: usize,
    /// At the limit of iterations.
    pub iteration_limit: usize,
    /// At a number that is not finite.
    pub not_finite: usize,
}

/// A scene with a residual above 1e-12 of the energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exception {
    /// Its number in the study.
    pub scene: usize,
    /// Its largest residual, in units of the energy.
    pub residual: f64,
}

/// What the rounding errors of a scene depend on most, and its largest residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scene {
    /// Time step.
    pub dt: f64,
    /// Length of the shortest element.
    pub shortest: f64,
    /// Largest residual of a step, in units of the energy.
    pub residual: f64,
}

impl Ends {
    fn count(&mut self, end: End) {
        *match end {
            End::Answer => &mut self.answers,
            End::Indefinite => &mut self.indefinite,
            End::IterationLimit => &mut self.iteration_limit,
            End::NotFinite => &mut self.not_finite,
        } += 1;
    }

    fn errors(self) -> usize {
        self.indefinite + self.iteration_limit + self.not_finite
    }

    fn sum(self, other: Self) -> Self {
        Self {
            answers: self.answers + other.answers,
            indefinite: self.indefinite + other.indefinite,
            iteration_limit: self.iteration_limit + other.iteration_limit,
            not_finite: self.not_finite + other.not_finite,
        }
    }
}

impl RandomScenes {
    fn scheme(&self, batch: usize) -> Scheme {
        SCHEMES[batch % SCHEMES.len()]
    }

    /// Problem and time step of a scene.
    fn problem(&self, scene: usize) -> Result<(Problem, f64), MeshError> {
        let elements = scene % BATCH / LANES + 1;
        // Far from the seeds of other studies, which are small.
        beams::wild(elements, (self.seed << 32) + scene as u64)
    }
}

impl FromFile for RandomScenes {
    fn from_document(header: Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "random"])?;
        let section = root.require("random", "a table with batches, steps and seed")?.section()?;
        section.allow(&["batches", "steps", "seed"])?;
        let number = "a whole number";
        Ok(Self {
            header,
            batches: section.require("batches", number)?.count(1..=100_000)?,
            steps: section.require("steps", number)?.count(1..=limits::STEPS)?,
            seed: section.require("seed", number)?.count(0..=u32::MAX as usize)? as u64,
        })
    }
}

impl Kind for RandomScenes {
    /// Number of the batch.
    type Data = usize;
    type Found = Batch;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<usize>> {
        // 16 elements on average, and an observed step costs some 100 ns an element.
        let cost = (BATCH * self.steps * GROUPS / 2) as f64 * 4.0;
        let label = |batch: usize| format!("scenes {} to {}", batch * BATCH, (batch + 1) * BATCH - 1);
        (0..self.batches).map(|batch| Case { label: label(batch), cost, data: batch }).collect()
    }

    fn run(&self, batch: &usize) -> Result<Batch, CaseFailure> {
        batch::run(self, *batch)
    }

    fn judge(&self, ran: &[Ran<usize, Batch>]) -> Outcome {
        judge::judge(self, ran)
    }
}
