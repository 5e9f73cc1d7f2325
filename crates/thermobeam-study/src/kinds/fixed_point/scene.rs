//! The fixed point on a scene: against Newton's method, over its own tolerance.

use super::Part;
use crate::kinds::untyped::Measured;
use crate::run::patience::StepPatience;
use crate::run::simulate;
use crate::scene::Scene;
use convergence_study::plots;
use convergence_study::run::time_limit::Patience;
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::{Check, Figure, Table};
use thermobeam::mesh::Mesh;
use thermobeam::norms::TheoremSquares;
use thermobeam::simulation::{Simulation, Stepping};
use thermobeam::solve::{Level, Settings, Solver};

/// Tolerance of the Newton run that the fixed point is compared with.
const SOLVED: f64 = 1e-14;

/// Runs the scene by both solvers side by side; the distance is the largest over all levels.
pub(super) fn compare(scene: &Scene, elements: usize, steps: usize, tolerance: f64) -> Result<Measured, CaseFailure> {
    let scene = Scene { mesh: Mesh::uniform(elements)?, ..scene.clone() };
    let simulation = |settings| {
        let stepping = Stepping { scheme: scene.scheme, settings, dt: scene.dt, loaded: false };
        Simulation::new(simulate::problem(&scene), stepping)
    };
    let mut newton = simulation(Settings { tolerance: SOLVED, ..Settings::default() })?;
    let mut fixed = simulation(Settings { solver: Solver::FixedPoint, tolerance, ..Settings::default() })?;
    let (mut reference, mut level) = (newton.level(), fixed.level());
    let (mut distance, mut total, mut most) = (0.0_f64, 0, 0);
    let (mut iterations, mut contact) = (vec![], vec![]);
    let mut patience = Patience::of(&newton);
    for _ in 0..steps {
        patience.before_step_of(&newton)?;
        newton.advance()?;
        let report = fixed.advance()?;
        newton.observe(&mut reference);
        fixed.observe(&mut level);
        let here = apart(newton.lengths(), &level, &reference);
        distance = if here.is_nan() { f64::NAN } else { distance.max(here) };
        total += report.iterations;
        most = most.max(report.iterations);
        iterations.push((fixed.t(), report.iterations as f64));
        if level.contact_force != 0.0 {
            contact.push((fixed.t() - scene.dt, fixed.t()));
        }
    }
    let mut measured = Measured::default();
    measured.push("distance", distance);
    measured.push("mean iterations", total as f64 / steps as f64);
    measured.push("most iterations", most as f64);
    measured.series = vec![("iterations".to_owned(), iterations), ("contact".to_owned(), contact)];
    Ok(measured)
}

/// Distance of two levels in the norm of Theorem 3.4.
fn apart(lengths: &[f64], a: &Level, b: &Level) -> f64 {
    let difference = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>();
    let [v, u, w, phi, theta] = [(&a.v, &b.v), (&a.u, &b.u), (&a.w, &b.w), (&a.phi, &b.phi), (&a.theta, &b.theta)]
        .map(|(a, b)| difference(a, b));
    TheoremSquares::of(lengths, &v, &u, &w, &phi, &theta).norm()
}

pub(super) fn judge(tolerances: &[f64], results: &[Result<Measured, CaseFailure>]) -> Part {
    let (mut checks, mut rows) = (vec![], vec![]);
    let mut last = f64::NAN;
    for (eta, result) in tolerances.iter().zip(results) {
        let Ok(measured) = result else { continue };
        let distance = measured.value("distance");
        last = distance;
        // A step leaves undone less than α/(1 - α) η*, with α far below 1/2 here, and the beam damps what is left.
        let evidence = format!("{distance:.2e}, {:.3} of the tolerance", distance / eta);
        checks.push(Check::that(distance <= *eta, format!("eta* = {eta:e}: its error is below eta*"), evidence));
        rows.push(vec![
            format!("{eta:e}"),
            format!("{distance:.3e}"),
            format!("{:.3}", measured.value("mean iterations")),
            format!("{}", measured.value("most iterations")),
        ]);
    }
    let head = ["tolerance", "distance to Newton", "mean iterations", "most iterations"].map(str::to_owned).to_vec();
    Part {
        summary: format!("distance to Newton's method {last:.1e} at the smallest tolerance"),
        checks,
        table: Table { title: "Fixed point against Newton's method on the scene".to_owned(), head, rows },
        quantities: vec![],
    }
}

pub(super) fn figure(id: &str, measured: Option<&Measured>) -> Figure {
    let curve = |name: &str| measured.map_or(vec![], |measured| measured.curve(name).to_vec());
    let series = vec![plots::Series { label: "fixed point".to_owned(), points: curve("iterations") }];
    let phases = plots::Phases { label: "in contact".to_owned(), intervals: curve("contact") };
    let svg = plots::iterations(&plots::Iterations { series, phases, ..plots::Iterations::default() });
    let caption =
        "Iterations per step of the fixed point at the smallest tolerance; shaded where the tip is in contact.";
    Figure { file: format!("{id}-iterations.svg"), caption: caption.to_owned(), svg }
}
