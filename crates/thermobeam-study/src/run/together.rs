//! Scenes that run together in lanes, twice as fast as one after the other, each with the same bits
//! as on its own.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use convergence_judge::time_limit::{Patience, TimeUp};
use thermobeam::energy::Balance;
use thermobeam::ensemble::Ensemble;
use thermobeam::error::SetupError;
use thermobeam::motion::TipRange;
use thermobeam::one_step::{Problem, Stepping};
use thermobeam::scheme::Scheme;
use thermobeam::solve::{Settings, Solver, TimeLevel};

use super::simulate::{Run, problem};
use super::{EnergySize, RunError, Sample};
use crate::scene::Scene;

/// What scenes must have in common to run together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Together {
    elements: usize,
    steps: usize,
    scheme: Scheme,
    settings: Settings,
}

impl Together {
    /// For a scene; `None` if it can only run alone.
    pub fn of(scene: &Scene) -> Option<Self> {
        let Stepping {
            scheme,
            settings,
            loaded,
            ..
        } = scene.one_step().ok()?;
        let common = Self {
            elements: scene.mesh.elements(),
            steps: scene.steps(),
            scheme,
            settings,
        };
        // Lanes have no loads.
        (settings.solver == Solver::Newton && !loaded).then_some(common)
    }
}

/// Runs scenes that agree in [`Together::of`] to their ends, as
/// [`Simulator::run`](super::simulate::Simulator::run) does with each, without a history. A scene
/// that fails does not affect the others.
///
/// The time of a run is its share of their total time.
///
/// # Errors
/// [`RunError::Setup`] of the first scene that cannot be set up, and if the scenes do not agree;
/// [`RunError::TimeUp`].
pub fn run_together(scenes: &[&Scene]) -> Result<Vec<Run>, RunError> {
    let Some(common) = scenes.first().and_then(|scene| Together::of(scene)) else {
        return Ok(vec![]);
    };
    let dt: Vec<f64> = scenes.iter().map(|scene| scene.dt()).collect();
    let mut driver = EnsembleDriver::new(
        scenes.iter().map(|scene| problem(scene)).collect(),
        &dt,
        common.scheme,
        common.settings,
    )?;
    let mut level = TimeLevel::new(common.elements + 1);
    let mut lanes = vec![];
    for (k, scene) in scenes.iter().enumerate() {
        lanes.push(LaneRun::new(k, scene, driver.ensemble(), &mut level));
    }
    driver.run(common.steps, |ensemble, balances| {
        for (lane, balance) in lanes.iter_mut().zip(balances) {
            lane.see(ensemble, balance, &mut level);
        }
        if lanes.iter().all(|lane| lane.run.failure.is_some()) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    })?;
    let share = driver.wall() / scenes.len() as u32;
    let mut runs = vec![];
    for mut lane in lanes {
        if lane.run.failure.is_none() {
            lane.end(driver.ensemble(), &mut level);
        }
        runs.push(Run {
            wall: share,
            ..lane.run
        });
    }
    Ok(runs)
}

/// One of the scenes.
struct LaneRun<'s> {
    k: usize,
    scene: &'s Scene,
    run: Run,
}

impl<'s> LaneRun<'s> {
    fn new(k: usize, scene: &'s Scene, ensemble: &Ensemble, level: &mut TimeLevel) -> Self {
        let first = sample(k, scene, ensemble, level, 0).at_the_start(scene.obstacles);
        Self {
            k,
            scene,
            run: Run::start(first, ensemble.cases()[k].energy_scale(level), false),
        }
    }

    /// Adds a step; the run ends if it fails or violates the law of the energy.
    fn see(&mut self, ensemble: &Ensemble, balance: &Balance, level: &mut TimeLevel) {
        if self.run.failure.is_some() {
            return;
        }
        let k = self.k;
        let dt = self.scene.dt();
        let step = ensemble.steps();
        let outcome = ensemble
            .report(k)
            .map_err(RunError::from)
            .and_then(|report| {
                let tip = TipRange::at(ensemble.tip(k));
                let outcome = self.run.add(&report, balance, tip, || {
                    ensemble.observe(k, level);
                    let case = &ensemble.cases()[k];
                    EnergySize {
                        terms: case.energy_scale(level),
                        rounding: case.rounding(level, level).total(),
                        is_solved: self.scene.method.stopping().tolerance().is_some(),
                    }
                });
                outcome.map_err(|unsound| RunError::Unsound {
                    step,
                    t: step as f64 * dt - dt,
                    dt,
                    unsound,
                })
            });
        if let Err(failure) = outcome {
            self.end(ensemble, level);
            self.run.failure = Some(failure);
        }
    }

    /// Ends the run at the present level.
    fn end(&mut self, ensemble: &Ensemble, level: &mut TimeLevel) {
        let (k, run) = (self.k, &mut self.run);
        let last = if run.steps == 0 {
            run.first
        } else {
            sample(k, self.scene, ensemble, level, run.steps)
        };
        run.end(last, ensemble.work_of(k), ensemble.is_heated(k));
    }
}

fn sample(
    k: usize,
    scene: &Scene,
    ensemble: &Ensemble,
    level: &mut TimeLevel,
    step: usize,
) -> Sample {
    ensemble.observe(k, level);
    let (t, energy) = (
        step as f64 * scene.dt(),
        ensemble.cases()[k].energy(level).total(),
    );
    Sample::of(level, t, &scene.mesh, scene.beam.theta_a, energy)
}

/// Simulations running in lanes: time limit, step, energy balances shown to an observer.
pub(crate) struct EnsembleDriver {
    ensemble: Ensemble,
    balances: Vec<Balance>,
    /// The first simulation's time step, for messages.
    dt: f64,
    patience: Patience,
    wall: Duration,
}

impl EnsembleDriver {
    /// Starts at t = 0; arguments as for [`Ensemble::new`].
    ///
    /// # Errors
    /// [`SetupError`] as for [`Ensemble::new`].
    pub(crate) fn new(
        problems: Vec<Problem>,
        dt: &[f64],
        scheme: Scheme,
        settings: Settings,
    ) -> Result<Self, SetupError> {
        let elements = problems.iter().map(|problem| problem.mesh.elements()).sum();
        let ensemble = Ensemble::new(problems, dt, scheme, settings)?;
        let (balances, patience) = (Vec::with_capacity(dt.len()), Patience::new(elements));
        Ok(Self {
            ensemble,
            balances,
            dt: dt[0],
            patience,
            wall: Duration::ZERO,
        })
    }

    /// The simulations.
    pub(crate) fn ensemble(&self) -> &Ensemble {
        &self.ensemble
    }

    /// Time spent in the solver.
    pub(crate) fn wall(&self) -> Duration {
        self.wall
    }

    /// Does at most `steps` steps and shows each with the energy balances, until `see` ends them or
    /// all simulations have failed.
    ///
    /// # Errors
    /// [`TimeUp`] if the time limit of the case is reached.
    #[expect(clippy::disallowed_methods, reason = "several beams at once, in lanes")]
    pub(crate) fn run(
        &mut self,
        steps: usize,
        mut see: impl FnMut(&Ensemble, &[Balance]) -> ControlFlow<()>,
    ) -> Result<(), TimeUp> {
        for step in 0..steps {
            let mut cases = 0..self.ensemble.cases().len();
            if step > 0 && cases.all(|k| self.ensemble.report(k).is_err()) {
                break;
            }
            self.patience.check(step, || step as f64 * self.dt)?;
            let started = Instant::now();
            self.ensemble.step_once();
            self.wall += started.elapsed();
            self.ensemble.balances(&mut self.balances);
            if see(&self.ensemble, &self.balances).is_break() {
                break;
            }
        }
        Ok(())
    }
}
