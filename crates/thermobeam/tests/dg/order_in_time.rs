//! Orders in time: 2q + 1 at the ends of steps, q + 2 for u and q + 1 for its velocity inside.

use super::scenes::{equal_steps, experiment, larger, simulate};
use thermobeam::dg::{Dg, DgLevel, DgProblem, Field};
use thermobeam::motion::Motion;

const T: f64 = 0.4;

fn free() -> DgProblem {
    DgProblem {
        obstacles: None,
        ..experiment(0.0, 0.0, 3)
    }
}

fn run(q: usize, steps: usize) -> Dg {
    let mut simulation = simulate(free(), equal_steps(q, T / steps as f64));
    simulation.advance(T).unwrap();
    assert_eq!(simulation.steps(), steps);
    simulation
}

/// The norm of Theorem 3.4's left-hand side.
fn distance(simulation: &Dg, level: &DgLevel) -> f64 {
    let mut difference = simulation.level().clone();
    for (one, other) in difference.places.iter_mut().zip(&level.places) {
        (0..2).for_each(|field| one[field] -= other[field]);
    }
    for (one, other) in difference.rates.iter_mut().zip(&level.rates) {
        (0..3).for_each(|field| one[field] -= other[field]);
    }
    let energy = simulation.energy(&difference);
    (2.0 * (energy.kinetic + energy.shear + energy.bending + energy.thermal)).sqrt()
}

#[test]
fn the_order_at_the_ends_of_steps_is_that_of_radau() {
    let reference = run(5, 100);
    for (q, steps) in [(0, 1600), (1, 160), (2, 40), (3, 12)] {
        let [coarse, fine] =
            [steps, 2 * steps].map(|steps| distance(&run(q, steps), reference.level()));
        let (rate, order) = ((coarse / fine).log2(), (2 * q + 1) as f64);
        assert!(
            (rate - order).abs() <= 0.03 * order,
            "q = {q}: {coarse:e} {fine:e}, rate {rate}"
        );
    }
}

#[test]
fn inside_a_step_the_order_is_that_of_interpolation() {
    for (q, steps) in [(0, 800), (1, 80), (2, 40), (3, 24)] {
        let errors = [steps, 2 * steps].map(|steps| {
            let simulation = run(q, steps);
            let dt = T / steps as f64;
            let mut reference = simulate(free(), equal_steps(5, T / 100.0));
            let mut worst = [0.0; 2];
            for t in [0.9, 0.7, 0.5, 0.3, 0.1].map(|part| T - part * dt) {
                reference.advance(t).unwrap();
                for (worst, field) in worst.iter_mut().zip([Field::U, Field::V]) {
                    let value = |simulation: &Dg| {
                        simulation
                            .value(field, 0.8, t)
                            .expect("a time in the last step")
                    };
                    *worst = larger(*worst, (value(&simulation) - value(&reference)).abs());
                }
            }
            worst
        });
        // For q = 0 the ends are of first order, and so is u.
        let orders = [(q + 2).min(2 * q + 1), q + 1];
        for (k, order) in orders.into_iter().enumerate() {
            let rate = (errors[0][k] / errors[1][k]).log2();
            assert!(
                (rate - order as f64).abs() <= 0.25,
                "q = {q}, {k}: {errors:?}, rate {rate}"
            );
        }
    }
}
