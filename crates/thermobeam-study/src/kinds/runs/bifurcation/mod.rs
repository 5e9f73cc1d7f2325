//! Steady states over the axial force at rest: all branches, stable and unstable, and where moving
//! beams come to rest.
//!
//! The branches are exact. They are continued from β to β by their invariants: the state of
//! contact, the side and the number of unstable directions. Three independent answers are compared
//! at the buckling point: where the number of exact steady states changes, the buckling force of P1
//! elements as the mesh is refined, and `-(π²/4)/(1 + π²/4)`.

mod branches;
mod buckling;
mod judge;

pub use super::steady::AtRest;
use super::{
    Findings, Results, RunStudy, Runs,
    steady::{self, ToRest, listed_scenes, meshes, tolerance},
};
use crate::kinds::prelude::*;
use crate::{
    kinds::{
        interval::SampledInterval,
        settings::{Exercise, Integration},
    },
    scene::Scene,
};
pub use branches::Diagram;
use buckling::discrete_buckling_force;
use thermobeam::mesh::Mesh;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/bifurcation",
    keys: Bifurcation::KEYS,
    read: read_study::<RunStudy<Bifurcation>>,
    why: "Below the buckling force -(pi^2/4)/(1 + pi^2/4) the straight beam is unstable and bent states appear; the branches are \
          followed over beta, and stability is an exact count.",
    judged: "The buckling point, found by counting states and by elements alone; and that moving beams end on stable branches.",
    failure: "Steady states are missed or invented, or the dynamics end where no stable state is.",
};

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct Bifurcation {
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
pub enum BifurcationResult {
    /// The branches.
    Diagram(Diagram),
    /// The buckling force of P1 elements, positive.
    Force(f64),
    /// Where a moving beam came to rest.
    Rest(AtRest),
}

impl BifurcationResult {
    fn diagram(&self) -> &Diagram {
        match self {
            Self::Diagram(diagram) => diagram,
            other => unreachable!("a diagram shows {other:?}"),
        }
    }

    fn force(&self) -> f64 {
        match self {
            Self::Force(force) => *force,
            other => unreachable!("a buckling force shows {other:?}"),
        }
    }

    fn rest(&self) -> &AtRest {
        match self {
            Self::Rest(rest) => rest,
            other => unreachable!("a run to rest shows {other:?}"),
        }
    }
}

const KEYS: [Key; 3] = [
    Key::new(
        "diagram",
        Form::Table(&[&[&DIAGRAM]]),
        "steady states over β",
    ),
    Key::new(
        "buckling",
        Form::Table(&[&[&BUCKLING_KEYS]]),
        "the buckling force of meshes",
    ),
    Key::new(
        "rest",
        Form::Table(&[&[&DISTANCE, &ToRest::KEYS]]),
        "moving beams until they rest",
    ),
];
const DIAGRAM: [Key; 3] = [
    steady::SCENES,
    Key::new(
        "beta",
        Form::List(&Form::Number),
        "the least and the greatest β",
    ),
    Key::new("points", Form::Count(2), "values of β, equally spaced"),
];
const BUCKLING_KEYS: [Key; 2] = [steady::MESHES, steady::TOLERANCE];
const DISTANCE: [Key; 1] = [Key::new(
    "distance",
    Form::Positive,
    "of a beam at rest to a stable state",
)];

impl Runs for Bifurcation {
    const KEYS: &'static [Keys] = &[&[&KEYS]];

    type Run = DiagramTask;
    type Shown = BifurcationResult;

    fn from_document(root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let diagram = root.table("diagram", &[&DIAGRAM])?;
        let beta = SampledInterval::read(&diagram, "beta", false)?;
        let points = diagram.count("points", 2..=100_000)?;
        let buckling = root.table("buckling", &[&BUCKLING_KEYS])?;
        let rest = root.table("rest", &[&DISTANCE, &ToRest::KEYS])?;
        Ok(Self {
            scenes: listed_scenes(&diagram, folder)?,
            grid: beta.values(points),
            meshes: meshes(&buckling)?,
            tolerance: tolerance(&buckling)?,
            rest: ToRest::read(&rest)?,
            distance: rest.positive("distance")?,
        })
    }

    fn exercise(&self, case: Option<&str>) -> Exercise {
        Exercise::of_scenes("steady states", Integration::Exact, &self.scenes, case)
    }

    /// A diagram for each scene, a discrete buckling force for each mesh, runs to rest.
    fn runs(&self) -> Vec<Case<DiagramTask>> {
        // Each β takes some 50 microseconds: as much as one step of 3000 elements.
        let cost = 3e3 * self.grid.len() as f64;
        let mut runs = vec![];
        for (k, scene) in self.scenes.iter().enumerate() {
            let label = format!("branches, θ_A = {}", scene.beam.theta_a);
            runs.push(Case::new(label, cost, DiagramTask::Diagram(k)));
        }
        for &n in &self.meshes {
            let label = format!("buckling force, n = {n}");
            runs.push(Case::new(label, n as f64, DiagramTask::Buckling(n)));
        }
        for (k, scene) in self.scenes.iter().enumerate() {
            for (place, beta) in self.rest.betas.iter().enumerate() {
                let label = format!("to rest, θ_A = {}, β = {beta}", scene.beam.theta_a);
                runs.push(Case::new(
                    label,
                    self.rest.cost(),
                    DiagramTask::Rest(k, place),
                ));
            }
        }
        runs
    }

    fn run(&self, task: &DiagramTask) -> Result<BifurcationResult, CaseFailure> {
        Ok(match *task {
            DiagramTask::Diagram(k) => {
                BifurcationResult::Diagram(Diagram::of(&self.scenes[k], &self.grid)?)
            }
            DiagramTask::Buckling(n) => {
                BifurcationResult::Force(discrete_buckling_force(&Mesh::uniform(n)?)?)
            }
            DiagramTask::Rest(k, place) => {
                BifurcationResult::Rest(self.rest.run(&self.scenes[k], place)?)
            }
        })
    }

    fn numbers(&self, _: &DiagramTask, found: &BifurcationResult) -> Vec<Reading> {
        match found {
            BifurcationResult::Diagram(diagram) => vec![
                Reading::new("event, below", diagram.event.low),
                Reading::new("event, above", diagram.event.high),
            ],
            BifurcationResult::Force(force) => vec![Reading::new("force", *force)],
            BifurcationResult::Rest(rest) => vec![
                Reading::new("u(1)", rest.tip[0]),
                Reading::new("distance", rest.distance()),
            ],
        }
    }

    fn judge(&self, results: &Results<'_, Self>) -> Findings {
        judge::judge(self, results)
    }
}
