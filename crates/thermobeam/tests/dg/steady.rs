//! Beams at rest: their steady states are known in closed form.

use super::scenes::{advanced, close, experiment, tip};
use thermobeam::dg::{Field, Phase, Stepping};
use thermobeam::equilibrium::equilibria;

#[test]
fn a_hot_end_drives_the_beam_to_its_steady_state() {
    for beta in [-0.5, 0.0, 5.0] {
        let problem = experiment(beta, 20.0, 16);
        let states = equilibria(&problem.beam, problem.obstacles.as_ref()).unwrap();
        let [state] = states.as_slice() else {
            panic!("{states:?}")
        };
        let stepping = Stepping {
            degree: 1,
            dt: 0.1,
            ..Stepping::default()
        };
        let simulation = advanced(problem, stepping, 300.0);
        close(tip(&simulation, Field::U), state.u_tip, 1e-12);
        close(tip(&simulation, Field::Phi), state.phi_tip, 1e-11);
        close(tip(&simulation, Field::V), 0.0, 1e-10);
        let expected = if state.contact == Phase::Upper {
            Phase::Upper
        } else {
            Phase::Free
        };
        assert_eq!(simulation.phase(), expected);
        for x in [0.2, 0.6] {
            close(
                simulation.value(Field::U, x, simulation.t()).unwrap(),
                state.shape.u(x),
                1e-11,
            );
            close(
                simulation.temperature(x, simulation.t()).unwrap(),
                20.0 * (1.0 - x),
                1e-10,
            );
        }
    }
}

#[test]
fn a_beam_at_rest_stays_at_rest_to_the_last_bit() {
    let mut problem = experiment(0.0, 0.0, 8);
    problem.initial = thermobeam::dg::Initial::at_rest(0.0);
    let simulation = advanced(problem, Stepping::default(), 1.0);
    assert!(
        simulation
            .level()
            .places
            .iter()
            .all(|places| *places == [0.0; 2])
    );
    assert!(
        simulation
            .level()
            .rates
            .iter()
            .all(|rates| *rates == [0.0; 3])
    );
    assert_eq!(simulation.events(), []);
}
