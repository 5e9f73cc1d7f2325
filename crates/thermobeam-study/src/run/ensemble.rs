//! The driver for several simulations side by side: time limit, step, energy balances shown to an observer.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use convergence_study::run::time_limit::{Patience, TimeUp};
use thermobeam::energy::Balance;
use thermobeam::ensemble::Ensemble;
use thermobeam::error::SetupError;
use thermobeam::scheme::Scheme;
use thermobeam::simulation::Problem;
use thermobeam::solve::Settings;

/// Simulations under way.
pub(crate) struct EnsembleDriver {
    ensemble: Ensemble,
    balances: Vec<Balance>,
    /// The first simulation's time step, for messages.
    dt: f64,
    patience: Patience,
    wall: Duration,
}

impl EnsembleDriver {
    /// Stands at t = 0; arguments as for [`Ensemble::new`].
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
        Ok(Self { ensemble, balances, dt: dt[0], patience, wall: Duration::ZERO })
    }

    /// The simulations.
    pub(crate) fn ensemble(&self) -> &Ensemble {
        &self.ensemble
    }

    /// Time that the solver has taken.
    pub(crate) fn wall(&self) -> Duration {
        self.wall
    }

    /// Does one step of every simulation that has not failed.
    ///
    /// # Errors
    /// [`TimeUp`] where the time limit of the case is reached.
    pub(crate) fn advance(&mut self) -> Result<(), TimeUp> {
        let step = self.ensemble.step();
        self.patience.check(step, || step as f64 * self.dt)?;
        let started = Instant::now();
        self.ensemble.advance();
        self.wall += started.elapsed();
        Ok(())
    }

    /// Does up to `steps` steps and shows each with the energy balances to `observe`, which may end the run; it ends
    /// where every simulation has failed.
    ///
    /// # Errors
    /// As [`EnsembleDriver::advance`].
    pub(crate) fn run(
        &mut self,
        steps: usize,
        mut observe: impl FnMut(&Ensemble, &[Balance]) -> ControlFlow<()>,
    ) -> Result<(), TimeUp> {
        for _ in 0..steps {
            self.advance()?;
            self.ensemble.balances(&mut self.balances);
            let is_over = observe(&self.ensemble, &self.balances).is_break();
            if is_over || (0..self.ensemble.cases()).all(|k| self.ensemble.report(k).is_err()) {
                break;
            }
        }
        Ok(())
    }
}
