//! The linear beam against the matrix exponential of its semi-discrete system, which is exact in
//! time.

use super::dense::{Dense, State};
use super::scenes::{advance, distance, last_rate, paper, schemes_and_meshes, simulate, stepping};
use nalgebra::{DMatrix, DVector};
use thermobeam::one_step::{Problem, Stepping};
use thermobeam::parameters::Beam;

/// y(t) of `y' = A y + b`, by the exponential of `[A b; 0 0]`.
fn exact(problem: &Problem, t: f64) -> State {
    let dense = Dense::new(problem);
    let rate = dense.rate();
    let start = dense.initial(problem).stack();
    let (n, size) = (problem.mesh.elements(), start.len());
    let at = |y: &DVector<f64>| rate(&State::unstack(y, n)).stack();
    let constant = at(&DVector::zeros(size));
    let mut augmented = DMatrix::zeros(size + 1, size + 1);
    for column in 0..size {
        let mut unit = DVector::zeros(size);
        unit[column] = 1.0;
        augmented
            .view_mut((0, column), (size, 1))
            .copy_from(&(at(&unit) - &constant));
    }
    augmented
        .view_mut((0, size), (size, 1))
        .copy_from(&constant);
    let end = (augmented * t).exp() * start.push(1.0);
    State::unstack(&end.rows(0, size).into_owned(), n)
}

#[test]
fn the_linear_beam_converges_to_the_matrix_exponential_at_the_order_of_the_scheme() {
    for experiment in [(-0.5, 0.0), (5.0, 20.0), (-0.8, 0.0)] {
        for (scheme, mesh) in schemes_and_meshes(5) {
            let problem = paper(mesh, experiment);
            let beam = Beam {
                rho: 0.0,
                a: 0.5,
                ..problem.beam
            };
            let problem = Problem {
                beam,
                obstacles: None,
                ..problem
            };
            let expected = exact(&problem, 0.5).to_level();
            let errors: Vec<_> = [1024, 2048]
                .map(|steps| {
                    let dt = 0.5 / steps as f64;
                    let mut simulation = simulate(
                        &problem,
                        Stepping {
                            scheme,
                            ..stepping(dt)
                        },
                    );
                    advance(&mut simulation, steps);
                    (dt, distance(&problem.mesh, &simulation.level(), &expected))
                })
                .to_vec();
            let rate = last_rate(&errors);
            assert!(
                (rate - scheme.order).abs() <= 0.01,
                "{experiment:?} {}: rate {rate}, {errors:?}",
                scheme.name
            );
        }
    }
}
