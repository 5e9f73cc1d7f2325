//! Ask a scene of any order for an accuracy: degrees, elements and steps that make an error no larger than wanted.
//!
//! A discretisation is judged by two comparisons in the curve u(1, t), at several times inside each of its steps: with a finer
//! space (p + 4, or the longest elements halved) and with finer steps. Finer steps have half the length *everywhere*: dt,
//! `restart_dt` and `growth - 1` are halved, since at a distance s from a contact event a step is about `(growth - 1) s` long;
//! `restart_dt` is halved twice. The difference estimates the error of the coarser run: p + 4 leaves up to a third of the error where
//! elements do not resolve a layer, half the steps leave less. If a difference exceeds half of the target, space or time is refined
//! according to their ratio, and both runs are compared again. The first two steps are refined for on their own before.
//!
//! * The start: initial data that break the condition at x = 1 make u(1, t) like t^(3/2). The error has its peak inside the first
//!   steps, which `restart_dt` alone makes shorter, and in the element at x = 1, which is split.
//! * Steps: during an impact, of duration (ε √ζ)^(2/3), u_tt behaves like t^(1/2); there the error inside steps has its peak,
//!   which ends of steps do not show. The degree q helps between impacts, short steps within.
//! * Elements: the last one, at x = 1, covers the layer that an impact sends into the beam; its width is √(ζ t) after the time t.
//!
//! ```
//! use thermobeam_study::predict::any_order::choose;
//! use thermobeam_study::scene::Scene;
//!
//! let text = "[initial]\nu_t = \"x\"\n[time]\nscheme = \"dg\"\nt_end = 1.0";
//! let scene = Scene::parse(text, "swing.toml")?;
//! let choice = choose(&scene, 1e-7)?;
//! assert!(choice.expected_error() <= 1e-7);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod budget;
mod sampled;

use std::ops::AddAssign;

use thermobeam::dg::{MAX_DEGREE, MAX_TIME_DEGREE, Stepping};
use thermobeam::mesh::Mesh;
use thiserror::Error;

use crate::scene::{Method, Scene};
pub use budget::{Budget, Estimate, Kind, Source, estimate};
use sampled::{Apart, Sampled, Wanted, sample};

/// Share of the target that each of the two differences may take.
const SHARE: f64 = 0.5;

/// The error in x falls at least by this for each degree, in the worst of the scenes measured: a front after an impact.
const FALL_PER_DEGREE: f64 = 1.8;

/// Rate of the error inside steps near a contact event, where u_tt behaves like t^(1/2).
const EVENT_RATE: f64 = 2.5;

/// Rate of the error in the first steps after the start, where data that break a condition at x = 1 make u_tt like t^(-1/2).
const START_RATE: f64 = 1.5;

/// What `restart_dt` is divided by in one go, at least and at most.
const SHORTENED: [f64; 2] = [2.0, 32.0];

/// A layer at x = 1 is resolved if its width is so many times that of the finest detail an element shows there, its length / p².
const RESOLVED: f64 = 12.0;

/// Halvings of all steps in one go: a difference that is too large tells no more.
const MOST_HALVINGS: i32 = 2;

/// Degrees that the finer space has more: with two, the difference is half of the error where a layer is not resolved.
const FINER_DEGREES: usize = 4;

/// Degrees added in one go, and the degree from which on elements are halved instead.
const MOST_DEGREES: usize = 8;
const HIGHEST_DEGREE: usize = 27;

/// Growth of steps below which it is kept: they would never reach dt.
const LEAST_GROWTH: f64 = 1.02;

/// Ratio of the distances of neighbouring nodes from x = 1.
const GRADING: f64 = 6.0;

/// Part of the longest element from which on elements are halved: shorter ones wait until the others have come closer.
const LONG: f64 = 0.25;

/// Most elements that are tried.
const MOST_ELEMENTS: usize = 64;

/// What is refused where no finer elements are to be had.
const FINEST: &str = "the elements are as fine as they get";

/// Rounds of refinement: each at least halves something.
const ROUNDS: usize = 14;

/// Unknowns times solves of the costliest run that is begun: some ten minutes.
const MOST_UNKNOWN_SOLVES: f64 = 2e10;

/// A round that lowers the difference by less than this has not paid.
const STALLED: f64 = 0.7;

/// Difference below which a round that has not paid has met round-off: that of the solver's own stopping rule, 1e-14 a step.
const ROUND_OFF: f64 = 1e-11;

/// What runs have cost.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Cost {
    /// Unknowns of a step times linear solves: the same on every machine.
    pub unknown_solves: f64,
    /// Seconds in steps.
    pub seconds: f64,
    /// Runs.
    pub runs: usize,
}

impl AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.unknown_solves += other.unknown_solves;
        self.seconds += other.seconds;
        self.runs += other.runs;
    }
}

/// The discretisation chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The scene with the mesh, the degrees and the steps chosen.
    pub scene: Scene,
    /// Largest difference of u(1, t) to a finer space.
    pub space: f64,
    /// Largest difference of u(1, t) to finer steps.
    pub time: f64,
    /// What all runs made to find it have cost, the last comparisons included.
    pub checks: Cost,
    /// What the run chosen costs.
    pub run: Cost,
    /// The finer space of the last comparison, in words.
    pub finer_space: String,
}

impl Choice {
    /// The error that the run is estimated to make.
    pub fn expected_error(&self) -> f64 {
        self.space + self.time
    }
}

/// Why there is no such run.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Unreachable {
    /// The target is not a positive number.
    #[error("target error {target}: expected a finite number > 0")]
    Target {
        /// As asked for.
        target: f64,
    },
    /// Refinement came to its end.
    #[error(
        "an error of {target:.3e} in u(1, t) was not reached: {reason}{}",
        reachable(*reached, *space, *time)
    )]
    NotReached {
        /// As asked for.
        target: f64,
        /// The smallest target that the comparisons would have met.
        reached: f64,
        /// Its part of space.
        space: f64,
        /// Its part of time.
        time: f64,
        /// What stopped it.
        reason: &'static str,
    },
    /// A run did not come to its end.
    #[error("a run to compare with failed: {0}")]
    Run(String),
}

/// What can be reached, in words; nothing before the first comparison.
fn reachable(reached: f64, space: f64, time: f64) -> String {
    if reached.is_finite() {
        format!("; about {reached:.1e} can be reached (space {space:.1e}, time {time:.1e})")
    } else {
        String::new()
    }
}

/// Chooses degrees, elements and steps.
///
/// * `scene`: its own mesh, degrees and steps do not matter.
/// * `target`: bound on the largest error of u(1, t) over [0, `t_end`], inside steps included.
///
/// # Errors
/// [`Unreachable`]: why there is no such run, and the error that was reached.
pub fn choose(scene: &Scene, target: f64) -> Result<Choice, Unreachable> {
    if !(target > 0.0 && target.is_finite()) {
        return Err(Unreachable::Target { target });
    }
    let mut search = Search::new(target);
    let begun = search.begin(&first(scene, target));
    Search { spent: search.spent, ..Search::new(target) }.refine(begun)
}

/// Two finer runs and how far they are from a run.
struct Compared {
    finer: (Scene, Sampled),
    shorter: (Scene, Sampled),
    space: Apart,
    time: Apart,
}

/// What a search for a discretisation keeps.
struct Search {
    target: f64,
    spent: Cost,
    last: Cost,
    /// The differences of the round whose sum was smallest.
    best: [f64; 2],
}

impl Search {
    fn new(target: f64) -> Self {
        Self { target, spent: Cost::default(), last: Cost::default(), best: [f64::INFINITY; 2] }
    }

    /// Refines for the first two steps alone, which cost little: the start often needs the shortest steps of all.
    ///
    /// Returns the discretisation given where that finds none.
    fn begin(&mut self, first: &Scene) -> Scene {
        let mut scene = first.clone();
        for _ in 0..ROUNDS {
            let Stepping { dt, restart_dt, .. } = scene.dg_stepping();
            let t_end = 2.0 * restart_dt;
            // Shorter steps only: room is made for each length, and these are all that occur.
            let method = Method::Dg(Stepping { dt: t_end.min(dt), ..scene.dg_stepping() });
            let short = Scene { t_end: t_end.min(scene.t_end), method, ..scene.clone() };
            let Ok(Compared { space, time, .. }) =
                self.sample(&short, &[]).and_then(|base| self.compare(&short, &base))
            else {
                return first.clone();
            };
            let share = SHARE * self.target;
            if space.most() <= share && time.most() <= share {
                return scene;
            }
            match refined(&scene, &space, &time, share) {
                Some(next) => scene = next,
                None => return first.clone(),
            }
        }
        first.clone()
    }

    /// Refines a discretisation until both differences are small enough.
    fn refine(mut self, mut scene: Scene) -> Result<Choice, Unreachable> {
        let share = SHARE * self.target;
        let mut base = self.sample(&scene, &[])?;
        for _ in 0..ROUNDS {
            let Compared { finer, shorter, space, time } = self.compare(&scene, &base)?;
            if space.most() <= share && time.most() <= share {
                let (space, time, finer_space) = (space.most(), time.most(), words(&finer.0));
                return Ok(Choice { scene, space, time, checks: self.spent, run: base.cost, finer_space });
            }
            self.judge(space.most(), time.most())?;
            scene = refined(&scene, &space, &time, share).ok_or_else(|| self.not_reached(FINEST))?;
            // A run that is already there is not made again.
            let there = [finer, shorter].into_iter().find(|(other, _)| *other == scene);
            base = there.map_or_else(|| self.sample(&scene, &[]), |(_, run)| Ok(run))?;
        }
        Err(self.not_reached("it was refined as often as is sensible"))
    }

    /// The two comparisons of a scene, `base` being its run.
    fn compare(&mut self, scene: &Scene, base: &Sampled) -> Result<Compared, Unreachable> {
        let finer = finer_space(scene).ok_or_else(|| self.not_reached(FINEST))?;
        let shorter = finer_steps(scene);
        let times = base.own_times();
        let in_space = self.sample(&finer, &times)?;
        let in_time = self.sample(&shorter, &times)?;
        let (space, time) = (Apart::of(base, &in_space), Apart::of(base, &in_time));
        Ok(Compared { finer: (finer, in_space), shorter: (shorter, in_time), space, time })
    }

    /// Runs a scene, to be compared with the run whose times are `at`.
    fn sample(&mut self, scene: &Scene, at: &[f64]) -> Result<Sampled, Unreachable> {
        // A run has at most four times the steps of the one before it; degrees that are raised as well add to that.
        if !(4.0 * self.last.unknown_solves <= MOST_UNKNOWN_SOLVES) {
            return Err(self.not_reached("a finer run would take more than some ten minutes"));
        }
        let sampled = sample(scene, Wanted { at, ends: &[], own: true, all: false }).map_err(Unreachable::Run)?;
        self.spent += sampled.cost;
        self.last = sampled.cost;
        Ok(sampled)
    }

    /// Notes what a round has found; stops where refining has met round-off.
    fn judge(&mut self, space: f64, time: f64) -> Result<(), Unreachable> {
        let ([best_space, best_time], found) = (self.best, space + time);
        let stalled = !(found <= STALLED * (best_space + best_time));
        if found < best_space + best_time {
            self.best = [space, time];
        }
        if !found.is_finite() {
            return Err(self.not_reached("a curve is not finite"));
        }
        if stalled && found <= ROUND_OFF {
            return Err(self.not_reached("finer runs differ by as much: rounding errors"));
        }
        Ok(())
    }

    fn not_reached(&self, reason: &'static str) -> Unreachable {
        let [space, time] = self.best;
        Unreachable::NotReached { target: self.target, reached: space.max(time) / SHARE, space, time, reason }
    }
}

/// Duration of an impact; without obstacles the longest step stands in for it.
fn impact(scene: &Scene) -> f64 {
    scene.obstacles.map_or(LONGEST, |obstacles| obstacles.impact_time(scene.beam.zeta))
}

/// Longest step for an error of 1e-5: a tenth of the shortest period that carries much energy.
const LONGEST: f64 = 0.02;

/// The discretisation tried first, from what scenes of the paper needed: two degrees in space for every decimal digit, half
/// a degree in time, and steps that shrink by two for every four digits.
fn first(scene: &Scene, target: f64) -> Scene {
    let digits = (-target.log10()).clamp(1.0, 11.0);
    let shrink = 10.0_f64.powf(-(digits - 5.0).max(0.0) / 11.0);
    let dt = (LONGEST * shrink).min(0.125 * scene.t_end);
    let impact = impact(scene);
    let stepping = Stepping {
        degree: ((0.5 * digits).round() as usize).clamp(1, MAX_TIME_DEGREE),
        dt,
        restart_dt: (0.2 * impact * shrink).min(dt),
        growth: 1.0 + 0.5 * shrink,
        ..Stepping::default()
    };
    // The layer at x = 1 some four impacts after a touch.
    let layer = (2.0 * (scene.beam.zeta * 4.0 * impact).sqrt()).clamp(1e-3, 0.5);
    let nodes = if scene.obstacles.is_some() { graded(layer) } else { vec![0.0, 1.0] };
    // An odd degree has as many unknowns as the even one below it: odd ones only.
    let degree = (4.0 + 1.2 * digits).round() as usize | 1;
    // Nodes that increase from 0 to 1.
    let mesh = Mesh::from_nodes(nodes).unwrap_or_else(|_| scene.mesh.clone());
    Scene { mesh, degree, method: Method::Dg(stepping), ..scene.clone() }
}

/// Elements towards x = 1 that grow by [`GRADING`] away from it, the last one of the width given.
fn graded(layer: f64) -> Vec<f64> {
    let widths = std::iter::successors(Some(layer), |width| Some(GRADING * width));
    let inner: Vec<f64> = widths.take_while(|width| *width <= 0.5).map(|width| 1.0 - width).collect();
    let ends = [0.0].into_iter().chain(inner.into_iter().rev());
    ends.chain([1.0]).collect()
}

/// Refined where a difference exceeds `share`; `None` where the elements are as fine as they get.
fn refined(scene: &Scene, space: &Apart, time: &Apart, share: f64) -> Option<Scene> {
    let (mut next, mut stepping) = (scene.clone(), scene.dg_stepping());
    if !(space.most() <= share) {
        next = more_space(&next, space, space.most() / share)?;
    }
    if !(time.late <= share) {
        stepping = more_time(stepping, time.late / share);
    }
    if !(time.early <= share) {
        let restart_dt = scene.dg_stepping().restart_dt / shortening(time.early / share);
        stepping.restart_dt = stepping.restart_dt.min(restart_dt);
    }
    Some(Scene { method: Method::Dg(stepping), ..next })
}

/// p + 4, or the longest elements halved.
fn finer_space(scene: &Scene) -> Option<Scene> {
    if scene.degree + FINER_DEGREES <= MAX_DEGREE {
        return Some(Scene { degree: scene.degree + FINER_DEGREES, ..scene.clone() });
    }
    halved(scene)
}

fn halved(scene: &Scene) -> Option<Scene> {
    let mesh = &scene.mesh;
    let mut nodes = vec![];
    for x in mesh.nodes().windows(2) {
        nodes.push(x[0]);
        if x[1] - x[0] >= LONG * mesh.size() {
            nodes.push(0.5 * (x[0] + x[1]));
        }
    }
    nodes.push(1.0);
    let mesh = (nodes.len() <= MOST_ELEMENTS + 1).then(|| Mesh::from_nodes(nodes).ok()).flatten()?;
    Some(Scene { mesh, ..scene.clone() })
}

/// One more node.
fn split(scene: &Scene, x: f64) -> Option<Scene> {
    let mut nodes = scene.mesh.nodes().to_vec();
    nodes.insert(nodes.len() - 1, x);
    let mesh = (nodes.len() <= MOST_ELEMENTS + 1).then(|| Mesh::from_nodes(nodes).ok()).flatten()?;
    Some(Scene { mesh, ..scene.clone() })
}

/// Space refined for an error smaller by `factor`, the difference being `apart`.
fn more_space(scene: &Scene, apart: &Apart, factor: f64) -> Option<Scene> {
    let layer = (scene.beam.zeta * apart.since).sqrt();
    let last = scene.mesh.lengths().last().unwrap_or(1.0);
    if layer < RESOLVED * last / (scene.degree * scene.degree) as f64 {
        return split(scene, 1.0 - last / GRADING);
    }
    let wanted = (factor.ln() / FALL_PER_DEGREE.ln()).ceil();
    let degrees = if wanted.is_finite() { (wanted as usize).clamp(2, MOST_DEGREES) } else { MOST_DEGREES };
    let degree = scene.degree + degrees + degrees % 2;
    if degree <= HIGHEST_DEGREE {
        return Some(Scene { degree, ..scene.clone() });
    }
    halved(scene)
}

fn half_steps(stepping: Stepping) -> Stepping {
    let Stepping { dt, restart_dt, growth, .. } = stepping;
    let growth = (1.0 + 0.5 * (growth - 1.0)).max(LEAST_GROWTH.min(growth));
    Stepping { dt: 0.5 * dt, restart_dt: 0.5 * restart_dt, growth, ..stepping }
}

/// Half the steps; the first ones are shorter still, since the error there falls more slowly.
fn finer_steps(scene: &Scene) -> Scene {
    let half = half_steps(scene.dg_stepping());
    let stepping = Stepping { restart_dt: 0.5 * half.restart_dt, ..half };
    Scene { method: Method::Dg(stepping), ..scene.clone() }
}

/// What `restart_dt` is divided by, for an error in the first steps smaller by `factor`.
fn shortening(factor: f64) -> f64 {
    let wanted = (1.5 * factor).powf(1.0 / START_RATE);
    if wanted.is_finite() { wanted.clamp(SHORTENED[0], SHORTENED[1]) } else { SHORTENED[1] }
}

/// Steps refined for an error smaller by `factor`; the degree grows with them while it can.
fn more_time(stepping: Stepping, factor: f64) -> Stepping {
    let wanted = (factor.log2() / EVENT_RATE).ceil();
    let halvings = if wanted.is_finite() { (wanted as i32).clamp(1, MOST_HALVINGS) } else { MOST_HALVINGS };
    let degree = (stepping.degree + 1).min(MAX_TIME_DEGREE);
    (0..halvings).fold(Stepping { degree, ..stepping }, |stepping, _| half_steps(stepping))
}

fn words(scene: &Scene) -> String {
    format!("{} elements of degree {}", scene.mesh.elements(), scene.degree)
}
