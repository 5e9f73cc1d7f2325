//! Unnecessary work is not done. Counts are tested because, unlike times, they are exact.

use crate::prelude::*;

const STEPS: usize = 50;

fn work(problem: &Problem, settings: Settings, dt: f64) -> Work {
    let mut simulation = simulate(problem, with(EULER_CRANK_NICOLSON, settings, dt));
    advance(&mut simulation, STEPS);
    simulation.work()
}

#[test]
fn newtons_method_keeps_a_factorisation_and_the_fixed_point_needs_one_for_each_iteration() {
    let problem = paper(uniform(20), (0.0, 0.0));
    for solver in Solver::ALL {
        for loaded in [false, true] {
            let stepping = Stepping {
                settings: by(solver),
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

/// For ρ = 0 one pass solves a step, and one factorisation all steps, with obstacles and without.
#[test]
fn newton_takes_one_pass_per_step_on_a_linear_beam() {
    for experiment in EXPERIMENTS {
        for (scheme, mesh) in schemes_and_meshes(20) {
            for start in [Start::Previous, Start::Extrapolated] {
                for free in [true, false] {
                    let mut problem = paper(mesh.clone(), experiment);
                    problem.beam.rho = 0.0;
                    problem.obstacles = problem.obstacles.filter(|_| !free);
                    let settings = Settings {
                        stopping: Stopping::below(1e-300),
                        ..from(start)
                    };
                    let mut simulation = simulate(&problem, with(scheme, settings, 1e-3));
                    advance(&mut simulation, 500);
                    let work = simulation.work();
                    assert_eq!(
                        (work.passes, work.factorizations),
                        (500, 1),
                        "{experiment:?} {}",
                        scheme.name
                    );
                    assert_eq!(simulation.step_once().unwrap().increment, 0.0);
                }
            }
        }
    }
    // A nonlinear beam needs more than one pass, with one factorisation.
    let problem = paper(uniform(20), (0.0, 0.0));
    let [default, rough] =
        [Settings::default(), from(Start::Previous)].map(|settings| work(&problem, settings, 1e-3));
    assert!(
        default.passes > STEPS && rough.passes >= 2 * STEPS && default.factorizations == 1,
        "{default:?} {rough:?}"
    );
}

#[test]
fn a_start_extrapolated_from_three_levels_saves_passes() {
    let problem = paper(uniform(20), (0.0, 0.0));
    let [extrapolated, previous] = [Start::Extrapolated, Start::Previous]
        .map(|start| work(&problem, from(start), 1e-4).passes);
    assert!(
        4 * extrapolated < 3 * previous,
        "{extrapolated} passes, {previous} from the level before"
    );
}
