//! An error budget for any scene: how far its numbers are from the exact ones, and why.
//!
//! No exact solution is needed, only the scene run again, seven times at four and a half times its cost:
//!
//! * *space*: on a half and a quarter of the elements. With the differences `d1 = |q_{h/2h}|`, `d2 = |q_{2h/4h}|` the rate is
//!   `p = log2(d2/d1)` and the error of the scene itself `d1/(2^p - 1)` (`convergence_study::judge::richardson`);
//! * *time*: the same with a half and a quarter of the steps;
//! * *iteration*: against Newton's method with a tolerance a hundred times tighter;
//! * *round-off*: with every inner node moved by one rounding error of its position. That changes the lengths, and with
//!   them every matrix entry, by about as much as rounding changes what the entries act on; with the sum of N rounded
//!   increments, √N ε |q| at least, it tells the order of magnitude and no more.
//!
//! The parts are added up as if their signs were equal.

mod report;
mod runs;

use crate::error::curve::distance;
use crate::run::driver::RunError;
use crate::scene::Scene;
use convergence_study::judge::richardson::error_and_rate;
use runs::{Reading, Runs};
use thiserror::Error;

/// The budget could not be computed: one of the runs did not complete.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("the run with {run}: {failure}")]
pub struct EstimateError {
    /// Which run.
    pub run: String,
    /// Why it failed.
    pub failure: RunError,
}

/// Where an error comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Source {
    /// The mesh.
    Space,
    /// The time step.
    Time,
    /// The tolerance of the iteration.
    Iteration,
    /// The arithmetic.
    RoundOff,
}

impl Source {
    /// All sources, in the order of the table.
    pub const ALL: [Source; 4] = [Source::Space, Source::Time, Source::Iteration, Source::RoundOff];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Source::Space => "space",
            Source::Time => "time",
            Source::Iteration => "iteration",
            Source::RoundOff => "round-off",
        }
    }

    /// The key in JSON.
    fn key(self) -> &'static str {
        match self {
            Source::RoundOff => "round_off",
            other => other.name(),
        }
    }
}

/// The error in one number or curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// What it is the error of.
    pub name: &'static str,
    /// The number itself; of a curve its largest absolute value.
    pub value: f64,
    /// Error by source, in the order of [`Source::ALL`]; of a curve the largest over time.
    pub errors: [f64; 4],
    /// Observed rates in space and in time; `None` where a difference was zero or not finite.
    pub rates: [Option<f64>; 2],
}

impl Estimate {
    /// Error from one source.
    pub fn error(&self, source: Source) -> f64 {
        self.errors[source as usize]
    }

    /// Sum of all four.
    pub fn total(&self) -> f64 {
        self.errors.iter().sum()
    }

    /// The largest of the four; the earlier one where two are equal.
    pub fn dominant(&self) -> Source {
        let larger = |a: Source, b: Source| if self.error(b) > self.error(a) { b } else { a };
        Source::ALL.into_iter().fold(Source::Space, larger)
    }
}

/// The errors in the numbers that a run of a scene shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Budget {
    /// The scene's name.
    pub scene: String,
    /// Elements and steps of the scene.
    pub resolution: [usize; 2],
    /// Elements and steps that the values are of: those of the scene, brought up to a multiple of 4.
    pub measured: [usize; 2],
    /// Order of the time scheme.
    pub time_order: f64,
    /// One for each number or curve.
    pub estimates: Vec<Estimate>,
}

/// What is estimated, by name, and how it is read off a run.
type Observable = (&'static str, fn(&Reading) -> Vec<f64>);

const OBSERVABLES: [Observable; 8] = [
    ("u(1) at the end", |r| last(&r.tip)),
    ("largest u(1)", |r| vec![r.extremes[1]]),
    ("smallest u(1)", |r| vec![r.extremes[0]]),
    ("u(1) over time", |r| r.tip.clone()),
    ("phi(1) at the end", |r| last(&r.rotation)),
    ("phi(1) over time", |r| r.rotation.clone()),
    ("energy at the end", |r| last(&r.energy)),
    ("energy over time", |r| r.energy.clone()),
];

fn last(curve: &[f64]) -> Vec<f64> {
    vec![curve.last().copied().unwrap_or(f64::NAN)]
}

/// Order of everything estimated here in h: values at nodes and the energy converge faster than the theorem's norm.
const SPACE_ORDER: f64 = 2.0;

/// Estimates the discretisation errors of a scene.
///
/// # Errors
/// [`EstimateError`] where the scene, or one of the coarser runs, does not come to its end.
pub fn estimate(scene: &Scene) -> Result<Budget, EstimateError> {
    let runs = Runs::new(scene)?;
    let estimates = OBSERVABLES.iter().map(|&observable| of(observable, scene, &runs)).collect();
    let resolution = [scene.mesh.elements(), scene.steps()];
    let time_order = order(scene);
    Ok(Budget { scene: scene.name.clone(), resolution, measured: runs.resolution, time_order, estimates })
}

/// Order of the scheme in dt.
fn order(scene: &Scene) -> f64 {
    scene.one_step().map_or(f64::NAN, |stepping| stepping.scheme.order)
}

fn of((name, read): Observable, scene: &Scene, runs: &Runs) -> Estimate {
    let own = read(&runs.own);
    let tight = read(&runs.tight);
    let richardson = |coarser: &[Reading; 2], order: f64, from: usize, to: usize| {
        let [half, quarter] = [read(&coarser[0]), read(&coarser[1])];
        let (error, rate) = error_and_rate(distance(&half, &tight), distance(&quarter, &half), order);
        // From the resolution measured to the scene's own, where 4 does not divide that.
        (error * (from as f64 / to as f64).powf(order), rate)
    };
    let (space, space_rate) = richardson(&runs.space, SPACE_ORDER, runs.resolution[0], scene.mesh.elements());
    let (time, time_rate) = richardson(&runs.time, order(scene), runs.resolution[1], scene.steps());
    let value = if own.len() == 1 { own[0] } else { distance(&own, &vec![0.0; own.len()]) };
    let summed = (scene.steps() as f64).sqrt() * f64::EPSILON * value.abs();
    let moved = distance(&read(&runs.moved), &tight);
    // A NaN must stay a NaN.
    let round_off = if moved < summed { summed } else { moved };
    Estimate { name, value, errors: [space, time, distance(&own, &tight), round_off], rates: [space_rate, time_rate] }
}
