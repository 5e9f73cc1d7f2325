//! For the linear beam (ρ = 0) one pass of Newton's method solves a step.

use super::scenes::{EXPERIMENTS, advance, paper, schemes_and_meshes, simulate, stepping};
use thermobeam::motion::Motion;
use thermobeam::one_step::{Problem, Stepping};
use thermobeam::parameters::Beam;
use thermobeam::solve::{Settings, Start, Stopping};

#[test]
fn newton_takes_one_pass_per_step_on_a_linear_beam() {
    for experiment in EXPERIMENTS {
        for (scheme, mesh) in schemes_and_meshes(20) {
            for (start, free) in [
                (Start::Previous, true),
                (Start::Previous, false),
                (Start::Extrapolated, true),
                (Start::Extrapolated, false),
            ] {
                let mut problem = paper(mesh.clone(), experiment);
                problem = Problem {
                    beam: Beam {
                        rho: 0.0,
                        ..problem.beam
                    },
                    ..problem
                };
                if free {
                    problem.obstacles = None;
                }
                let settings = Settings {
                    stopping: Stopping::below(1e-300),
                    start,
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

#[test]
fn a_nonlinear_beam_needs_more_than_one_pass_from_a_rough_start() {
    let settings = Settings {
        start: Start::Previous,
        ..Settings::default()
    };
    let mut simulation = simulate(
        &paper(super::scenes::uniform(20), (0.0, 0.0)),
        Stepping {
            settings,
            ..stepping(1e-3)
        },
    );
    advance(&mut simulation, 100);
    assert!(simulation.work().passes >= 200);
}
