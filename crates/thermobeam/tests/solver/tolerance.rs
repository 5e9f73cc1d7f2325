//! The tolerance bounds the distance of an accepted step to the solution of its equations.

use crate::prelude::*;

/// Each of the first steps is within its tolerance of the same step solved to round-off.
#[track_caller]
fn is_within_its_tolerance(
    problem: &Problem,
    scheme: Scheme,
    settings: Settings,
    dt: f64,
    steps: usize,
) {
    let tolerance = settings.stopping.tolerance().expect("a tolerance");
    let exactly = Settings {
        start: Start::Previous,
        ..below(1e-14)
    };
    let mut simulation = simulate(problem, with(scheme, settings, dt));
    for step in 1..=steps {
        let mut same = simulate(
            &from_level(problem, &simulation.level()),
            with(scheme, exactly, dt),
        );
        same.step_once().unwrap();
        let report = simulation.step_once().unwrap();
        let distance = distance(&problem.mesh, &simulation.level(), &same.level());
        assert!(
            report.increment <= tolerance && distance <= tolerance,
            "{} {settings:?} dt = {dt}, step {step}: {distance:e}, {report:?}",
            scheme.name
        );
    }
}

#[test]
fn an_accepted_step_is_within_the_tolerance_of_its_solution() {
    let short = [
        (2e-3, 1e-2),
        (2e-3, 1e-4),
        (2e-3, 1e-6),
        (2e-3, 1e-8),
        (2e-3, 1e-10),
        (1e-4, 1e-6),
    ];
    let long = [(0.02, 1e-2), (0.02, 1e-5), (0.5, 1e-2), (0.5, 1e-8)];
    // Newton's error bound holds for large steps and rough starts, too.
    for (solver, start, cases, steps) in [
        (Solver::Newton, Start::Extrapolated, &short[..], 200),
        (Solver::FixedPoint, Start::Extrapolated, &short, 200),
        (Solver::Newton, Start::Previous, &long, 50),
        (Solver::Newton, Start::Extrapolated, &long, 50),
    ] {
        for experiment in EXPERIMENTS {
            for (scheme, mesh) in schemes_and_meshes(20) {
                let problem = paper(mesh, experiment);
                for &(dt, tolerance) in cases {
                    let settings = Settings {
                        solver,
                        start,
                        ..below(tolerance)
                    };
                    is_within_its_tolerance(&problem, scheme, settings, dt, steps);
                }
            }
        }
    }
}

#[test]
fn newtons_error_bound_holds_near_buckling() {
    for (scheme, mesh) in schemes_and_meshes(20) {
        let mut problem = paper(mesh, (-0.7, 0.0));
        problem.obstacles = None;
        for (dt, tolerance) in [
            (0.5, 1e-1),
            (0.5, 1e-3),
            (2.0, 1e-1),
            (2.0, 1e-3),
            (2.0, 1e-5),
        ] {
            let settings = Settings {
                start: Start::Previous,
                ..below(tolerance)
            };
            is_within_its_tolerance(&problem, scheme, settings, dt, 50);
        }
    }
}
