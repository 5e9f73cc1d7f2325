//! The four computations of a compliance.

use crate::run::patience::StepPatience;
use thermobeam::error::{StepError, StepFailure};
use thermobeam::solve::{Settings, Solver};

use super::theory::tip_compliance;
use crate::kinds::steady::{settle, start};
use crate::kinds::untyped::Measured;
use crate::scene::Scene;
use convergence_study::run::time_limit::Patience;
use convergence_study::study::CaseFailure;
use convergence_study::text::number::max_or_nan;

/// The scene with another compliance.
pub(super) fn with_compliance(scene: &Scene, epsilon: f64) -> Scene {
    let mut scene = scene.clone();
    if let Some(obstacles) = &mut scene.obstacles {
        obstacles.epsilon = epsilon;
    }
    scene
}

fn epsilon(scene: &Scene) -> f64 {
    scene.obstacles.map_or(f64::NAN, |obstacles| obstacles.epsilon)
}

/// A bouncing beam by Newton's method: forces, penetrations, iterations, the motion of the free end.
///
/// The penetration is ε times the contact force, which keeps the digits that u(1) - g loses.
pub(super) fn moving(scene: &Scene) -> Result<Measured, CaseFailure> {
    let mut simulation = start(scene)?;
    let mut level = simulation.level();
    let tip = level.u.len() - 1;
    let (mut motion, mut force) = (vec![(0.0, level.u[tip])], 0.0);
    let (mut iterations, mut most_iterations) = (0, 0);
    let mut patience = Patience::of(&simulation);
    for _ in 0..scene.steps {
        patience.before_step_of(&simulation)?;
        let report = simulation.advance()?;
        simulation.observe(&mut level);
        iterations += report.iterations;
        most_iterations = most_iterations.max(report.iterations);
        force = max_or_nan(force, level.contact_force.abs());
        motion.push((simulation.t(), level.u[tip]));
    }
    let mut measured = Measured::default();
    measured.push("force", force);
    measured.push("penetration", epsilon(scene) * force);
    measured.push("iterations", iterations as f64 / scene.steps as f64);
    measured.push("most_iterations", most_iterations as f64);
    measured.series.push(("u_tip".into(), motion));
    Ok(measured)
}

/// The same beam by the paper's fixed point, as far as it comes.
///
/// The contraction is the largest of all steps in contact; where a step fails, that of its last increments.
pub(super) fn fixed_point(scene: &Scene, max_iterations: usize) -> Result<Measured, CaseFailure> {
    let settings = Settings { solver: Solver::FixedPoint, max_iterations, ..scene.settings };
    let mut simulation = start(&Scene { settings, ..scene.clone() })?;
    let mut level = simulation.level();
    let (mut contraction, mut iterations, mut failed) = (f64::NAN, 0, f64::NAN);
    let mut patience = Patience::of(&simulation);
    for _ in 0..scene.steps {
        patience.before_step_of(&simulation)?;
        let was_in_contact = level.contact_force != 0.0;
        match simulation.advance() {
            Ok(report) => {
                simulation.observe(&mut level);
                iterations += report.iterations;
                // While the tip comes or goes the law is not linear, and two increments tell nothing.
                if let Some(found) = report.contraction.filter(|_| was_in_contact && level.contact_force != 0.0) {
                    contraction = f64::max(contraction, found);
                }
            }
            Err(error) => {
                failed = error.t;
                contraction = contraction_of(&error);
                break;
            }
        }
    }
    let mut measured = Measured::default();
    measured.push("alpha", tip_compliance(scene)? / epsilon(scene));
    // Nothing where no step was in contact, or where an iteration went beyond all numbers.
    if contraction.is_finite() {
        measured.push("contraction", contraction);
    }
    measured.push("iterations", iterations as f64 / simulation.step().max(1) as f64);
    measured.push("converged", f64::from(u8::from(failed.is_nan())));
    if !failed.is_nan() {
        measured.push("failed_at", failed);
    }
    Ok(measured)
}

/// NaN where the iteration went beyond all numbers.
fn contraction_of(error: &StepError) -> f64 {
    match error.failure {
        StepFailure::Diverged { contraction, .. } | StepFailure::IterationLimit { contraction, .. } => contraction,
        _ => f64::NAN,
    }
}

/// A beam at rest on an obstacle.
pub(super) fn rest(scene: &Scene, speed: f64, t_max: f64) -> Result<Measured, CaseFailure> {
    let end = settle(scene, speed, t_max)?;
    let mut measured = Measured::default();
    measured.push("force", end.level.contact_force.abs());
    measured.push("penetration", epsilon(scene) * end.level.contact_force.abs());
    Ok(measured)
}

/// The peak of the first impact.
pub(super) fn impact(scene: &Scene) -> Result<Measured, CaseFailure> {
    let mut simulation = start(scene)?;
    let mut level = simulation.level();
    let tip = level.v.len() - 1;
    let (velocity, mut force, mut when) = (level.v[tip], 0.0, f64::NAN);
    let mut patience = Patience::of(&simulation);
    for _ in 0..scene.steps {
        patience.before_step_of(&simulation)?;
        simulation.advance()?;
        simulation.observe(&mut level);
        if !(level.contact_force <= force) {
            (force, when) = (level.contact_force, simulation.t());
        }
    }
    let mut measured = Measured::default();
    measured.push("velocity", velocity);
    measured.push("force", force);
    measured.push("penetration", epsilon(scene) * force);
    measured.push("when", when);
    Ok(measured)
}
