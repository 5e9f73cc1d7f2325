//! Cases in lanes agree bitwise with single runs, and a failed case does not affect the others.

use thermobeam::energy::Balance;
use thermobeam::ensemble::Ensemble;
use thermobeam::error::{SetupError, StepFailure};
use thermobeam::mesh::Mesh;
use thermobeam::motion::Motion;
use thermobeam::one_step::{InitialValues, OneStep, Problem, Stepping};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{EULER_CRANK_NICOLSON, SCHEMES};
use thermobeam::solve::Settings;

/// Number of elements, not a multiple of four.
const N: usize = 22;

/// The bits of a balance.
fn bits(balance: &Balance) -> [u64; 6] {
    let Balance {
        change,
        viscous,
        thermal,
        inertial,
        contact,
        residual,
        ..
    } = *balance;
    [change, viscous, thermal, inertial, contact, residual].map(f64::to_bits)
}

/// Four different beams: in some steps only some of them need a second pass or the safeguarded
/// iteration.
fn problem(k: usize) -> Problem {
    let grading = 0.1 * k as f64;
    let mesh = Mesh::mapped(N, |s| (1.0 - grading) * s + grading * s * s).unwrap();
    let nodes = mesh.nodes().to_vec();
    let on = |f: &dyn Fn(f64) -> f64| nodes.iter().map(|&x| f(x)).collect::<Vec<_>>();
    let theta_a = [0.0, 20.0, -3.0, 0.0][k];
    let initial = InitialValues {
        u: on(&|x| 0.01 * x * (x - 2.0)),
        u_t: on(&|x| 20.0 * x * (x - 1.0) * (x - 1.0)),
        theta: on(&|x| theta_a * (1.0 - x) + (3.0 * x * (1.0 - x))),
        ..InitialValues::at_rest(&mesh, 0.0)
    };
    let beam = Beam {
        beta: [-0.5, 0.0, 5.0, 1.0][k],
        rho: [1.0, 0.0, 1e4, 10.0][k],
        theta_a,
        ..Beam::default()
    };
    let obstacles = (k != 3).then(Obstacles::default);
    Problem {
        beam,
        obstacles,
        mesh,
        initial,
    }
}

const DT: [f64; 4] = [1e-4, 1e-3, 1e-2, 0.1];

#[test]
fn a_case_in_a_lane_agrees_bitwise_with_a_single_run() {
    for scheme in SCHEMES {
        let settings = Settings::default();
        let mut ensemble =
            Ensemble::new((0..4).map(problem).collect(), &DT, scheme, settings).unwrap();
        let mut alone: Vec<OneStep> = (0..4)
            .map(|k| {
                OneStep::new(
                    problem(k),
                    Stepping {
                        scheme,
                        settings,
                        dt: DT[k],
                        loaded: false,
                    },
                )
                .unwrap()
            })
            .collect();
        let mut balances = vec![];
        ensemble.balances(&mut balances);
        assert_eq!(balances.len(), 4);
        assert!(
            balances.iter().all(|balance| balance.residual.is_nan()),
            "no step has been done"
        );
        for _ in 0..200 {
            ensemble.step_once();
            ensemble.balances(&mut balances);
            for (k, simulation) in alone.iter_mut().enumerate() {
                let old = simulation.level();
                let report = simulation.step_once().unwrap();
                assert_eq!(
                    ensemble.report(k).unwrap(),
                    report,
                    "{}: case {k}",
                    scheme.name
                );
                let level = simulation.level();
                let mut lane = level.clone();
                lane.u[3] = f64::NAN;
                ensemble.observe(k, &mut lane);
                assert_eq!(lane, level, "{}: case {k}", scheme.name);
                assert_eq!(
                    [ensemble.tip(k), ensemble.contact_force(k)],
                    [level.u[N], level.contact_force]
                );
                assert_eq!(
                    bits(&balances[k]),
                    bits(&simulation.balance(&old, &level)),
                    "{}: case {k}",
                    scheme.name
                );
                assert_eq!(
                    ensemble.cases()[k].energy_scale(&level),
                    simulation.energy_scale(&level)
                );
                assert_eq!(
                    ensemble.cases()[k].energy(&level),
                    simulation.energy(&level)
                );
                assert_eq!(
                    ensemble.cases()[k].rounding(&old, &level),
                    simulation.rounding(&old, &level)
                );
                let alone = simulation.work();
                assert_eq!(
                    (
                        ensemble.work_of(k).passes,
                        ensemble.work_of(k).factorizations
                    ),
                    (alone.passes, alone.factorizations)
                );
            }
        }
    }
}

/// The four lanes of a group share a pass; each lane has its own factorisations.
#[test]
fn an_ensemble_counts_a_pass_once_per_group() {
    let dt = [DT, DT].concat();
    let problems = (0..8).map(|k| problem(k % 4)).collect();
    let mut ensemble =
        Ensemble::new(problems, &dt, EULER_CRANK_NICOLSON, Settings::default()).unwrap();
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

#[test]
fn any_number_of_cases_agrees_bitwise_with_single_runs() {
    let settings = Settings::default();
    for count in [1, 3, 5, 8] {
        let dt: Vec<f64> = (0..count).map(|k| DT[k % 4] / (1 + k / 4) as f64).collect();
        let problems = (0..count).map(|k| problem(k % 4)).collect();
        let mut ensemble = Ensemble::new(problems, &dt, EULER_CRANK_NICOLSON, settings).unwrap();
        (0..50).for_each(|_| ensemble.step_once());
        assert_eq!((ensemble.cases().len(), ensemble.steps()), (count, 50));
        for (k, &dt) in dt.iter().enumerate() {
            let stepping = Stepping {
                scheme: EULER_CRANK_NICOLSON,
                settings,
                dt,
                loaded: false,
            };
            let mut alone = OneStep::new(problem(k % 4), stepping).unwrap();
            for _ in 0..50 {
                alone.step_once().unwrap();
            }
            let mut lane = alone.level();
            lane.u.fill(f64::NAN);
            ensemble.observe(k, &mut lane);
            assert_eq!(lane, alone.level(), "case {k} of {count}");
        }
    }
}

#[test]
fn an_unheated_case_beside_a_heated_one_agrees_bitwise_with_a_single_run() {
    let cold = |k: usize| {
        let mut problem = problem(k);
        problem.beam = Beam {
            a: 0.0,
            theta_a: 0.0,
            ..problem.beam
        };
        problem.initial.theta.fill(0.0);
        problem
    };
    let settings = Settings::default();
    for scheme in SCHEMES {
        let mut ensemble =
            Ensemble::new(vec![cold(0), problem(1)], &DT[..2], scheme, settings).unwrap();
        let mut alone = OneStep::new(
            cold(0),
            Stepping {
                scheme,
                settings,
                dt: DT[0],
                loaded: false,
            },
        )
        .unwrap();
        assert_eq!(
            [0, 1].map(|k| ensemble.is_heated(k)),
            [alone.is_heated(), true]
        );
        let mut old = alone.level();
        let mut balances = vec![];
        let mut lane = old.clone();
        for _ in 0..100 {
            ensemble.step_once();
            ensemble.balances(&mut balances);
            alone.step_once().unwrap();
            let level = alone.level();
            ensemble.observe(0, &mut lane);
            assert_eq!(lane, level, "{}", scheme.name);
            assert_eq!(
                bits(&balances[0]),
                bits(&alone.balance(&old, &level)),
                "{}",
                scheme.name
            );
            old = level;
        }
    }
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
    let settings = Settings::default();
    for scheme in SCHEMES {
        for first in 0..UNLIKE {
            let members = [0, 1, 2, 3].map(|place| (first + place) % UNLIKE);
            let problems = members.map(unlike).to_vec();
            let mut ensemble = Ensemble::new(problems, &members.map(dt), scheme, settings).unwrap();
            (0..50).for_each(|_| ensemble.step_once());
            for (lane, &k) in members.iter().enumerate() {
                let stepping = Stepping {
                    scheme,
                    settings,
                    dt: dt(k),
                    loaded: false,
                };
                let mut alone = OneStep::new(unlike(k), stepping).unwrap();
                assert_eq!(alone.is_heated(), matches!(k, 1..=3));
                for _ in 0..50 {
                    alone.step_once().unwrap();
                }
                let mut level = alone.level();
                level.u.fill(f64::NAN);
                ensemble.observe(lane, &mut level);
                assert_eq!(level, alone.level(), "{}: {members:?}: {k}", scheme.name);
            }
        }
    }
}

#[test]
fn an_ensemble_needs_equal_numbers_of_elements_and_one_time_step_per_case() {
    let new = |problems, dt: &[f64]| {
        Ensemble::new(problems, dt, EULER_CRANK_NICOLSON, Settings::default()).err()
    };
    let short = Mesh::uniform(3).unwrap();
    let initial = InitialValues::at_rest(&short, 0.0);
    let other = Problem {
        mesh: short,
        initial,
        beam: Beam::default(),
        obstacles: None,
    };
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
    let settings = Settings::default();
    let mut ensemble = Ensemble::new(
        (0..4).map(buckled).collect(),
        &dt,
        EULER_CRANK_NICOLSON,
        settings,
    )
    .unwrap();
    let before = OneStep::new(
        buckled(2),
        Stepping {
            scheme: EULER_CRANK_NICOLSON,
            settings,
            dt: 10.0,
            loaded: false,
        },
    )
    .unwrap();
    for _ in 0..50 {
        ensemble.step_once();
    }
    let error = ensemble.report(2).unwrap_err();
    assert_eq!((error.step, error.dt), (1, 10.0));
    assert!(
        matches!(error.failure, StepFailure::Indefinite { .. }),
        "{error}"
    );
    let mut lane = before.level();
    ensemble.observe(2, &mut lane);
    assert_eq!(lane, before.level());
    assert_eq!(ensemble.tip(2), lane.u[N]);
    let mut balances = vec![];
    ensemble.balances(&mut balances);
    let open: Vec<bool> = balances
        .iter()
        .map(|balance| balance.residual.is_nan())
        .collect();
    assert_eq!(open, [false, false, true, false]);
    for k in [0, 1, 3] {
        let stepping = Stepping {
            scheme: EULER_CRANK_NICOLSON,
            settings,
            dt: dt[k],
            loaded: false,
        };
        let mut alone = OneStep::new(problem(k), stepping).unwrap();
        for _ in 0..50 {
            alone.step_once().unwrap();
        }
        ensemble.observe(k, &mut lane);
        assert_eq!(lane, alone.level(), "case {k}");
    }
}
