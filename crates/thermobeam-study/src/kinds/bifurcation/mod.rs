//! Steady states over the axial force at rest: all branches, stable and unstable, and where moving beams come to rest.
//!
//! The branches are exact. They are continued from β to β by their invariants: the state of contact, the side and the
//! number of unstable directions. Three independent answers are compared at the buckling point: where the number of exact
//! steady states changes, the buckling force of P1 elements as the mesh is refined, and `-(π²/4)/(1 + π²/4)`.

mod branches;
mod judge;

use super::prelude::*;
pub use super::steady::AtRest;
use super::steady::{ToRest, listed_scenes, meshes, tolerance};
pub use branches::{Diagram, SteadyBranch};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "bifurcation",
    read: reader::<BifurcationStudy>,
    why: "Below the buckling force -(pi^2/4)/(1 + pi^2/4) the straight beam is unstable and bent states appear; the branches are \
          followed over beta, and stability is an exact count.",
    judged: "The buckling point, found by counting states and by elements alone; and that moving beams end on stable branches.",
    failure: "Steady states are missed or invented, or the dynamics end where no stable state is.",
};

/// Half the width of the close-up of a fork.
const CLOSE: f64 = 0.025;

/// Width to which an event is bracketed.
const BRACKET: f64 = 1e-9;

/// Points of the close-up of a fork.
const FORK_POINTS: usize = 80;

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct BifurcationStudy {
    header: Header,
    /// One diagram for each scene; their β is overridden.
    scenes: Vec<Scene>,
    /// β of the diagrams.
    grid: Vec<f64>,
    /// Meshes of the discrete buckling force.
    meshes: Vec<usize>,
    /// Tolerance of its rate about the order 2.
    tolerance: f64,
    rest: ToRest,
    /// Allowed distance from an exact steady state.
    distance: f64,
}

/// What a case computes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DiagramTask {
    /// The branches of a scene, by its place in the list.
    Diagram(usize),
    /// The buckling force for this number of elements.
    Buckling(usize),
    /// A moving beam until it comes to rest: indices of scene and β.
    Rest(usize, usize),
}

/// What a case finds.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// The branches.
    Diagram(Diagram),
    /// The buckling force of P1 elements, positive.
    Force(f64),
    /// Where a moving beam came to rest.
    Rest(AtRest),
}

impl FromFile for BifurcationStudy {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "diagram", "buckling", "rest"])?;
        let diagram = root.table("diagram", &["scenes", "beta", "points"])?;
        let fits = |ends: &[f64]| ends.len() == 2 && increases(ends);
        let ends = diagram.list("beta", "a list of two numbers, ascending", Field::number, fits)?;
        let points = diagram.count("points", 2..=100_000)?;
        let beta = |k: usize| ends[0] + (ends[1] - ends[0]) * (k as f64 / (points - 1) as f64);
        let buckling = root.table("buckling", &["elements", "tolerance"])?;
        let rest = root.table("rest", &[&["distance"], &ToRest::KEYS[..]].concat())?;
        Ok(Self {
            header,
            scenes: listed_scenes(&diagram, folder)?,
            grid: (0..points).map(beta).collect(),
            meshes: meshes(&buckling)?,
            tolerance: tolerance(&buckling)?,
            rest: ToRest::read(&rest)?,
            distance: rest.positive("distance")?,
        })
    }
}

impl Kind for BifurcationStudy {
    type Data = DiagramTask;
    type Found = Found;

    fn header(&self) -> &Header {
        &self.header
    }

    /// A diagram for each scene, a discrete buckling force for each mesh, runs to rest.
    fn cases(&self) -> Vec<Case<DiagramTask>> {
        // Each β takes some 50 microseconds: as much as one step of 3000 elements.
        let diagram = |(k, scene): (usize, &Scene)| Case {
            label: format!("branches, θ_A = {}", scene.beam.theta_a),
            cost: 3e3 * self.grid.len() as f64,
            data: DiagramTask::Diagram(k),
        };
        let force = |&n: &usize| Case {
            label: format!("buckling force, n = {n}"),
            cost: n as f64,
            data: DiagramTask::Buckling(n),
        };
        let rest = |scene: usize, beta: usize| Case {
            label: format!("to rest, θ_A = {}, β = {}", self.scenes[scene].beam.theta_a, self.rest.betas[beta]),
            cost: self.rest.cost(),
            data: DiagramTask::Rest(scene, beta),
        };
        let rests =
            (0..self.scenes.len()).flat_map(|scene| (0..self.rest.betas.len()).map(move |beta| rest(scene, beta)));
        self.scenes.iter().enumerate().map(diagram).chain(self.meshes.iter().map(force)).chain(rests).collect()
    }

    fn run(&self, task: &DiagramTask) -> Result<Found, CaseFailure> {
        Ok(match *task {
            DiagramTask::Diagram(scene) => Found::Diagram(self.diagram(&self.scenes[scene])?),
            DiagramTask::Buckling(n) => Found::Force(branches::discrete_buckling_force(&Mesh::uniform(n)?)?),
            DiagramTask::Rest(scene, beta) => Found::Rest(self.rest.run(&self.scenes[scene], beta)?),
        })
    }

    fn judge(&self, ran: &[Ran<DiagramTask, Found>]) -> Outcome {
        judge::judge(self, ran)
    }
}

impl BifurcationStudy {
    fn diagram(&self, scene: &Scene) -> Result<Diagram, CaseFailure> {
        let coarse = branches::sample(scene, &self.grid, 0)?;
        let event = branches::bracket(scene, &coarse, BRACKET)?;
        let mut grid = self.grid.clone();
        if branches::buckles(scene) && !event[0].is_nan() {
            // Additional points around a fork for its close-up.
            let close = |k: usize| event[0] + CLOSE * (2.0 * k as f64 / FORK_POINTS as f64 - 1.0);
            grid.extend((0..=FORK_POINTS).map(close));
            grid.sort_by(f64::total_cmp);
        }
        Ok(branches::trace(&branches::sample(scene, &grid, branches::HALVINGS)?, event))
    }
}
