//! Branches of exact steady states over β.

use convergence_study::run::time_limit::Patience;
use thermobeam::equilibrium::{Contact, Equilibrium};

use crate::kinds::prelude::*;
use crate::kinds::steady::exact_states;

/// Steady states of one branch, at consecutive β.
#[derive(Debug, Clone, PartialEq)]
pub struct Branch {
    /// State of contact of all of them.
    pub contact: Contact,
    /// Whether they are stable.
    pub stable: bool,
    /// `(β, u(1))`.
    pub points: Vec<(f64, f64)>,
    key: Key,
}

/// What stays the same along a branch: contact, side and the number of unstable directions change only where branches meet.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Key {
    contact: Contact,
    side: Side,
    stable: bool,
    unstable_directions: Option<usize>,
}

/// The side to which the beam is bent.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Straight,
    Up,
    Down,
}

impl Key {
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
pub(super) struct Sample {
    beta: f64,
    states: Vec<Equilibrium>,
}

impl Sample {
    /// The steady states of the scene with another β.
    fn at(scene: &Scene, beta: f64) -> Result<Self, CaseFailure> {
        let mut scene = scene.clone();
        scene.beam.beta = beta;
        Ok(Self { beta, states: exact_states(&scene)? })
    }

    fn keys(&self) -> Vec<Key> {
        self.states.iter().map(Key::of).collect()
    }
}

/// Halvings of an interval in which branches meet: a fork opens like a square root, so that its tip needs points close by.
pub(super) const HALVINGS: usize = 10;

/// The steady states over a grid, which is halved up to `halvings` times where branches begin, meet or end.
///
/// # Errors
/// β at which the steady states cannot be told.
pub(super) fn sample(scene: &Scene, betas: &[f64], halvings: usize) -> Result<Vec<Sample>, CaseFailure> {
    let mut samples: Vec<Sample> = Vec::new();
    let mut patience = Patience::of_long_rounds();
    for (done, &beta) in betas.iter().enumerate() {
        patience.check(done, || beta)?;
        let next = Sample::at(scene, beta)?;
        if let Some(last) = samples.last() {
            let mut between = Vec::new();
            refine(scene, last, &next, halvings, &mut between)?;
            between.sort_by(|a: &Sample, b| a.beta.total_cmp(&b.beta));
            samples.extend(between);
        }
        samples.push(next);
    }
    Ok(samples)
}

/// Adds the middle of an interval in which branches meet, and refines both halves.
fn refine(
    scene: &Scene,
    low: &Sample,
    high: &Sample,
    depth: usize,
    found: &mut Vec<Sample>,
) -> Result<(), CaseFailure> {
    if depth == 0 || low.keys() == high.keys() {
        return Ok(());
    }
    let middle = Sample::at(scene, 0.5 * (low.beta + high.beta))?;
    refine(scene, low, &middle, depth - 1, found)?;
    refine(scene, &middle, high, depth - 1, found)?;
    found.push(middle);
    Ok(())
}

/// All branches, continued from each β to the next.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagram {
    /// The branches.
    pub branches: Vec<Branch>,
    /// β with the number of steady states.
    pub counts: Vec<(f64, usize)>,
    /// Steady states that could belong to either of two branches: none, or the diagram means nothing.
    pub ambiguous: usize,
    /// Bracket of the β at which the beam buckles or lifts off; NaN where it does not, or more than once.
    pub event: [f64; 2],
}

/// Traces all branches.
pub(super) fn trace(samples: &[Sample], event: [f64; 2]) -> Diagram {
    let mut diagram = Diagram { branches: vec![], counts: vec![], ambiguous: 0, event };
    let mut open: Vec<Branch> = Vec::new();
    for Sample { beta, states } in samples {
        diagram.counts.push((*beta, states.len()));
        let mut continued: Vec<Branch> = Vec::new();
        for state in states {
            let key = Key::of(state);
            diagram.ambiguous += usize::from(continued.iter().any(|branch| branch.key == key));
            let before = open.iter().position(|branch| branch.key == key);
            let mut branch = before.map_or_else(|| Branch::new(key), |k| open.swap_remove(k));
            branch.points.push((*beta, state.u_tip));
            continued.push(branch);
        }
        diagram.branches.append(&mut open);
        open = continued;
    }
    diagram.branches.append(&mut open);
    diagram
}

impl Branch {
    fn new(key: Key) -> Self {
        Self { contact: key.contact, stable: key.stable, points: vec![], key }
    }
}

/// What changes qualitatively somewhere between two β.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Event {
    /// Below there are several steady states, above one.
    Buckling,
    /// Below the beam presses against the upper obstacle, above it is free.
    LiftOff,
}

impl Event {
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
pub(super) fn bracket(scene: &Scene, samples: &[Sample], width: f64) -> Result<[f64; 2], CaseFailure> {
    let event = Event::of(scene);
    let before: Vec<bool> = samples.iter().map(|sample| event.is_before(&sample.states)).collect();
    let changes: Vec<usize> = (1..before.len()).filter(|&k| before[k - 1] != before[k]).collect();
    let &[k] = changes.as_slice() else { return Ok([f64::NAN; 2]) };
    if !before[0] {
        return Ok([f64::NAN; 2]);
    }
    let [mut low, mut high] = [samples[k - 1].beta, samples[k].beta];
    while high - low > width {
        let middle = Sample::at(scene, 0.5 * (low + high))?;
        if event.is_before(&middle.states) {
            low = middle.beta;
        } else {
            high = middle.beta;
        }
    }
    Ok([low, high])
}
