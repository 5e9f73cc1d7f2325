//! The paper's fixed point contracts with the predicted factor, and diverges if that factor exceeds
//! one.

use crate::dense::{dense_iteration, spectral_radius};
use crate::prelude::*;

fn by_fixed_point(problem: &Problem, scheme: Scheme, dt: f64, tolerance: f64) -> OneStep {
    let settings = Settings {
        stopping: Stopping::below(tolerance).with_limit(1000),
        ..by(Solver::FixedPoint)
    };
    simulate(problem, with(scheme, settings, dt))
}

/// The factor that the first step shows.
#[track_caller]
fn measured(problem: &Problem, scheme: Scheme, dt: f64, tolerance: f64) -> f64 {
    let mut simulation = by_fixed_point(problem, scheme, dt, tolerance);
    let report = simulation.step_once().unwrap();
    report.contraction.unwrap()
}

/// A beam whose tip penetrates the upper obstacle by a fifth of the gap, at rest or moving upwards.
fn pressed(zeta: f64, epsilon: f64, speed: f64) -> Problem {
    let beam = Beam {
        zeta,
        ..Beam::default()
    };
    let start: [&dyn Fn(f64) -> f64; 2] = [&|x| 0.12 * x, &|x| speed * x];
    launched(uniform(100), beam, Some(soft(epsilon)), start)
}

fn predicted(problem: &Problem, scheme: &Scheme, dt: f64) -> f64 {
    problem.case(*scheme, dt).contact_contraction(0.0144)
}

#[test]
fn in_contact_the_fixed_point_contracts_by_alpha() {
    // The factor of the paper's scheme, measured with an independent implementation, and half a
    // digit.
    let rows = [
        (1e-3, 0.1, 1e-4, [0.00234, 5e-6]),
        (1e-3, 0.1, 1e-3, [0.0959, 5e-5]),
        (1e-3, 0.1, 3e-3, [0.509, 5e-4]),
        (1e-4, 0.1, 1e-3, [0.959, 5e-4]),
        (1e-3, 0.01, 1e-3, [0.230, 5e-4]),
    ];
    for (epsilon, zeta, dt, [expected, half]) in rows {
        let case = pressed(zeta, epsilon, 0.0).case(EULER_CRANK_NICOLSON, dt);
        close(case.contact_contraction(0.0), expected, 1.5 * half);
        for scheme in SCHEMES {
            let problem = pressed(zeta, epsilon, 0.0);
            let measured = measured(&problem, scheme, dt, 1e-9);
            let alpha = predicted(&problem, &scheme, dt);
            near(scheme.name, measured, alpha, 0.03 * alpha);
        }
    }
}

#[test]
fn above_a_factor_of_one_the_fixed_point_diverges_and_newton_converges() {
    // In the midpoint rule a tip at rest would leave the obstacle within such a step; a fast tip
    // does not.
    for (scheme, dt, speed) in [
        (EULER_CRANK_NICOLSON, 5e-3, 0.0),
        (EULER_CRANK_NICOLSON, 2e-2, 0.0),
        (MIDPOINT, 1e-2, 10.0),
    ] {
        let problem = pressed(0.1, 1e-3, speed);
        assert!(predicted(&problem, &scheme, dt) > 1.05);
        let mut simulation = by_fixed_point(&problem, scheme, dt, 1e-10);
        let before = simulation.level();
        let error = simulation.step_once().unwrap_err();
        assert_eq!((error.step, error.t, error.dt), (1, 0.0, dt));
        let StepFailure::Diverged {
            iterations,
            increment,
            contraction,
            of,
        } = error.failure
        else {
            panic!("{error}")
        };
        assert_eq!(of, Some(Loop::Contact));
        assert_eq!(iterations, 1000);
        assert!(
            increment > 1e-3 && contraction >= 1.0,
            "{increment} {contraction}"
        );
        assert_eq!((simulation.steps(), simulation.t()), (0, 0.0));
        assert_eq!(simulation.level(), before);
        after(&problem, with(scheme, Settings::default(), dt), 100);
    }
}

#[test]
fn below_a_factor_of_one_the_fixed_point_converges() {
    let problem = pressed(0.1, 1e-3, 0.0);
    let alpha = predicted(&problem, &EULER_CRANK_NICOLSON, 4.5e-3);
    assert!((0.9..1.0).contains(&alpha), "{alpha}");
    let mut simulation = by_fixed_point(&problem, EULER_CRANK_NICOLSON, 4.5e-3, 1e-10);
    assert!(simulation.step_once().unwrap().iterations > 100);
}

#[test]
fn without_contact_the_fixed_point_contracts_by_the_coupling_factor() {
    for dt in [0.01, 0.1, 1.0, 10.0] {
        for scheme in SCHEMES {
            let beam = Beam {
                rho: 0.0,
                a: 0.0,
                beta: 0.3,
                ..Beam::default()
            };
            let start: [&dyn Fn(f64) -> f64; 2] = [&|_| 0.0, &|x| 20.0 * x * (x - 1.0) * (x - 1.0)];
            let problem = launched(graded(40), beam, None, start);
            let measured = measured(&problem, scheme, dt, 1e-12);
            let predicted = problem.case(scheme, dt).coupling_contraction(beam.beta);
            let exact = spectral_radius(&dense_iteration(&problem, &scheme, dt).all);
            near(scheme.name, predicted, exact, 1e-6 * exact);
            // For small steps the iteration converges before the slowest mode dominates.
            let lowest = if dt < 1.0 { 0.0 } else { 0.97 };
            assert!(
                (lowest..1.03).contains(&(measured / exact)),
                "{}: {measured} for {exact}",
                scheme.name
            );
        }
    }
}

/// A beam without obstacles, whose free end moves.
fn swinging(beam: Beam) -> Problem {
    launched(uniform(50), beam, None, [&|_| 0.0, &|x| x * x])
}

/// Without obstacles a large a makes the iteration diverge, and a larger ε is not a remedy.
#[test]
fn without_contact_the_loop_of_rotation_and_temperature_can_diverge() {
    for (a, diverges) in [(20.0, true), (10.0, false)] {
        let problem = swinging(Beam {
            a,
            ..Beam::default()
        });
        let factor = problem.case(EULER_CRANK_NICOLSON, 1e-2).heat_contraction();
        // A hundred iterations, since more would overflow.
        let stepping = with(EULER_CRANK_NICOLSON, by(Solver::FixedPoint), 1e-2);
        let outcome = simulate(&problem, stepping).step_once();
        assert_eq!(
            (outcome.is_err(), factor > 1.0),
            (diverges, diverges),
            "{factor}"
        );
        let Err(error) = outcome else { continue };
        let StepFailure::Diverged {
            contraction, of, ..
        } = error.failure
        else {
            panic!("{error}")
        };
        assert_eq!(of, Some(Loop::Heat));
        close(contraction, factor, 0.03 * factor);
        let said = error.to_string();
        assert!(
            said.contains("rotation and temperature") && !said.contains("epsilon"),
            "{said}"
        );
    }
}

/// A factor is that of its loop alone: the four together may converge where one of them would not.
#[test]
fn a_loop_with_a_factor_above_one_converges_if_another_damps_it() {
    let problem = swinging(Beam {
        zeta: 0.1,
        a: 3.425,
        rho: 0.0,
        ..Beam::default()
    });
    let factor = problem.case(EULER_CRANK_NICOLSON, 1.0).heat_contraction();
    let dense = dense_iteration(&problem, &EULER_CRANK_NICOLSON, 1.0);
    let [together, heat] = [&dense.all, &dense.heat].map(spectral_radius);
    close(factor, 1.0035, 1e-4);
    close(heat, factor, 1e-6);
    close(together, 0.9002, 1e-4);
    let measured = measured(&problem, EULER_CRANK_NICOLSON, 1.0, 1e-10);
    close(measured, together, 0.01);
}

/// Contact and axial force move the tip in the same way: two factors below 1 add up to more.
#[test]
fn two_loops_with_factors_below_one_diverge_if_they_add() {
    let beam = Beam {
        zeta: 0.1,
        rho: 1000.0,
        beta: 0.0,
        ..Beam::default()
    };
    // The tip just touches the obstacle at 0.1.
    let start: [&dyn Fn(f64) -> f64; 2] = [&|x| (0.1 + 1e-12) * x.powi(16), &|_| 0.0];
    let problem = launched(uniform(50), beam, Some(soft(1e-3)), start);
    let u = &problem.initial.u;
    let case = problem.case(EULER_CRANK_NICOLSON, 4e-3);
    let n_value = beam.axial_force(slope_squared(&case.lengths, u));
    close(case.contact_contraction(n_value), 0.4831, 1e-4);
    close(case.axial_contraction(n_value, u), 0.6789, 1e-4);
    assert!(case.contraction(u).0 < 1.0);
    let dense = dense_iteration(&problem, &EULER_CRANK_NICOLSON, 4e-3);
    close(spectral_radius(&dense.all), 1.1002, 1e-4);
}

/// Whether a linear beam in lasting contact stays bounded with this number of iterations in each
/// step; both obstacles stand at 0.
fn is_stable(iterations: usize, dt: f64) -> bool {
    let beam = Beam {
        rho: 0.0,
        a: 0.5,
        ..Beam::default()
    };
    let obstacles = Some(Obstacles {
        epsilon: 1e-3,
        g1: 0.0,
        g2: 0.0,
    });
    let problem = launched(uniform(20), beam, obstacles, [&|x| 0.01 * x * x, &|_| 0.0]);
    let settings = Settings {
        stopping: Stopping::Iterations(iterations),
        ..by(Solver::FixedPoint)
    };
    let mut simulation = simulate(&problem, with(EULER_CRANK_NICOLSON, settings, dt));
    (0..4000).all(|_| simulation.step_once().is_ok()) && simulation.level().u[20].abs() < 1.0
}

/// α = 1 is at dt = 5.22e-3 here. The limits are those of the table in THEORY.md, ζ = 0.1, with 2 %
/// on either side.
#[test]
fn a_single_iteration_is_stable_for_twice_the_step_of_convergence() {
    for (iterations, limit) in [(1, 1.039e-2), (2, 5.224e-3), (3, 7.016e-3), (4, 5.224e-3)] {
        assert!(
            is_stable(iterations, 0.98 * limit),
            "L = {iterations} below {limit}"
        );
        assert!(
            !is_stable(iterations, 1.02 * limit),
            "L = {iterations} above {limit}"
        );
    }
}

/// A beam at rest under three times its stiffness.
fn compressed(elements: usize, obstacles: Option<Obstacles>) -> Problem {
    let beam = Beam {
        beta: -3.0,
        zeta: 0.1,
        ..Beam::default()
    };
    launched(uniform(elements), beam, obstacles, [&|_| 0.0, &|_| 0.0])
}

/// (4.2) has one solution up to dt = 2ζ/(-1 - β) on every mesh, and that is sharp: beyond, only on
/// coarse ones.
#[test]
fn the_fixed_point_runs_up_to_the_limit_of_its_problems() {
    for (elements, dt, runs) in [
        (10, 0.099, true),
        (400, 0.099, true),
        (400, 0.101, false),
        (10, 0.101, true),
    ] {
        let problem = compressed(elements, Some(Obstacles::default()));
        let step = by_fixed_point(&problem, EULER_CRANK_NICOLSON, dt, 1e-10).step_once();
        assert_eq!(step.is_ok(), runs, "{elements} elements, dt = {dt}");
        if let Err(error) = step {
            let words = "dt <= 1.0 zeta is enough for this axial force";
            assert!(error.to_string().ends_with(words), "{error}");
        }
    }
}

/// The coupled step is definite up to dt = 2ζB/(-B - m), which the message of a refusal names.
#[test]
fn a_refused_coupled_step_names_the_step_that_is_enough() {
    let message = |dt: f64| {
        let step = simulate(&compressed(20, None), stepping(dt)).step_once();
        step.err().map(|error| error.to_string())
    };
    // 2 B/(3 - B) = 0.6219.
    assert_eq!(message(0.0621), None);
    let refused = message(1.0).expect("a refusal");
    let words = "dt <= 0.622 zeta is enough for this axial force";
    assert!(refused.ends_with(words), "{refused}");
}
