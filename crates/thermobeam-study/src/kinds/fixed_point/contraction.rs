//! The contraction factor in contact, measured against α.

use super::Part;
use crate::figures;
use crate::kinds::untyped::Measured;
use convergence_study::plots;
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::{Check, Figure, Quantity, Table};
use thermobeam::contraction::{contact_contraction, coupling_contraction};
use thermobeam::error::StepFailure;
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::EULER_CRANK_NICOLSON;
use thermobeam::simulation::{Initial, Problem, Simulation, Stepping};
use thermobeam::solve::{Settings, Solver};

/// Iterations after which an iteration with a factor near 1 is given up.
pub(super) const ITERATIONS: usize = 1000;
/// Increment at which a measurement stops: small enough for the slowest mode to stand alone, large against round-off.
const TOLERANCE: f64 = 1e-9;
/// Agreement asked for between measured and predicted factor.
const AGREEMENT: f64 = 0.03;
/// How far α must stand above the factor of the other lags to be seen alone: one percent is left to them.
const DOMINANCE: f64 = 100.0;
/// Slope of the beam pressed into the upper obstacle by a fifth of the gap.
const PRESSED: f64 = 0.12;

/// One step of a beam at rest, pressed into the upper obstacle.
pub(super) fn measure(elements: usize, [dt, epsilon, zeta]: [f64; 3]) -> Result<Measured, CaseFailure> {
    let mesh = Mesh::uniform(elements)?;
    let mut initial = Initial::at_rest(&mesh, 0.0);
    initial.u = mesh.nodes().iter().map(|x| PRESSED * x).collect();
    let beam = Beam { zeta, ..Beam::default() };
    let obstacles = Obstacles { epsilon, ..Obstacles::default() };
    let lengths: Vec<f64> = mesh.lengths().collect();
    let force = beam.axial_force(PRESSED * PRESSED);
    let alpha = contact_contraction(&beam, &obstacles, &lengths, &EULER_CRANK_NICOLSON, dt, force);
    let settings = Settings {
        solver: Solver::FixedPoint,
        tolerance: TOLERANCE,
        max_iterations: ITERATIONS,
        ..Settings::default()
    };
    let stepping = Stepping { scheme: EULER_CRANK_NICOLSON, settings, dt, loaded: false };
    let mut simulation = Simulation::new(Problem { beam, obstacles: Some(obstacles), mesh, initial }, stepping)?;
    let mut measured = Measured::default();
    measured.push("alpha", alpha);
    measured.push("coupling", coupling_contraction(&beam, &lengths, &EULER_CRANK_NICOLSON, dt, force));
    let (converged, factor, iterations) = match simulation.advance() {
        Ok(report) => (true, report.contraction.unwrap_or(f64::NAN), report.iterations),
        Err(error) => match error.failure {
            StepFailure::Diverged { iterations, contraction, .. } => (false, contraction, iterations),
            StepFailure::IterationLimit { iterations, contraction, .. } => (false, contraction, iterations),
            StepFailure::NonFinite { iterations, .. } => (false, f64::INFINITY, iterations),
            StepFailure::Indefinite { .. } => return Err(error.into()),
        },
    };
    measured.push("converged", f64::from(converged));
    measured.push("contraction", factor);
    measured.push("iterations", iterations as f64);
    Ok(measured)
}

pub(super) fn judge(grid: &[[f64; 3]], results: &[Result<Measured, CaseFailure>]) -> Part {
    let (mut checks, mut rows, mut quantities) = (vec![], vec![], vec![]);
    let mut worst = 0.0_f64;
    for ([dt, epsilon, zeta], result) in grid.iter().zip(results) {
        let Ok(measured) = result else { continue };
        let name = format!("dt = {dt:e}, epsilon = {epsilon:e}, zeta = {zeta}");
        let (alpha, factor) = (measured.value("alpha"), measured.value("contraction"));
        let converged = measured.value("converged") == 1.0;
        let deviation = factor / alpha - 1.0;
        let evidence = format!("alpha {alpha:.5}, measured {factor:.5}");
        if alpha < 1.0 - AGREEMENT && alpha >= DOMINANCE * measured.value("coupling") {
            worst = if deviation.is_nan() { f64::NAN } else { worst.max(deviation.abs()) };
            let holds = converged && deviation.abs() <= AGREEMENT;
            checks.push(Check::that(holds, format!("{name}: contracts by alpha"), evidence));
            quantities.push(Quantity { name: format!("contraction, {name}"), value: factor, tolerance: 1e-2 });
        } else if alpha > 1.0 + AGREEMENT {
            checks.push(Check::that(!converged, format!("{name}: diverges, alpha being above 1"), evidence));
        }
        rows.push(vec![
            format!("{dt:e}"),
            format!("{epsilon:e}"),
            zeta.to_string(),
            format!("{alpha:.5}"),
            if converged { format!("{factor:.5}") } else { "diverges".to_owned() },
            format!("{}", measured.value("iterations")),
        ]);
    }
    let head = ["dt", "epsilon", "zeta", "alpha", "measured", "iterations"].map(str::to_owned).to_vec();
    Part {
        summary: format!("contraction within {:.1} % of alpha", 100.0 * worst),
        checks,
        table: Table { title: "Contraction factor in contact".to_owned(), head, rows },
        quantities,
    }
}

pub(super) fn figure(id: &str, grid: &[[f64; 3]], results: &[Result<Measured, CaseFailure>]) -> Figure {
    let mut zetas: Vec<f64> = grid.iter().map(|[_, _, zeta]| *zeta).collect();
    zetas.dedup();
    let series = zetas.iter().map(|zeta| {
        let of_zeta = grid.iter().zip(results).filter(|([_, _, z], _)| z == zeta);
        let point = |measured: &Measured| (measured.value("alpha"), measured.value("contraction"));
        let points = of_zeta.filter_map(|(_, result)| result.as_ref().ok().map(point)).collect();
        plots::Series { label: format!("ζ = {zeta}"), points }
    });
    let svg = figures::contraction(&figures::Contraction { title: None, series: series.collect() });
    let caption = "Contraction factor of the fixed point in contact, measured over predicted; past 1 it diverges.";
    Figure { file: format!("{id}-contraction.svg"), caption: caption.to_owned(), svg }
}
