//! Newton's method and the fixed point, and different initial iterates, give the same solution of a
//! step.

use super::scenes::{
    EXPERIMENTS, advance, distance, from_level, paper, relative_difference, schemes_and_meshes,
    simulate, stepping, uniform,
};
use thermobeam::one_step::Stepping;
use thermobeam::solve::{Settings, Solver, Start, Stopping};

/// Runs all experiments twice in parallel, and compares every nodal value at every step.
#[track_caller]
fn agree(one: Settings, other: Settings, dt: f64, steps: usize, allowed: f64) {
    for experiment in EXPERIMENTS {
        for (scheme, mesh) in schemes_and_meshes(20) {
            let problem = paper(mesh, experiment);
            let mut pair = [one, other].map(|settings| {
                simulate(
                    &problem,
                    Stepping {
                        scheme,
                        settings,
                        ..stepping(dt)
                    },
                )
            });
            for step in 1..=steps {
                for simulation in &mut pair {
                    simulation
                        .step_once()
                        .unwrap_or_else(|error| panic!("{experiment:?} {}: {error}", scheme.name));
                }
                let [one, other] = pair.each_mut().map(|simulation| simulation.level());
                let difference = relative_difference(&one, &other);
                assert!(
                    difference <= allowed,
                    "{experiment:?} {} step {step}: {difference:e}",
                    scheme.name
                );
            }
        }
    }
}

fn tight() -> Settings {
    Settings {
        stopping: Stopping::below(1e-13),
        ..Settings::default()
    }
}

#[test]
fn newton_and_the_fixed_point_agree() {
    agree(
        tight(),
        Settings {
            solver: Solver::FixedPoint,
            ..tight()
        },
        1e-3,
        1000,
        1e-10,
    );
}

/// By (4.1) a step depends only on the previous level: a run restarted from a level continues
/// bitwise.
#[test]
fn a_fixed_point_step_depends_on_the_previous_level_only() {
    let settings = Settings {
        solver: Solver::FixedPoint,
        ..Settings::default()
    };
    for (scheme, mesh) in schemes_and_meshes(20) {
        let problem = paper(mesh, EXPERIMENTS[0]);
        let stepping = Stepping {
            scheme,
            settings,
            ..stepping(1e-3)
        };
        let mut simulation = simulate(&problem, stepping);
        advance(&mut simulation, 5);
        let mut afresh = simulate(&from_level(&problem, &simulation.level()), stepping);
        for _ in 0..5 {
            assert_eq!(simulation.step_once(), afresh.step_once());
            assert_eq!(simulation.level(), afresh.level(), "{}", scheme.name);
        }
    }
}

#[test]
fn newton_and_the_fixed_point_agree_under_loads() {
    for (scheme, mesh) in schemes_and_meshes(20) {
        let problem = paper(mesh, EXPERIMENTS[1]);
        let mut pair = Solver::ALL.map(|solver| {
            let settings = Settings { solver, ..tight() };
            simulate(
                &problem,
                Stepping {
                    scheme,
                    settings,
                    loaded: true,
                    ..stepping(1e-3)
                },
            )
        });
        for step in 0..100 {
            let levels = pair.each_mut().map(|simulation| {
                for (i, load) in simulation.load_mut().unwrap().iter_mut().enumerate() {
                    let phase = 0.1 * f64::from(step) + i as f64;
                    *load = [
                        0.2 * phase.sin(),
                        0.1 * phase.cos(),
                        0.05 * (2.0 * phase).sin(),
                    ];
                }
                simulation.step_once().unwrap();
                simulation.level()
            });
            let difference = relative_difference(&levels[0], &levels[1]);
            assert!(
                difference < 1e-10,
                "{} step {step}: {difference:e}",
                scheme.name
            );
        }
    }
}

/// If a step is accepted after one iteration, the increment is the change of the level.
#[test]
fn the_increment_of_a_single_iteration_is_the_change_of_the_level() {
    for (scheme, mesh) in schemes_and_meshes(20) {
        let problem = paper(mesh, EXPERIMENTS[3]);
        let settings = Settings {
            solver: Solver::FixedPoint,
            stopping: Stopping::below(1e9),
            ..Settings::default()
        };
        let mut simulation = simulate(
            &problem,
            Stepping {
                scheme,
                settings,
                ..stepping(1e-3)
            },
        );
        for _ in 0..3 {
            let old = simulation.level();
            let report = simulation.step_once().unwrap();
            let new = simulation.level();
            let expected = distance(&problem.mesh, &new, &old);
            assert_eq!((report.iterations, report.contraction), (1, None));
            assert!(
                (report.increment / expected - 1.0).abs() < 1e-12,
                "{}: {report:?}, {expected}",
                scheme.name
            );
        }
    }
}

#[test]
fn the_start_of_the_iteration_does_not_change_the_answer() {
    agree(
        tight(),
        Settings {
            start: Start::Previous,
            ..tight()
        },
        1e-3,
        1000,
        1e-10,
    );
    agree(
        tight(),
        Settings {
            start: Start::Previous,
            ..tight()
        },
        2e-2,
        200,
        1e-10,
    );
}

/// "L times": every step ends after L solves of (4.2), whatever its increment; the distance to the
/// solved step falls with L.
#[test]
fn a_fixed_number_of_iterations_is_done_in_every_step() {
    let problem = paper(uniform(20), EXPERIMENTS[3]);
    let run = |stopping| {
        let settings = Settings {
            solver: Solver::FixedPoint,
            stopping,
            ..Settings::default()
        };
        let mut simulation = simulate(
            &problem,
            Stepping {
                settings,
                ..stepping(1e-3)
            },
        );
        let reports: Vec<_> = (0..300).map(|_| simulation.step_once().unwrap()).collect();
        (reports, simulation.level())
    };
    let (_, solved) = run(Stopping::below(1e-13));
    let mut last = f64::INFINITY;
    for iterations in 1..=4 {
        let (reports, level) = run(Stopping::Iterations(iterations));
        assert!(reports.iter().all(|report| report.iterations == iterations));
        let apart = distance(&problem.mesh, &level, &solved);
        assert!(
            apart < 0.2 * last,
            "{iterations}: {apart}, {last} with one less"
        );
        last = apart;
    }
    assert!(last > 0.0 && last < 1e-5, "{last}");
}
