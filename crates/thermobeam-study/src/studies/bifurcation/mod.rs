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

use super::paper::{Experiment, FIRST, SECOND};
use super::prelude::*;
pub use crate::studies::steady::AtRest;
use crate::studies::steady::{MethodToRest, ToRest};
pub use branches::Diagram;
use buckling::discrete_buckling_force;
use thermobeam::mesh::Mesh;

/// What the study says about itself.
pub const ABOUT: About = About {
    id: "bifurcation",
    claim: "The beam buckles at beta = -(pi^2/4)/(1 + pi^2/4) = -0.711600, and moving beams come to rest on stable branches",
    tier: Tier::Quick,
    group: "steady states",
    home: file!(),
};

/// Cold and heated; their own β are not used.
const SCENES: [Experiment; 2] = [FIRST[1], SECOND[1]];
/// Least and greatest β of the diagrams, and how many between; more where branches meet.
const BETA: [f64; 2] = [-1.0, 1.0];
const POINTS: usize = 201;
/// Meshes of the discrete buckling force.
const MESHES: [usize; 5] = [8, 16, 32, 64, 128];
/// β of the beams that move until they rest.
const RESTS: [f64; 22] = [
    -1.0, -0.95, -0.9, -0.85, -0.8, -0.75, -0.73, -0.72, -0.715, -0.71, -0.7, -0.65, -0.6, -0.5,
    -0.4, -0.2, 0.0, 0.2, 0.4, 0.6, 0.8, 1.0,
];

/// How they are run.
const TO_REST: ToRest = ToRest {
    method: MethodToRest::OneStep {
        elements: 32,
        dt: 0.1,
    },
    speed: 1e-8,
    t_max: 3000.0,
};

/// The branches, the buckling forces and the runs to rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bifurcation;

/// The study.
pub fn study() -> Described<Bifurcation> {
    ABOUT.study(Bifurcation)
}

/// β of the diagrams.
fn grid() -> Vec<f64> {
    let [low, high] = BETA;
    let share = |k: usize| k as f64 / (POINTS - 1) as f64;
    (0..POINTS).map(|k| low + (high - low) * share(k)).collect()
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

impl Kind for Bifurcation {
    type Data = DiagramTask;
    type Found = BifurcationResult;

    /// A diagram for each scene, a discrete buckling force for each mesh, runs to rest.
    fn cases(&self) -> Vec<Case<DiagramTask>> {
        // Each β takes some 50 microseconds: as much as one step of 3000 elements.
        let cost = 3e3 * POINTS as f64;
        let mut runs = vec![];
        for (k, scene) in SCENES.iter().enumerate() {
            let label = format!("branches, θ_A = {}", scene.theta_a);
            let parts = scene.parts().against(Known::SteadyStates);
            let case = Case::new(label, cost, DiagramTask::Diagram(k));
            runs.push(case.described(&parts));
        }
        for n in MESHES {
            let label = format!("buckling force, n = {n}");
            runs.push(Case::new(label, n as f64, DiagramTask::Buckling(n)));
        }
        for (k, scene) in SCENES.iter().enumerate() {
            for (place, beta) in RESTS.iter().enumerate() {
                let label = format!("to rest, θ_A = {}, β = {beta}", scene.theta_a);
                let task = DiagramTask::Rest(k, place);
                let scene = Experiment {
                    beta: *beta,
                    ..*scene
                };
                let parts = scene.parts().on(true).against(Known::SteadyStates);
                let parts = parts.by_the_paper(Solver::Newton);
                runs.push(Case::new(label, TO_REST.cost(), task).described(&parts));
            }
        }
        runs
    }

    fn run(&self, task: &DiagramTask) -> Result<BifurcationResult, CaseFailure> {
        Ok(match *task {
            DiagramTask::Diagram(k) => {
                BifurcationResult::Diagram(Diagram::of(&SCENES[k].scene()?, &grid())?)
            }
            DiagramTask::Buckling(n) => {
                BifurcationResult::Force(discrete_buckling_force(&Mesh::uniform(n)?)?)
            }
            DiagramTask::Rest(k, place) => {
                BifurcationResult::Rest(TO_REST.run(&SCENES[k].scene()?, RESTS[place])?)
            }
        })
    }

    fn judge(&self, ran: &[Ran<DiagramTask, BifurcationResult>]) -> Outcome {
        Outcome::of_complete(self, ran, judge::judge)
    }
}
