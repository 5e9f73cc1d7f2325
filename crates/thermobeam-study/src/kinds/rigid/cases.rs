//! The computations: each compliance in four scenes, and the rigid limit.

use std::ops::ControlFlow;

use convergence_study::study::{Case, CaseFailure};
use convergence_study::text::number::max_or_nan;
use thermobeam::contraction::contact_contraction;
use thermobeam::error::{StepError, StepFailure};
use thermobeam::parameters::Obstacles;
use thermobeam::simulation::Stepping;
use thermobeam::solve::{Settings, Solver};

use super::{Bouncing, FixedPointRun, Found, Impact, Rest, RigidStudy, RunOf, Task};
use crate::kinds::steady::settle;
use crate::run::driver::{RunError, Step};
use crate::run::simulate::driver;
use crate::scene::{Method, Scene};

pub(super) fn cases(study: &RigidStudy) -> Vec<Case<Task>> {
    let case = |run: RunOf, epsilon: f64| {
        let (name, scene, steps) = match run {
            RunOf::RigidLimit | RunOf::Bouncing => ("bouncing", &study.moving, study.moving.steps() as f64),
            RunOf::FixedPoint => ("fixed point", &study.moving, 4.0 * study.moving.steps() as f64),
            RunOf::Rest => ("at rest", &study.resting, 200.0 / study.resting.dt()),
            RunOf::Impact => ("impact", &study.impact, 3.0 * study.steps as f64),
        };
        let cost = steps * scene.mesh.elements() as f64;
        Case { label: format!("{name}, ε = {epsilon:.1e}"), cost, data: Task { epsilon, run } }
    };
    let runs = [RunOf::Bouncing, RunOf::FixedPoint, RunOf::Rest, RunOf::Impact];
    let all = runs.iter().flat_map(|&run| study.epsilons.iter().map(move |&epsilon| case(run, epsilon)));
    std::iter::once(case(RunOf::RigidLimit, study.limit)).chain(all).collect()
}

pub(super) fn run(study: &RigidStudy, Task { epsilon, run }: Task) -> Result<Found, CaseFailure> {
    Ok(match run {
        RunOf::RigidLimit | RunOf::Bouncing => Found::Bouncing(bouncing(&with_compliance(&study.moving, epsilon))?),
        RunOf::FixedPoint => {
            Found::FixedPoint(fixed_point(&with_compliance(&study.moving, epsilon), study.max_iterations)?)
        }
        RunOf::Rest => Found::Rest(rest(&with_compliance(&study.resting, epsilon), study.speed, study.t_max)?),
        RunOf::Impact => Found::Impact(impact(&impact_scene(study, epsilon))?),
    })
}

fn with_compliance(scene: &Scene, epsilon: f64) -> Scene {
    let mut scene = scene.clone();
    if let Some(obstacles) = &mut scene.obstacles {
        obstacles.epsilon = epsilon;
    }
    scene
}

fn impact_scene(study: &RigidStudy, epsilon: f64) -> Scene {
    let scene = with_compliance(&study.impact, epsilon);
    let time = Obstacles { epsilon, ..Obstacles::default() }.impact_time(scene.beam.zeta);
    // The peak is at 1.65 t*.
    Scene { t_end: 3.0 * time, method: scene.method.with_dt(time / study.steps as f64), ..scene }
}

fn epsilon(scene: &Scene) -> f64 {
    scene.obstacles.map_or(f64::NAN, |obstacles| obstacles.epsilon)
}

fn bouncing(scene: &Scene) -> Result<Bouncing, CaseFailure> {
    let mut driver = driver(scene)?;
    let end = scene.mesh.elements();
    let mut tip = vec![(0.0, driver.level().u[end])];
    let (mut force, mut iterations, mut most_iterations) = (0.0, 0, 0);
    driver.run::<()>(scene.steps(), |Step { report, new, simulation, .. }| {
        iterations += report.iterations;
        most_iterations = most_iterations.max(report.iterations);
        force = max_or_nan(force, new.contact_force.abs());
        tip.push((simulation.t(), new.u[end]));
        ControlFlow::Continue(())
    })?;
    let mean_iterations = iterations as f64 / scene.steps() as f64;
    Ok(Bouncing { force, penetration: epsilon(scene) * force, mean_iterations, most_iterations, tip })
}

fn fixed_point(scene: &Scene, max_iterations: usize) -> Result<FixedPointRun, CaseFailure> {
    let stepping = scene.one_step()?;
    let settings = Settings { solver: Solver::FixedPoint, max_iterations, ..stepping.settings };
    let method = Method::OneStep(Stepping { settings, ..stepping });
    let mut driver = driver(&Scene { method, ..scene.clone() })?;
    let (mut contraction, mut iterations) = (None, 0);
    let ended = driver.run::<()>(scene.steps(), |Step { report, old, new, .. }| {
        iterations += report.iterations;
        // While the tip comes or goes the law is not linear, and two increments tell nothing.
        let in_contact = old.contact_force != 0.0 && new.contact_force != 0.0;
        if let Some(found) = report.contraction.filter(|_| in_contact) {
            contraction = Some(contraction.map_or(found, |largest| max_or_nan(largest, found)));
        }
        ControlFlow::Continue(())
    });
    let failed_at = match ended {
        Ok(_) => None,
        Err(RunError::Step(error)) => {
            contraction = contraction_of(&error);
            Some(error.t)
        }
        Err(other) => return Err(other.into()),
    };
    let mean_iterations = iterations as f64 / driver.simulation().step().max(1) as f64;
    Ok(FixedPointRun { alpha: alpha(scene, &stepping), contraction, mean_iterations, failed_at })
}

/// The factor for the mean axial force β of a beam that is hardly bent; infinite where the operator is not definite.
fn alpha(scene: &Scene, by: &Stepping) -> f64 {
    let lengths: Vec<f64> = scene.mesh.lengths().collect();
    let beta = scene.beam.beta;
    let factor = |obstacles| contact_contraction(&scene.beam, &obstacles, &lengths, &by.scheme, by.dt, beta);
    scene.obstacles.map_or(f64::NAN, factor)
}

/// `None` where the iterates overflowed.
fn contraction_of(error: &StepError) -> Option<f64> {
    match error.failure {
        StepFailure::Diverged { contraction, .. } | StepFailure::IterationLimit { contraction, .. } => {
            Some(contraction).filter(|contraction| contraction.is_finite())
        }
        _ => None,
    }
}

fn rest(scene: &Scene, speed: f64, t_max: f64) -> Result<Rest, CaseFailure> {
    let force = settle(scene, speed, t_max)?.level.contact_force.abs();
    Ok(Rest { force, penetration: epsilon(scene) * force })
}

fn impact(scene: &Scene) -> Result<Impact, CaseFailure> {
    let mut driver = driver(scene)?;
    let velocity = driver.level().v[scene.mesh.elements()];
    let mut force = 0.0;
    driver.run::<()>(scene.steps(), |Step { new, .. }| {
        force = max_or_nan(force, new.contact_force);
        ControlFlow::Continue(())
    })?;
    Ok(Impact { velocity, force, penetration: epsilon(scene) * force })
}
