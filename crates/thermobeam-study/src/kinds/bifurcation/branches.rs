//! Branches of exact steady states over β.

use crate::kinds::prelude::*;
use crate::kinds::steady::exact_states;

/// Steady states of one branch, at consecutive β.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyBranch {
    /// What all of them have in common.
    pub(super) key: BranchKey,
    /// `(β, u(1))`.
    pub points: Vec<(f64, f64)>,
}

/// What stays the same along a branch: contact, side and the number of unstable directions change only where branches meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BranchKey {
    pub(super) contact: Contact,
    side: Side,
    pub(super) stable: bool,
    unstable_directions: Option<usize>,
}

/// The side to which the beam is bent.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Straight,
    Up,
    Down,
}

impl BranchKey {
    fn of(state: &Equilibrium) -> Self {
        let side = match state.u_tip {
            u if u > 0.0 => Side::Up,
            u if u < 0.0 => Side::Down,
            _ => Side::Straight,
        };
        let Equilibrium { contact, stable, unstable_directions, .. } = *state;
        Self { contact, side, stable, unstable_directions }
    }
}

/// The steady states at one β.
pub(super) struct StatesAt {
    beta: f64,
    states: Vec<Equilibrium>,
}

impl StatesAt {
    /// The steady states of the scene with another β.
    fn at(scene: &Scene, beta: f64) -> Result<Self, CaseFailure> {
        let mut scene = scene.clone();
        scene.beam.beta = beta;
        Ok(Self { beta, states: exact_states(&scene)? })
    }

    fn keys(&self) -> Vec<BranchKey> {
        self.states.iter().map(BranchKey::of).collect()
    }
}

/// Halvings of an interval in which branches meet: a fork opens like a square root, so that its tip needs points close by.
pub(super) const HALVINGS: usize = 10;

/// The steady states over a grid, which is halved up to `halvings` times where branches begin, meet or end.
///
/// # Errors
/// β at which the steady states cannot be told.
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
    /// Steady states that could belong to either of two branches: none, or the diagram means nothing.
    pub ambiguous: usize,
    /// Bracket of the β at which the beam buckles or lifts off; NaN where it does not, or more than once.
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

/// What changes qualitatively somewhere between two β.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BranchEvent {
    /// Below there are several steady states, above one.
    Buckling,
    /// Below the beam presses against the upper obstacle, above it is free.
    LiftOff,
}

impl BranchEvent {
    /// What happens to a straight beam is buckling, what happens to a heated one is lifting off.
    pub(super) fn of(scene: &Scene) -> Self {
        if scene.beam.theta_a == 0.0 { Self::Buckling } else { Self::LiftOff }
    }

    fn is_before(self, states: &[Equilibrium]) -> bool {
        match self {
            Self::Buckling => states.len() > 1,
            Self::LiftOff => states.iter().any(|state| state.contact == Contact::Upper),
        }
    }
}

/// Brackets the event by bisection, starting from the samples; NaN where it does not happen, or more than once.
///
/// # Errors
/// β at which the steady states cannot be told.
pub(super) fn bracket(scene: &Scene, samples: &[StatesAt], width: f64) -> Result<[f64; 2], CaseFailure> {
    let event = BranchEvent::of(scene);
    let before: Vec<bool> = samples.iter().map(|sample| event.is_before(&sample.states)).collect();
    let changes: Vec<usize> = (1..before.len()).filter(|&k| before[k - 1] != before[k]).collect();
    let &[k] = changes.as_slice() else { return Ok([f64::NAN; 2]) };
    if !before[0] {
        return Ok([f64::NAN; 2]);
    }
    let [mut low, mut high] = [samples[k - 1].beta, samples[k].beta];
    while high - low > width {
        let middle = StatesAt::at(scene, 0.5 * (low + high))?;
        if event.is_before(&middle.states) {
            low = middle.beta;
        } else {
            high = middle.beta;
        }
    }
    Ok([low, high])
}
