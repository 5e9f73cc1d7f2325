//! With a heated clamped end the beam converges to its steady state, which is known in closed form.

use super::scenes::{advance, paper, simulate, stepping, uniform};
use thermobeam::equilibrium::{Phase, equilibria};
use thermobeam::simulation::Stepping;
use thermobeam::solve::{Settings, Stopping};

/// Errors of u(1), φ(1) and the contact force in the steady state with the given number of elements.
fn errors(beta: f64, contact: Phase, elements: usize) -> [f64; 3] {
    let problem = paper(uniform(elements), (beta, 20.0));
    let states = equilibria(&problem.beam, problem.obstacles.as_ref()).unwrap();
    let [state] = states.as_slice() else {
        panic!("{states:?}")
    };
    assert_eq!(state.contact, contact);
    let settings = Settings {
        stopping: Stopping::below(1e-12),
        ..Settings::default()
    };
    let mut simulation = simulate(
        &problem,
        Stepping {
            settings,
            ..stepping(0.05)
        },
    );
    // Backward Euler damps every mode; the slowest thermal mode decays by 13 digits until t = 3.
    advance(&mut simulation, 4000);
    let level = simulation.level();
    let motion = level
        .v
        .iter()
        .chain(&level.w)
        .chain(&level.theta)
        .fold(0.0, |sum: f64, value| sum + value.abs());
    assert!(motion <= 1e-10, "beta = {beta}: still moving, {motion:e}");
    [
        level.u[elements] - state.u_tip,
        level.phi[elements] - state.phi_tip,
        level.contact_force - state.contact_force,
    ]
}

#[test]
fn a_hot_end_drives_the_beam_to_its_steady_state_at_second_order_in_h() {
    for (beta, contact) in [
        (-0.5, Phase::Upper),
        (0.0, Phase::Upper),
        (5.0, Phase::Free),
    ] {
        let [coarse, fine] = [16, 32].map(|elements| errors(beta, contact, elements));
        for (k, (coarse, fine)) in coarse.into_iter().zip(fine).enumerate() {
            if k == 2 && contact == Phase::Free {
                assert_eq!((coarse, fine), (0.0, 0.0));
                continue;
            }
            let rate = (coarse / fine).log2();
            assert!(
                (rate - 2.0).abs() <= 0.05,
                "beta = {beta}, quantity {k}: {coarse:e} {fine:e}, rate {rate}"
            );
        }
        assert!(
            fine[0].abs() <= 1e-4 && fine[1].abs() <= 1e-4,
            "beta = {beta}: {fine:?}"
        );
    }
}
