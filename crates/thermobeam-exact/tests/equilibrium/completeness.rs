//! No state is missed, and none is found twice.

use super::{loaded, slope_squared, states};
use crate::drawn::at_least;
use crate::prelude::*;
use proptest::prelude::*;

fn any_beam() -> impl Strategy<Value = Beam> {
    (
        -0.999..3.0_f64,
        -2.0..4.0_f64,
        -6.0..1.0_f64,
        prop::bool::ANY,
    )
        .prop_map(|(beta, rho, moment, up)| {
            loaded(
                beta,
                10.0_f64.powf(rho),
                if up { 1.0 } else { -1.0 } * 10.0_f64.powf(moment),
            )
        })
}

fn any_obstacles() -> impl Strategy<Value = Option<Obstacles>> {
    let gap = || prop_oneof![Just(0.0), 1e-3..0.5_f64];
    prop::option::of(
        (-8.0..1.0_f64, gap(), gap()).prop_map(|(epsilon, below, above)| Obstacles {
            epsilon: 10.0_f64.powf(epsilon),
            g1: -below,
            g2: above,
        }),
    )
}

proptest! {
    #![proptest_config(at_least(1000))]

    /// The energy is coercive, so its gradient has degree 1: a state missed or found twice changes
    /// the sum. A missed pair does not; the fine scan covers that case.
    #[test]
    fn the_indices_of_all_states_add_up_to_one(beam in any_beam(), obstacles in any_obstacles()) {
        let found = states(&beam, obstacles.as_ref());
        let parity = |state: &Equilibrium| 1 - 2 * (state.unstable_directions.unwrap() % 2) as i32;
        prop_assert_eq!(found.iter().map(parity).sum::<i32>(), 1, "{:#?}", found);
        prop_assert!(found.iter().any(|state| state.stable));
    }

    /// Reflecting beam and obstacles reflects the states.
    #[test]
    fn a_mirrored_scene_has_mirrored_states(beam in any_beam(), obstacles in any_obstacles()) {
        let mirrored_beam = Beam { theta_a: -beam.theta_a, ..beam };
        let mirrored_obstacles = obstacles.map(|o| Obstacles { g1: -o.g2, g2: -o.g1, ..o });
        let (found, mirrored) = (states(&beam, obstacles.as_ref()), states(&mirrored_beam, mirrored_obstacles.as_ref()));
        prop_assert_eq!(found.len(), mirrored.len());
        for (state, image) in found.iter().zip(mirrored.iter().rev()) {
            prop_assert!((state.u_tip + image.u_tip).abs() <= 1e-12 * (1.0 + state.u_tip.abs()));
            prop_assert_eq!(state.stable, image.stable);
        }
    }

    /// For all coefficients the states are finite, satisfy N = β + ρ‖u'‖², and one of them is
    /// stable.
    #[test]
    fn equilibria_are_found_for_extreme_coefficients(
        beta in prop_oneof![-1e6..1e6_f64, -5.0..1.0_f64, -1.01..-0.99_f64],
        rho in -6.0..8.0_f64,
        moment in prop_oneof![-1e4..1e4_f64, -1.0..1.0_f64, -1e-9..1e-9_f64],
        epsilon in -10.0..6.0_f64,
        (below, above) in (prop_oneof![Just(0.0), 1e-6..10.0_f64], prop_oneof![Just(0.0), 1e-6..10.0_f64]),
    ) {
        let beam = loaded(beta, 10.0_f64.powf(rho), moment);
        let walls = Obstacles { epsilon: 10.0_f64.powf(epsilon), g1: -below, g2: above };
        for obstacles in [None, Some(&walls)] {
            let found = states(&beam, obstacles);
            prop_assert!(found.iter().any(|state| state.stable));
            for state in &found {
                let slope_squared = slope_squared(state);
                let defect = state.n_value - beta - beam.rho * slope_squared;
                // Simpson's rule does not resolve a boundary layer thinner than its step.
                let resolved = !(-1.001..=-1.0).contains(&state.n_value);
                prop_assert!(!resolved || defect.abs() <= 1e-6 * (1.0 + beta.abs() + beam.rho * slope_squared), "{:?}", state);
            }
        }
    }
}

/// Next to N = -1 the sum S(N) stays finite, so there may be a single root.
#[test]
fn below_minus_one_there_may_be_one_state() {
    let found = states(&loaded(-2.0, 1.0, 0.5), None);
    let below: Vec<f64> = found
        .iter()
        .map(|state| state.n_value)
        .filter(|n| *n < -1.0)
        .collect();
    assert!(
        below.len() == 1 && (below[0] + 1.98964).abs() < 5e-6,
        "{below:?}"
    );
}
