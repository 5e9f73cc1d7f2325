//! One experiment, run until it is steady, and what is measured on the way.

use thermobeam::simulation::Simulation;

use super::{Nearest, Until};
use crate::figures::energy_at_rest;
use crate::kinds::prelude::*;
use crate::kinds::steady::exact_states;
use crate::run::simulate::driver;

/// Points of a curve in a figure, about: more than a figure has columns.
const POINTS: usize = 4000;

/// The time that an animation shows: both obstacles are hit several times.
pub(super) const SPAN: f64 = 6.0;

/// Parts into which that time is divided, with a frame at each end; what lies between two frames is interpolated.
const PARTS: usize = 100;

/// What an experiment shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Time from which the beam is steady.
    pub t_steady: f64,
    /// The energy then.
    pub energy: f64,
    /// u(1) then.
    pub u_tip: f64,
    /// φ(1) then.
    pub phi_tip: f64,
    /// The contact force then: positive at the upper obstacle.
    pub contact_force: f64,
    /// Largest nodal value of u, φ and the lifted temperature then, without its sign.
    pub largest_field: f64,
    /// Number of exact steady states.
    pub states: usize,
    /// The nearest of them; `None` if there is none.
    pub nearest: Option<Nearest>,
    /// When u(1) first passes the upper obstacle, within the figures' span.
    pub first_upper: Option<f64>,
    /// When u(1) first passes the lower obstacle, within the figures' span.
    pub first_lower: Option<f64>,
    /// Upward crossings of zero by u(1) within the figures' span.
    pub crossings: usize,
    /// Frequency of u(1); `None` with fewer than two crossings.
    pub frequency: Option<f64>,
    /// Largest minus smallest φ(1) within the figures' span.
    pub phi_amplitude: f64,
    /// Largest change of the energy in a step: negative where it falls in every step.
    pub largest_increase: f64,
    /// Free end and energy over time.
    pub points: Vec<CurvePoint>,
    /// Times of the first seconds, each with u at each node.
    pub frames: Vec<(f64, Vec<f64>)>,
}

/// A point of the curves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Time.
    pub t: f64,
    /// u(1).
    pub u_tip: f64,
    /// φ(1).
    pub phi_tip: f64,
    /// The energy.
    pub energy: f64,
}

/// Runs a scene until its energy stands still.
///
/// # Errors
/// A step that fails, steady states that cannot be found, or a beam that still moves at `t_max`.
pub(super) fn run(scene: &Scene, until: &Until) -> Result<Measured, CaseFailure> {
    let mut driver = driver(scene)?;
    let mut log = MotionLog::new(scene, &mut driver);
    let window = (until.window / scene.dt()).round().max(1.0) as usize;
    let mut fall = 0.0;
    loop {
        let Step { old, new, simulation, .. } = driver.stepped()?;
        // Summed up from differences: the total's round-off would hide a slow fall.
        let change = simulation.energy_change(old, new);
        log.largest_increase = max_or_nan(log.largest_increase, change);
        log.add(simulation, new);
        fall -= change;
        if simulation.step() % window == 0 {
            if fall <= until.rate * until.window {
                return log.finish(simulation, new);
            }
            fall = 0.0;
        }
        if !(simulation.t() < until.t_max) {
            return Err(CaseFailure { reason: format!("not steady by t = {}", until.t_max) });
        }
    }
}

/// What a run has shown so far.
struct MotionLog<'a> {
    scene: &'a Scene,
    /// (t, u(1), φ(1)) at the start and after each step in the figures' span.
    motion: Vec<[f64; 3]>,
    largest_increase: f64,
    points: Vec<CurvePoint>,
    frames: Vec<(f64, Vec<f64>)>,
}

impl<'a> MotionLog<'a> {
    fn new(scene: &'a Scene, driver: &mut Driver) -> Self {
        let largest_increase = f64::NEG_INFINITY;
        let mut log = Self { scene, motion: vec![], largest_increase, points: vec![], frames: vec![] };
        let (simulation, level) = driver.present();
        log.add(simulation, level);
        log
    }

    fn add(&mut self, simulation: &Simulation, level: &Level) {
        let (t, step, tip) = (simulation.t(), simulation.step(), level.u.len() - 1);
        let (t_end, dt) = (self.scene.t_end, self.scene.dt());
        // Half a step of slack: n dt is not t_end to the last bit.
        if t <= t_end + 0.5 * dt {
            self.motion.push([t, level.u[tip], level.phi[tip]]);
        }
        let of_frames = (SPAN / dt).round() as usize;
        if step <= of_frames && step.is_multiple_of((of_frames / PARTS).max(1)) {
            self.frames.push((t, level.u.clone()));
        }
        // Beyond the figures' span only slow, smooth motion is left.
        let stride = ((t_end / dt).round() as usize / POINTS).max(1) * if t <= t_end { 1 } else { 10 };
        if step.is_multiple_of(stride) {
            let energy = simulation.energy(level).total();
            self.points.push(CurvePoint { t, u_tip: level.u[tip], phi_tip: level.phi[tip], energy });
        }
    }

    /// When u(1) passes a value between two levels that `passes` accepts, interpolated.
    fn passings(&self, at: f64, passes: impl Fn(f64, f64) -> bool) -> impl Iterator<Item = f64> {
        let pairs = self.motion.windows(2).map(|pair| [pair[0][1], pair[1][1], pair[1][0]]);
        let passing = pairs.filter(move |[before, now, _]| passes(*before, *now));
        passing.map(move |[before, now, t]| t - self.scene.dt() * (now - at) / (now - before))
    }

    fn finish(self, simulation: &Simulation, end: &Level) -> Result<Measured, CaseFailure> {
        let states = exact_states(self.scene)?;
        let tip = end.u.len() - 1;
        let values = [&end.u, &end.phi, &end.theta].into_iter().flatten();
        let obstacles = self.scene.obstacles.as_ref();
        let upper = obstacles.and_then(|of| self.passings(of.g2, |before, now| before <= of.g2 && now > of.g2).next());
        let lower = obstacles.and_then(|of| self.passings(of.g1, |before, now| before >= of.g1 && now < of.g1).next());
        let crossings: Vec<f64> = self.passings(0.0, |before, now| before < 0.0 && now >= 0.0).collect();
        let count = crossings.len();
        // The start is no step.
        let largest =
            |sign: f64| self.motion.iter().skip(1).map(|[_, _, phi]| sign * phi).fold(f64::NEG_INFINITY, max_or_nan);
        Ok(Measured {
            t_steady: simulation.t(),
            energy: simulation.energy(end).total(),
            u_tip: end.u[tip],
            phi_tip: end.phi[tip],
            contact_force: end.contact_force,
            largest_field: values.fold(0.0, |most, value| max_or_nan(most, value.abs())),
            states: states.len(),
            nearest: Nearest::of(&self.scene.mesh, end, &states),
            first_upper: upper,
            first_lower: lower,
            crossings: count,
            frequency: (count >= 2).then(|| (count as f64 - 1.0) / (crossings[count - 1] - crossings[0])),
            phi_amplitude: largest(1.0) + largest(-1.0),
            largest_increase: self.largest_increase,
            points: self.points,
            frames: self.frames,
        })
    }
}

/// The energy of the straight beam at rest; NaN for the linear beam, whose energy has another constant.
pub(super) fn straight_energy(scene: &Scene) -> f64 {
    energy_at_rest(&scene.beam).unwrap_or(f64::NAN)
}
