//! Steady states over the axial force at rest: all branches, stable and unstable, and where moving
//! beams come to rest.
//!
//! The branches are exact. They are continued from β to β by their invariants: the state of
//! contact, the side and the number of unstable directions. Three independent answers are compared
//! at the buckling point: where the number of exact steady states changes, the buckling force of P1
//! elements as the mesh is refined, and `-(π²/4)/(1 + π²/4)`.

mod judge;

use std::cmp::Ordering;

use thermobeam::tridiagonal::TridiagonalFactor;

use super::prelude::*;
pub use super::steady::AtRest;
use super::steady::{ToRest, exact_states, listed_scenes, meshes, tolerance};
use crate::kinds::settings;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/bifurcation",
    read: reader::<BifurcationStudy>,
    why: "Below the buckling force -(pi^2/4)/(1 + pi^2/4) the straight beam is unstable and bent states appear; the branches are \
          followed over beta, and stability is an exact count.",
    judged: "The buckling point, found by counting states and by elements alone; and that moving beams end on stable branches.",
    failure: "Steady states are missed or invented, or the dynamics end where no stable state is.",
    settings: settings::of_branches,
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
    fn from_document(_: &Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "diagram", "buckling", "rest"])?;
        let diagram = root.table("diagram", &["scenes", "beta", "points"])?;
        let fits = |ends: &[f64]| ends.len() == 2 && increases(ends);
        let ends = diagram.list(
            "beta",
            "a list of two numbers, ascending",
            Field::number,
            fits,
        )?;
        let points = diagram.count("points", 2..=100_000)?;
        let beta = |k: usize| ends[0] + (ends[1] - ends[0]) * (k as f64 / (points - 1) as f64);
        let buckling = root.table("buckling", &["elements", "tolerance"])?;
        let rest = root.table("rest", &[&["distance"], &ToRest::KEYS[..]].concat())?;
        Ok(Self {
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

    /// A diagram for each scene, a discrete buckling force for each mesh, runs to rest.
    fn cases(&self) -> Vec<Case<DiagramTask>> {
        // Each β takes some 50 microseconds: as much as one step of 3000 elements.
        let cost = 3e3 * self.grid.len() as f64;
        let theta_a = |scene: usize| self.scenes[scene].beam.theta_a;
        let scenes = 0..self.scenes.len();
        let diagram = |k| {
            Case::new(
                format!("branches, θ_A = {}", theta_a(k)),
                cost,
                DiagramTask::Diagram(k),
            )
        };
        let force = |&n: &usize| {
            Case::new(
                format!("buckling force, n = {n}"),
                n as f64,
                DiagramTask::Buckling(n),
            )
        };
        let rest = |scene: usize, (k, beta): (usize, &f64)| {
            let label = format!("to rest, θ_A = {}, β = {beta}", theta_a(scene));
            Case::new(label, self.rest.cost(), DiagramTask::Rest(scene, k))
        };
        let rests = |scene: usize| {
            self.rest
                .betas
                .iter()
                .enumerate()
                .map(move |beta| rest(scene, beta))
        };
        let forces = self.meshes.iter().map(force);
        scenes
            .clone()
            .map(diagram)
            .chain(forces)
            .chain(scenes.flat_map(rests))
            .collect()
    }

    fn run(&self, task: &DiagramTask) -> Result<Found, CaseFailure> {
        Ok(match *task {
            DiagramTask::Diagram(scene) => Found::Diagram(self.diagram(&self.scenes[scene])?),
            DiagramTask::Buckling(n) => Found::Force(discrete_buckling_force(&Mesh::uniform(n)?)?),
            DiagramTask::Rest(scene, beta) => {
                Found::Rest(self.rest.run(&self.scenes[scene], beta)?)
            }
        })
    }

    fn judge(&self, ran: &[Ran<DiagramTask, Found>]) -> Outcome {
        judge::judge(self, ran)
    }
}

impl BifurcationStudy {
    fn diagram(&self, scene: &Scene) -> Result<Diagram, CaseFailure> {
        let coarse = sample(scene, &self.grid, 0)?;
        let event = bracket(scene, &coarse, BRACKET)?;
        let mut grid = self.grid.clone();
        if buckles(scene) && !event[0].is_nan() {
            // Additional points around a fork for its close-up.
            let close = |k: usize| event[0] + CLOSE * (2.0 * k as f64 / FORK_POINTS as f64 - 1.0);
            grid.extend((0..=FORK_POINTS).map(close));
            grid.sort_by(f64::total_cmp);
        }
        Ok(trace(&sample(scene, &grid, HALVINGS)?, event))
    }
}

/// Steady states of one branch, at consecutive β.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyBranch {
    /// What all its states have in common.
    key: BranchKey,
    /// `(β, u(1))`.
    pub points: Vec<(f64, f64)>,
}

/// The invariants of a branch: contact, side and number of unstable directions change only where
/// branches meet.
#[derive(Debug, Clone, Copy, PartialEq)]
struct BranchKey {
    contact: Phase,
    /// The side to which the beam bends.
    side: Option<Ordering>,
    stable: bool,
    unstable_directions: Option<usize>,
}

impl BranchKey {
    fn of(state: &Equilibrium) -> Self {
        let Equilibrium {
            contact,
            stable,
            unstable_directions,
            u_tip,
            ..
        } = *state;
        Self {
            contact,
            side: u_tip.partial_cmp(&0.0),
            stable,
            unstable_directions,
        }
    }
}

/// The steady states at one β.
struct StatesAt {
    beta: f64,
    states: Vec<Equilibrium>,
}

impl StatesAt {
    /// Steady states of the scene, with its β replaced.
    fn at(scene: &Scene, beta: f64) -> Result<Self, CaseFailure> {
        let mut scene = scene.clone();
        scene.beam.beta = beta;
        Ok(Self {
            beta,
            states: exact_states(&scene)?,
        })
    }

    fn keys(&self) -> Vec<BranchKey> {
        self.states.iter().map(BranchKey::of).collect()
    }
}

/// Halvings of an interval in which branches meet: a fork opens like a square root, so its tip
/// needs close points.
const HALVINGS: usize = 10;

/// The steady states over a grid; intervals in which branches begin, meet or end are halved up to
/// `halvings` times.
///
/// # Errors
/// β at which the steady states cannot be found.
fn sample(scene: &Scene, betas: &[f64], halvings: usize) -> Result<Vec<StatesAt>, CaseFailure> {
    let mut samples: Vec<StatesAt> = Vec::new();
    let mut patience = Patience::of_long_rounds();
    for (done, &beta) in betas.iter().enumerate() {
        patience.check(done, || beta)?;
        let next = StatesAt::at(scene, beta)?;
        if let Some(last) = samples.last() {
            let between = between(scene, last, &next, halvings)?;
            samples.extend(between);
        }
        samples.push(next);
    }
    Ok(samples)
}

/// The middle of an interval in which branches meet, between the same of both halves.
fn between(
    scene: &Scene,
    low: &StatesAt,
    high: &StatesAt,
    depth: usize,
) -> Result<Vec<StatesAt>, CaseFailure> {
    if depth == 0 || low.keys() == high.keys() {
        return Ok(vec![]);
    }
    let middle = StatesAt::at(scene, 0.5 * (low.beta + high.beta))?;
    let below = between(scene, low, &middle, depth - 1)?;
    let above = between(scene, &middle, high, depth - 1)?;
    Ok(below.into_iter().chain([middle]).chain(above).collect())
}

/// All branches, continued from each β to the next.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagram {
    /// The branches.
    pub branches: Vec<SteadyBranch>,
    /// β with the number of steady states.
    pub counts: Vec<(f64, usize)>,
    /// Steady states that could belong to either of two branches: must be none for the diagram to
    /// have a meaning.
    pub ambiguous: usize,
    /// Bracket of the β at which the beam buckles or lifts off; NaN if it does neither, or more
    /// than once.
    pub event: [f64; 2],
}

/// Traces all branches.
fn trace(samples: &[StatesAt], event: [f64; 2]) -> Diagram {
    let mut diagram = Diagram {
        branches: vec![],
        counts: vec![],
        ambiguous: 0,
        event,
    };
    let mut open: Vec<SteadyBranch> = Vec::new();
    for StatesAt { beta, states } in samples {
        diagram.counts.push((*beta, states.len()));
        let mut continued: Vec<SteadyBranch> = Vec::new();
        for state in states {
            let key = BranchKey::of(state);
            diagram.ambiguous += usize::from(continued.iter().any(|branch| branch.key == key));
            let before = open.iter().position(|branch| branch.key == key);
            let mut branch = before.map_or_else(
                || SteadyBranch {
                    key,
                    points: vec![],
                },
                |k| open.swap_remove(k),
            );
            branch.points.push((*beta, state.u_tip));
            continued.push(branch);
        }
        diagram.branches.append(&mut open);
        open = continued;
    }
    diagram.branches.append(&mut open);
    diagram
}

/// Whether the event of a scene is buckling of its straight beam: below it there are several steady
/// states, above it one. A heated beam lifts off instead: below the event it presses against the
/// upper obstacle, above it is free.
fn buckles(scene: &Scene) -> bool {
    scene.beam.theta_a == 0.0
}

/// Brackets the event by bisection, starting from the samples; NaN if it does not occur exactly
/// once.
///
/// # Errors
/// β at which the steady states cannot be found.
fn bracket(scene: &Scene, samples: &[StatesAt], width: f64) -> Result<[f64; 2], CaseFailure> {
    let is_before = |at: &StatesAt| match buckles(scene) {
        true => at.states.len() > 1,
        false => at.states.iter().any(|state| state.contact == Phase::Upper),
    };
    let before: Vec<bool> = samples.iter().map(is_before).collect();
    let changes: Vec<usize> = (1..before.len())
        .filter(|&k| before[k - 1] != before[k])
        .collect();
    let [mut low, mut high] = match changes[..] {
        [k] if before[0] => [samples[k - 1].beta, samples[k].beta],
        _ => return Ok([f64::NAN; 2]),
    };
    while high - low > width {
        let middle = StatesAt::at(scene, 0.5 * (low + high))?;
        *(if is_before(&middle) {
            &mut low
        } else {
            &mut high
        }) = middle.beta;
    }
    Ok([low, high])
}

/// Iterations of the power method, with ratio 0.043/0.288 of the first two modes: three times as
/// many as needed.
const ITERATIONS: usize = 60;

/// The buckling force of the beam on a mesh, `min (‖v_x - w‖² + ‖w_x‖²) / ‖v_x‖²` over P1 functions
/// v and w that vanish at 0.
///
/// For given p = v_x, constant on each element, the best w solves `(K + M) w = (p, N_i)`, and
/// leaves `‖p‖² - (p, w)`. So the minimum is 1 - λ, where λ is the largest eigenvalue of p -> mean
/// of w on each element.
///
/// # Errors
/// A pivot that is not positive, which no mesh produces.
fn discrete_buckling_force(mesh: &Mesh) -> Result<f64, StepFailure> {
    let lengths: Vec<f64> = mesh.lengths().collect();
    let n = lengths.len();
    let mut factor = TridiagonalFactor::new(n);
    factor.factorize(&lengths, 1.0, 1.0, 0.0)?;
    let (mut p, mut lambda) = (vec![1.0; n], f64::NAN);
    for _ in 0..ITERATIONS {
        let mut w = vec![0.0; n + 1];
        for (i, h) in lengths.iter().enumerate() {
            w[i] += 0.5 * h * p[i];
            w[i + 1] += 0.5 * h * p[i];
        }
        w[0] = 0.0;
        factor.solve_in_place(&mut w);
        let image: Vec<f64> = w.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
        lambda = product(&lengths, &p, &image) / product(&lengths, &p, &p);
        let norm = product(&lengths, &image, &image).sqrt();
        p = image.into_iter().map(|value| value / norm).collect();
    }
    Ok(1.0 - lambda)
}

fn product(lengths: &[f64], p: &[f64], q: &[f64]) -> f64 {
    lengths
        .iter()
        .zip(p.iter().zip(q))
        .map(|(h, (p, q))| h * p * q)
        .sum()
}
