//! One experiment, run until it is steady, and what is measured on the way.

use std::ops::ControlFlow;

use thermobeam::simulation::Simulation;
use thermobeam::solve::Level;

use super::{Nearest, Until};
use crate::kinds::prelude::*;
use crate::kinds::steady::exact_states;
use crate::run::driver::{Driver, Step};
use crate::run::simulate::driver;

/// Points of a curve in a figure, about: more than a figure has columns.
const POINTS: usize = 4000;

/// The time that an animation shows: both obstacles are hit several times.
pub(super) const SPAN: f64 = 6.0;

/// Parts into which that time is divided, with a frame at each end; what lies between two frames is interpolated.
const PARTS: usize = 100;

/// What an experiment shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
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
    pub points: Vec<Point>,
    /// Shapes of the beam over the first seconds.
    pub frames: Vec<Frame>,
}

/// A point of the curves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Time.
    pub t: f64,
    /// u(1).
    pub u_tip: f64,
    /// φ(1).
    pub phi_tip: f64,
    /// The energy.
    pub energy: f64,
}

/// The shape of the beam at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// The time.
    pub t: f64,
    /// u at each node.
    pub u: Vec<f64>,
}

/// Runs a scene until its energy stands still.
///
/// # Errors
/// A step that fails, steady states that cannot be found, or a beam that still moves at `t_max`.
pub(super) fn run(scene: &Scene, until: &Until) -> Result<Run, CaseFailure> {
    let mut driver = driver(scene)?;
    let mut log = Log::new(scene, &mut driver);
    let window = (until.window / scene.dt()).round().max(1.0) as usize;
    let mut fall = 0.0;
    let end = driver.run(usize::MAX, |step| {
        // Summed up from differences: the total's round-off would hide a slow fall.
        let change = step.simulation.energy_change(step.old, step.new);
        log.add(&step, change);
        fall -= change;
        if step.simulation.step() % window == 0 {
            if fall <= until.rate * until.window {
                return ControlFlow::Break(Some(step.new.clone()));
            }
            fall = 0.0;
        }
        if step.simulation.t() < until.t_max { ControlFlow::Continue(()) } else { ControlFlow::Break(None) }
    })?;
    let end = end.flatten().ok_or_else(|| CaseFailure { reason: format!("not steady by t = {}", until.t_max) })?;
    log.finish(driver.simulation(), &end)
}

/// What a run has shown so far.
struct Log<'a> {
    scene: &'a Scene,
    /// Range of φ(1) in the figures' span.
    phi: [f64; 2],
    first_upper: Option<f64>,
    first_lower: Option<f64>,
    /// First and last upward crossing of zero by u(1), and their number.
    crossings: ([f64; 2], usize),
    largest_increase: f64,
    /// Steps between two points of a curve.
    stride: usize,
    points: Vec<Point>,
    frames: Vec<Frame>,
}

impl<'a> Log<'a> {
    fn new(scene: &'a Scene, driver: &mut Driver) -> Self {
        let mut log = Self {
            scene,
            phi: [f64::INFINITY, f64::NEG_INFINITY],
            first_upper: None,
            first_lower: None,
            crossings: ([f64::NAN; 2], 0),
            largest_increase: f64::NEG_INFINITY,
            stride: ((scene.t_end / scene.dt()).round() as usize / POINTS).max(1),
            points: vec![],
            frames: vec![],
        };
        let (simulation, level) = driver.present();
        log.add_point(simulation, level);
        log.add_frame(0, 0.0, level);
        log
    }

    fn add(&mut self, step: &Step<'_>, change: f64) {
        let Step { old, new, simulation, .. } = *step;
        self.largest_increase = max_or_nan(self.largest_increase, change);
        let (t, step) = (simulation.t(), simulation.step());
        // Half a step of slack: n dt is not t_end to the last bit.
        if t <= self.scene.t_end + 0.5 * self.scene.dt() {
            self.add_motion(t, [old, new]);
        }
        self.add_frame(step, t, new);
        // Beyond the figures' span only slow, smooth motion is left.
        let thinning = if t <= self.scene.t_end { 1 } else { 10 };
        if step.is_multiple_of(thinning * self.stride) {
            self.add_point(simulation, new);
        }
    }

    /// Contacts, crossings and extremes of the free end.
    fn add_motion(&mut self, t: f64, [old, new]: [&Level; 2]) {
        let tip = new.u.len() - 1;
        let [before, now] = [old.u[tip], new.u[tip]];
        let passes = |at: f64| t - self.scene.dt() * (now - at) / (now - before);
        if let Some(obstacles) = self.scene.obstacles {
            if self.first_upper.is_none() && before <= obstacles.g2 && now > obstacles.g2 {
                self.first_upper = Some(passes(obstacles.g2));
            }
            if self.first_lower.is_none() && before >= obstacles.g1 && now < obstacles.g1 {
                self.first_lower = Some(passes(obstacles.g1));
            }
        }
        if before < 0.0 && now >= 0.0 {
            let (([first, _], count), t) = (self.crossings, passes(0.0));
            self.crossings = ([if count == 0 { t } else { first }, t], count + 1);
        }
        let phi = new.phi[tip];
        self.phi = [-max_or_nan(-self.phi[0], -phi), max_or_nan(self.phi[1], phi)];
    }

    fn add_point(&mut self, simulation: &Simulation, level: &Level) {
        let tip = level.u.len() - 1;
        let energy = simulation.energy(level).total();
        self.points.push(Point { t: simulation.t(), u_tip: level.u[tip], phi_tip: level.phi[tip], energy });
    }

    /// Keeps the level after so many steps, if it is one of the frames.
    fn add_frame(&mut self, step: usize, t: f64, level: &Level) {
        let steps = (SPAN / self.scene.dt()).round() as usize;
        if step <= steps && step.is_multiple_of((steps / PARTS).max(1)) {
            self.frames.push(Frame { t, u: level.u.clone() });
        }
    }

    fn finish(self, simulation: &Simulation, end: &Level) -> Result<Run, CaseFailure> {
        let states = exact_states(self.scene)?;
        let tip = end.u.len() - 1;
        let ([first, last], crossings) = self.crossings;
        let values = [&end.u, &end.phi, &end.theta].into_iter().flatten();
        Ok(Run {
            t_steady: simulation.t(),
            energy: simulation.energy(end).total(),
            u_tip: end.u[tip],
            phi_tip: end.phi[tip],
            contact_force: end.contact_force,
            largest_field: values.fold(0.0, |most, value| max_or_nan(most, value.abs())),
            states: states.len(),
            nearest: Nearest::of(&self.scene.mesh, end, &states),
            first_upper: self.first_upper,
            first_lower: self.first_lower,
            crossings,
            frequency: (crossings >= 2).then(|| (crossings as f64 - 1.0) / (last - first)),
            phi_amplitude: self.phi[1] - self.phi[0],
            largest_increase: self.largest_increase,
            points: self.points,
            frames: self.frames,
        })
    }
}

/// β²/(4ρ), the energy of the straight beam at rest; NaN for the linear beam, whose energy has another constant.
pub(super) fn straight_energy(scene: &Scene) -> f64 {
    let beam = &scene.beam;
    if beam.rho > 0.0 { beam.beta * beam.beta / (4.0 * beam.rho) } else { f64::NAN }
}
