//! Beams at rest.

use crate::prelude::*;

#[test]
fn a_beam_at_rest_stays_at_rest_to_the_last_bit() {
    let mut problem = experiment((0.0, 0.0), 8);
    problem.initial = InitialFunctions::at_rest(0.0);
    let simulation = advanced(problem, DgStepping::default(), 1.0);
    let level = simulation.level();
    assert!(level.places.iter().all(|places| *places == [0.0; 2]));
    assert!(level.rates.iter().all(|rates| *rates == [0.0; 3]));
    assert_eq!(simulation.events(), []);
}
