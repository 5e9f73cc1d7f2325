use super::*;
use crate::equilibrium::equilibria;
use crate::interval::{planted, tests};

/// `1 + N` and N to 60 digits by mpmath 1.3 (`mp.dps = 60`): the 2 x 2 system for (α, c) solved at
/// each N with cosines of complex arguments, ‖u'‖² by quadrature of φ + c, N by a secant method.
/// The coefficients are the doubles of the scenes, exactly.
const BUCKLING: &str = include_str!("buckling.txt");
const LIFT_OFF: &str = "0.0832592035009391630298775988684572147574490096860046020630479";
const FOLD: &str = "-1.0216245463878471344530068081404853071567334001849";

fn encloses(interval: Enclosure, decimals: &str) -> bool {
    tests::encloses(interval, &tests::decimal(decimals))
}

fn beam(beta: f64, theta_a: f64) -> Beam {
    Beam {
        beta,
        theta_a,
        ..Beam::default()
    }
}

fn loaded(beta: f64, rho: f64, moment: f64) -> Beam {
    Beam {
        zeta: 0.1,
        beta,
        rho,
        a: 1.0,
        theta_a: moment,
    }
}

fn paper() -> Option<Obstacles> {
    Some(Obstacles::default())
}

/// What is undecided about a beam without obstacles.
fn reasons(beam: &Beam) -> Vec<UndecidedReason> {
    let undecided = prove(beam, None).unwrap().undecided;
    undecided.iter().map(|undecided| undecided.reason).collect()
}

/// N and u(1) of states of the paper's scenes.
const STATES: [(f64, f64, Phase, &str, &str); 5] = [
    (
        -0.5,
        20.0,
        Phase::Upper,
        "-0.479586346429628161731835041298590312136832302203767008902596",
        "0.100063408762910046254839129489302730628582647937639437039284",
    ),
    (
        0.0,
        20.0,
        Phase::Upper,
        "0.0123585837961039648245750903765621285602016259087289775591427",
        "0.100008690436975988382620312840082066184804546665743166447649",
    ),
    (
        5.0,
        20.0,
        Phase::Free,
        "5.00023946069405200459465957995992784124566036689864198547077",
        "0.0141796393563597054419263780874747530007813701402394546520191",
    ),
    (
        -0.8,
        0.0,
        Phase::Upper,
        "-0.784571845600001964679386973785769099282085688785953164600235",
        "0.100009895393763672498869952322880195310010644868098549033916",
    ),
    (
        -0.8,
        0.0,
        Phase::Lower,
        "-0.799831467970994401145693437669140848168739781489815926906197",
        "-0.0100012352033069279015659241213923111125746452571839092047145",
    ),
];

#[test]
fn states_of_the_paper_are_proved_and_enclose_60_digits() {
    for (beta, theta_a, contact, n_value, u_tip) in STATES {
        let proof = prove(&beam(beta, theta_a), paper().as_ref()).unwrap();
        assert_eq!(
            proof.count(),
            Some(if theta_a == 0.0 { 3 } else { 1 }),
            "{proof:?}"
        );
        let state = proof
            .states
            .iter()
            .find(|state| state.contact == contact)
            .unwrap();
        assert!(encloses(state.n_value, n_value), "{state:?}");
        assert!(encloses(state.u_tip, u_tip), "{state:?}");
        for enclosure in [state.n_value, state.u_tip] {
            let relative = enclosure.width() / enclosure.midpoint().abs();
            assert!(relative < 1e-12, "{relative:e} of {state:?}");
        }
    }
}

#[test]
fn bounds_rounded_inward_prove_nothing_or_miss() {
    for (beta, theta_a, contact, n_value, _) in STATES {
        let proof = planted::inward(|| prove(&beam(beta, theta_a), paper().as_ref()).unwrap());
        let is_enclosed = proof
            .states
            .iter()
            .any(|state| state.contact == contact && encloses(state.n_value, n_value));
        assert!(!is_enclosed, "{proof:?}");
    }
}

/// Buckling, lift-off and a fold: the numbers change where 60 digits say.
#[test]
fn the_changes_of_the_number_of_states_are_enclosed() {
    let several = |proof: &Proof| proof.count().map(|count| count > 1);
    let cold = enclose_change(&beam(0.0, 0.0), paper().as_ref(), [-0.9, -0.5], several)
        .unwrap()
        .unwrap();
    assert!(encloses(cold, BUCKLING) && cold.width() < 1e-14, "{cold:?}");

    let presses = |proof: &Proof| {
        proof.count()?;
        Some(
            proof
                .states
                .iter()
                .any(|state| state.contact == Phase::Upper),
        )
    };
    let hot = enclose_change(&beam(0.0, 20.0), paper().as_ref(), [-0.5, 1.0], presses)
        .unwrap()
        .unwrap();
    assert!(encloses(hot, LIFT_OFF) && hot.width() < 1e-13, "{hot:?}");

    let gained = |proof: &Proof| {
        let between = |state: &&ProvedState| (-0.92..-0.9).contains(&state.n_value.midpoint());
        proof.count()?;
        Some(proof.states.iter().filter(between).count() > 0)
    };
    let fold = enclose_change(&loaded(0.0, 1.0, 0.25), None, [-1.0217, -1.0216], gained)
        .unwrap()
        .unwrap();
    assert!(encloses(fold, FOLD) && fold.width() < 1e-13, "{fold:?}");
}

/// At a fold, at a buckling value and at a touch the answer is that nothing is decided, and why.
#[test]
fn what_no_enclosure_decides_is_named() {
    let fold: f64 = FOLD.parse().unwrap();
    let proof = prove(&loaded(fold, 1.0, 0.25), None).unwrap();
    let [undecided] = proof.undecided[..] else {
        panic!("{proof:?}")
    };
    assert_eq!(undecided.reason, UndecidedReason::Fold);
    assert!(
        undecided.width > 0.0 && undecided.width < 1e-12,
        "{undecided:?}"
    );
    assert_eq!(proof.count(), None);

    let lift_off: f64 = LIFT_OFF.parse().unwrap();
    let touch = prove(&beam(lift_off, 20.0), paper().as_ref()).unwrap();
    assert!(
        touch
            .undecided
            .iter()
            .any(|u| u.reason == UndecidedReason::Touch),
        "{touch:?}"
    );

    let buckling: f64 = BUCKLING.trim_end().parse().unwrap();
    assert_eq!(
        reasons(&beam(buckling, 0.0)),
        [UndecidedReason::Bifurcation]
    );

    // ρ(aθ_A)² = -1 - β: the free state at N = -1.
    assert_eq!(
        reasons(&loaded(-2.0, 1.0, 1.0)),
        [UndecidedReason::MinusOne]
    );
}

#[test]
fn a_pole_left_out_proves_nothing() {
    let beam = loaded(-0.97, 1.0, 0.1);
    let force = laws(&beam, None)[0].1;
    let law = IntervalLaw::new(Phase::Free, force, Enclosure::from(beam.theta_a));
    let poles = law.poles_above(BUCKLING_VALUES + 1).unwrap();
    assert!(poles.len() > 2);
    for missing in 0..poles.len() {
        let mut proof = Proof {
            states: Vec::new(),
            undecided: Vec::new(),
            completeness: Completeness::Complete,
        };
        let mut branch = ProvedBranch {
            law,
            obstacles: None,
            proof: &mut proof,
        };
        let mut left = poles.clone();
        if missing > 0 {
            left.remove(missing - 1);
        }
        let is_proved = branch.bent_above(&left).is_ok() && proof.count().is_some();
        assert_eq!(is_proved, missing == 0, "pole {missing}");
    }
}

/// The interval formulas are another form of those of `Law`: one transcendental function.
#[test]
fn the_interval_law_encloses_the_law() {
    let support = Some(super::super::law::Support {
        epsilon: 0.5,
        position: 0.125,
    });
    for support in [None, support] {
        let law = ForceLaw {
            moment: 0.5,
            beta: -0.25,
            rho: 2.0,
            support,
        };
        let moment = Enclosure::from(law.moment);
        let intervals = IntervalLaw::new(Phase::Upper, law, moment);
        for s in [-40.0, -0.9, -0.02, 0.011, 0.15, 0.45, 0.8, 1.0, 1.7, 30.0] {
            let shape = law.solve(s);
            let expected = s - (1.0 + law.beta) - law.rho * shape.slope_squared();
            let solution = intervals.at(Enclosure::from(s));
            let gap = |interval: Enclosure, value: f64| {
                (interval.midpoint() - value).abs() / (1.0 + value.abs())
            };
            assert!(
                gap(solution.f, expected) < 1e-10,
                "{s}: {solution:?} {expected}"
            );
            assert!(gap(solution.u_tip, shape.u(1.0)) < 1e-10, "{s}");
            let h = 1e-6 * s.abs();
            let f = |s: f64| intervals.at(Enclosure::from(s)).f.midpoint();
            let quotient = (f(s + h) - f(s - h)) / (2.0 * h);
            assert!(gap(solution.slope, quotient) < 1e-4, "{s}: {quotient}");
        }
    }
}

/// Over scenes of all kinds the proof finds the states that the list has, or says why not.
#[test]
fn the_proof_agrees_with_the_list() {
    let mut proved = 0;
    for beta in [-3.0, -1.2, -0.98, -0.8, -0.3, 0.0, 4.0] {
        for rho in [0.0, 0.3, 20.0] {
            for moment in [-1.5, 0.0, 0.2] {
                for obstacles in [
                    None,
                    paper(),
                    Some(Obstacles {
                        epsilon: 1.0,
                        g1: -0.3,
                        g2: 0.2,
                    }),
                    Some(Obstacles {
                        epsilon: 0.01,
                        g1: 0.0,
                        g2: 0.0,
                    }),
                ] {
                    let beam = loaded(beta, rho, moment);
                    let proof = prove(&beam, obstacles.as_ref()).unwrap();
                    let Ok(list) = equilibria(&beam, obstacles.as_ref()) else {
                        continue;
                    };
                    let matched = list.iter().filter(|state| proof.of(state).is_some());
                    let matched = matched.count();
                    assert_eq!(
                        matched,
                        proof.states.len(),
                        "{beam:?} {obstacles:?} {proof:?}"
                    );
                    if proof.undecided.is_empty() {
                        assert_eq!(matched, list.len(), "{beam:?} {obstacles:?} {proof:?}");
                        proved += 1;
                    }
                }
            }
        }
    }
    assert!(proved > 240, "{proved} of 252");
}
