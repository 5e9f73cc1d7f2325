//! The solver omits the temperature if nothing heats the beam, and the result is the same.

use crate::prelude::*;

/// The paper's data without temperature.
fn cold(mut problem: Problem) -> Problem {
    (problem.beam.a, problem.beam.theta_a) = (0.0, 0.0);
    problem.initial.theta.fill(0.0);
    problem
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
                let stepping = with(scheme, below(1e-13), 1e-3);
                assert!(!simulate(&problem, stepping).is_heated());
                let without = after(&problem, stepping, 300);
                let loaded = Stepping {
                    loaded: true,
                    ..stepping
                };
                let mut with = simulate(&problem, loaded);
                assert!(with.is_heated());
                for _ in 0..300 {
                    with.load_mut().unwrap().fill([0.0; 3]);
                    advance(&mut with, 1);
                }
                let with = with.level();
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
    let [mut coupled, mut warm] = [base.clone(), base.clone()];
    coupled.beam.a = 0.017;
    warm.initial.theta[3] = 1e-3;
    let newton = stepping(1e-3);
    let fixed_point = with(EULER_CRANK_NICOLSON, by(Solver::FixedPoint), 1e-3);
    for (problem, stepping, is_heated) in [
        (&coupled, newton, true),
        (&warm, newton, true),
        (&base, fixed_point, true),
        (&base, newton, false),
    ] {
        assert_eq!(simulate(problem, stepping).is_heated(), is_heated);
    }
    assert!(simulate(&base, newton).load_mut().is_none());
}
