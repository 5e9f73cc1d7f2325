//! The solver omits the temperature if nothing heats the beam, and the result is the same.

use super::scenes::{
    EXPERIMENTS, advance, paper, relative_difference, schemes_and_meshes, simulate, stepping,
    uniform,
};
use thermobeam::motion::Motion;
use thermobeam::one_step::{InitialValues, Problem, Stepping};
use thermobeam::parameters::Beam;
use thermobeam::solve::{Settings, Solver, Stopping};

/// The paper's data without temperature.
fn cold(problem: Problem) -> Problem {
    let beam = Beam {
        a: 0.0,
        theta_a: 0.0,
        ..problem.beam
    };
    let theta = vec![0.0; problem.initial.theta.len()];
    Problem {
        beam,
        initial: InitialValues {
            theta,
            ..problem.initial
        },
        ..problem
    }
}

#[test]
fn an_unheated_beam_moves_the_same_with_and_without_the_temperature() {
    for experiment in EXPERIMENTS {
        for (scheme, mesh) in schemes_and_meshes(20) {
            for linear_and_free in [true, false] {
                let mut problem = cold(paper(mesh.clone(), experiment));
                if linear_and_free {
                    problem.beam.rho = 0.0;
                    problem.obstacles = None;
                }
                let settings = Settings {
                    stopping: Stopping::below(1e-13),
                    ..Settings::default()
                };
                let stepping = Stepping {
                    scheme,
                    settings,
                    ..stepping(1e-3)
                };
                let mut without = simulate(&problem, stepping);
                let mut with = simulate(
                    &problem,
                    Stepping {
                        loaded: true,
                        ..stepping
                    },
                );
                assert!(!without.is_heated() && with.is_heated());
                assert!(without.load_mut().is_none());
                for _ in 0..300 {
                    with.load_mut().unwrap().fill([0.0; 3]);
                    advance(&mut without, 1);
                    advance(&mut with, 1);
                }
                let (without, with) = (without.level(), with.level());
                let difference = relative_difference(&without, &with);
                assert!(
                    difference <= 1e-12,
                    "{experiment:?} {}: {difference:e}",
                    scheme.name
                );
                assert!(with.theta.iter().all(|&theta| theta == 0.0));
            }
        }
    }
}

#[test]
fn the_temperature_is_computed_when_anything_heats_the_beam() {
    let base = cold(paper(uniform(8), (0.0, 0.0)));
    let coupled = Problem {
        beam: Beam {
            a: 0.017,
            ..base.beam
        },
        ..base.clone()
    };
    assert!(simulate(&coupled, stepping(1e-3)).is_heated());
    let mut warm = base.clone();
    warm.initial.theta[3] = 1e-3;
    assert!(simulate(&warm, stepping(1e-3)).is_heated());
    let settings = Settings {
        solver: Solver::FixedPoint,
        ..Settings::default()
    };
    assert!(
        simulate(
            &base,
            Stepping {
                settings,
                ..stepping(1e-3)
            }
        )
        .is_heated()
    );
    assert!(!simulate(&base, stepping(1e-3)).is_heated());
}
