//! The time limit of a case, asked for before each step of a simulation.

use convergence_study::run::time_limit::{Patience, TimeUp};
use thermobeam::simulation::Simulation;

/// The limit for the steps of a simulation.
pub(crate) trait StepPatience: Sized {
    /// For the steps of this simulation.
    fn of(simulation: &Simulation) -> Self;

    /// May the simulation do its next step?
    ///
    /// # Errors
    /// [`TimeUp`] where the limit is reached.
    fn before_step_of(&mut self, simulation: &Simulation) -> Result<(), TimeUp>;
}

impl StepPatience for Patience {
    fn of(simulation: &Simulation) -> Self {
        Self::new(simulation.lengths().len())
    }

    fn before_step_of(&mut self, simulation: &Simulation) -> Result<(), TimeUp> {
        self.check(simulation.step(), || simulation.t())
    }
}
