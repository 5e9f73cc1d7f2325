//! No state is missed, and none is found twice.

use super::{close, loaded, slope_squared_by_quadrature, states};
use crate::drawn::at_least;
use proptest::prelude::*;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam_exact::equilibrium::{Equilibrium, Phase, equilibria};

/// The textbook formula for one law at one N, with integrals by Simpson's rule: (f, c, u(1)).
fn textbook(beam: &Beam, support: Option<(f64, f64)>, n_value: f64) -> (f64, f64, f64) {
    let (q, m, moment) = (
        1.0 / (1.0 + n_value),
        n_value / (1.0 + n_value),
        beam.a * beam.theta_a,
    );
    let k = m.abs().sqrt();
    let cosine = |y: f64| {
        if m > 0.0 {
            (k * y).cosh()
        } else {
            (k * y).cos()
        }
    };
    let p = |x: f64| (1.0 - cosine(1.0 - x) / cosine(1.0)) / m;
    let points = 120;
    let (mut a, mut b) = (0.0, 0.0);
    for i in 0..=points {
        let weight = if i == 0 || i == points {
            1.0
        } else {
            f64::from(2 + 2 * (i % 2))
        } / f64::from(3 * points);
        let value = p(f64::from(i) / f64::from(points));
        a += weight * value;
        b += weight * value * value;
    }
    let c = support.map_or(0.0, |(epsilon, g)| {
        (g - q * moment * a) / (epsilon + q * (1.0 + q * a))
    });
    let d = moment + c * q;
    let slope_squared = q * q * (d * d * b + 2.0 * d * c * a + c * c);
    (
        n_value - beam.beta - beam.rho * slope_squared,
        c,
        q * (d * a + c),
    )
}

/// All states with N > -0.98 by a fine scan: (contact, u(1)).
fn blind_scan(beam: &Beam, obstacles: &Obstacles, largest: f64) -> Vec<(Phase, f64)> {
    let Obstacles { epsilon, g1, g2 } = *obstacles;
    let laws = [
        (Phase::Free, None),
        (Phase::Upper, Some((epsilon, g2))),
        (Phase::Lower, Some((epsilon, g1))),
    ];
    let mut found = Vec::new();
    for (contact, support) in laws {
        let f = |n| textbook(beam, support, n).0;
        let points = 20_000;
        // Cubic spacing: dense near N = -1, where the poles are.
        let node =
            |i: i32| -0.98 + (largest + 0.98) * ((f64::from(i) + 0.37) / f64::from(points)).powi(3);
        for i in 0..points {
            let (mut lo, mut hi) = (node(i), node(i + 1));
            if (f(lo) > 0.0) == (f(hi) > 0.0) {
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (lo + hi);
                if (f(middle) > 0.0) == (f(lo) > 0.0) {
                    lo = middle;
                } else {
                    hi = middle;
                }
            }
            let (_, c, tip) = textbook(beam, support, lo);
            let consistent = match contact {
                Phase::Free => (g1..=g2).contains(&tip),
                Phase::Upper => c < 0.0,
                Phase::Lower => c > 0.0,
            };
            if consistent {
                found.push((contact, tip));
            }
        }
    }
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    found
}

#[test]
fn a_fine_scan_of_the_textbook_formula_finds_the_same_states() {
    let cases = [
        (
            loaded(-0.95, 1.0, 0.05),
            Obstacles {
                epsilon: 1e-3,
                g1: -0.6,
                g2: 0.1,
            },
            2.0,
        ),
        (
            loaded(-0.97, 0.5, -0.02),
            Obstacles {
                epsilon: 0.1,
                g1: -2.0,
                g2: 2.0,
            },
            2.0,
        ),
        (
            loaded(-1.4, 0.7, 0.4),
            Obstacles {
                epsilon: 0.05,
                g1: -0.2,
                g2: 0.0,
            },
            3.0,
        ),
        (
            loaded(-5.0, 1.0, 0.34),
            Obstacles {
                epsilon: 1e-3,
                g1: -0.01,
                g2: 0.1,
            },
            3.0,
        ),
    ];
    for (beam, obstacles, largest) in cases {
        let expected = blind_scan(&beam, &obstacles, largest);
        let found: Vec<_> = states(&beam, Some(&obstacles))
            .into_iter()
            .filter(|state| state.n_value > -0.98)
            .collect();
        assert_eq!(
            found.len(),
            expected.len(),
            "{beam:?}: {found:#?} {expected:?}"
        );
        for (state, (contact, tip)) in found.iter().zip(expected) {
            assert_eq!(state.contact, contact);
            close(state.u_tip, tip, 1e-5);
        }
    }
}

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
            let found = equilibria(&beam, obstacles);
            prop_assert!(found.is_ok(), "{:?}", found);
            let found = found.unwrap();
            prop_assert!(found.iter().any(|state| state.stable));
            for state in &found {
                let slope_squared = slope_squared_by_quadrature(state);
                let defect = state.n_value - beta - beam.rho * slope_squared;
                // Simpson's rule does not resolve a boundary layer thinner than its step.
                let resolved = !(-1.001..=-1.0).contains(&state.n_value);
                prop_assert!(!resolved || defect.abs() <= 1e-6 * (1.0 + beta.abs() + beam.rho * slope_squared), "{:?}", state);
            }
        }
    }
}

#[test]
fn small_heat_load_splits_each_buckled_pair() {
    let tips = |theta_a: f64| {
        let beam = Beam {
            beta: -0.99,
            theta_a,
            ..Beam::default()
        };
        let mut tips: Vec<f64> = equilibria(&beam, None)
            .unwrap()
            .iter()
            .map(|state| state.u_tip)
            .collect();
        tips.sort_by(f64::total_cmp);
        tips
    };
    let cold = tips(0.0);
    assert!(cold.len() >= 7, "{cold:?}");
    for theta_a in [1e-12, 1e-11, 1e-10] {
        let warm = tips(theta_a);
        assert_eq!(warm.len(), cold.len(), "{theta_a}");
        for (warm, cold) in warm.iter().zip(&cold) {
            assert!((warm - cold).abs() < 1e-6, "{theta_a}: {warm} for {cold}");
        }
    }
}

/// Next to N = -1 the sum S(N) stays finite, so there may be a single root.
#[test]
fn below_minus_one_there_may_be_one_state() {
    let beam = Beam {
        beta: -2.0,
        a: 1.0,
        theta_a: 0.5,
        rho: 1.0,
        ..Beam::default()
    };
    let below: Vec<f64> = equilibria(&beam, None)
        .unwrap()
        .iter()
        .map(|state| state.n_value)
        .filter(|n| *n < -1.0)
        .collect();
    assert!(
        below.len() == 1 && (below[0] + 1.98964).abs() < 5e-6,
        "{below:?}"
    );
}
