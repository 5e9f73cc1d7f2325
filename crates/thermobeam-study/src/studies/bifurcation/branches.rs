//! The branches of steady states over β, continued by their invariants.

use std::cmp::Ordering;

use convergence_judge::{interval::Interval, time_limit::Patience};
use thermobeam_exact::equilibrium::{Equilibrium, EquilibriumError, Phase, Proof, enclose_change};

use crate::scene::Scene;
use crate::studies::steady::exact_states;
use convergence_study::CaseFailure;

/// Half the width of the close-up of a fork.
pub(super) const CLOSE: f64 = 0.025;

/// Width to which an event is bracketed.
pub(super) const BRACKET: f64 = 1e-9;

/// The bracket of an event that is not there, or not once.
const UNKNOWN: Interval = Interval {
    low: f64::NAN,
    high: f64::NAN,
};

/// Points of the close-up of a fork.
const FORK_POINTS: usize = 80;

/// Names of branches, in the order of the legend.
const NAMES: [&str; 4] = [
    "straight",
    "bent, free",
    "on the upper obstacle",
    "on the lower obstacle",
];

/// Steady states of one branch, at consecutive β.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyBranch {
    /// What all its states have in common.
    pub(super) key: BranchKey,
    /// `(β, u(1))`.
    pub points: Vec<(f64, f64)>,
}

/// The invariants of a branch: contact, side and number of unstable directions change only where
/// branches meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BranchKey {
    contact: Phase,
    /// The side to which the beam bends.
    side: Option<Ordering>,
    pub(super) stable: bool,
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

    /// The place of its name in the legend.
    pub(super) fn place(&self) -> usize {
        match (self.contact, self.side) {
            (Phase::Free, Some(Ordering::Equal)) => 0,
            (Phase::Free, _) => 1,
            (Phase::Upper, _) => 2,
            (Phase::Lower, _) => 3,
        }
    }

    pub(super) fn name(&self) -> &'static str {
        NAMES[self.place()]
    }

    /// The straight beam is one branch, whatever the number of its unstable directions.
    pub(super) fn is_straight(&self) -> bool {
        self.place() == 0
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

    /// Whether it is on the side of the event where the straight beam is buckled, or the heated
    /// beam pressed.
    fn is_before(&self, scene: &Scene) -> bool {
        if buckles(scene) {
            self.states.len() > 1
        } else {
            self.states
                .iter()
                .any(|state| state.contact == Phase::Upper)
        }
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
    pub event: Interval,
    /// Bounds between which the event is proved to be; NaN if it is not proved.
    pub proved: Interval,
}

impl Diagram {
    /// The diagram of a scene over these β; its own β is overridden.
    ///
    /// # Errors
    /// β at which the steady states cannot be found.
    pub(super) fn of(scene: &Scene, betas: &[f64]) -> Result<Self, CaseFailure> {
        let event = bracket(scene, &sample(scene, betas, 0)?)?;
        let mut grid = betas.to_vec();
        if buckles(scene) && !event.low.is_nan() {
            // Additional points around a fork for its close-up.
            for k in 0..=FORK_POINTS {
                grid.push(event.low + CLOSE * (2.0 * k as f64 / FORK_POINTS as f64 - 1.0));
            }
            grid.sort_by(f64::total_cmp);
        }
        let mut diagram = Self::trace(&sample(scene, &grid, HALVINGS)?, event);
        diagram.proved = proved(scene, event)?;
        Ok(diagram)
    }

    /// Traces all branches.
    fn trace(samples: &[StatesAt], event: Interval) -> Self {
        let mut diagram = Self {
            branches: vec![],
            counts: vec![],
            ambiguous: 0,
            event,
            proved: UNKNOWN,
        };
        let mut open: Vec<SteadyBranch> = vec![];
        for StatesAt { beta, states } in samples {
            diagram.counts.push((*beta, states.len()));
            let mut continued: Vec<SteadyBranch> = vec![];
            for state in states {
                let key = BranchKey::of(state);
                diagram.ambiguous += usize::from(continued.iter().any(|branch| branch.key == key));
                let mut branch = match open.iter().position(|branch| branch.key == key) {
                    Some(place) => open.swap_remove(place),
                    None => SteadyBranch {
                        key,
                        points: vec![],
                    },
                };
                branch.points.push((*beta, state.u_tip));
                continued.push(branch);
            }
            diagram.branches.append(&mut open);
            open = continued;
        }
        diagram.branches.append(&mut open);
        diagram
    }
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
fn bracket(scene: &Scene, samples: &[StatesAt]) -> Result<Interval, CaseFailure> {
    let changes: Vec<&[StatesAt]> = samples
        .windows(2)
        .filter(|pair| pair[0].is_before(scene) != pair[1].is_before(scene))
        .collect();
    let [mut low, mut high] = match changes[..] {
        [[last, first]] if last.is_before(scene) => [last.beta, first.beta],
        _ => return Ok(UNKNOWN),
    };
    while high - low > BRACKET {
        let middle = StatesAt::at(scene, 0.5 * (low + high))?;
        if middle.is_before(scene) {
            low = middle.beta;
        } else {
            high = middle.beta;
        }
    }
    Ok(Interval { low, high })
}

/// Half the width in which the event is enclosed: the answers at its ends are proved.
const AROUND: f64 = 1e-6;

/// Encloses the event by proofs of the steady states on both sides of it.
///
/// # Errors
/// A coefficient out of range.
fn proved(scene: &Scene, event: Interval) -> Result<Interval, CaseFailure> {
    let is_before = |proof: &Proof| {
        let count = proof.count()?;
        Some(if buckles(scene) {
            count > 1
        } else {
            let mut contacts = proof.states.iter().map(|state| state.contact);
            contacts.any(|contact| contact == Phase::Upper)
        })
    };
    if event.low.is_nan() {
        return Ok(UNKNOWN);
    }
    let ends = [event.low - AROUND, event.high + AROUND];
    let change = enclose_change(&scene.beam, scene.obstacles.as_ref(), ends, is_before)
        .map_err(EquilibriumError::from)?;
    Ok(change.map_or(UNKNOWN, |change| Interval {
        low: change.lo,
        high: change.hi,
    }))
}
