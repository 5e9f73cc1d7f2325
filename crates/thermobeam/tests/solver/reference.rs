//! Comparison with numbers from an independent implementation of the scheme.

use crate::prelude::*;

#[test]
fn both_solvers_agree_with_the_reference_to_nine_digits() {
    for (experiment, expected) in [
        (
            (0.0, 0.0),
            [-1.174001195293e-2, -9.730912695990e-2, 4.539642780254e-1],
        ),
        (
            (-0.5, 20.0),
            [-1.094811531838e-2, -2.193974223913e-2, 5.155906791580e-1],
        ),
    ] {
        for solver in Solver::ALL {
            let settings = Settings {
                solver,
                ..below(1e-12)
            };
            let stepping = with(EULER_CRANK_NICOLSON, settings, 1e-3);
            let mut simulation = simulate(&paper(uniform(20), experiment), stepping);
            advance(&mut simulation, 1000);
            let level = simulation.level();
            let energy = simulation.energy(&level).total();
            for (found, expected) in [level.u[20], level.phi[20], energy]
                .into_iter()
                .zip(expected)
            {
                close(found, expected, 1e-9 * f64::abs(expected));
            }
        }
    }
}
