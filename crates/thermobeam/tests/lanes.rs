//! Cases in lanes agree bitwise with single runs, and a failed case does not affect the others.

use crate::prelude::*;

/// Number of elements, not a multiple of four.
const N: usize = 22;

/// Four different beams: in some steps only some of them need a second pass or the safeguarded
/// iteration.
fn problem(k: usize) -> Problem {
    let grading = 0.1 * k as f64;
    let mesh = Mesh::mapped(N, |s| (1.0 - grading) * s + grading * s * s).unwrap();
    let theta_a = [0.0, 20.0, -3.0, 0.0][k];
    let theta = on_nodes(&mesh, &|x| theta_a * (1.0 - x) + (3.0 * x * (1.0 - x)));
    let beam = Beam {
        beta: [-0.5, 0.0, 5.0, 1.0][k],
        rho: [1.0, 0.0, 1e4, 10.0][k],
        theta_a,
        ..Beam::default()
    };
    let obstacles = (k != 3).then(Obstacles::default);
    let start: [&dyn Fn(f64) -> f64; 2] = [&|x| 0.01 * x * (x - 2.0), &|x| {
        20.0 * x * (x - 1.0) * (x - 1.0)
    }];
    let mut problem = launched(mesh, beam, obstacles, start);
    problem.initial.theta = theta;
    problem
}

fn in_lanes(problems: Vec<Problem>, dt: &[f64], scheme: Scheme) -> Ensemble {
    Ensemble::new(problems, dt, scheme, Settings::default()).unwrap()
}

fn alone(problem: &Problem, dt: f64, scheme: Scheme) -> OneStep {
    simulate(problem, with(scheme, Settings::default(), dt))
}

/// The level of a lane, every value of which is written.
fn lane(ensemble: &Ensemble, k: usize) -> TimeLevel {
    let unwritten = || vec![f64::NAN; N + 1];
    let mut level = TimeLevel {
        u: unwritten(),
        v: unwritten(),
        phi: unwritten(),
        w: unwritten(),
        theta: unwritten(),
        contact_force: 0.0,
    };
    ensemble.observe(k, &mut level);
    level
}

const DT: [f64; 4] = [1e-4, 1e-3, 1e-2, 0.1];

/// Each case agrees bitwise with a single run in each of so many steps.
fn agreeing(problems: &[Problem], dt: &[f64], scheme: Scheme, steps: usize) -> Ensemble {
    let mut ensemble = in_lanes(problems.to_vec(), dt, scheme);
    let pairs = problems.iter().zip(dt);
    let mut alone: Vec<OneStep> = pairs.map(|(one, dt)| alone(one, *dt, scheme)).collect();
    let mut balances = vec![];
    ensemble.balances(&mut balances);
    let counts = [balances.len(), ensemble.cases().len()];
    assert_eq!(counts, [problems.len(); 2]);
    assert!(
        balances.iter().all(|balance| balance.residual.is_nan()),
        "no step has been done"
    );
    for _ in 0..steps {
        ensemble.step_once();
        ensemble.balances(&mut balances);
        for (k, simulation) in alone.iter_mut().enumerate() {
            let old = simulation.level();
            let report = simulation.step_once().unwrap();
            let level = simulation.level();
            let case = format!("{}: {problems:?}: case {k}", scheme.name);
            assert_eq!(ensemble.report(k).unwrap(), report, "{case}");
            assert_eq!(lane(&ensemble, k), level, "{case}");
            assert_eq!(
                [ensemble.tip(k), ensemble.contact_force(k)],
                [level.u[N], level.contact_force]
            );
            // The shortest decimals that give the bits.
            let [own, expected] = [&balances[k], &simulation.balance(&old, &level)]
                .map(|balance| format!("{balance:?}"));
            assert_eq!(own, expected, "{case}");
            let own = &ensemble.cases()[k];
            assert_eq!(own.energy_scale(&level), simulation.energy_scale(&level));
            assert_eq!(own.energy(&level), simulation.energy(&level));
            assert_eq!(
                own.rounding(&old, &level),
                simulation.rounding(&old, &level)
            );
            assert_eq!(ensemble.is_heated(k), simulation.is_heated(), "{case}");
            let (work, alone) = (ensemble.work_of(k), simulation.work());
            assert_eq!(
                (work.passes, work.factorizations),
                (alone.passes, alone.factorizations)
            );
        }
    }
    ensemble
}

#[test]
fn a_case_in_a_lane_agrees_bitwise_with_a_single_run() {
    for scheme in SCHEMES {
        for count in [1, 3, 5, 8] {
            let dt: Vec<f64> = (0..count).map(|k| DT[k % 4] / (1 + k / 4) as f64).collect();
            let problems: Vec<Problem> = (0..count).map(|k| problem(k % 4)).collect();
            agreeing(&problems, &dt, scheme, 200);
        }
    }
}

/// The four lanes of a group share a pass; each lane has its own factorisations.
#[test]
fn an_ensemble_counts_a_pass_once_per_group() {
    let dt = [DT, DT].concat();
    let problems = (0..8).map(|k| problem(k % 4)).collect();
    let mut ensemble = in_lanes(problems, &dt, EULER_CRANK_NICOLSON);
    (0..20).for_each(|_| ensemble.step_once());
    let of = |k: usize| ensemble.work_of(k);
    assert_eq!(
        ensemble.work().factorizations,
        (0..8).map(|k| of(k).factorizations).sum()
    );
    let longest = (0..4).map(|k| of(k).passes).max().unwrap();
    let all: usize = (0..8).map(|k| of(k).passes).sum();
    let passes = ensemble.work().passes;
    assert!(
        (2 * longest..all).contains(&passes),
        "{passes} passes, {longest} of one case, {all} of all"
    );
}

/// Number of unlike cases.
const UNLIKE: usize = 5;

/// A case that differs from the others in more than numbers: no heat in contact, heat and coupling,
/// heat without coupling, no obstacles, no heat and no initial data.
fn unlike(k: usize) -> Problem {
    let mut problem = problem([0, 1, 2, 3, 0][k]);
    if matches!(k, 0 | 2 | 4) {
        problem.beam.a = 0.0;
    }
    if matches!(k, 0 | 4) {
        problem.beam.theta_a = 0.0;
        problem.initial.theta.fill(0.0);
    }
    if k == 4 {
        problem.initial = InitialValues::at_rest(&problem.mesh, 0.0);
    }
    problem
}

/// Each case is once the first of its group, since a group must not take a property from one case.
#[test]
fn unlike_cases_of_one_group_agree_bitwise_with_single_runs() {
    let dt = |k: usize| [1e-3, 1e-4, 1e-2, 1e-3, 0.1][k];
    for scheme in SCHEMES {
        for first in 0..UNLIKE {
            let members = [0, 1, 2, 3].map(|place| (first + place) % UNLIKE);
            let ensemble = agreeing(&members.map(unlike), &members.map(dt), scheme, 50);
            for (place, k) in members.into_iter().enumerate() {
                assert_eq!(ensemble.is_heated(place), matches!(k, 1..=3), "{k}");
            }
        }
    }
}

#[test]
fn an_ensemble_needs_equal_numbers_of_elements_and_one_time_step_per_case() {
    let new = |problems, dt: &[f64]| {
        Ensemble::new(problems, dt, EULER_CRANK_NICOLSON, Settings::default()).err()
    };
    let other = launched(uniform(3), Beam::default(), None, [&|_| 0.0, &|_| 0.0]);
    let found = |field, found, expected| {
        Some(SetupError::Length {
            field,
            found,
            expected,
        })
    };
    assert_eq!(new(vec![], &[]), found("problems", 0, 1));
    assert_eq!(new(vec![problem(0)], &DT), found("dt", 4, 1));
    assert_eq!(
        new(vec![problem(0), other], &[0.1, 0.1]),
        found("nodes", 4, N + 1)
    );
    let refused = new(vec![problem(0)], &[f64::NAN]);
    assert!(matches!(refused, Some(SetupError::Parameter(parameter)) if parameter.name == "dt"));
}

#[test]
fn a_case_that_fails_keeps_its_last_level_and_leaves_the_others_alone() {
    // At dt = 10 the matrix of a beam loaded beyond buckling is not positive definite.
    let buckled = |k: usize| {
        let mut problem = problem(k);
        if k == 2 {
            problem.beam = Beam {
                beta: -0.8,
                theta_a: problem.beam.theta_a,
                ..Beam::default()
            };
        }
        problem
    };
    let dt = [1e-4, 1e-3, 10.0, 0.1];
    let mut ensemble = in_lanes((0..4).map(buckled).collect(), &dt, EULER_CRANK_NICOLSON);
    (0..50).for_each(|_| ensemble.step_once());
    let error = ensemble.report(2).unwrap_err();
    assert_eq!((error.step, error.dt), (1, 10.0));
    assert!(
        matches!(error.failure, StepFailure::Indefinite { .. }),
        "{error}"
    );
    assert_eq!(ensemble.tip(2), lane(&ensemble, 2).u[N]);
    let mut balances = vec![];
    ensemble.balances(&mut balances);
    for (k, balance) in balances.iter().enumerate() {
        assert_eq!(balance.residual.is_nan(), k == 2);
        let stepping = with(EULER_CRANK_NICOLSON, Settings::default(), dt[k]);
        let steps = if k == 2 { 0 } else { 50 };
        let expected = after(&buckled(k), stepping, steps);
        assert_eq!(lane(&ensemble, k), expected, "case {k}");
    }
}
