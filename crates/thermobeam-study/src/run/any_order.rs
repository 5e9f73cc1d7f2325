//! A scene of any order, run: dG(q) from event to event, sampled from the polynomials inside its steps.
//!
//! The history is as fine as asked, whatever the steps: u, φ and their rates are polynomials within a step. Energy and its
//! balance are summed over the steps themselves.

use std::time::{Duration, Instant};

use convergence_study::run::time_limit::{Patience, TimeUp};
use serde::Serialize;
use thermobeam::dg::{Balance, ContactEvent, Field, Level, Phase, SetupError, Simulation, StepError};
use thiserror::Error;

use super::simulate::Counts;
use super::tally::{EnergyLaw, EnergySummary, Extremes, Iterations, Sample, Tally, Unsound};
use crate::figures::SceneMotion;
use crate::scene::Scene;

/// Times of a history: more than a figure has columns.
pub const HISTORY_TIMES: usize = 4000;

/// Frames of the displacement over space and time, and points of a frame.
const FRAMES: usize = 440;
const FRAME_POINTS: usize = 141;

/// Why a run ended before the scene's end.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AnyOrderFailure {
    /// A step failed.
    #[error(transparent)]
    Step(#[from] StepError),
    /// The time limit was reached.
    #[error(transparent)]
    TimeUp(#[from] TimeUp),
    /// A step raised the energy, or broke its balance, far beyond what rounding and tolerance explain.
    #[error("step {step} (from t = {t}, length {dt:e}): {unsound}")]
    Unsound {
        /// Number of the step, counted from 1.
        step: usize,
        /// The time at which it started.
        t: f64,
        /// Its length.
        dt: f64,
        /// What it did.
        unsound: Unsound,
    },
}

/// Displacement over space and time, for pictures.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Frames {
    /// Times.
    pub times: Vec<f64>,
    /// Points x.
    pub points: Vec<f64>,
    /// `u[k][i]` at `times[k]` and `points[i]`.
    pub u: Vec<Vec<f64>>,
}

/// A finished run, or the part of it that was done.
#[derive(Debug, Clone, PartialEq)]
pub struct AnyOrderRun {
    /// Steps done.
    pub steps: usize,
    /// Iterations of all steps.
    pub iterations: Iterations,
    /// Time spent in steps.
    pub wall: Duration,
    /// The start and the last level.
    pub ends: [Sample; 2],
    /// The free end's range.
    pub extremes: Extremes,
    /// Energy and balance.
    pub energy: EnergySummary,
    /// What the free end touched at the start.
    pub started_in: Phase,
    /// Where contact began and ended.
    pub events: Vec<ContactEvent>,
    /// Solves and factorisations.
    pub work: thermobeam::dg::Work,
    /// States at equally spaced times; empty unless asked for.
    pub history: Vec<Sample>,
    /// Displacement over space and time; empty unless asked for.
    pub frames: Frames,
    /// Why the run ended early, if it did.
    pub failure: Option<AnyOrderFailure>,
}

/// Runs a scene.
///
/// * `times`: how many equally spaced times the history has beside t = 0; 0 for no history and no frames.
/// * `progress`: called after every step with the time reached.
///
/// # Errors
/// [`SetupError`] where the solver refuses the scene's numbers. A step that fails is part of the result.
pub fn run(scene: &Scene, times: usize, progress: &mut dyn FnMut(f64)) -> Result<AnyOrderRun, SetupError> {
    watched(scene, &[], &mut |_, _| (), times, true, progress)
}

/// Runs a scene without frames for pictures; a step ends at each of the times `at`, which increase, and is shown to `observe` with
/// the state there.
///
/// # Errors
/// As [`run`].
pub fn run_at(
    scene: &Scene,
    at: &[f64],
    observe: &mut dyn FnMut(&Simulation, Sample),
    times: usize,
    progress: &mut dyn FnMut(f64),
) -> Result<AnyOrderRun, SetupError> {
    watched(scene, at, observe, times, false, progress)
}

fn watched(
    scene: &Scene,
    at: &[f64],
    observe: &mut dyn FnMut(&Simulation, Sample),
    times: usize,
    framed: bool,
    progress: &mut dyn FnMut(f64),
) -> Result<AnyOrderRun, SetupError> {
    let stepping = scene.dg_stepping();
    let mut simulation = Simulation::new(scene.dg_problem(), stepping)?;
    let mut observed = Observed::new(&simulation, scene, times, framed && times > 0);
    let mut patience = Patience::new(simulation.space().blocks() * (stepping.degree + 1));
    let (mut wall, mut failure) = (Duration::ZERO, None);
    loop {
        if let Err(up) = patience.check(simulation.work().steps, || simulation.t()) {
            failure = Some(up.into());
            break;
        }
        let started = Instant::now();
        // A step ends at each time asked for: its end is of order 2q + 1, its inside of order q + 1.
        let limit = at.iter().copied().find(|&t| t > simulation.t()).unwrap_or(scene.t_end).min(scene.t_end);
        let outcome = simulation.step(limit);
        wall += started.elapsed();
        match outcome {
            Ok(Some(report)) => {
                let sound = observed.step(&simulation, report.iterations);
                if at.contains(&simulation.t()) {
                    observe(&simulation, state(&simulation, scene, simulation.level()));
                }
                if let Err(unsound) = sound {
                    let (step, t) = (simulation.work().steps, simulation.old_level().t);
                    failure = Some(AnyOrderFailure::Unsound { step, t, dt: report.dt, unsound });
                    break;
                }
            }
            Ok(None) => break,
            Err(error) => {
                failure = Some(error.into());
                break;
            }
        }
        progress(simulation.t());
    }
    Ok(observed.finish(&simulation, wall, failure))
}

/// What is seen of the steps.
struct Observed<'s> {
    scene: &'s Scene,
    level: Level,
    first: Sample,
    law: EnergyLaw,
    started_in: Phase,
    tally: Tally,
    times: usize,
    framed: bool,
    history: Vec<Sample>,
    frames: Frames,
}

impl<'s> Observed<'s> {
    fn new(simulation: &Simulation, scene: &'s Scene, times: usize, framed: bool) -> Self {
        let level = simulation.level().clone();
        let first = state(simulation, scene, &level);
        let points = (0..FRAME_POINTS).map(|i| i as f64 / (FRAME_POINTS - 1) as f64).collect();
        let mut observed = Self {
            scene,
            level,
            first,
            law: EnergyLaw::new(first.energy),
            started_in: simulation.phase(),
            tally: Tally::new(first.u_tip),
            times,
            framed,
            history: vec![],
            frames: Frames { points, ..Frames::default() },
        };
        if times > 0 {
            observed.history.push(first);
        }
        if framed {
            observed.frame(simulation, 0.0);
        }
        observed
    }

    /// # Errors
    /// [`Unsound`] where the step raised the energy or broke its balance.
    fn step(&mut self, simulation: &Simulation, iterations: usize) -> Result<(), Unsound> {
        let Balance { change, residual, .. } = simulation.balance();
        self.tally.add(iterations, change, residual);
        let (from, to) = (simulation.old_level().t, simulation.t());
        for u_tip in simulation.tip_range() {
            self.tally.include(u_tip);
        }
        self.sample(simulation, from, to);
        self.law.step(change, residual)
    }

    /// The states of the history that lie in the last step.
    fn sample(&mut self, simulation: &Simulation, from: f64, to: f64) {
        let t_end = self.scene.t_end;
        for t in grid(t_end, self.times, from, to) {
            if simulation.level_into(t, &mut self.level) {
                let state = state(simulation, self.scene, &self.level);
                self.history.push(state);
            }
        }
        if self.framed {
            for t in grid(t_end, FRAMES, from, to) {
                self.frame(simulation, t);
            }
        }
    }

    fn frame(&mut self, simulation: &Simulation, t: f64) {
        let u = |&x: &f64| simulation.value(Field::U, x, t).unwrap_or(f64::NAN);
        self.frames.u.push(self.frames.points.iter().map(u).collect());
        self.frames.times.push(t);
    }

    fn finish(self, simulation: &Simulation, wall: Duration, failure: Option<AnyOrderFailure>) -> AnyOrderRun {
        let last = state(simulation, self.scene, simulation.level());
        AnyOrderRun {
            steps: simulation.work().steps,
            iterations: self.tally.iterations,
            wall,
            ends: [self.first, last],
            extremes: self.tally.extremes,
            energy: self.tally.energy(self.first.energy, last.energy),
            started_in: self.started_in,
            events: simulation.events().to_vec(),
            work: simulation.work(),
            history: self.history,
            frames: self.frames,
            failure,
        }
    }
}

/// Those of `t_end k / count`, k = 1 ... count, that lie in (from, to].
fn grid(t_end: f64, count: usize, from: f64, to: f64) -> impl Iterator<Item = f64> {
    let time = move |k: usize| if k == count { t_end } else { t_end * k as f64 / count as f64 };
    let first = if t_end > 0.0 { (from / t_end * count as f64).floor() as usize } else { count };
    (first.max(1)..=count).map(time).skip_while(move |&t| t <= from).take_while(move |&t| t <= to)
}

fn state(simulation: &Simulation, scene: &Scene, level: &Level) -> Sample {
    let space = simulation.space();
    let at = |field, x| level.value_and_slope(space, field, x).0;
    let u_tip = at(Field::U, 1.0);
    Sample {
        t: level.t,
        u_tip,
        phi_tip: at(Field::Phi, 1.0),
        u_t_tip: at(Field::V, 1.0),
        phi_t_tip: at(Field::W, 1.0),
        theta_mid: at(Field::Theta, 0.5) + 0.5 * scene.beam.theta_a,
        contact_force: scene.obstacles.map_or(0.0, |obstacles| obstacles.force(u_tip)),
        energy: simulation.energy(level).total(),
    }
}

impl AnyOrderRun {
    /// Why the numbers of the run cannot be used, in words: it failed, or they mean nothing.
    pub fn complaint(&self) -> Option<String> {
        let failure = self.failure.as_ref().map(ToString::to_string);
        failure.or_else(|| self.energy.sound(self.steps).err().map(|unsound| unsound.to_string()))
    }

    /// The history as comma-separated values, with enough digits to read back every bit.
    pub fn csv(&self) -> String {
        let mut csv = String::from("t,u_tip,phi_tip,u_t_tip,phi_t_tip,theta_mid,contact_force,energy\n");
        for s in &self.history {
            let row = [s.t, s.u_tip, s.phi_tip, s.u_t_tip, s.phi_t_tip, s.theta_mid, s.contact_force, s.energy];
            let cells: Vec<String> = row.iter().map(|value| format!("{value:?}")).collect();
            csv += &(cells.join(",") + "\n");
        }
        csv
    }

    /// Names of files and their SVG documents; none where no history was asked for.
    pub fn pictures(&self, scene: &Scene) -> Vec<(&'static str, String)> {
        if self.frames.times.is_empty() {
            return vec![];
        }
        let over_time = |value: fn(&Sample) -> f64| self.history.iter().map(|state| (state.t, value(state))).collect();
        let motion = SceneMotion {
            name: &scene.name,
            beam: &scene.beam,
            obstacles: scene.obstacles,
            u_tip: over_time(|state| state.u_tip),
            phi_tip: over_time(|state| state.phi_tip),
            energy: over_time(|state| state.energy),
            contact: self.contact_phases(),
            times: &self.frames.times,
            points: &self.frames.points,
            frames: &self.frames.u,
        };
        motion.pictures()
    }

    /// Intervals of time in which the free end touched an obstacle, from the phase at the start and the events.
    pub fn contact_phases(&self) -> Vec<(f64, f64)> {
        let [start, end] = self.ends.map(|state| state.t);
        let mut phases = if self.started_in == Phase::Free { vec![] } else { vec![(start, end)] };
        for event in &self.events {
            if let Some(phase) = phases.last_mut().filter(|_| event.from != Phase::Free) {
                phase.1 = event.t;
            }
            if event.to != Phase::Free {
                phases.push((event.t, end));
            }
        }
        phases
    }
}

/// The object that `run --format json` prints; names and order of the first keys are those of a one-step run.
#[derive(Debug, Serialize)]
pub struct AnyOrderObject<'r> {
    scene: &'r str,
    elements: usize,
    steps: usize,
    dt: f64,
    t_end: f64,
    iterations: Iterations,
    #[serde(skip_serializing_if = "Option::is_none")]
    wall_seconds: Option<f64>,
    #[serde(rename = "final")]
    last: Sample,
    extremes: Extremes,
    energy: EnergySummary,
    scheme: &'static str,
    degree: usize,
    time_degree: usize,
    restart_dt: f64,
    growth: f64,
    work: Counts,
    events: Vec<Event>,
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<Failure>,
}

#[derive(Debug, Serialize)]
struct Event {
    t: f64,
    from: &'static str,
    to: &'static str,
}

#[derive(Debug, Serialize)]
struct Failure {
    step: usize,
    t: f64,
    message: String,
}

/// A contact state in a word.
pub fn phase_name(phase: Phase) -> &'static str {
    match phase {
        Phase::Free => "free",
        Phase::Lower => "lower",
        Phase::Upper => "upper",
    }
}

impl<'r> AnyOrderObject<'r> {
    /// Everything there is to say about a run.
    pub fn new(scene: &'r Scene, run: &AnyOrderRun) -> Self {
        Self { wall_seconds: Some(run.wall.as_secs_f64()), ..Self::reproducible(scene, run) }
    }

    /// The same without the time on the clock: the same run gives the same bytes.
    pub fn reproducible(scene: &'r Scene, run: &AnyOrderRun) -> Self {
        let stepping = scene.dg_stepping();
        let event = |event: &ContactEvent| Event { t: event.t, from: phase_name(event.from), to: phase_name(event.to) };
        Self {
            scene: &scene.name,
            elements: scene.mesh.elements(),
            steps: run.steps,
            dt: stepping.dt,
            t_end: scene.t_end,
            iterations: run.iterations,
            wall_seconds: None,
            last: run.ends[1],
            extremes: run.extremes,
            energy: run.energy,
            scheme: scene.method.name(),
            degree: scene.degree,
            time_degree: stepping.degree,
            restart_dt: stepping.restart_dt,
            growth: stepping.growth,
            work: Counts { passes: run.work.solves, factorizations: run.work.factorizations },
            events: run.events.iter().map(event).collect(),
            failure: run.failure.as_ref().map(|failure| {
                let (step, t) = match failure {
                    AnyOrderFailure::Unsound { step, t, .. } => (*step, *t),
                    AnyOrderFailure::Step(_) | AnyOrderFailure::TimeUp(_) => (run.steps + 1, run.ends[1].t),
                };
                Failure { step, t, message: failure.to_string() }
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::{Expression, Variable};

    fn scene(time: &str) -> Scene {
        let text = format!(
            "[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\nu_t = \"20*x*(x-1)^2\"\ntheta = \"sin(pi*x)\"\n\
             [mesh]\ndegree = 12\n[time]\nscheme = \"dg\"\n{time}\n"
        );
        Scene::parse(&text, "s.toml").expect("a scene")
    }

    #[test]
    fn contact_at_the_start_is_a_phase_and_a_last_phase_ends_with_the_run() {
        let pressed = |t_end: f64| {
            let mut scene = scene(&format!("t_end = {t_end}"));
            scene.initial.u = Some(Expression::parse("0.15*x^2", Variable::X).expect("a function"));
            run(&scene, 0, &mut |_| ()).expect("a run")
        };
        let run = pressed(0.005);
        assert_eq!((run.started_in, run.events.len()), (Phase::Upper, 0));
        assert_eq!(run.contact_phases(), [(0.0, 0.005)]);
        let run = pressed(0.02);
        assert_eq!((run.events[0].from, run.events[0].to), (Phase::Upper, Phase::Free));
        assert_eq!(run.contact_phases()[0], (0.0, run.events[0].t));
    }

    #[test]
    fn the_first_experiment_comes_out_to_seven_digits_with_its_events() {
        let run = run(&scene("t_end = 1.0"), 100, &mut |_| ()).expect("a run");
        assert_eq!(run.failure, None);
        assert!((run.ends[1].u_tip - -0.011_764_243_810).abs() < 1e-7, "{:?}", run.ends);
        assert_eq!(run.events.len(), 3);
        let phases = run.contact_phases();
        assert!((phases[0].0 - 0.203_413_276).abs() < 1e-7 && (phases[0].1 - 0.648_169_461).abs() < 1e-7);
        assert_eq!(phases[1].1, 1.0);
        // Each time once, whatever the steps.
        assert_eq!(run.history.len(), 101);
        assert!(run.history.windows(2).all(|pair| (pair[1].t - pair[0].t - 0.01).abs() < 1e-12));
        assert_eq!(run.history[100], run.ends[1]);
        assert_eq!((run.frames.times.len(), run.frames.u.len()), (441, 441));
        // E falls in every step and its balance closes to round-off.
        assert!(run.energy.largest_increase < 0.0 && run.energy.largest_balance_residual < 1e-12 * run.energy.initial);
        assert!(run.extremes.u_tip_max > 0.105 && run.extremes.u_tip_min < -0.011, "{:?}", run.extremes);
    }

    #[test]
    fn a_run_without_history_keeps_none_and_ends_alike() {
        let scene = scene("t_end = 0.3\ndegree = 1");
        let [with, without] = [50, 0].map(|times| run(&scene, times, &mut |_| ()).expect("a run"));
        assert_eq!(with.ends, without.ends);
        assert!(without.history.is_empty() && without.frames.u.is_empty());
    }
}
