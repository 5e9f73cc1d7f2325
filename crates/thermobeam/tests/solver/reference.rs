//! Comparison with numbers from an independent implementation of the scheme.

use super::scenes::{advance, paper, simulate, stepping, uniform};
use thermobeam::one_step::Stepping;
use thermobeam::solve::{Settings, Solver, Stopping};

#[test]
fn both_solvers_agree_with_the_reference_to_nine_digits() {
    let rows = [
        (
            (0.0, 0.0),
            [-1.174001195293e-2, -9.730912695990e-2, 4.539642780254e-1],
        ),
        (
            (-0.5, 20.0),
            [-1.094811531838e-2, -2.193974223913e-2, 5.155906791580e-1],
        ),
    ];
    for (experiment, expected) in rows {
        for solver in Solver::ALL {
            let settings = Settings {
                solver,
                stopping: Stopping::below(1e-12),
                ..Settings::default()
            };
            let mut simulation = simulate(
                &paper(uniform(20), experiment),
                Stepping {
                    settings,
                    ..stepping(1e-3)
                },
            );
            advance(&mut simulation, 1000);
            let level = simulation.level();
            let found = [
                level.u[20],
                level.phi[20],
                simulation.energy(&level).total(),
            ];
            for (found, expected) in found.into_iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-9 * expected.abs(),
                    "{solver:?}: {found} for {expected}"
                );
            }
        }
    }
}
