//! A failed step returns an error with step and time and leaves the simulation at its level;
//! invalid input is rejected.

use crate::prelude::*;

fn all_steppings() -> impl Iterator<Item = Stepping> {
    SCHEMES.into_iter().flat_map(|scheme| {
        Solver::ALL.map(|solver| Stepping {
            scheme,
            settings: by(solver),
            loaded: true,
            ..stepping(1e-3)
        })
    })
}

#[test]
fn a_load_that_is_not_finite_is_reported_and_the_step_can_be_done_again() {
    for stepping in all_steppings() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for component in 0..3 {
                for node in [1, 5, 10] {
                    // The temperature is prescribed at the tip: no equation there contains the
                    // load.
                    if (component, node) == (2, 10) {
                        continue;
                    }
                    let [mut simulation, mut undisturbed] =
                        [(); 2].map(|()| simulate(&paper(uniform(10), (-0.5, 20.0)), stepping));
                    let step = |simulation: &mut OneStep| {
                        simulation.load_mut().unwrap().fill([0.1; 3]);
                        simulation.step_once().unwrap();
                    };
                    (0..3).for_each(|_| step(&mut simulation));
                    (0..4).for_each(|_| step(&mut undisturbed));
                    let before = simulation.level();
                    simulation.load_mut().unwrap()[node][component] = bad;
                    for _ in 0..2 {
                        let StepError {
                            step,
                            t,
                            dt,
                            failure,
                            ..
                        } = simulation.step_once().unwrap_err();
                        assert_eq!((step, t, dt), (4, 3.0 * stepping.dt, stepping.dt));
                        assert!(
                            matches!(failure, StepFailure::NonFinite { .. }),
                            "{stepping:?} {bad}: {failure:?}"
                        );
                        assert_eq!((simulation.steps(), simulation.t()), (3, 3.0 * stepping.dt));
                        assert_eq!(
                            simulation.level(),
                            before,
                            "{stepping:?} {bad} {component} {node}"
                        );
                    }
                    step(&mut simulation);
                    let difference = relative_difference(&simulation.level(), &undisturbed.level());
                    assert!(difference <= 1e-9, "{stepping:?}: {difference:e}");
                }
            }
        }
    }
}

#[test]
fn the_initial_contact_force_is_that_of_the_initial_tip() {
    for stepping in all_steppings() {
        let mut problem = paper(uniform(10), (0.0, 0.0));
        problem.initial.u = problem.mesh.nodes().iter().map(|x| 0.12 * x).collect();
        let expected = problem.obstacles.unwrap().force(problem.initial.u[10]);
        assert!(expected > 19.0);
        assert_eq!(
            simulate(&problem, stepping).level().contact_force,
            expected,
            "{stepping:?}"
        );
    }
}

#[test]
fn too_few_iterations_are_reported_with_the_contraction_of_the_last_two() {
    for stepping in all_steppings() {
        let mut problem = paper(uniform(10), (0.0, 0.0));
        problem.beam.rho = 1e4;
        let failed_at = |max_iterations: usize| {
            let settings = Settings {
                stopping: Stopping::Converged {
                    tolerance: 1e-300,
                    max_iterations,
                },
                ..stepping.settings
            };
            let error = simulate(
                &problem,
                Stepping {
                    settings,
                    dt: 0.1,
                    ..stepping
                },
            )
            .step_once()
            .unwrap_err();
            let (StepFailure::IterationLimit {
                iterations,
                increment,
                contraction,
            }
            | StepFailure::Diverged {
                iterations,
                increment,
                contraction,
                ..
            }) = error.failure
            else {
                panic!("{stepping:?}: {error}")
            };
            assert_eq!(iterations, max_iterations, "{stepping:?}");
            assert!(increment > 0.0, "{error}");
            (increment, contraction)
        };
        let mut compared = 0;
        let mut previous = f64::NAN;
        for max_iterations in 1..=4 {
            let (increment, contraction) = failed_at(max_iterations);
            // Newton's method has a contraction factor only in the safeguarded iteration.
            if !contraction.is_nan() {
                assert_eq!(
                    contraction,
                    increment / previous,
                    "{stepping:?} {max_iterations}"
                );
                compared += 1;
            }
            previous = increment;
        }
        assert!(compared > 1, "{stepping:?}");
    }
}

#[test]
fn a_lost_pivot_is_reported_by_both_solvers() {
    for stepping in all_steppings() {
        let stepping = Stepping {
            dt: 1.0,
            ..stepping
        };
        let mut simulation = simulate(&paper(uniform(10), (-3.0, 0.0)), stepping);
        let error = simulation.step_once().unwrap_err();
        let StepFailure::Indefinite {
            node,
            pivot,
            n_value,
            of,
        } = error.failure
        else {
            panic!("{error}")
        };
        assert!(
            (1..=10).contains(&node) && pivot <= 0.0 && n_value < -2.9,
            "{error}"
        );
        let is_of_fixed_point = stepping.settings.solver == Solver::FixedPoint;
        assert_eq!(of == StepMatrix::OneField, is_of_fixed_point, "{error}");
        assert_eq!(
            simulation.step_once().unwrap_err(),
            error,
            "the same failure again"
        );
    }
}

#[track_caller]
fn rejection(change: impl FnOnce(&mut Problem, &mut Stepping)) -> SetupError {
    let (mut problem, mut stepping) = (paper(uniform(4), (0.0, 20.0)), stepping(1e-3));
    change(&mut problem, &mut stepping);
    match OneStep::new(problem, stepping) {
        Ok(_) => panic!("accepted"),
        Err(error) => error,
    }
}

#[test]
fn initial_data_that_violate_a_boundary_condition_are_rejected() {
    type Field = fn(&mut InitialValues) -> &mut Vec<f64>;
    let fields: [(&str, Field, usize, f64); 6] = [
        ("u", |i| &mut i.u, 0, 0.0),
        ("u_t", |i| &mut i.u_t, 0, 0.0),
        ("phi", |i| &mut i.phi, 0, 0.0),
        ("phi_t", |i| &mut i.phi_t, 0, 0.0),
        ("theta", |i| &mut i.theta, 0, 20.0),
        ("theta", |i| &mut i.theta, 4, 0.0),
    ];
    for (field, of, node, boundary) in fields {
        let with = |value: f64| rejection(|problem, _| of(&mut problem.initial)[node] = value);
        assert_eq!(
            [
                with(boundary + 1e-9),
                with(f64::INFINITY),
                rejection(|problem, _| of(&mut problem.initial).push(0.0)),
            ],
            [
                SetupError::Boundary {
                    field,
                    x: node as f64 / 4.0,
                    found: boundary + 1e-9,
                    allowed: boundary,
                },
                SetupError::NotFinite {
                    field,
                    node,
                    found: f64::INFINITY,
                },
                SetupError::Length {
                    field,
                    found: 6,
                    expected: 5,
                },
            ]
        );
    }
    let error = rejection(|problem, _| problem.initial.phi[2] = f64::NAN);
    assert!(
        matches!(error, SetupError::NotFinite { field: "phi", node: 2, found } if found.is_nan())
    );
}

/// The name of the parameter that is rejected.
#[track_caller]
fn rejected(change: impl FnOnce(&mut Problem, &mut Stepping)) -> &'static str {
    match rejection(change) {
        SetupError::Parameter(parameter) => parameter.name,
        other => panic!("{other}"),
    }
}

#[test]
fn invalid_settings_are_rejected_by_name() {
    for dt in [0.0, -1.0, f64::INFINITY] {
        let expected = ParameterError {
            name: "dt",
            found: dt,
            allowed: "a finite number > 0".into(),
        };
        assert_eq!(
            rejection(|_, stepping| stepping.dt = dt),
            SetupError::Parameter(expected)
        );
    }
    assert_eq!(rejected(|_, stepping| stepping.dt = f64::NAN), "dt");
    // Newton's method cannot stop without a test, and the fixed point needs one iteration.
    for (solver, stopping, name) in [
        (Solver::Newton, Stopping::below(0.0), "tolerance"),
        (Solver::Newton, Stopping::below(-1e-10), "tolerance"),
        (Solver::Newton, Stopping::below(f64::NAN), "tolerance"),
        (Solver::Newton, Stopping::below(f64::INFINITY), "tolerance"),
        (
            Solver::Newton,
            Stopping::default().with_limit(0),
            "max_iterations",
        ),
        (Solver::Newton, Stopping::Iterations(2), "iterations"),
        (Solver::FixedPoint, Stopping::Iterations(0), "iterations"),
    ] {
        let settings = Settings {
            stopping,
            ..by(solver)
        };
        assert_eq!(rejected(|_, stepping| stepping.settings = settings), name);
    }
}

#[test]
fn coefficients_out_of_range_are_rejected_by_name() {
    type Change = fn(&mut Beam, &mut Obstacles);
    let changes: [(&str, Change); 9] = [
        ("zeta", |beam, _| beam.zeta = -1.0),
        ("a", |beam, _| beam.a = f64::NAN),
        ("rho", |beam, _| beam.rho = -1e-9),
        ("beta", |beam, _| beam.beta = f64::INFINITY),
        ("theta_a", |beam, _| beam.theta_a = f64::NAN),
        ("epsilon", |_, obstacles| obstacles.epsilon = 0.0),
        ("epsilon", |_, obstacles| obstacles.epsilon = f64::NAN),
        ("g1", |_, obstacles| obstacles.g1 = 1e-9),
        ("g2", |_, obstacles| obstacles.g2 = -1e-9),
    ];
    for (name, change) in changes {
        let changed = |problem: &mut Problem, _: &mut Stepping| {
            change(&mut problem.beam, problem.obstacles.as_mut().unwrap());
        };
        assert_eq!(rejected(changed), name);
    }
}

#[test]
fn invalid_nodes_are_rejected() {
    for nodes in [
        vec![0.0],
        vec![0.0, 0.5],
        vec![0.0, 0.6, 0.6, 1.0],
        vec![0.0, f64::NAN, 1.0],
    ] {
        assert!(matches!(
            Mesh::from_nodes(nodes).map_err(SetupError::from),
            Err(SetupError::Mesh(_))
        ));
    }
}
