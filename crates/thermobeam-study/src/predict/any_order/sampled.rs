//! A scene of any order, run for its curves alone.

use std::time::{Duration, Instant};

use convergence_study::run::time_limit::Patience;
use convergence_study::text::number::max_or_nan;
use thermobeam::dg::{Field, Simulation};

use super::Cost;
use crate::run::any_order::AnyOrderFailure;
use crate::scene::any_order::AnyOrderScene;

/// Times at which runs are compared, at least and at most.
const TIMES: [f64; 2] = [2000.0, 100_000.0];

/// Times for the duration of an impact, during which the error inside steps has its peak.
const TIMES_PER_IMPACT: f64 = 8.0;

/// Curves at equally spaced times, which lie inside steps as well as at their ends.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sampled {
    /// u(1, t).
    pub(super) u: Vec<f64>,
    /// φ(1, t).
    pub(super) phi: Vec<f64>,
    /// The energy.
    pub(super) energy: Vec<f64>,
    /// Smallest and largest u(1, t), between the times as well.
    pub(super) range: [f64; 2],
    /// What the run has cost.
    pub(super) cost: Cost,
}

/// Which curves are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Curves {
    /// u(1, t).
    Tip,
    /// All.
    All,
}

/// How many intervals there are between the times of comparison.
pub(super) fn times(scene: &AnyOrderScene, impact: f64) -> usize {
    (TIMES_PER_IMPACT * scene.t_end / impact).clamp(TIMES[0], TIMES[1]).ceil() as usize
}

/// Runs the scene and samples it at `t_end k / count`, k = 0 ... count.
///
/// # Errors
/// The solver's own words: a scene that it refuses, a step that fails, or the time limit.
pub(super) fn sample(scene: &AnyOrderScene, count: usize, curves: Curves) -> Result<Sampled, String> {
    let mut simulation = Simulation::new(scene.problem(), scene.stepping).map_err(|error| error.to_string())?;
    let unknowns = 3 * simulation.space().blocks() * (scene.stepping.degree + 1);
    let mut patience = Patience::new(unknowns / 3);
    let mut level = simulation.level().clone();
    let range = simulation.tip_range();
    let mut sampled = Sampled { u: vec![], phi: vec![], energy: vec![], range, cost: Cost::default() };
    let mut wall = Duration::ZERO;
    let mut next = 0;
    loop {
        // The times of the last step, or the start.
        while next <= count {
            let t = if next == count { scene.t_end } else { scene.t_end * next as f64 / count as f64 };
            if t > simulation.t() {
                break;
            }
            match curves {
                Curves::Tip => sampled.u.push(simulation.value(Field::U, 1.0, t).unwrap_or(f64::NAN)),
                Curves::All => {
                    simulation.level_into(t, &mut level);
                    let at = |field| level.value_and_slope(simulation.space(), field, 1.0).0;
                    sampled.u.push(at(Field::U));
                    sampled.phi.push(at(Field::Phi));
                    sampled.energy.push(simulation.energy(&level).total());
                }
            }
            next += 1;
        }
        let failed = |failure: AnyOrderFailure| failure.to_string();
        patience.check(simulation.work().steps, || simulation.t()).map_err(|up| failed(up.into()))?;
        let started = Instant::now();
        let step = simulation.step(scene.t_end).map_err(|error| failed(error.into()))?;
        wall += started.elapsed();
        if step.is_none() {
            break;
        }
        let ([low, high], [least, most]) = (simulation.tip_range(), sampled.range);
        sampled.range = [-max_or_nan(-least, -low), max_or_nan(most, high)];
    }
    sampled.cost = Cost {
        unknown_solves: unknowns as f64 * simulation.work().solves as f64,
        seconds: wall.as_secs_f64(),
        runs: 1,
    };
    Ok(sampled)
}
