//! The tolerance bounds the distance of an accepted step to the solution of its equations.

use super::scenes::{
    EXPERIMENTS, distance, from_level, paper, schemes_and_meshes, simulate, stepping,
};
use thermobeam::norms::max_or_nan;
use thermobeam::one_step::Stepping;
use thermobeam::solve::{Settings, Solver, Start, Stopping};

/// The largest distance of a step to the same step solved to round-off, over the first steps of
/// every experiment.
fn largest_distance(settings: Settings, dt: f64, steps: usize) -> f64 {
    let exactly = Settings {
        stopping: Stopping::below(1e-14),
        start: Start::Previous,
        ..Settings::default()
    };
    let mut worst = 0.0;
    for experiment in EXPERIMENTS {
        for (scheme, mesh) in schemes_and_meshes(20) {
            let problem = paper(mesh, experiment);
            let mut simulation = simulate(
                &problem,
                Stepping {
                    scheme,
                    settings,
                    ..stepping(dt)
                },
            );
            for _ in 0..steps {
                let old = simulation.level();
                let report = simulation.step_once().unwrap();
                assert!(
                    report.increment <= settings.stopping.tolerance().expect("a tolerance"),
                    "{report:?}"
                );
                let mut same = simulate(
                    &from_level(&problem, &old),
                    Stepping {
                        scheme,
                        settings: exactly,
                        ..stepping(dt)
                    },
                );
                same.step_once().unwrap();
                worst = max_or_nan(
                    worst,
                    distance(&problem.mesh, &simulation.level(), &same.level()),
                );
            }
        }
    }
    worst
}

#[test]
fn an_accepted_step_is_within_the_tolerance_of_its_solution() {
    for solver in Solver::ALL {
        for (dt, tolerance) in [
            (2e-3, 1e-2),
            (2e-3, 1e-4),
            (2e-3, 1e-6),
            (2e-3, 1e-8),
            (2e-3, 1e-10),
            (1e-4, 1e-6),
        ] {
            let distance = largest_distance(
                Settings {
                    solver,
                    stopping: Stopping::below(tolerance),
                    ..Settings::default()
                },
                dt,
                200,
            );
            assert!(
                distance <= tolerance,
                "{solver:?} with dt = {dt}: {distance:e} for {tolerance:e}"
            );
        }
    }
}

#[test]
fn newtons_error_bound_holds_for_large_steps_and_rough_starts() {
    for start in [Start::Previous, Start::Extrapolated] {
        for (dt, tolerance) in [(0.02, 1e-2), (0.02, 1e-5), (0.5, 1e-2), (0.5, 1e-8)] {
            let distance = largest_distance(
                Settings {
                    stopping: Stopping::below(tolerance),
                    start,
                    ..Settings::default()
                },
                dt,
                50,
            );
            assert!(
                distance <= tolerance,
                "{start:?} with dt = {dt}: {distance:e} for {tolerance:e}"
            );
        }
    }
}

#[test]
fn newtons_error_bound_holds_near_buckling() {
    let exactly = Settings {
        stopping: Stopping::below(1e-14),
        start: Start::Previous,
        ..Settings::default()
    };
    let experiment = EXPERIMENTS[0];
    for (scheme, mesh) in schemes_and_meshes(20) {
        let mut problem = paper(mesh, experiment);
        (problem.beam.beta, problem.obstacles) = (-0.7, None);
        for (dt, tolerance) in [
            (0.5, 1e-1),
            (0.5, 1e-3),
            (2.0, 1e-1),
            (2.0, 1e-3),
            (2.0, 1e-5),
        ] {
            let settings = Settings {
                stopping: Stopping::below(tolerance),
                start: Start::Previous,
                ..Settings::default()
            };
            let mut simulation = simulate(
                &problem,
                Stepping {
                    scheme,
                    settings,
                    ..stepping(dt)
                },
            );
            for step in 1..=50 {
                let old = simulation.level();
                let report = simulation.step_once().unwrap();
                let mut same = simulate(
                    &from_level(&problem, &old),
                    Stepping {
                        scheme,
                        settings: exactly,
                        ..stepping(dt)
                    },
                );
                same.step_once().unwrap();
                let distance = distance(&problem.mesh, &simulation.level(), &same.level());
                assert!(
                    distance <= tolerance,
                    "{} with dt = {dt}, step {step}: {distance:e} {report:?}",
                    scheme.name
                );
            }
        }
    }
}
