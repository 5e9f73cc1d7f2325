//! One row of a map: all its time steps, Newton's method in lanes.

use crate::kinds::untyped::Measured;
use crate::kinds::watch::{SOLVED, Watch};
use convergence_study::run::time_limit::Patience;
use convergence_study::study::CaseFailure;
use thermobeam::contraction::{contact_contraction, coupling_contraction};
use thermobeam::ensemble::Ensemble;
use thermobeam::error::{StepError, StepFailure};
use thermobeam::parameters::Beam;
use thermobeam::scheme::EULER_CRANK_NICOLSON;
use thermobeam::simulation::{Problem, Simulation, Stepping};
use thermobeam::solve::{Level, Settings, Solver, StepReport};

/// Iterations after which the fixed point is given up on the map.
pub(super) const ITERATIONS: usize = 150;
/// Increment at which it has converged: large against round-off, so that the last ratio is a contraction.
const TOLERANCE: f64 = 1e-10;

/// What is measured at each point of a row; a curve of (dt, value), without the points that have none.
pub(super) const CONTRACTION: &str = "contraction";
pub(super) const ITERATIONS_OF_FIXED_POINT: &str = "fixed-point iterations";
pub(super) const FAILED: &str = "fixed point failed";
pub(super) const ALPHA: &str = "alpha";
pub(super) const GAMMA: &str = "gamma";
pub(super) const ITERATIONS_OF_NEWTON: &str = "newton iterations";
pub(super) const REFUSED: &str = "newton refused";
pub(super) const RESIDUAL: &str = "residual";

/// The first step by the fixed point, with so many iterations at most.
pub(super) fn fixed_point(problem: &Problem, dt: f64, iterations: usize) -> Result<Ended, CaseFailure> {
    let settings = Settings {
        solver: Solver::FixedPoint,
        tolerance: TOLERANCE,
        max_iterations: iterations,
        ..Settings::default()
    };
    let stepping = Stepping { scheme: EULER_CRANK_NICOLSON, settings, dt, loaded: false };
    Ok(Ended::of(Simulation::new(problem.clone(), stepping)?.advance()))
}

/// How a step by the fixed point ended.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ended {
    pub(super) converged: bool,
    pub(super) iterations: usize,
    /// Ratio of the last two increments: below 1 where the iteration converges, if slowly; NaN where there was one.
    pub(super) contraction: f64,
}

impl Ended {
    fn of(outcome: Result<StepReport, StepError>) -> Self {
        let (converged, iterations, contraction) = match outcome {
            Ok(report) => (true, report.iterations, report.contraction.unwrap_or(f64::NAN)),
            Err(error) => match error.failure {
                StepFailure::Diverged { iterations, contraction, .. }
                | StepFailure::IterationLimit { iterations, contraction, .. } => (false, iterations, contraction),
                StepFailure::NonFinite { iterations, .. } => (false, iterations, f64::INFINITY),
                StepFailure::Indefinite { .. } => (false, 0, f64::INFINITY),
            },
        };
        Self { converged, iterations, contraction }
    }
}

/// The factors α and γ of a step with the mean axial force m.
pub(super) fn factors(problem: &Problem, dt: f64, m: f64) -> (f64, f64) {
    let lengths: Vec<f64> = problem.mesh.lengths().collect();
    let scheme = &EULER_CRANK_NICOLSON;
    let alpha = problem
        .obstacles
        .map_or(0.0, |obstacles| contact_contraction(&problem.beam, &obstacles, &lengths, scheme, dt, m));
    (alpha, coupling_contraction(&problem.beam, &lengths, scheme, dt, m))
}

/// The axial force at the start; the maps' first steps hardly change it.
pub(super) fn axial_force(beam: &Beam, problem: &Problem) -> f64 {
    let lengths: Vec<f64> = problem.mesh.lengths().collect();
    beam.axial_force(thermobeam::norms::slope_squared(&lengths, &problem.initial.u))
}

pub(super) fn row(problem: &Problem, dts: &[f64], steps: usize) -> Result<Measured, CaseFailure> {
    let mut row = Row::default();
    let m = axial_force(&problem.beam, problem);
    let mut patience = Patience::of_long_rounds();
    for (done, &dt) in dts.iter().enumerate() {
        patience.check(done, || dt)?;
        let ended = fixed_point(problem, dt, ITERATIONS)?;
        row.push(FAILED, dt, f64::from(!ended.converged));
        if ended.converged {
            row.push(ITERATIONS_OF_FIXED_POINT, dt, ended.iterations as f64);
            row.push(CONTRACTION, dt, ended.contraction);
        }
        let (alpha, gamma) = factors(problem, dt, m);
        row.push(ALPHA, dt, alpha);
        row.push(GAMMA, dt, gamma);
    }
    let mut worst = Measured::default();
    newton(problem, dts, steps, &mut row, &mut worst)?;
    worst.series = row.curves;
    Ok(worst)
}

/// Newton's method, several time steps side by side.
fn newton(
    problem: &Problem,
    dts: &[f64],
    steps: usize,
    row: &mut Row,
    worst: &mut Measured,
) -> Result<(), CaseFailure> {
    let settings = Settings { tolerance: SOLVED, ..Settings::default() };
    let mut ensemble = Ensemble::new(vec![problem.clone(); dts.len()], dts, EULER_CRANK_NICOLSON, settings)?;
    let mut old = vec![Level::new(problem.mesh.nodes().len()); dts.len()];
    (0..dts.len()).for_each(|k| ensemble.observe(k, &mut old[k]));
    let mut new = old.clone();
    let mut watches: Vec<Watch> = (0..dts.len()).map(|k| Watch::new(ensemble.energy_scale(k, &old[k]))).collect();
    let (mut most, mut balances) = (vec![0; dts.len()], vec![]);
    let mut patience = Patience::new(dts.len() * problem.mesh.elements());
    for step in 1..=steps {
        patience.check(step - 1, || (step - 1) as f64 * dts[0])?;
        ensemble.advance();
        ensemble.balances(&mut balances);
        for k in 0..dts.len() {
            let Ok(report) = ensemble.report(k) else { continue };
            most[k] = most[k].max(report.iterations);
            ensemble.observe(k, &mut new[k]);
            if step == 1 {
                row.push("contact", dts[k], new[k].contact_force);
            }
            let scale = ensemble.energy_scale(k, &new[k]);
            watches[k].step(&balances[k], scale, || ensemble.rounding(k, &old[k], &new[k]));
        }
        std::mem::swap(&mut old, &mut new);
    }
    for (k, &dt) in dts.iter().enumerate() {
        let refused = ensemble.report(k).is_err();
        row.push(REFUSED, dt, f64::from(refused));
        if most[k] > 0 {
            row.push(ITERATIONS_OF_NEWTON, dt, most[k] as f64);
            row.push(RESIDUAL, dt, watches[k].residual);
            watches[k].worsen(worst);
        }
    }
    Ok(())
}

/// Curves under construction.
#[derive(Default)]
struct Row {
    curves: Vec<(String, Vec<(f64, f64)>)>,
}

impl Row {
    /// Adds a point; one that is not finite, an α of infinity say, is no point.
    fn push(&mut self, name: &str, dt: f64, value: f64) {
        if !value.is_finite() {
            return;
        }
        match self.curves.iter_mut().find(|(key, _)| key == name) {
            Some((_, points)) => points.push((dt, value)),
            None => self.curves.push((name.to_owned(), vec![(dt, value)])),
        }
    }
}
