//! Steady states against reference numbers, the strong form, a discretisation, and a topological count.

use proptest::prelude::*;
use std::f64::consts::PI;
use thermobeam::equilibrium::{Contact, Equilibrium, EquilibriumError, equilibria, lists_all};
use thermobeam::parameters::{Beam, Obstacles};

mod discrete_beam;
use discrete_beam::DiscreteBeam;

fn heated(beta: f64, theta_a: f64) -> Beam {
    Beam { beta, theta_a, ..Beam::default() }
}

/// A beam on which the load aθ_A is `drive`.
fn driven(beta: f64, rho: f64, drive: f64) -> Beam {
    Beam { zeta: 0.1, beta, rho, a: 1.0, theta_a: drive }
}

fn obstacles(epsilon: f64, g1: f64, g2: f64) -> Option<Obstacles> {
    Some(Obstacles { epsilon, g1, g2 })
}

#[track_caller]
fn states(beam: &Beam, obstacles: Option<&Obstacles>) -> Vec<Equilibrium> {
    equilibria(beam, obstacles).unwrap_or_else(|error| panic!("{beam:?} {obstacles:?}: {error}"))
}

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected} to {tolerance:e}");
}

/// N_k, where the beam without support buckles.
fn buckling(k: u32) -> f64 {
    let kappa = (f64::from(k) - 0.5) * PI;
    -kappa * kappa / (1.0 + kappa * kappa)
}

/// Scenes from all corners: buckled and not, pushed up and down, hard and soft obstacles and none, strong stretching.
fn scenes() -> Vec<(Beam, Option<Obstacles>)> {
    let paper = Some(Obstacles::default());
    vec![
        (heated(-0.5, 20.0), paper),
        (heated(0.0, 20.0), paper),
        (heated(5.0, 20.0), paper),
        (heated(-0.8, 0.0), paper),
        (heated(-0.8, 0.0), None),
        (heated(-0.8, 0.5), None),
        (heated(-0.97, 0.1), None),
        (heated(-0.99, 5.0), paper),
        (heated(-5.0, 20.0), paper),
        (driven(-0.9, 1e4, -5.1), paper),
        (driven(0.0, 1e6, -3000.0), None),
        (driven(-0.985, 2.0, -0.3), obstacles(1e-8, -0.05, 0.0)),
        (driven(-0.96, 0.5, 0.0), obstacles(1e-8, 0.0, 0.0)),
        (driven(-0.75, 0.01, 0.02), obstacles(1.0, -0.3, 0.2)),
        (driven(-2.0, 1.0, 1.5), obstacles(1.0, -0.3, 0.2)),
        (driven(-5.0, 0.3, -2.0), obstacles(0.5, 0.0, 0.4)),
        (driven(-5.0, 1.0, 0.0), obstacles(0.5, 0.0, 0.0)),
        (driven(-5.0, 1.0, 0.0), None),
        (driven(200.0, 0.0, -7.0), paper),
        (driven(-0.8, 0.0, 0.3), paper),
    ]
}

#[test]
fn reference_states_are_met() {
    let paper = Obstacles::default();
    type Row = (Contact, f64, bool);
    let rows: [(f64, f64, &[Row]); 4] = [
        (-0.5, 20.0, &[(Contact::Upper, 0.1000634088, true)]),
        (0.0, 20.0, &[(Contact::Upper, 0.1000086904, true)]),
        (5.0, 20.0, &[(Contact::Free, 0.0141796394, true)]),
        (
            -0.8,
            0.0,
            &[(Contact::Lower, -0.0100012352, true), (Contact::Free, 0.0, false), (Contact::Upper, 0.1000098954, true)],
        ),
    ];
    for (beta, theta_a, expected) in rows {
        let found = states(&heated(beta, theta_a), Some(&paper));
        assert_eq!(found.len(), expected.len(), "beta = {beta}: {found:#?}");
        for (state, &(contact, u_tip, stable)) in found.iter().zip(expected) {
            assert_eq!((state.contact, state.stable), (contact, stable));
            // The references carry ten decimals.
            close(state.u_tip, u_tip, 5.1e-11);
        }
    }
    close(states(&heated(-0.5, 20.0), Some(&paper))[0].phi_tip, 0.1760200007, 5.1e-11);
}

/// Largest residual of both equations in the interior, derivatives differenced over h.
fn strong_residual(beam: &Beam, state: &Equilibrium, h: f64) -> f64 {
    let drive = beam.a * beam.theta_a;
    let residual = |x: f64| {
        let difference = |f: &dyn Fn(f64) -> f64| (f(x + h) - f(x - h)) / (2.0 * h);
        let second = |f: &dyn Fn(f64) -> f64| (f(x + h) - 2.0 * f(x) + f(x - h)) / (h * h);
        let (u, phi) = (|x| state.u(x), |x| state.phi(x));
        let force = (1.0 + state.n_value) * second(&u) - difference(&phi);
        let moment = second(&phi) + difference(&u) - phi(x) + drive;
        let slopes = (difference(&u) - state.u_x(x)).abs() + (difference(&phi) - state.phi_x(x)).abs();
        force.abs() + moment.abs() + slopes
    };
    (1..20).map(|i| residual(f64::from(i) / 20.0)).fold(0.0, f64::max)
}

/// ∫ u_x² by Simpson's rule.
fn stretch_by_quadrature(state: &Equilibrium) -> f64 {
    let n = 4000;
    let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    (0..=n).map(|i| weight(i) * state.u_x(f64::from(i) / f64::from(n)).powi(2)).sum::<f64>() / (3.0 * f64::from(n))
}

#[test]
fn every_state_solves_the_strong_form() {
    for (beam, obstacles) in scenes() {
        for state in states(&beam, obstacles.as_ref()) {
            let size = 1.0 + (0..=20).map(|i| state.u_x(f64::from(i) / 20.0).abs()).fold(0.0, f64::max);
            let (coarse, fine) = (strong_residual(&beam, &state, 4e-3), strong_residual(&beam, &state, 2e-3));
            assert!(fine <= 0.27 * coarse || fine <= 1e-8 * size, "{beam:?} {state:?}: {coarse:e} {fine:e}");
            let stress = (1.0 + state.n_value) * state.u_x(1.0) - state.phi(1.0);
            close(stress, -state.contact_force, 1e-12 * size);
            for (found, name) in [(state.u(0.0), "u(0)"), (state.phi(0.0), "phi(0)"), (state.phi_x(1.0), "phi_x(1)")] {
                assert!(found.abs() <= 2e-13 * size, "{name} = {found:e} of {beam:?} {state:?}");
            }
            close(state.u(1.0), state.u_tip, 2e-13 * size);
            let stretch = stretch_by_quadrature(&state);
            close(state.n_value, beam.beta + beam.rho * stretch, 1e-8 * (1.0 + beam.rho * stretch));
        }
    }
}

#[test]
fn contact_force_is_the_compliance_law() {
    for (beam, obstacles) in scenes() {
        for state in states(&beam, obstacles.as_ref()) {
            let expected =
                obstacles.map_or(0.0, |o| ((state.u_tip - o.g2).max(0.0) - (o.g1 - state.u_tip).max(0.0)) / o.epsilon);
            let round_off = obstacles.map_or(0.0, |o| 4.0 * f64::EPSILON * state.u_tip.abs() / o.epsilon);
            close(state.contact_force, expected, round_off);
        }
    }
}

/// Newton's method on n elements from the exact state: the discrete state and the number of negative eigenvalues there.
fn discrete_state(beam: &Beam, obstacles: Option<&Obstacles>, state: &Equilibrium, n: usize) -> (f64, usize) {
    let discrete = DiscreteBeam::new(n);
    let mut x = discrete.interpolate(|x| state.u(x), |x| state.phi(x));
    for _ in 0..20 {
        let (first, second) = discrete.variations(beam, obstacles, &x);
        let step = second.lu().solve(&first).expect("regular second variation");
        x -= &step;
        if step.amax() <= 1e-11 * (1.0 + x.amax()) {
            let (_, second) = discrete.variations(beam, obstacles, &x);
            let negative = second.symmetric_eigenvalues().iter().filter(|e| **e < 0.0).count();
            return (x[n - 1], negative);
        }
    }
    panic!("Newton's method does not settle near {state:?}");
}

#[test]
fn discrete_states_converge_at_second_order_and_have_as_many_unstable_directions() {
    for (beam, obstacles) in scenes() {
        for state in states(&beam, obstacles.as_ref()) {
            // Finer waves would need finer meshes than dense matrices allow.
            if state.n_value < -0.985 {
                continue;
            }
            let at = |n| discrete_state(&beam, obstacles.as_ref(), &state, n);
            let ((coarse, _), (fine, negative)) = (at(32), at(64));
            let errors = (coarse - state.u_tip, fine - state.u_tip);
            let rate = (errors.0 / errors.1).log2();
            let floor = 1e-10 * (1.0 + state.u_tip.abs());
            assert!(errors.1.abs() <= floor || (1.85..2.15).contains(&rate), "{beam:?} {state:?} {errors:?}");
            // A beam that only touches has no second variation in the classical sense.
            let touches = obstacles.is_some_and(|o| state.u_tip == o.g1 || state.u_tip == o.g2);
            if !touches {
                assert_eq!(state.unstable_directions, Some(negative), "{beam:?} {state:?}");
                assert_eq!(state.stable, negative == 0);
            }
        }
    }
}

#[test]
fn a_straight_beam_has_a_pair_of_buckled_states_per_buckling_value() {
    let beam = driven(-0.985, 3.0, 0.0);
    let found = states(&beam, None);
    assert_eq!(found.len(), 7);
    for k in 1..=3 {
        let n = buckling(k);
        let pair: Vec<_> = found.iter().filter(|state| (state.n_value - n).abs() < 1e-13).collect();
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
    assert_eq!((straight.u_tip, straight.n_value, straight.unstable_directions), (0.0, beam.beta, Some(3)));
}

#[test]
fn obstacles_take_away_the_buckled_states_that_they_are_in_the_way_of() {
    let beam = driven(-0.72, 1.0, 0.0);
    let amplitude = states(&beam, None)[2].u_tip;
    let wide = Obstacles { g1: -1.001 * amplitude, g2: 1.001 * amplitude, epsilon: 1e-3 };
    let narrow = Obstacles { g1: -0.999 * amplitude, ..wide };
    let contacts = |o: &Obstacles| states(&beam, Some(o)).iter().map(|state| state.contact).collect::<Vec<_>>();
    assert_eq!(contacts(&wide), [Contact::Free; 3]);
    assert_eq!(contacts(&narrow), [Contact::Lower, Contact::Free, Contact::Free]);
}

#[test]
fn a_small_load_moves_buckled_states_linearly() {
    let sum = |drive: f64| {
        let found = states(&driven(-0.9, 1.0, drive), None);
        assert_eq!(found.len(), 3, "drive {drive:e}");
        (found[0].u_tip + found[2].u_tip) / drive
    };
    let slope = sum(1e-4);
    for drive in [1e-6, -1e-8, 1e-10, -1e-12] {
        close(sum(drive), slope, 1e-5 + 4e-16 / drive.abs());
    }
    // Below round-off of the amplitude the pair is that of the unloaded beam.
    let unloaded = states(&driven(-0.9, 1.0, 0.0), None);
    for drive in [1e-15, 1e-17, -1e-30, 1e-200] {
        let found = states(&driven(-0.9, 1.0, drive), None);
        assert_eq!(found.len(), 3, "drive {drive:e}");
        found.iter().zip(&unloaded).for_each(|(state, limit)| close(state.u_tip, limit.u_tip, 1e-14));
    }
}

#[test]
fn two_states_merge_in_a_fold_and_vanish() {
    let count = |drive: f64| states(&driven(-0.8, 1.0, drive), None).len();
    let (mut three, mut one) = (1e-4, 1.0);
    assert_eq!((count(three), count(one)), (3, 1));
    while one - three > 1e-14 * one {
        let middle = 0.5 * (three + one);
        if count(middle) == 1 { one = middle } else { three = middle }
    }
    assert_eq!((count(three * (1.0 - 1e-12)), count(one * (1.0 + 1e-12))), (3, 1));
    // Beside the fold the pair is √ close, one of it stable, one not.
    let close_by = states(&driven(-0.8, 1.0, three * (1.0 - 1e-10)), None);
    assert!((close_by[1].u_tip - close_by[0].u_tip).abs() < 1e-4);
    assert_eq!(close_by.iter().filter(|state| state.stable).count(), 2);
}

#[test]
fn the_straight_beam_pinched_between_two_obstacles_at_zero_is_stiffer() {
    let beam = driven(-0.8, 1.0, 0.0);
    let pinched = states(&beam, obstacles(1e-3, 0.0, 0.0).as_ref());
    assert_eq!(pinched.len(), 1);
    assert!(pinched[0].stable);
    let one_sided = states(&beam, obstacles(1e-3, -1.0, 0.0).as_ref());
    assert_eq!(one_sided.iter().map(|state| state.stable).collect::<Vec<_>>(), [true, false]);
}

#[test]
fn at_minus_one_the_stress_vanishes() {
    // ρ(aθ_A)² = -1 - β, all exact in binary.
    let found = states(&driven(-1.25, 1.0, 0.5), None);
    let state = found.iter().find(|state| state.n_value == -1.0).expect("the state at N = -1");
    assert_eq!((state.u_tip, state.phi_tip, state.u_x(0.3), state.unstable_directions), (-0.5, 0.0, -0.5, None));
}

#[test]
fn what_cannot_be_told_is_an_error() {
    let resonant = equilibria(&driven(buckling(2), 0.0, 0.1), None);
    assert!(matches!(resonant, Err(EquilibriumError::Resonance { contact: Contact::Free, .. })), "{resonant:?}");
    let bad = equilibria(&driven(f64::NAN, 1.0, 0.1), None);
    assert!(matches!(bad, Err(EquilibriumError::Parameter(_))), "{bad:?}");
    assert!(lists_all(&driven(-0.999, 1.0, 0.0)) && !lists_all(&driven(-1.0, 1.0, 0.0)));
}

/// The textbook formula for one law at one N, integrals by Simpson's rule: (f, c, u(1)).
fn textbook(beam: &Beam, support: Option<(f64, f64)>, n_value: f64) -> (f64, f64, f64) {
    let (q, m, drive) = (1.0 / (1.0 + n_value), n_value / (1.0 + n_value), beam.a * beam.theta_a);
    let k = m.abs().sqrt();
    let cosine = |y: f64| if m > 0.0 { (k * y).cosh() } else { (k * y).cos() };
    let p = |x: f64| (1.0 - cosine(1.0 - x) / cosine(1.0)) / m;
    let points = 120;
    let (mut a, mut b) = (0.0, 0.0);
    for i in 0..=points {
        let weight = if i == 0 || i == points { 1.0 } else { f64::from(2 + 2 * (i % 2)) } / f64::from(3 * points);
        let value = p(f64::from(i) / f64::from(points));
        a += weight * value;
        b += weight * value * value;
    }
    let c = support.map_or(0.0, |(epsilon, g)| (g - q * drive * a) / (epsilon + q * (1.0 + q * a)));
    let d = drive + c * q;
    let stretch = q * q * (d * d * b + 2.0 * d * c * a + c * c);
    (n_value - beam.beta - beam.rho * stretch, c, q * (d * a + c))
}

/// All states with N > -0.98 by a blind fine scan: (contact, u(1)).
fn blind_scan(beam: &Beam, obstacles: &Obstacles, largest: f64) -> Vec<(Contact, f64)> {
    let Obstacles { epsilon, g1, g2 } = *obstacles;
    let laws = [(Contact::Free, None), (Contact::Upper, Some((epsilon, g2))), (Contact::Lower, Some((epsilon, g1)))];
    let mut found = Vec::new();
    for (contact, support) in laws {
        let f = |n| textbook(beam, support, n).0;
        let points = 20_000;
        // Cubic spacing: dense near N = -1, where the poles are.
        let node = |i: i32| -0.98 + (largest + 0.98) * ((f64::from(i) + 0.37) / f64::from(points)).powi(3);
        for i in 0..points {
            let (mut lo, mut hi) = (node(i), node(i + 1));
            if (f(lo) > 0.0) == (f(hi) > 0.0) {
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (lo + hi);
                if (f(middle) > 0.0) == (f(lo) > 0.0) { lo = middle } else { hi = middle }
            }
            let (_, c, tip) = textbook(beam, support, lo);
            let consistent = match contact {
                Contact::Free => (g1..=g2).contains(&tip),
                Contact::Upper => c < 0.0,
                Contact::Lower => c > 0.0,
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
fn a_blind_scan_with_the_textbook_formula_finds_the_same_states() {
    let cases = [
        (driven(-0.95, 1.0, 0.05), Obstacles { epsilon: 1e-3, g1: -0.6, g2: 0.1 }, 2.0),
        (driven(-0.97, 0.5, -0.02), Obstacles { epsilon: 0.1, g1: -2.0, g2: 2.0 }, 2.0),
        (driven(-1.4, 0.7, 0.4), Obstacles { epsilon: 0.05, g1: -0.2, g2: 0.0 }, 3.0),
        (driven(-5.0, 1.0, 0.34), Obstacles { epsilon: 1e-3, g1: -0.01, g2: 0.1 }, 3.0),
    ];
    for (beam, obstacles, largest) in cases {
        let expected = blind_scan(&beam, &obstacles, largest);
        let found: Vec<_> = states(&beam, Some(&obstacles)).into_iter().filter(|state| state.n_value > -0.98).collect();
        assert_eq!(found.len(), expected.len(), "{beam:?}: {found:#?} {expected:?}");
        for (state, (contact, tip)) in found.iter().zip(expected) {
            assert_eq!(state.contact, contact);
            close(state.u_tip, tip, 1e-5);
        }
    }
}

fn any_beam() -> impl Strategy<Value = Beam> {
    (-0.999..3.0_f64, -2.0..4.0_f64, -6.0..1.0_f64, prop::bool::ANY).prop_map(|(beta, rho, drive, up)| {
        driven(beta, 10.0_f64.powf(rho), if up { 1.0 } else { -1.0 } * 10.0_f64.powf(drive))
    })
}

fn any_obstacles() -> impl Strategy<Value = Option<Obstacles>> {
    let gap = || prop_oneof![Just(0.0), 1e-3..0.5_f64];
    prop::option::of((-8.0..1.0_f64, gap(), gap()).prop_map(|(epsilon, below, above)| Obstacles {
        epsilon: 10.0_f64.powf(epsilon),
        g1: -below,
        g2: above,
    }))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    /// The energy grows in all directions, so its gradient has degree 1: a state missed or found twice breaks the sum.
    #[test]
    fn minima_saddles_and_so_on_add_up_to_one(beam in any_beam(), obstacles in any_obstacles()) {
        let found = states(&beam, obstacles.as_ref());
        let parity = |state: &Equilibrium| if state.unstable_directions.unwrap() % 2 == 0 { 1 } else { -1 };
        prop_assert_eq!(found.iter().map(parity).sum::<i32>(), 1, "{:#?}", found);
        prop_assert!(found.iter().any(|state| state.stable));
    }

    /// Upside down, everything is upside down.
    #[test]
    fn the_mirrored_scene_has_the_mirrored_states(beam in any_beam(), obstacles in any_obstacles()) {
        let mirrored_beam = Beam { theta_a: -beam.theta_a, ..beam };
        let mirrored_obstacles = obstacles.map(|o| Obstacles { g1: -o.g2, g2: -o.g1, ..o });
        let (found, mirrored) = (states(&beam, obstacles.as_ref()), states(&mirrored_beam, mirrored_obstacles.as_ref()));
        prop_assert_eq!(found.len(), mirrored.len());
        for (state, image) in found.iter().zip(mirrored.iter().rev()) {
            prop_assert!((state.u_tip + image.u_tip).abs() <= 1e-12 * (1.0 + state.u_tip.abs()));
            prop_assert_eq!(state.stable, image.stable);
        }
    }

    /// Whatever the coefficients, the states are finite, hold N = β + ρ‖u'‖², and one of them is stable.
    #[test]
    fn no_coefficient_is_too_extreme(
        beta in prop_oneof![-1e6..1e6_f64, -5.0..1.0_f64, -1.01..-0.99_f64],
        rho in -6.0..8.0_f64,
        drive in prop_oneof![-1e4..1e4_f64, -1.0..1.0_f64, -1e-9..1e-9_f64],
        epsilon in -10.0..6.0_f64,
        (below, above) in (prop_oneof![Just(0.0), 1e-6..10.0_f64], prop_oneof![Just(0.0), 1e-6..10.0_f64]),
    ) {
        let beam = driven(beta, 10.0_f64.powf(rho), drive);
        let walls = Obstacles { epsilon: 10.0_f64.powf(epsilon), g1: -below, g2: above };
        for obstacles in [None, Some(&walls)] {
            let found = equilibria(&beam, obstacles);
            prop_assert!(found.is_ok(), "{:?}", found);
            let found = found.unwrap();
            prop_assert!(found.iter().any(|state| state.stable));
            for state in &found {
                let stretch = stretch_by_quadrature(state);
                let defect = state.n_value - beta - beam.rho * stretch;
                // Simpson's rule sees no boundary layer thinner than its step.
                let resolved = !(-1.001..=-1.0).contains(&state.n_value);
                prop_assert!(!resolved || defect.abs() <= 1e-6 * (1.0 + beta.abs() + beam.rho * stretch), "{:?}", state);
            }
        }
    }
}
