//! Bad input and failed steps give errors with names and numbers.

use crate::prelude::*;

#[track_caller]
fn refused(problem: DgProblem, stepping: DgStepping) -> String {
    match Dg::new(problem, stepping) {
        Ok(_) => panic!("it was taken"),
        Err(error) => error.to_string(),
    }
}

fn good() -> DgStepping {
    DgStepping::default()
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    for degree in [0, 41, 100] {
        let message = refused(experiment((0.0, 0.0), degree), good());
        assert_eq!(
            message,
            format!("degree of the elements: expected an integer from 1 to 40, found {degree}")
        );
    }
    type Change = fn(&mut DgStepping);
    let cases: [(Change, &str); 11] = [
        (
            |by| by.degree = 6,
            "degree in time: expected an integer from 0 to 5, found 6",
        ),
        (
            |by| by.dt = 0.0,
            "dt: expected a finite number > 0, found 0",
        ),
        (
            |by| by.dt = f64::NAN,
            "dt: expected a finite number > 0, found NaN",
        ),
        (
            |by| by.dt = f64::INFINITY,
            "dt: expected a finite number > 0, found inf",
        ),
        (
            |by| by.restart_dt = 0.03,
            "restart_dt: expected a number > 0 and at most dt = 0.02, found 0.03",
        ),
        (
            |by| by.restart_dt = -1.0,
            "restart_dt: expected a number > 0 and at most dt = 0.02, found -1",
        ),
        (
            |by| by.growth = 0.9,
            "growth: expected a finite number >= 1, found 0.9",
        ),
        (
            |by| by.growth = f64::NAN,
            "growth: expected a finite number >= 1, found NaN",
        ),
        (
            |by| by.growth = 1.0001,
            "growth: expected a ratio that leads from restart_dt to dt in 1000 steps, found 1.0001",
        ),
        (
            |by| by.tolerance = 0.0,
            "tolerance: expected a finite number > 0, found 0",
        ),
        (
            |by| by.max_iterations = 0,
            "max_iterations: expected an integer >= 1, found 0",
        ),
    ];
    for (change, message) in cases {
        let mut stepping = good();
        change(&mut stepping);
        assert_eq!(refused(experiment((0.0, 0.0), 4), stepping), message);
    }
    for (degree, q) in [(1, 0), (1, 5), (40, 0), (40, 5)] {
        assert!(Dg::new(experiment((0.0, 0.0), degree), of_degree(q)).is_ok());
    }
}

#[test]
fn coefficients_and_initial_data_are_checked() {
    let base = || experiment((0.0, 0.0), 4);
    let with = |initial: InitialFunctions| DgProblem { initial, ..base() };
    let at_rest = || InitialFunctions::at_rest(0.0);
    for (problem, message) in [
        (
            DgProblem {
                beam: Beam {
                    rho: -1.0,
                    ..Beam::default()
                },
                ..base()
            },
            "rho: expected a finite number >= 0, found -1",
        ),
        (
            DgProblem {
                obstacles: Some(soft(0.0)),
                ..base()
            },
            "epsilon: expected a finite number > 0, found 0",
        ),
        (
            with(InitialFunctions {
                u: Box::new(|x| 0.5 + x),
                ..at_rest()
            }),
            "initial u at x = 0: expected 0 from the boundary condition, found 0.5",
        ),
        (
            with(InitialFunctions {
                theta: Box::new(|x| 2.0 * (1.0 - x)),
                ..at_rest()
            }),
            "initial theta at x = 0: expected 0 from the boundary condition, found 2",
        ),
    ] {
        assert_eq!(refused(problem, good()), message);
    }
    let wild = InitialFunctions {
        phi_t: Box::new(|x| 1.0 / (x - x)),
        ..at_rest()
    };
    let found = Dg::new(with(wild), good()).err();
    assert!(
        matches!(
            found,
            Some(SetupError::NotFiniteBetween { field: "phi_t", .. })
        ),
        "{found:?}"
    );
}

/// The error of a step that must fail, after which the simulation stays at its level.
#[track_caller]
fn failed(mut simulation: Dg) -> StepError {
    let (level, events) = (simulation.level().clone(), simulation.events().to_vec());
    let error = simulation
        .step(1e6)
        .expect_err("a step that cannot be done");
    assert_eq!(
        (simulation.level(), simulation.events()),
        (&level, &events[..])
    );
    assert_eq!((error.step, error.t), (1, 0.0));
    error
}

/// The linear beam, pushed.
fn pushed(beta: f64) -> DgProblem {
    DgProblem {
        beam: Beam {
            beta,
            rho: 0.0,
            ..Beam::default()
        },
        ..experiment((0.0, 0.0), 6)
    }
}

#[test]
fn beyond_its_buckling_force_a_beam_needs_steps_that_are_short_enough() {
    let long = DgStepping {
        dt: 50.0,
        restart_dt: 50.0,
        ..good()
    };
    let mut simulation = of_any_order(pushed(-3.0), long);
    let report = simulation.step(50.0).unwrap().expect("a step");
    assert!(
        report.dt < 1.0 && simulation.shortened() > 5,
        "{report:?} {}",
        simulation.shortened()
    );
    let error = failed(of_any_order(pushed(-1e6), long));
    let StepFailure::Indefinite { pivot, n_value, .. } = error.failure else {
        panic!("{error}")
    };
    assert!(
        pivot < 0.0 && n_value == -1e6 && error.dt == 50.0,
        "{error}"
    );
    assert!(error.to_string().ends_with("its buckling force"), "{error}");
}

#[test]
fn iterations_that_are_not_enough_are_an_error() {
    let error = failed(of_any_order(
        experiment((0.0, 0.0), 6),
        DgStepping {
            max_iterations: 1,
            ..good()
        },
    ));
    assert!(
        matches!(
            error.failure,
            StepFailure::IterationLimit { iterations: 1, .. }
        ),
        "{error}"
    );
    assert!(
        error
            .to_string()
            .starts_with("step 1 (from t = 0, length 1e-3): the iteration is too slow"),
        "{error}"
    );
}

#[test]
fn numbers_beyond_all_bounds_are_an_error() {
    let initial = InitialFunctions {
        u_t: Box::new(|x| 1e200 * x),
        ..InitialFunctions::at_rest(0.0)
    };
    let error = failed(of_any_order(
        DgProblem {
            initial,
            ..experiment((0.0, 0.0), 6)
        },
        good(),
    ));
    assert!(
        matches!(error.failure, StepFailure::NonFinite { .. }),
        "{error}"
    );
}

/// If ε is below some 1e-15, rounding errors of u(1) exceed any contact force. Such a run once kept
/// its free end on the obstacle forever, and passed; later it failed once the obstacle pulled by
/// 1e-2, after the true end of contact.
///
/// The answers are those of a free end that the obstacle holds without any compliance: 12
/// polynomials on one element, a Radau method of tolerance 1e-11, the momentum of the impact
/// projected, and contact until the force changes sign.
#[test]
fn contact_that_the_position_cannot_tell_ends_where_its_force_changes_sign() {
    for epsilon in [1e-18, 1e-20, 1e-100] {
        let initial = InitialFunctions {
            theta: Box::new(|_| 0.0),
            ..experiment((0.0, 0.0), 12).initial
        };
        let problem = DgProblem {
            obstacles: Some(soft(epsilon)),
            initial,
            ..experiment((0.0, 0.0), 12)
        };
        let mut simulation = of_any_order(problem, of_degree(3));
        simulation.advance(0.65).unwrap();
        let [touch, leave] = simulation.events() else {
            panic!("{epsilon}: {:?}", simulation.events())
        };
        near(epsilon, touch.t, 0.203_455_295_9, 1e-8);
        near(epsilon, leave.t, 0.647_054_347_5, 1e-6);
        near(epsilon, tip(&simulation, Field::U), 0.099_995_486_56, 1e-8);
        simulation.advance(0.7).unwrap();
        near(epsilon, tip(&simulation, Field::U), 0.094_578_238_75, 1e-8);
    }
}
