//! A beam in motion, whatever the method: what it does in a step, and what can be read off it.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use convergence_study::run::time_limit::Patience;
use thermobeam::dg::{self, ContactEvent, Field, Phase};
use thermobeam::energy::Balance;
use thermobeam::mesh::Mesh;
use thermobeam::parameters::Obstacles;
use thermobeam::solve::Level;

use super::driver::RunError;
use super::tally::{Sample, Solves};
use crate::scene::{Method, Scene};

/// What a step took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// Its length.
    pub dt: f64,
    /// Iterations that it took.
    pub iterations: usize,
    /// Whether the free end touched an obstacle: at the end of a one-step scheme's step, in the whole step by dG.
    pub in_contact: bool,
}

/// A beam in motion, one step at a time. What is read of a step is computed when it is read.
pub trait Motion {
    /// Does one step, at most to `until`; `None` where it stands there. Whole steps of a one-step scheme: `until` is the end of one.
    ///
    /// # Errors
    /// [`RunError`]; the state stays where it was.
    fn step(&mut self, until: f64) -> Result<Option<Report>, RunError>;

    /// The present time.
    fn t(&self) -> f64;

    /// Steps done.
    fn steps(&self) -> usize;

    /// The state at a time in the last step; of a one-step scheme at its end.
    fn at(&mut self, t: f64) -> Sample;

    /// Shows those of `count` equal parts of the time to `t_end` that end in the last step: the first time is `t_end / count`. A
    /// one-step scheme shows the level at each whole number of steps of which there are at most `count`.
    fn parts(&self, t_end: f64, count: usize, show: &mut dyn FnMut(f64));

    /// Times of a history.
    fn rows(&self) -> usize;

    /// Points x of a picture.
    fn points(&self) -> Vec<f64>;

    /// Displacement at those points, at a time in the last step.
    fn shape(&self, t: f64) -> Vec<f64>;

    /// The values of the present level at the nodes of a mesh, without contact force.
    fn on(&self, mesh: &Mesh) -> Level;

    /// Smallest and largest u(1) in the last step; of a one-step scheme at its end.
    fn extremes(&self) -> [f64; 2];

    /// The energy's balance over the last step.
    fn balance(&self) -> Balance;

    /// Counts of the work done so far.
    fn solves(&self) -> Solves;

    /// Time spent in steps.
    fn wall(&self) -> Duration;

    /// Whether the temperature is computed.
    fn is_heated(&self) -> bool {
        true
    }

    /// What the free end touches, and where contact began and ended; `None` where a method does not locate that.
    fn contact(&self) -> Option<(Phase, &[ContactEvent])> {
        None
    }
}

/// What looks at a motion after each of its steps.
pub trait Watch {
    /// Looks at the step just done, and reads what it needs.
    ///
    /// # Errors
    /// [`RunError`] ends the run at this step.
    fn see(&mut self, motion: &mut dyn Motion, report: &Report) -> Result<ControlFlow<()>, RunError>;
}

impl<F: FnMut(&mut dyn Motion, &Report) -> Result<ControlFlow<()>, RunError>> Watch for F {
    fn see(&mut self, motion: &mut dyn Motion, report: &Report) -> Result<ControlFlow<()>, RunError> {
        self(motion, report)
    }
}

/// Steps a motion to `until`, or until a watch ends it.
///
/// * `ends`: times, which increase, at which a step ends; of a one-step scheme they are ends of steps.
///
/// # Errors
/// [`RunError`] of the step that fails, or of a watch; the motion then stands at the last level.
pub fn run(motion: &mut dyn Motion, until: f64, ends: &[f64], watches: &mut [&mut dyn Watch]) -> Result<(), RunError> {
    let mut passed = 0;
    loop {
        while ends.get(passed).is_some_and(|&end| end <= motion.t()) {
            passed += 1;
        }
        let Some(report) = motion.step(ends.get(passed).copied().unwrap_or(until).min(until))? else {
            if passed >= ends.len() {
                return Ok(());
            }
            // A one-step scheme stands there up to rounding.
            passed += 1;
            continue;
        };
        for watch in &mut *watches {
            if watch.see(motion, &report)?.is_break() {
                return Ok(());
            }
        }
    }
}

/// A scene at t = 0.
///
/// # Errors
/// [`RunError`] where the solver refuses the scene's numbers.
pub fn motion(scene: &Scene) -> Result<Box<dyn Motion>, RunError> {
    Ok(match scene.method {
        Method::OneStep(_) => Box::new(super::simulate::driver(scene)?.timed()),
        Method::Dg(stepping) => Box::new(DgMotion::new(scene, stepping)?),
    })
}

/// Times of a history by dG: more than a figure has columns.
const ROWS: usize = 4000;

/// Points of a frame by dG.
const POINTS: usize = 141;

/// A scene by dG.
pub(crate) struct DgMotion {
    simulation: dg::Simulation,
    theta_a: f64,
    obstacles: Option<Obstacles>,
    level: dg::Level,
    patience: Patience,
    wall: Duration,
}

impl DgMotion {
    /// Stands at t = 0.
    ///
    /// # Errors
    /// [`dg::SetupError`] where the solver refuses the scene's numbers.
    pub(crate) fn new(scene: &Scene, stepping: dg::Stepping) -> Result<Self, dg::SetupError> {
        let simulation = dg::Simulation::new(scene.dg_problem(), stepping)?;
        Ok(Self {
            level: simulation.level().clone(),
            patience: Patience::new(simulation.space().blocks() * (stepping.degree + 1)),
            simulation,
            theta_a: scene.beam.theta_a,
            obstacles: scene.obstacles,
            wall: Duration::ZERO,
        })
    }
}

impl Motion for DgMotion {
    fn step(&mut self, until: f64) -> Result<Option<Report>, RunError> {
        let Self { simulation, patience, wall, .. } = self;
        patience.check(simulation.work().steps, || simulation.t())?;
        let started = Instant::now();
        let outcome = simulation.step(until);
        *wall += started.elapsed();
        Ok(outcome?.map(|done| {
            let phase = done.event.map_or(simulation.phase(), |event| event.from);
            Report { dt: done.dt, iterations: done.iterations, in_contact: phase != Phase::Free }
        }))
    }

    fn t(&self) -> f64 {
        self.simulation.t()
    }

    fn steps(&self) -> usize {
        self.simulation.work().steps
    }

    fn at(&mut self, t: f64) -> Sample {
        let Self { simulation, level, .. } = self;
        simulation.level_into(t, level);
        let value = |field, x| level.value_and_slope(simulation.space(), field, x).0;
        let u_tip = value(Field::U, 1.0);
        Sample {
            t,
            u_tip,
            phi_tip: value(Field::Phi, 1.0),
            u_t_tip: value(Field::V, 1.0),
            phi_t_tip: value(Field::W, 1.0),
            theta_mid: value(Field::Theta, 0.5) + 0.5 * self.theta_a,
            contact_force: self.obstacles.map_or(0.0, |obstacles| obstacles.force(u_tip)),
            energy: simulation.energy(level).total(),
        }
    }

    fn parts(&self, t_end: f64, count: usize, show: &mut dyn FnMut(f64)) {
        let (from, to) = (self.simulation.old_level().t, self.simulation.t());
        let time = |k: usize| if k == count { t_end } else { t_end * k as f64 / count as f64 };
        let first = (from / t_end * count as f64).floor() as usize;
        (first.max(1)..=count).map(time).skip_while(|&t| t <= from).take_while(|&t| t <= to).for_each(show);
    }

    fn rows(&self) -> usize {
        ROWS
    }

    fn points(&self) -> Vec<f64> {
        (0..POINTS).map(|i| i as f64 / (POINTS - 1) as f64).collect()
    }

    fn shape(&self, t: f64) -> Vec<f64> {
        let u = |x: f64| self.simulation.value(Field::U, x, t).unwrap_or(f64::NAN);
        self.points().into_iter().map(u).collect()
    }

    fn on(&self, mesh: &Mesh) -> Level {
        nodal(self.simulation.space(), self.simulation.level(), mesh.nodes())
    }

    fn extremes(&self) -> [f64; 2] {
        self.simulation.tip_range()
    }

    fn balance(&self) -> Balance {
        self.simulation.balance()
    }

    fn solves(&self) -> Solves {
        let dg::Work { solves, factorizations, .. } = self.simulation.work();
        Solves { passes: solves, factorizations }
    }

    fn wall(&self) -> Duration {
        self.wall
    }

    fn contact(&self) -> Option<(Phase, &[ContactEvent])> {
        Some((self.simulation.phase(), self.simulation.events()))
    }
}

/// A level of any order by its values at the nodes; without contact force.
pub(crate) fn nodal(space: &dg::Space, level: &dg::Level, nodes: &[f64]) -> Level {
    let at = |field| nodes.iter().map(|&x| level.value_and_slope(space, field, x).0).collect();
    Level {
        u: at(Field::U),
        v: at(Field::V),
        phi: at(Field::Phi),
        w: at(Field::W),
        theta: at(Field::Theta),
        contact_force: 0.0,
    }
}
