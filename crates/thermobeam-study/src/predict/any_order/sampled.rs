//! A scene of any order, run for its curves alone, and the differences of two such runs.

use std::f64::consts::PI;
use std::time::{Duration, Instant};

use convergence_study::run::time_limit::Patience;
use convergence_study::text::number::max_or_nan;
use thermobeam::dg::{Field, Level, Simulation};

use super::Cost;
use crate::run::any_order::AnyOrderFailure;
use crate::scene::Scene;

/// Times of comparison in a step, its end among them: dense at its ends, since a layer at the start of a step is shorter than that.
pub(super) const POINTS: usize = 12;

/// Steps of the largest length that are compared, at most: the others of a longer run are left out evenly.
const MOST_LONG_STEPS: f64 = 20_000.0;

/// Curves at given times.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Curves {
    /// u(1, t).
    pub(super) u: Vec<f64>,
    /// φ(1, t); empty unless asked for.
    pub(super) phi: Vec<f64>,
    /// The energy; empty unless asked for.
    pub(super) energy: Vec<f64>,
}

/// A time of comparison of a run's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Instance {
    /// The time.
    pub(super) t: f64,
    /// Time since the start or the last contact event.
    pub(super) since: f64,
    /// Whether the step is longer than steps far from an event are at its distance from the last one: a smaller `restart_dt` shortens it.
    pub(super) early: bool,
}

/// What is wanted of a run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted<'a> {
    /// Times, which increase, at which the run is compared with another.
    pub(super) at: &'a [f64],
    /// Times, which increase, at which a step ends: its end is of higher order than its inside.
    pub(super) ends: &'a [f64],
    /// Whether the curves at times inside the run's own steps are wanted.
    pub(super) own: bool,
    /// Whether φ and the energy are wanted beside u.
    pub(super) all: bool,
}

/// A run's curves.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Sampled {
    /// At the times asked for.
    pub(super) at: Curves,
    /// At the ends of steps asked for.
    pub(super) ends: Curves,
    /// Times inside the run's own steps and at their ends.
    pub(super) times: Vec<Instance>,
    /// At those times.
    pub(super) own: Curves,
    /// Smallest and largest u(1, t), between all those times as well.
    pub(super) range: [f64; 2],
    /// What the run has cost.
    pub(super) cost: Cost,
}

impl Sampled {
    /// The times of the run's own.
    pub(super) fn own_times(&self) -> Vec<f64> {
        self.times.iter().map(|instance| instance.t).collect()
    }
}

/// Runs the scene and samples it.
///
/// # Errors
/// The solver's own words: a scene that it refuses, a step that fails, or the time limit.
pub(super) fn sample(scene: &Scene, wanted: Wanted<'_>) -> Result<Sampled, String> {
    let stepping = scene.dg_stepping();
    let mut simulation = Simulation::new(scene.dg_problem(), stepping).map_err(|error| error.to_string())?;
    let unknowns = 3 * simulation.space().blocks() * (stepping.degree + 1);
    let mut patience = Patience::new(unknowns / 3);
    let mut watch = Watch::new(scene, wanted, &simulation);
    let mut wall = Duration::ZERO;
    loop {
        let failed = |failure: AnyOrderFailure| failure.to_string();
        patience.check(simulation.work().steps, || simulation.t()).map_err(|up| failed(up.into()))?;
        let limit = wanted.ends.get(watch.ended).copied().unwrap_or(scene.t_end);
        let started = Instant::now();
        let step = simulation.step(limit).map_err(|error| failed(error.into()))?;
        wall += started.elapsed();
        if step.is_none() {
            break;
        }
        watch.step(&simulation);
    }
    let mut sampled = watch.sampled;
    let solves = simulation.work().solves;
    sampled.cost = Cost { unknown_solves: unknowns as f64 * solves as f64, seconds: wall.as_secs_f64(), runs: 1 };
    Ok(sampled)
}

/// What is seen of the steps.
struct Watch<'a> {
    wanted: Wanted<'a>,
    sampled: Sampled,
    level: Level,
    /// How many of the times and of the ends asked for are behind.
    passed: usize,
    ended: usize,
    /// Distance from an event below which steps are early.
    early: f64,
    dt: f64,
    t_end: f64,
    /// Of so many steps of the largest length one is compared.
    stride: usize,
    long: usize,
}

impl<'a> Watch<'a> {
    fn new(scene: &Scene, wanted: Wanted<'a>, simulation: &Simulation) -> Self {
        let stepping = scene.dg_stepping();
        Self {
            wanted,
            sampled: Sampled { range: simulation.tip_range(), ..Sampled::default() },
            level: simulation.level().clone(),
            passed: 0,
            ended: 0,
            early: stepping.restart_dt / (stepping.growth - 1.0),
            dt: stepping.dt,
            t_end: scene.t_end,
            stride: (scene.t_end / stepping.dt / MOST_LONG_STEPS).ceil().max(1.0) as usize,
            long: 0,
        }
    }

    fn step(&mut self, simulation: &Simulation) {
        let (from, to) = (simulation.old_level().t, simulation.t());
        while let Some(&t) = self.wanted.at.get(self.passed).filter(|t| **t <= to) {
            self.read(simulation, t, |sampled| &mut sampled.at);
            self.passed += 1;
        }
        if self.wanted.ends.get(self.ended) == Some(&to) {
            self.read(simulation, to, |sampled| &mut sampled.ends);
            self.ended += 1;
        }
        if self.wanted.own && self.is_compared(to - from, to) {
            let event = simulation.events().iter().rev().map(|event| event.t).find(|t| *t <= from).unwrap_or(0.0);
            let early = from - event < self.early;
            for point in 1..=POINTS {
                let s = 0.5 * (1.0 - (PI * point as f64 / POINTS as f64).cos());
                let t = if point == POINTS { to } else { from + s * (to - from) };
                self.sampled.times.push(Instance { t, since: t - event, early });
                self.read(simulation, t, |sampled| &mut sampled.own);
            }
        }
        let ([low, high], [least, most]) = (simulation.tip_range(), self.sampled.range);
        self.sampled.range = [-max_or_nan(-least, -low), max_or_nan(most, high)];
    }

    /// Whether a step of this length and end is one that is compared.
    fn is_compared(&mut self, length: f64, end: f64) -> bool {
        if length < self.dt || end >= self.t_end {
            return true;
        }
        self.long += 1;
        self.long.is_multiple_of(self.stride)
    }

    fn read(&mut self, simulation: &Simulation, t: f64, to: impl FnOnce(&mut Sampled) -> &mut Curves) {
        let curves = to(&mut self.sampled);
        if self.wanted.all {
            simulation.level_into(t, &mut self.level);
            let at = |field| self.level.value_and_slope(simulation.space(), field, 1.0).0;
            curves.u.push(at(Field::U));
            curves.phi.push(at(Field::Phi));
            curves.energy.push(simulation.energy(&self.level).total());
        } else {
            curves.u.push(simulation.value(Field::U, 1.0, t).unwrap_or(f64::NAN));
        }
    }
}

/// The largest differences of u(1, t) between a run, at the times of its own, and another.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Apart {
    /// In early steps.
    pub(super) early: f64,
    /// In the others.
    pub(super) late: f64,
    /// Time since the last event, or the start, where the difference is largest.
    pub(super) since: f64,
}

impl Apart {
    /// Between `own` and `other`, which was sampled at the times of `own`; NaN where the curves do not match.
    pub(super) fn of(own: &Sampled, other: &Sampled) -> Self {
        if own.own.u.len() != other.at.u.len() || own.own.u.is_empty() {
            return Self { early: f64::NAN, late: f64::NAN, since: 0.0 };
        }
        let mut apart = Self::default();
        for (instance, (u, v)) in own.times.iter().zip(own.own.u.iter().zip(&other.at.u)) {
            let difference = (u - v).abs();
            if !(difference <= apart.most()) {
                apart.since = instance.since;
            }
            let part = if instance.early { &mut apart.early } else { &mut apart.late };
            *part = max_or_nan(*part, difference);
        }
        apart
    }

    /// In all steps.
    pub(super) fn most(&self) -> f64 {
        max_or_nan(self.early, self.late)
    }
}
