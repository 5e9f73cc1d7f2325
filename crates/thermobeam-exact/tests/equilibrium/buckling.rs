//! Buckling, folds and limit cases.

use super::roots::bent;
use super::{loaded, obstacles, states};
use crate::prelude::*;
use std::f64::consts::PI;
use thermobeam_exact::equilibrium::{
    BUCKLING_VALUES, Completeness, EquilibriumError, completeness, equilibria,
};

/// The buckling value N_k of the beam without support.
fn buckling(k: u32) -> f64 {
    let kappa = (f64::from(k) - 0.5) * PI;
    -kappa * kappa / (1.0 + kappa * kappa)
}

#[test]
fn a_straight_beam_has_a_pair_of_buckled_states_per_buckling_value() {
    let beam = loaded(-0.985, 3.0, 0.0);
    let found = states(&beam, None);
    assert_eq!(found.len(), 7);
    for k in 1..=3 {
        let n = buckling(k);
        let pair: Vec<_> = found
            .iter()
            .filter(|state| (state.n_value - n).abs() < 1e-13)
            .collect();
        assert_eq!(pair.len(), 2, "buckling value {k}");
        // u' = α q cos(κ(1 - x)), whose square integrates to α² q²/2.
        let (q, kappa) = (1.0 / (1.0 + n), (f64::from(k) - 0.5) * PI);
        let alpha = (2.0 * (n - beam.beta) / beam.rho).sqrt() / q;
        close(pair[1].phi_tip.abs(), alpha, 1e-13);
        close(pair[1].u_tip, alpha * q / kappa, 1e-13);
        close(pair[0].u_tip, -pair[1].u_tip, 1e-15);
        assert_eq!(pair[0].unstable_directions, Some(k as usize - 1));
    }
    let straight = &found[3];
    assert_eq!(
        (
            straight.u_tip,
            straight.n_value,
            straight.unstable_directions
        ),
        (0.0, beam.beta, Some(3))
    );
}

#[test]
fn obstacles_exclude_the_free_states_that_would_cross_them() {
    let beam = loaded(-0.72, 1.0, 0.0);
    let amplitude = states(&beam, None)[2].u_tip;
    let wide = Obstacles {
        g1: -1.001 * amplitude,
        g2: 1.001 * amplitude,
        epsilon: 1e-3,
    };
    let narrow = Obstacles {
        g1: -0.999 * amplitude,
        ..wide
    };
    let contacts = |o: &Obstacles| {
        states(&beam, Some(o))
            .iter()
            .map(|state| state.contact)
            .collect::<Vec<_>>()
    };
    assert_eq!(contacts(&wide), [Phase::Free; 3]);
    assert_eq!(contacts(&narrow), [Phase::Lower, Phase::Free, Phase::Free]);
}

#[test]
fn a_small_load_moves_buckled_states_linearly() {
    let sum = |moment: f64| {
        let found = states(&loaded(-0.9, 1.0, moment), None);
        assert_eq!(found.len(), 3, "moment {moment:e}");
        (found[0].u_tip + found[2].u_tip) / moment
    };
    let slope = sum(1e-4);
    for moment in [1e-6, -1e-8, 1e-10, -1e-12] {
        close(sum(moment), slope, 1e-5 + 4e-16 / moment.abs());
    }
    // For loads below round-off of the amplitude each pair is that of the unloaded beam.
    for beta in [-0.9, -0.99] {
        let unloaded = states(&loaded(beta, 1.0, 0.0), None);
        assert_eq!(unloaded.len(), if beta == -0.9 { 3 } else { 7 });
        for moment in [1e-15, 1e-17, -1e-30, 1e-200] {
            let found = states(&loaded(beta, 1.0, moment), None);
            assert_eq!(found.len(), unloaded.len(), "moment {moment:e}");
            for (state, limit) in found.iter().zip(&unloaded) {
                close(state.u_tip, limit.u_tip, 1e-14);
            }
        }
    }
}

#[test]
fn two_states_merge_in_a_fold_and_vanish() {
    let count = |moment: f64| states(&loaded(-0.8, 1.0, moment), None).len();
    let (mut three, mut one) = (1e-4, 1.0);
    assert_eq!((count(three), count(one)), (3, 1));
    while one - three > 1e-14 * one {
        let middle = 0.5 * (three + one);
        if count(middle) == 1 {
            one = middle;
        } else {
            three = middle;
        }
    }
    assert_eq!(
        (count(three * (1.0 - 1e-12)), count(one * (1.0 + 1e-12))),
        (3, 1)
    );
    // At a relative distance δ from the fold the two states differ by √δ; one is stable, the other
    // is not.
    let nearby = states(&loaded(-0.8, 1.0, three * (1.0 - 1e-10)), None);
    assert!((nearby[1].u_tip - nearby[0].u_tip).abs() < 1e-4);
    assert_eq!(nearby.iter().filter(|state| state.stable).count(), 2);
}

#[test]
fn the_straight_beam_held_by_two_obstacles_at_zero_is_stiffer() {
    let beam = loaded(-0.8, 1.0, 0.0);
    let pinched = states(&beam, obstacles(1e-3, 0.0, 0.0).as_ref());
    assert_eq!(pinched.len(), 1);
    assert!(pinched[0].stable);
    let one_sided = states(&beam, obstacles(1e-3, -1.0, 0.0).as_ref());
    assert_eq!(
        one_sided
            .iter()
            .map(|state| state.stable)
            .collect::<Vec<_>>(),
        [true, false]
    );
}

#[test]
fn the_state_at_axial_force_minus_one_has_no_stress() {
    // ρ(aθ_A)² = -1 - β, all exact in binary.
    for (beta, rho) in [(-1.25, 1.0), (-3.0, 8.0)] {
        let found = states(&loaded(beta, rho, 0.5), None);
        let state = found
            .iter()
            .find(|state| state.n_value == -1.0)
            .expect("the state at N = -1");
        assert_eq!(
            (
                state.u_tip,
                state.phi_tip,
                state.shape.u_x(0.3),
                state.unstable_directions
            ),
            (-0.5, 0.0, -0.5, None)
        );
        assert!(
            states(&loaded(beta, 1.001 * rho, 0.5), None)
                .iter()
                .all(|state| state.n_value != -1.0)
        );
    }
    // So has the only state of a linear beam with β = -1.
    let linear = states(&loaded(-1.0, 0.0, 0.5), None);
    assert_eq!([linear[0].n_value, linear[0].u_tip], [-1.0, -0.5]);
}

/// For β < -1 the list ends at N_17 from above and continues from N = -1 downwards.
#[test]
fn sixteen_buckled_pairs_are_listed_for_any_beta() {
    for beta in [-1.0, -1.5] {
        let unloaded = states(&loaded(beta, 1.0, 0.0), None);
        assert_eq!(
            unloaded.len(),
            1 + 2 * BUCKLING_VALUES,
            "one straight, and a pair each: {beta}"
        );
        assert!((1..=16).all(|k| {
            unloaded
                .iter()
                .filter(|s| (s.n_value - buckling(k)).abs() < 1e-13)
                .count()
                == 2
        }));
        let straight = unloaded
            .iter()
            .find(|state| state.u_tip == 0.0)
            .expect("the straight beam");
        assert_eq!(
            (straight.n_value, straight.unstable_directions),
            (beta, None)
        );
    }
    // A load splits each pair into one state above and one below N_k; of N_17 only the upper one is
    // listed.
    let split = states(&loaded(-1.5, 1.0, 1e-6), None);
    let above_minus_one: Vec<f64> = split
        .iter()
        .map(|state| state.n_value)
        .filter(|n| *n > -1.0)
        .collect();
    assert_eq!(
        above_minus_one.len(),
        2 * BUCKLING_VALUES + 1,
        "{above_minus_one:?}"
    );
    assert!(
        above_minus_one
            .iter()
            .all(|n| *n > buckling(BUCKLING_VALUES as u32 + 1))
    );
    assert!(split.iter().any(|state| state.n_value < -1.0));
}

#[test]
fn undecidable_equilibria_are_errors() {
    let resonant = equilibria(&loaded(buckling(2), 0.0, 0.1), None);
    assert!(
        matches!(
            resonant,
            Err(EquilibriumError::Resonance {
                contact: Phase::Free,
                ..
            })
        ),
        "{resonant:?}"
    );
    let bad = equilibria(&loaded(f64::NAN, 1.0, 0.1), None);
    assert!(
        matches!(bad, Err(EquilibriumError::Parameter(_))),
        "{bad:?}"
    );
}

/// Whether the law has a state between buckling values: a root of f that the obstacles admit, or a
/// maximum of f above 0.
fn has_state_beyond_the_list(
    beam: &Beam,
    gap: Option<Obstacles>,
    waves: std::ops::Range<usize>,
) -> bool {
    let supports = gap.map_or(vec![None], |o| {
        vec![None, Some([o.epsilon, o.g1]), Some([o.epsilon, o.g2])]
    });
    let places =
        waves.flat_map(|wave| (1..40).map(move |i| wave as f64 - 0.5 + f64::from(i) / 40.0));
    let places: Vec<f64> = places.map(|k| 1.0 / (1.0 + (k * PI).powi(2))).collect();
    supports.into_iter().any(|support| {
        places.iter().any(|&s| {
            let bent = bent(beam, support, s);
            let admitted = match support {
                None => gap.is_none_or(|o| (o.g1..=o.g2).contains(&bent.u_tip)),
                Some([_, g]) => -bent.stress * (g - 1e-9) > 0.0,
            };
            s - 1.0 - beam.beta - beam.rho * bent.slope_squared >= 0.0 && admitted
        })
    })
}

#[test]
fn a_list_is_complete_where_no_beam_has_another_state() {
    let hard = |g1, g2| obstacles(1e-3, g1, g2);
    let narrow = hard(-0.1, 0.1);
    for (beam, gap, expected) in [
        ([-0.999, 1.0, 0.0], None, Completeness::Complete),
        ([-0.9997, 1.0, 0.0], None, Completeness::Unknown),
        ([-1.0, 1.0, 0.0], None, Completeness::Infinite),
        ([-1.0, 1.0, 0.0], narrow, Completeness::Infinite),
        ([-1.0, 1.0, 1.0], None, Completeness::Complete),
        ([-2.49, 1.0, 1.0], None, Completeness::Complete),
        ([-2.51, 1.0, 1.0], None, Completeness::Infinite),
        ([-4.0, 1.0, 1.0], None, Completeness::Infinite),
        ([-4.0, 1.0, 1.0], narrow, Completeness::Complete),
        ([-4.0, 1.0, -1.0], narrow, Completeness::Complete),
        ([-4.0, 1.0, 1.0], hard(-2.0, 0.1), Completeness::Infinite),
        ([-4.0, 1.0, -1.0], hard(-0.1, 2.0), Completeness::Infinite),
        // The free states are admitted or not by a hair.
        ([-4.0, 1.0, 1.0], hard(-1.0, 0.1), Completeness::Unknown),
        ([-4.0, 0.0, 1.0], None, Completeness::Complete),
        ([-1.4, 3.0, 0.3], hard(-0.2, 0.5), Completeness::Complete),
    ] {
        let [beta, rho, moment] = beam;
        let beam = loaded(beta, rho, moment);
        assert_eq!(
            completeness(&beam, gap.as_ref()),
            expected,
            "{beam:?} {gap:?}"
        );
        // So it is on intervals that are not searched. (Roots without a load are the N_k.)
        if rho > 0.0 && moment != 0.0 && expected != Completeness::Unknown {
            assert_eq!(
                has_state_beyond_the_list(&beam, gap, 18..24),
                expected == Completeness::Infinite,
                "{beam:?} {gap:?}"
            );
        }
    }
    let last = buckling(BUCKLING_VALUES as u32 + 1);
    let unloaded = |beta: f64| completeness(&loaded(beta, 1.0, 0.0), None);
    assert_eq!(
        [last + 1e-9, last - 1e-9].map(unloaded),
        [Completeness::Complete, Completeness::Unknown]
    );
}
