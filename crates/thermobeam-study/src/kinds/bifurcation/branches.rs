//! Branches of exact steady states over β, and the buckling force from P1 matrices alone, independent of the branches.

use std::cmp::Ordering;

use thermobeam::tridiagonal::TridiagonalFactor;

use crate::kinds::prelude::*;
use crate::kinds::steady::exact_states;

/// Steady states of one branch, at consecutive β.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyBranch {
    /// What all its states have in common.
    pub(super) key: BranchKey,
    /// `(β, u(1))`.
    pub points: Vec<(f64, f64)>,
}

/// The invariants of a branch: contact, side and number of unstable directions change only where branches meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BranchKey {
    pub(super) contact: Contact,
    /// The side to which the beam bends.
    side: Option<Ordering>,
    pub(super) stable: bool,
    unstable_directions: Option<usize>,
}

impl BranchKey {
    fn of(state: &Equilibrium) -> Self {
        let Equilibrium { contact, stable, unstable_directions, u_tip, .. } = *state;
        Self { contact, side: u_tip.partial_cmp(&0.0), stable, unstable_directions }
    }
}

/// The steady states at one β.
pub(super) struct StatesAt {
    beta: f64,
    states: Vec<Equilibrium>,
}

impl StatesAt {
    /// Steady states of the scene, with its β replaced.
    fn at(scene: &Scene, beta: f64) -> Result<Self, CaseFailure> {
        let mut scene = scene.clone();
        scene.beam.beta = beta;
        Ok(Self { beta, states: exact_states(&scene)? })
    }

    fn keys(&self) -> Vec<BranchKey> {
        self.states.iter().map(BranchKey::of).collect()
    }
}

/// Halvings of an interval in which branches meet: a fork opens like a square root, so its tip needs close points.
pub(super) const HALVINGS: usize = 10;

/// The steady states over a grid; intervals in which branches begin, meet or end are halved up to `halvings` times.
///
/// # Errors
/// β at which the steady states cannot be found.
pub(super) fn sample(scene: &Scene, betas: &[f64], halvings: usize) -> Result<Vec<StatesAt>, CaseFailure> {
    let mut samples: Vec<StatesAt> = Vec::new();
    let mut patience = Patience::of_long_rounds();
    for (done, &beta) in betas.iter().enumerate() {
        patience.check(done, || beta)?;
        let next = StatesAt::at(scene, beta)?;
        if let Some(last) = samples.last() {
            let mut between = Vec::new();
            refine(scene, last, &next, halvings, &mut between)?;
            between.sort_by(|a: &StatesAt, b| a.beta.total_cmp(&b.beta));
            samples.extend(between);
        }
        samples.push(next);
    }
    Ok(samples)
}

/// Adds the middle of an interval in which branches meet, and refines both halves.
fn refine(
    scene: &Scene,
    low: &StatesAt,
    high: &StatesAt,
    depth: usize,
    found: &mut Vec<StatesAt>,
) -> Result<(), CaseFailure> {
    if depth == 0 || low.keys() == high.keys() {
        return Ok(());
    }
    let middle = StatesAt::at(scene, 0.5 * (low.beta + high.beta))?;
    refine(scene, low, &middle, depth - 1, found)?;
    refine(scene, &middle, high, depth - 1, found)?;
    found.push(middle);
    Ok(())
}

/// All branches, continued from each β to the next.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagram {
    /// The branches.
    pub branches: Vec<SteadyBranch>,
    /// β with the number of steady states.
    pub counts: Vec<(f64, usize)>,
    /// Steady states that could belong to either of two branches: must be none for the diagram to have a meaning.
    pub ambiguous: usize,
    /// Bracket of the β at which the beam buckles or lifts off; NaN if it does neither, or more than once.
    pub event: [f64; 2],
}

/// Traces all branches.
pub(super) fn trace(samples: &[StatesAt], event: [f64; 2]) -> Diagram {
    let mut diagram = Diagram { branches: vec![], counts: vec![], ambiguous: 0, event };
    let mut open: Vec<SteadyBranch> = Vec::new();
    for StatesAt { beta, states } in samples {
        diagram.counts.push((*beta, states.len()));
        let mut continued: Vec<SteadyBranch> = Vec::new();
        for state in states {
            let key = BranchKey::of(state);
            diagram.ambiguous += usize::from(continued.iter().any(|branch| branch.key == key));
            let before = open.iter().position(|branch| branch.key == key);
            let mut branch = before.map_or_else(|| SteadyBranch { key, points: vec![] }, |k| open.swap_remove(k));
            branch.points.push((*beta, state.u_tip));
            continued.push(branch);
        }
        diagram.branches.append(&mut open);
        open = continued;
    }
    diagram.branches.append(&mut open);
    diagram
}

/// Whether the event of a scene is buckling of its straight beam: below it there are several steady states, above it one. A heated beam
/// lifts off instead: below the event it presses against the upper obstacle, above it is free.
pub(super) fn buckles(scene: &Scene) -> bool {
    scene.beam.theta_a == 0.0
}

/// Brackets the event by bisection, starting from the samples; NaN if it does not occur exactly once.
///
/// # Errors
/// β at which the steady states cannot be found.
pub(super) fn bracket(scene: &Scene, samples: &[StatesAt], width: f64) -> Result<[f64; 2], CaseFailure> {
    let is_before = |at: &StatesAt| match buckles(scene) {
        true => at.states.len() > 1,
        false => at.states.iter().any(|state| state.contact == Contact::Upper),
    };
    let before: Vec<bool> = samples.iter().map(is_before).collect();
    let changes: Vec<usize> = (1..before.len()).filter(|&k| before[k - 1] != before[k]).collect();
    let &[k] = changes.as_slice() else { return Ok([f64::NAN; 2]) };
    if !before[0] {
        return Ok([f64::NAN; 2]);
    }
    let [mut low, mut high] = [samples[k - 1].beta, samples[k].beta];
    while high - low > width {
        let middle = StatesAt::at(scene, 0.5 * (low + high))?;
        if is_before(&middle) {
            low = middle.beta;
        } else {
            high = middle.beta;
        }
    }
    Ok([low, high])
}

/// Iterations of the power method, with ratio 0.043/0.288 of the first two modes: three times as many as needed.
const ITERATIONS: usize = 60;

/// The buckling force of the beam on a mesh, `min (‖v_x - w‖² + ‖w_x‖²) / ‖v_x‖²` over P1 functions v and w that vanish at 0.
///
/// For given p = v_x, constant on each element, the best w solves `(K + M) w = (p, N_i)`, and leaves `‖p‖² - (p, w)`. So
/// the minimum is 1 - λ, where λ is the largest eigenvalue of p -> mean of w on each element.
///
/// # Errors
/// A pivot that is not positive, which no mesh produces.
pub(super) fn discrete_buckling_force(mesh: &Mesh) -> Result<f64, StepFailure> {
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
    lengths.iter().zip(p.iter().zip(q)).map(|(h, (p, q))| h * p * q).sum()
}
