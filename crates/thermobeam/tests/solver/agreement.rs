//! Newton's method and the fixed point, and different initial iterates, give the same solution of a
//! step.

use crate::prelude::*;

const TIGHT: f64 = 1e-13;

/// Runs all experiments twice in parallel, and compares every nodal value at every step.
#[track_caller]
fn agree(other: Settings, dt: f64, steps: usize) {
    for experiment in EXPERIMENTS {
        for (scheme, mesh) in schemes_and_meshes(20) {
            let problem = paper(mesh, experiment);
            let mut pair = [below(TIGHT), other]
                .map(|settings| simulate(&problem, with(scheme, settings, dt)));
            for step in 1..=steps {
                pair.iter_mut()
                    .for_each(|simulation| advance(simulation, 1));
                let [one, other] = pair.each_ref().map(|simulation| simulation.level());
                let difference = relative_difference(&one, &other);
                assert!(
                    difference <= 1e-10,
                    "{experiment:?} {} step {step}: {difference:e}",
                    scheme.name
                );
            }
        }
    }
}

#[test]
fn newton_and_the_fixed_point_agree() {
    let fixed_point = Settings {
        solver: Solver::FixedPoint,
        ..below(TIGHT)
    };
    agree(fixed_point, 1e-3, 1000);
}

#[test]
fn the_start_of_the_iteration_does_not_change_the_answer() {
    let previous = Settings {
        start: Start::Previous,
        ..below(TIGHT)
    };
    agree(previous, 1e-3, 1000);
    agree(previous, 2e-2, 200);
}

/// By (4.1) a step depends only on the previous level: a run restarted from a level continues
/// bitwise.
#[test]
fn a_fixed_point_step_depends_on_the_previous_level_only() {
    for (scheme, mesh) in schemes_and_meshes(20) {
        let problem = paper(mesh, (0.0, 0.0));
        let stepping = with(scheme, by(Solver::FixedPoint), 1e-3);
        let mut simulation = simulate(&problem, stepping);
        advance(&mut simulation, 5);
        let mut afresh = simulate(&from_level(&problem, &simulation.level()), stepping);
        for _ in 0..5 {
            assert_eq!(simulation.step_once(), afresh.step_once());
            assert_eq!(simulation.level(), afresh.level(), "{}", scheme.name);
        }
    }
}

/// If a step is accepted after one iteration, the increment is the change of the level.
#[test]
fn the_increment_of_a_single_iteration_is_the_change_of_the_level() {
    for (scheme, mesh) in schemes_and_meshes(20) {
        let problem = paper(mesh, (-0.5, 20.0));
        let settings = Settings {
            stopping: Stopping::below(1e9),
            ..by(Solver::FixedPoint)
        };
        let mut simulation = simulate(&problem, with(scheme, settings, 1e-3));
        for _ in 0..3 {
            let old = simulation.level();
            let report = simulation.step_once().unwrap();
            let expected = distance(&problem.mesh, &simulation.level(), &old);
            assert_eq!((report.iterations, report.contraction), (1, None));
            near(scheme.name, report.increment, expected, 1e-12 * expected);
        }
    }
}

/// "L times": every step ends after L solves of (4.2), whatever its increment; the distance to the
/// solved step falls with L.
#[test]
fn a_fixed_number_of_iterations_is_done_in_every_step() {
    let problem = paper(uniform(20), (-0.5, 20.0));
    let stepping = |stopping| {
        let settings = Settings {
            stopping,
            ..by(Solver::FixedPoint)
        };
        with(EULER_CRANK_NICOLSON, settings, 1e-3)
    };
    let solved = after(&problem, stepping(Stopping::below(TIGHT)), 300);
    let mut last = f64::INFINITY;
    for iterations in 1..=4 {
        let mut simulation = simulate(&problem, stepping(Stopping::Iterations(iterations)));
        for _ in 0..300 {
            assert_eq!(simulation.step_once().unwrap().iterations, iterations);
        }
        let apart = distance(&problem.mesh, &simulation.level(), &solved);
        assert!(
            apart < 0.2 * last,
            "{iterations}: {apart}, {last} with one less"
        );
        last = apart;
    }
    assert!(last > 0.0 && last < 1e-5, "{last}");
}
