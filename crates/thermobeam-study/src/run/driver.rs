//! The one driver that steps a simulation: time limit, loads, step, levels shown to an observer.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use convergence_study::run::time_limit::{Patience, TimeUp};
use thermobeam::error::{SetupError, StepError};
use thermobeam::mesh::MeshError;
use thermobeam::simulation::{Problem, Simulation, Stepping};
use thermobeam::solve::{Level, StepReport};
use thiserror::Error;

use super::tally::{EnergyLaw, Unsound};

/// Why a problem was not stepped to its end.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RunError {
    /// The solver refuses the problem.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A step failed.
    #[error(transparent)]
    Step(#[from] StepError),
    /// The time limit of the case was reached.
    #[error(transparent)]
    TimeUp(#[from] TimeUp),
    /// A step raised the energy far beyond what rounding and tolerance explain, or it is not finite.
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

impl From<MeshError> for RunError {
    fn from(error: MeshError) -> Self {
        Self::Setup(error.into())
    }
}

/// A step that was done, as an observer sees it.
pub(crate) struct Step<'s> {
    /// Iterations and contraction of the step.
    pub(crate) report: StepReport,
    /// The level before it.
    pub(crate) old: &'s Level,
    /// The level after it.
    pub(crate) new: &'s Level,
    /// The simulation, standing at the new level.
    pub(crate) simulation: &'s Simulation,
}

/// A simulation under way.
pub(crate) struct Driver {
    simulation: Simulation,
    old: Level,
    new: Level,
    patience: Patience,
    wall: Duration,
    is_timed: bool,
}

impl Driver {
    /// Stands at t = 0.
    ///
    /// # Errors
    /// [`SetupError`] where the solver refuses the problem.
    pub(crate) fn new(problem: Problem, stepping: Stepping) -> Result<Self, SetupError> {
        let mut simulation = Simulation::new(problem, stepping)?;
        let old = simulation.level();
        let (new, patience) = (old.clone(), Patience::new(simulation.lengths().len()));
        Ok(Self { simulation, old, new, patience, wall: Duration::ZERO, is_timed: false })
    }

    /// Reads the clock before and after each step, which takes some 50 ns.
    pub(crate) fn timed(self) -> Self {
        Self { is_timed: true, ..self }
    }

    /// The simulation.
    pub(crate) fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The present level.
    pub(crate) fn level(&mut self) -> &Level {
        self.simulation.observe(&mut self.old);
        &self.old
    }

    /// The simulation and its present level.
    pub(crate) fn present(&mut self) -> (&Simulation, &Level) {
        self.simulation.observe(&mut self.old);
        (&self.simulation, &self.old)
    }

    /// Time that the solver has taken, if [`Driver::timed`].
    pub(crate) fn wall(&self) -> Duration {
        self.wall
    }

    /// Does one step.
    ///
    /// * `fill`: the loads of the step, asked for at its middle t_{n-½} if [`Stepping::loaded`] is set.
    ///
    /// # Errors
    /// [`RunError`]; the simulation then stands where it stood.
    pub(crate) fn advance(&mut self, fill: impl FnOnce(f64, &mut [[f64; 3]])) -> Result<StepReport, RunError> {
        let Self { simulation, patience, .. } = self;
        patience.check(simulation.step(), || simulation.t())?;
        let middle = (simulation.step() as f64 + 0.5) * simulation.dt();
        if let Some(load) = simulation.load_mut() {
            fill(middle, load);
        }
        let started = self.is_timed.then(Instant::now);
        let outcome = self.simulation.advance();
        self.wall += started.map(|started| started.elapsed()).unwrap_or_default();
        Ok(outcome?)
    }

    /// Does up to `steps` steps without loads and shows each to `observe`, which may end the run. It also ends at the step that raises
    /// the energy, or makes it infinite or NaN: no exactly solved step does.
    ///
    /// * Returns what `observe` broke off with; `None` after all steps.
    ///
    /// # Errors
    /// [`RunError`]; the simulation then stands at the last level shown.
    pub(crate) fn run<B>(
        &mut self,
        steps: usize,
        mut observe: impl FnMut(Step<'_>) -> ControlFlow<B>,
    ) -> Result<Option<B>, RunError> {
        let (simulation, level) = self.present();
        let mut law = EnergyLaw::new(simulation.energy(level).total());
        for _ in 0..steps {
            let report = self.advance(|_, _| ())?;
            self.simulation.observe(&mut self.new);
            let sound = law.step(self.simulation.energy_change(&self.old, &self.new), 0.0);
            let step = Step { report, old: &self.old, new: &self.new, simulation: &self.simulation };
            let flow = observe(step);
            std::mem::swap(&mut self.old, &mut self.new);
            if let Err(unsound) = sound {
                let (step, dt) = (self.simulation.step(), self.simulation.dt());
                return Err(RunError::Unsound { step, t: self.simulation.t() - dt, dt, unsound });
            }
            if let ControlFlow::Break(found) = flow {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }
}
