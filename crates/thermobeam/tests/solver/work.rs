//! Unnecessary work is not done. Counts are tested because, unlike times, they are exact.

use super::scenes::{EXPERIMENTS, advance, paper, simulate, stepping, uniform};
use thermobeam::motion::Motion;
use thermobeam::one_step::{Problem, Stepping};
use thermobeam::solve::{Settings, Solver, Start};

const STEPS: usize = 50;

#[test]
fn newtons_method_keeps_a_factorisation_and_the_fixed_point_needs_one_for_each_iteration() {
    let problem = paper(uniform(20), EXPERIMENTS[0]);
    for solver in Solver::ALL {
        for loaded in [false, true] {
            let settings = Settings {
                solver,
                ..Settings::default()
            };
            let stepping = Stepping {
                settings,
                loaded,
                ..stepping(1e-4)
            };
            let mut simulation = simulate(&problem, stepping);
            for _ in 0..STEPS {
                if let Some(load) = simulation.load_mut() {
                    load.fill([0.0; 3]);
                }
                advance(&mut simulation, 1);
            }
            let work = simulation.work();
            assert!(work.passes >= STEPS, "{work:?}");
            // In the fixed point m changes with every iterate.
            let expected = if solver == Solver::Newton {
                1..STEPS
            } else {
                work.passes..work.passes + 1
            };
            assert!(
                expected.contains(&work.factorizations),
                "{solver:?}, loaded: {loaded}: {work:?}"
            );
        }
    }
}

#[test]
fn a_free_linear_beam_is_solved_once_a_step_and_factorized_once() {
    let mut problem = paper(uniform(20), EXPERIMENTS[0]);
    let passes = |problem: &Problem| {
        let mut simulation = simulate(problem, stepping(1e-3));
        advance(&mut simulation, STEPS);
        let work = simulation.work();
        (work.passes, work.factorizations)
    };
    let nonlinear = passes(&problem);
    problem.beam.rho = 0.0;
    problem.obstacles = None;
    assert_eq!(passes(&problem), (STEPS, 1));
    assert!(
        nonlinear.0 > STEPS && nonlinear.1 == 1,
        "expected more passes with one factorisation: {nonlinear:?}"
    );
}

#[test]
fn a_start_extrapolated_from_three_levels_saves_passes() {
    let problem = paper(uniform(20), EXPERIMENTS[0]);
    let passes = |start: Start| {
        let settings = Settings {
            start,
            ..Settings::default()
        };
        let mut simulation = simulate(
            &problem,
            Stepping {
                settings,
                ..stepping(1e-4)
            },
        );
        advance(&mut simulation, STEPS);
        simulation.work().passes
    };
    let (extrapolated, previous) = (passes(Start::Extrapolated), passes(Start::Previous));
    assert!(
        4 * extrapolated < 3 * previous,
        "{extrapolated} passes, {previous} from the level before"
    );
}
