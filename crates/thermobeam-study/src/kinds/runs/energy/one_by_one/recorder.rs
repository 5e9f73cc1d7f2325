//! What is recorded of a run, step by step.

use thermobeam::{energy::Energy, motion::Motion, one_step::Problem};

use super::{EnergyAt, EnergyHistory, EnergyRun};
use crate::kinds::prelude::*;
use crate::{
    kinds::runs::{
        energy::bound::{Stability, left_side},
        watch::EnergyWatch,
    },
    run::driver::Driver,
};

/// Samples of a run, about.
const SAMPLES: usize = 400;

/// Steps from one computation of the energy's size to the next.
const SCALED: usize = 8;

/// What is recorded of a run, step by step.
pub(super) struct Recorder<'r> {
    run: &'r EnergyRun,
    /// The bound of (3.12), if Corollary 3.2 is claimed of the run.
    bound: Option<Stability>,
    pub(super) watch: EnergyWatch,
    /// Largest change of the energy in a step since the last sample, in units of the initial
    /// energy.
    change: f64,
    /// Kinetic energy at t = 0.
    kinetic: f64,
    pub(super) found: EnergyHistory,
}

impl<'r> Recorder<'r> {
    /// The beam stands at t = 0.
    pub(super) fn new(run: &'r EnergyRun, driver: &Driver<'_>) -> Self {
        let simulation = driver.simulation();
        let level = driver.level();
        let energy = simulation.energy(level);
        let Energy {
            kinetic,
            shear,
            bending,
            thermal,
            kirchhoff,
            contact,
            lifting,
        } = energy;
        let Problem {
            beam, obstacles, ..
        } = &run.problem;
        let bound = run
            .is_bounded
            .then(|| Stability::of(beam, obstacles.as_ref(), energy.total()));
        let mut recorder = Self {
            run,
            bound: bound.flatten(),
            watch: EnergyWatch::new(simulation.energy_scale(level)),
            change: f64::NAN,
            kinetic,
            found: EnergyHistory {
                initial_energy: kinetic
                    + shear
                    + bending
                    + thermal
                    + kirchhoff.abs()
                    + contact
                    + lifting.abs(),
                ..EnergyHistory::default()
            },
        };
        recorder.add_share(driver);
        recorder.sample(driver);
        recorder
    }

    /// Adds the last step.
    pub(super) fn add(&mut self, driver: &Driver<'_>, iterations: usize) {
        let simulation = driver.simulation();
        let old = driver.old_level();
        let new = driver.level();
        let step = simulation.steps();
        let found = &mut self.found;
        found.steps = step;
        found.contact_steps += usize::from(new.contact_force != 0.0);
        found.most_iterations = iterations.max(found.most_iterations);
        // The scale only grows, so that leaving a level out makes the bounds stricter.
        let is_scaled = step % SCALED == 1;
        let scale = if is_scaled {
            simulation.energy_scale(new)
        } else {
            0.0
        };
        let balance = simulation.balance(old, new);
        self.watch
            .add(&balance, scale, || simulation.rounding(old, new));
        if is_scaled || step == self.run.steps {
            let moved = (simulation.energy(new).kinetic - self.kinetic).abs() / self.watch.unit();
            found.moved = max_or_nan(found.moved, moved);
        }
        let change = balance.change / found.initial_energy;
        self.change = if self.change.is_nan() {
            change
        } else {
            max_or_nan(self.change, change)
        };
        self.add_share(driver);
        if let Some(bound) = self.bound {
            let lost = (balance.viscous + balance.thermal) / bound.available;
            self.found.lost = Some(self.found.lost.unwrap_or(0.0) + lost);
        }
        let steps = self.run.steps;
        if step.is_multiple_of(steps.div_ceil(SAMPLES)) || step == steps {
            self.sample(driver);
        }
    }

    /// Compares the left side of (3.12) with its bound.
    fn add_share(&mut self, driver: &Driver<'_>) {
        let Some(bound) = self.bound else { return };
        let simulation = driver.simulation();
        let level = driver.level();
        let obstacles = self.run.problem.obstacles.as_ref();
        let energy = simulation.energy(level);
        let share = left_side(obstacles, simulation.lengths(), level, &energy) / bound.constant;
        let largest = self.found.of_bound;
        self.found.of_bound = Some(largest.map_or(share, |largest| max_or_nan(largest, share)));
    }

    fn sample(&mut self, driver: &Driver<'_>) {
        let simulation = driver.simulation();
        self.found.samples.push(EnergyAt {
            step: simulation.steps(),
            t: simulation.t(),
            change: self.change,
            drift: self.watch.drift,
        });
        self.change = f64::NAN;
    }
}
