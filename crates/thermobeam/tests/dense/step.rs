//! Single steps of both solvers against a dense solution of (3.7)-(3.8), on random small systems.

use super::system::{Dense, level_of, unknowns};
use crate::prelude::*;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::cell::Cell;

const STEPS: usize = 3;
const MAX_ELEMENTS: usize = 5;

/// Ranges of the coefficients.
#[derive(Debug, Clone, Copy)]
struct Range {
    log_dt: (f64, f64),
    log_epsilon: (f64, f64),
    log_rho: (f64, f64),
    beta: (f64, f64),
}

/// Coefficients for Newton's method.
const NEWTON_RANGE: Range = Range {
    log_dt: (-4.0, -0.5),
    log_epsilon: (-6.0, 0.0),
    log_rho: (-2.0, 4.0),
    beta: (-0.7, 50.0),
};
/// Coefficients for which the fixed point converges.
const FIXED_POINT_RANGE: Range = Range {
    log_dt: (-4.0, -3.0),
    log_epsilon: (-1.0, 0.0),
    log_rho: (-2.0, 0.5),
    beta: (-0.7, 2.0),
};

#[derive(Debug, Clone)]
struct Random {
    problem: Problem,
    stepping: Stepping,
    loads: Vec<Vec<[f64; 3]>>,
}

/// Nodal values with the given slopes, zero at x = 0.
fn integrate(slopes: &[f64], mesh: &Mesh) -> Vec<f64> {
    let mut sum = 0.0;
    std::iter::once(0.0)
        .chain(mesh.lengths().zip(slopes).map(|(h, slope)| {
            sum += h * slope;
            sum
        }))
        .collect()
}

prop_compose! {
    fn beam(range: Range)(
        log_zeta in -3.0..0.0f64, a in -1.0..1.0f64, theta_a in -20.0..20.0f64, beta in range.beta.0..range.beta.1,
        rho in prop_oneof![1 => Just(0.0), 3 => (range.log_rho.0..range.log_rho.1).prop_map(|log: f64| 10f64.powf(log))],
    ) -> Beam {
        Beam { zeta: 10f64.powf(log_zeta), a, rho, beta, theta_a }
    }
}

prop_compose! {
    fn obstacles(range: Range)(
        log_epsilon in range.log_epsilon.0..range.log_epsilon.1, g1 in -0.1..0.0f64, g2 in 0.0..0.1f64,
    ) -> Obstacles {
        Obstacles { epsilon: 10f64.powf(log_epsilon), g1, g2 }
    }
}

/// A scheme that is not in the table, to test other inertias.
const BETWEEN: Scheme = Scheme {
    name: "between",
    order: 1.0,
    inertia: 1.25,
    contact: ContactRule::DiscreteGradient,
    source: "V = 4/5 v + 1/5 v0",
};

prop_compose! {
    fn random(range: Range, solver: Solver)(
        mesh in mesh(MAX_ELEMENTS), mut beam in beam(range), obstacles in proptest::option::weighted(0.8, obstacles(range)),
        log_dt in range.log_dt.0..range.log_dt.1, row in 0..=SCHEMES.len(), loaded: bool, cold in proptest::bool::weighted(0.2),
        fields in vec(vec(-1.0..1.0f64, MAX_ELEMENTS), 5),
        loads in vec(vec(proptest::array::uniform3(-1.0..1.0f64), MAX_ELEMENTS + 1), STEPS),
    ) -> Random {
        if cold {
            (beam.a, beam.theta_a) = (0.0, 0.0);
        }
        let n = mesh.elements();
        let mut theta: Vec<f64> = mesh.nodes().iter().map(|x| beam.theta_a * (1.0 - x)).collect();
        for i in 1..n {
            theta[i] += if cold { 0.0 } else { fields[4][i] };
        }
        let half: Vec<f64> = fields[0].iter().map(|slope| 0.5 * slope).collect();
        let initial = InitialValues {
            u: integrate(&half, &mesh),
            u_t: integrate(&fields[1], &mesh),
            phi: integrate(&fields[2], &mesh),
            phi_t: integrate(&fields[3], &mesh),
            theta,
        };
        let settings = Settings { solver, stopping: Stopping::Converged { tolerance: 1e-13, max_iterations: 200 }, ..Settings::default() };
        let scheme = SCHEMES.get(row).copied().unwrap_or(BETWEEN);
        let stepping = Stepping { scheme, settings, dt: 10f64.powf(log_dt), loaded };
        let loads = loads.into_iter().map(|load| load[..=n].to_vec()).collect();
        Random { problem: Problem { beam, obstacles, mesh, initial }, stepping, loads }
    }
}

/// Compares each step with the dense one from the same level; whether the tip pressed the upper and
/// the lower obstacle.
fn compare(case: &Random) -> Result<[bool; 2], TestCaseError> {
    let Random {
        problem,
        stepping,
        loads,
    } = case;
    let dense = Dense::new(problem);
    let mut simulation = simulate(problem, *stepping);
    let mut pressed = [false; 2];
    for load in loads {
        let old = simulation.level();
        let mut given: &[[f64; 3]] = &[];
        if let Some(to) = simulation.load_mut() {
            to.copy_from_slice(load);
            given = load;
        }
        if let Err(error) = simulation.step_once() {
            return Err(TestCaseError::fail(error.to_string()));
        }
        let Some(expected) = dense.step(&stepping.scheme, stepping.dt, &unknowns(&old), given)
        else {
            return Err(TestCaseError::reject(
                "the dense Newton iteration does not converge",
            ));
        };
        let [found, expected] = [simulation.level(), level_of(&expected)];
        let difference = relative_difference(&found, &expected);
        prop_assert!(
            difference <= 1e-10,
            "{:e}:\n{:?}\n{:?}",
            difference,
            found,
            expected
        );
        pressed[0] |= found.contact_force > 0.0;
        pressed[1] |= found.contact_force < 0.0;
    }
    Ok(pressed)
}

/// Compares on the given number of random cases; each obstacle must be pressed in a tenth of them.
fn compare_all(range: Range, solver: Solver, cases: u32) {
    let config = ProptestConfig {
        max_global_rejects: 10,
        source_file: Some(file!()),
        ..at_least(cases)
    };
    let cases = config.cases;
    let pressed = [Cell::new(0), Cell::new(0)];
    TestRunner::new(config)
        .run(&random(range, solver), |case| {
            for (count, pressed) in pressed.iter().zip(compare(&case)?) {
                count.set(count.get() + u32::from(pressed));
            }
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
    assert!(
        pressed.iter().all(|count| count.get() > cases / 10),
        "{pressed:?} of {cases}"
    );
}

#[test]
fn a_newton_step_solves_the_equations_of_the_scheme() {
    compare_all(NEWTON_RANGE, Solver::Newton, 1000);
}

#[test]
fn a_fixed_point_step_solves_the_equations_of_the_scheme() {
    compare_all(FIXED_POINT_RANGE, Solver::FixedPoint, 500);
}
