//! Scenes that run side by side in lanes, twice as fast as one after the other, each with the bits that it gets alone.

use std::ops::ControlFlow;

use thermobeam::ensemble::Ensemble;
use thermobeam::scheme::Scheme;
use thermobeam::simulation::Stepping;
use thermobeam::solve::{Level, Settings, Solver};

use super::{Middle, Recording, Run, Sample, Simulator, Sums, problem};
use crate::run::driver::RunError;
use crate::run::ensemble::EnsembleDriver;
use crate::run::tally::EnergyLaw;
use crate::scene::Scene;

/// What scenes must have in common to run side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Together {
    elements: usize,
    steps: usize,
    scheme: Scheme,
    settings: Settings,
}

impl Together {
    /// Of a scene; `None` where it can only run alone.
    pub fn of(scene: &Scene) -> Option<Self> {
        let Stepping { scheme, settings, .. } = scene.one_step().ok()?;
        let common = Self { elements: scene.mesh.elements(), steps: scene.steps(), scheme, settings };
        (settings.solver == Solver::Newton).then_some(common)
    }
}

/// Runs scenes that agree in [`Together::of`] to their ends, as [`Simulator::run`](super::Simulator::run) does each of
/// them, without a history. A scene that fails does not touch the others.
///
/// A run's time is its share of the time that all of them took.
///
/// # Errors
/// [`RunError::Setup`] of the first scene that cannot be set up, and where the scenes do not agree; [`RunError::TimeUp`].
pub fn run_together(scenes: &[Scene]) -> Result<Vec<Run>, RunError> {
    let Some(common) = scenes.first().and_then(Together::of) else { return Ok(vec![]) };
    let dt: Vec<f64> = scenes.iter().map(|scene| scene.dt()).collect();
    let mut driver = EnsembleDriver::new(scenes.iter().map(problem).collect(), &dt, common.scheme, common.settings)?;
    let mut level = Level::new(common.elements + 1);
    let sample = |ensemble: &Ensemble, level: &mut Level, k: usize, step: usize| {
        ensemble.observe(k, level);
        let scene = &scenes[k];
        let t = step as f64 * scene.dt();
        Sample::of(level, t, Middle::of(&scene.mesh), scene.beam.theta_a, ensemble.energy(k, level).total())
    };
    let start = |k: usize| sample(driver.ensemble(), &mut level, k, 0).at_the_start(scenes[k].obstacles);
    let firsts: Vec<Sample> = (0..scenes.len()).map(start).collect();
    let mut sums: Vec<Sums> = firsts.iter().map(|first| Sums::new(first.u_tip)).collect();
    let mut laws: Vec<EnergyLaw> = firsts.iter().map(|first| EnergyLaw::new(first.energy)).collect();
    let mut is_sound = vec![true; scenes.len()];
    driver.run(common.steps, |ensemble, balances| {
        for (k, (sums, balance)) in sums.iter_mut().zip(balances).enumerate() {
            if let Ok(report) = ensemble.report(k) {
                is_sound[k] &= laws[k].step(balance.change, 0.0).is_ok();
                sums.add(&report, balance, ensemble.tip(k), ensemble.contact_force(k));
            }
        }
        ControlFlow::Continue(())
    })?;
    let (ensemble, share) = (driver.ensemble(), driver.wall() / scenes.len() as u32);
    let end = |(k, sums): (usize, Sums)| {
        if !is_sound[k] {
            // By itself it ends at the step that breaks the law.
            return Ok(Simulator::new(&scenes[k])?.run(Recording::Summary, &mut |_| ()));
        }
        let failure = ensemble.report(k).err().filter(|_| common.steps > 0);
        let steps = failure.as_ref().map_or(common.steps, |error| error.step - 1);
        let last = if steps == 0 { firsts[k] } else { sample(ensemble, &mut level, k, steps) };
        let run = sums.run(steps, [firsts[k], last], share, ensemble.work_of(k), ensemble.is_heated(k));
        Ok(Run { failure: failure.map(Into::into), ..run })
    };
    sums.into_iter().enumerate().map(end).collect()
}
