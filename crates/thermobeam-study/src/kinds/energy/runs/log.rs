//! One run: the energy and its balance in every step.

use std::ops::ControlFlow;

use convergence_study::study::CaseFailure;
use convergence_study::text::number::max_or_nan;
use thermobeam::energy::Energy;

use super::{End, Found, Run, Sample};
use crate::kinds::watch::Watch;
use crate::run::driver::{Driver, RunError, Step};

/// Samples of a run, about.
const SAMPLES: usize = 400;

/// The size of the energy is computed every so many steps.
const SCALED: usize = 8;

/// Runs to the last step, or to the step that fails.
pub(super) fn run(run: &Run) -> Result<Found, CaseFailure> {
    let mut driver = Driver::new(run.problem(), run.stepping)?;
    let mut log = Log::new(&mut driver, run.steps);
    let ended = driver.run(run.steps, |step| {
        log.add(&step);
        ControlFlow::<()>::Continue(())
    });
    log.found.end = match ended {
        Ok(_) => End::Answer,
        Err(RunError::Step(error)) => End::of(&error.failure),
        Err(error) => return Err(error.into()),
    };
    log.found.worst = log.watch.worst();
    log.found.drift = log.watch.drift;
    Ok(log.found)
}

/// What a run has shown so far.
struct Log {
    watch: Watch,
    /// Steps of the whole run.
    last: usize,
    /// Steps from one sample to the next; the last step is one in any case.
    every: usize,
    /// Largest residual since the last sample, in units of the initial energy.
    peak: f64,
    found: Found,
}

impl Log {
    fn new(driver: &mut Driver, last: usize) -> Self {
        let (simulation, level) = driver.present();
        let watch = Watch::new(simulation.energy_scale(level));
        let energy = simulation.energy(level);
        let start = Sample { step: 0, t: simulation.t(), energy: energy.total(), residual: 0.0, drift: 0.0 };
        let found = Found {
            end: End::Answer,
            steps: 0,
            contact_steps: 0,
            most_iterations: 0,
            initial_energy: size(&energy),
            worst: watch.worst(),
            drift: 0.0,
            samples: vec![start],
        };
        Self { watch, last, every: last.div_ceil(SAMPLES), peak: 0.0, found }
    }

    fn add(&mut self, step: &Step<'_>) {
        let Step { report, old, new, simulation } = *step;
        let Found { steps, contact_steps, most_iterations, initial_energy, samples, .. } = &mut self.found;
        *steps = simulation.step();
        *contact_steps += usize::from(new.contact_force != 0.0);
        *most_iterations = report.iterations.max(*most_iterations);
        // The scale only grows, so that leaving a level out makes the bounds stricter.
        let scale = if *steps % SCALED == 1 { simulation.energy_scale(new) } else { 0.0 };
        let balance = simulation.balance(old, new);
        self.watch.step(&balance, scale, || simulation.rounding(old, new));
        self.peak = max_or_nan(self.peak, balance.residual.abs() / *initial_energy);
        if *steps % self.every == 0 || *steps == self.last {
            let energy = simulation.energy(new).total();
            let (t, residual, drift) = (simulation.t(), self.peak, self.watch.drift);
            samples.push(Sample { step: *steps, t, energy, residual, drift });
            self.peak = 0.0;
        }
    }
}

/// The size of an energy: its terms without their signs.
fn size(energy: &Energy) -> f64 {
    let Energy { kinetic, shear, bending, thermal, kirchhoff, contact, lifting } = energy;
    kinetic + shear + bending + thermal + kirchhoff.abs() + contact + lifting.abs()
}
