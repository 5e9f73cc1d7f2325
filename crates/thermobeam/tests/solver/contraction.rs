//! The paper's fixed point contracts with the predicted factor, and diverges if that factor exceeds one.

use super::scenes::{advance, graded, simulate, stepping, uniform};
use nalgebra::DMatrix;
use thermobeam::assembly::{Tridiagonal, coupling, mass, stiffness};
use thermobeam::error::{Loop, StepFailure};
use thermobeam::norms::max_or_nan;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{EULER_CRANK_NICOLSON, MIDPOINT, SCHEMES, Scheme};
use thermobeam::simulation::{Initial, Problem, Simulation, Stepping};
use thermobeam::solve::{Settings, Solver};

fn by_fixed_point(problem: &Problem, scheme: Scheme, dt: f64, tolerance: f64) -> Simulation {
    let settings = Settings { solver: Solver::FixedPoint, tolerance, max_iterations: 1000, ..Settings::default() };
    simulate(problem, Stepping { scheme, settings, ..stepping(dt) })
}

/// A beam whose tip penetrates the upper obstacle by a fifth of the gap, at rest or moving upwards.
fn pressed(zeta: f64, epsilon: f64, speed: f64) -> Problem {
    let mesh = uniform(100);
    let mut initial = Initial::at_rest(&mesh, 0.0);
    initial.u = mesh.nodes().iter().map(|x| 0.12 * x).collect();
    initial.u_t = mesh.nodes().iter().map(|x| speed * x).collect();
    let obstacles = Some(Obstacles { epsilon, ..Obstacles::default() });
    Problem { beam: Beam { zeta, ..Beam::default() }, obstacles, mesh, initial }
}

fn predicted(problem: &Problem, scheme: &Scheme, dt: f64) -> f64 {
    problem.case(*scheme, dt).contact_contraction(0.0144)
}

#[test]
fn in_contact_the_fixed_point_contracts_by_alpha() {
    let rows = [(1e-3, 0.1, 1e-4), (1e-3, 0.1, 1e-3), (1e-3, 0.1, 3e-3), (1e-4, 0.1, 1e-3), (1e-3, 0.01, 1e-3)];
    for (epsilon, zeta, dt) in rows {
        for scheme in SCHEMES {
            let problem = pressed(zeta, epsilon, 0.0);
            let report = by_fixed_point(&problem, scheme, dt, 1e-9).advance().unwrap();
            let (measured, alpha) = (report.contraction.unwrap(), predicted(&problem, &scheme, dt));
            assert!((measured - alpha).abs() <= 0.03 * alpha, "{}: {measured} for {alpha}", scheme.name);
        }
    }
}

#[test]
fn above_a_factor_of_one_the_fixed_point_diverges_and_newton_converges() {
    // In the midpoint rule a tip at rest would leave the obstacle within such a step; a fast tip does not.
    for (scheme, dt, speed) in
        [(EULER_CRANK_NICOLSON, 5e-3, 0.0), (EULER_CRANK_NICOLSON, 2e-2, 0.0), (MIDPOINT, 1e-2, 10.0)]
    {
        let problem = pressed(0.1, 1e-3, speed);
        assert!(predicted(&problem, &scheme, dt) > 1.05);
        let mut simulation = by_fixed_point(&problem, scheme, dt, 1e-10);
        let before = simulation.level();
        let error = simulation.advance().unwrap_err();
        assert_eq!((error.step, error.t, error.dt), (1, 0.0, dt));
        let StepFailure::Diverged { iterations, increment, contraction, of } = error.failure else { panic!("{error}") };
        assert_eq!(of, Some(Loop::Contact));
        assert_eq!(iterations, 1000);
        assert!(increment > 1e-3 && contraction >= 1.0, "{increment} {contraction}");
        assert_eq!((simulation.step(), simulation.t()), (0, 0.0));
        assert_eq!(simulation.level(), before);
        advance(&mut simulate(&problem, Stepping { scheme, ..stepping(dt) }), 100);
    }
}

#[test]
fn below_a_factor_of_one_the_fixed_point_converges() {
    let problem = pressed(0.1, 1e-3, 0.0);
    let alpha = predicted(&problem, &EULER_CRANK_NICOLSON, 4.5e-3);
    assert!((0.9..1.0).contains(&alpha), "{alpha}");
    let mut simulation = by_fixed_point(&problem, EULER_CRANK_NICOLSON, 4.5e-3, 1e-10);
    assert!(simulation.advance().unwrap().iterations > 100);
}

fn dense(matrix: &Tridiagonal) -> DMatrix<f64> {
    let n = matrix.diagonal.len() - 1;
    DMatrix::from_fn(n, n, |i, j| match (i + 1).wrapping_sub(j) {
        2 => matrix.lower[i + 1],
        1 => matrix.diagonal[i + 1],
        0 => matrix.upper[i + 1],
        _ => 0.0,
    })
}

/// Spectral radius of the iteration V → W → V on the mesh, without contact, with N = 0 and a = 0.
fn spectral_radius(problem: &Problem, scheme: &Scheme, dt: f64) -> f64 {
    let [m, k, c] = [mass, stiffness, coupling].map(|assemble| dense(&assemble(&problem.mesh)));
    let (kappa, s) = (scheme.inertia / dt, problem.beam.zeta + 0.5 * dt);
    let to_rotation = (&m * (kappa + s) + &k * s).lu().solve(&(c.transpose() * s)).unwrap();
    let back = (&m * kappa + &k * s).lu().solve(&(&c * s)).unwrap();
    (back * to_rotation).complex_eigenvalues().iter().map(|value| value.norm()).fold(0.0, max_or_nan)
}

#[test]
fn without_contact_the_fixed_point_contracts_by_the_coupling_factor() {
    let mesh = graded(40);
    for dt in [0.01, 0.1, 1.0, 10.0] {
        for scheme in SCHEMES {
            let mut initial = Initial::at_rest(&mesh, 0.0);
            initial.u_t = mesh.nodes().iter().map(|x| 20.0 * x * (x - 1.0) * (x - 1.0)).collect();
            let beam = Beam { rho: 0.0, a: 0.0, ..Beam::default() };
            let problem = Problem { beam, obstacles: None, mesh: mesh.clone(), initial };
            let report = by_fixed_point(&problem, scheme, dt, 1e-12).advance().unwrap();
            let measured = report.contraction.unwrap();
            let predicted = problem.case(scheme, dt).coupling_contraction(0.0);
            let exact = spectral_radius(&problem, &scheme, dt);
            assert!((predicted - exact).abs() <= 1e-6 * exact, "{}: {predicted} for {exact}", scheme.name);
            // For small steps the iteration converges before the slowest mode dominates.
            let lowest = if dt < 1.0 { 0.0 } else { 0.97 };
            assert!((lowest..1.03).contains(&(measured / exact)), "{}: {measured} for {exact}", scheme.name);
        }
    }
}

/// Without obstacles a large a makes the iteration diverge, and a larger ε is not a remedy.
#[test]
fn without_contact_the_loop_of_rotation_and_temperature_can_diverge() {
    let mesh = uniform(50);
    for (a, diverges) in [(20.0, true), (10.0, false)] {
        let mut initial = Initial::at_rest(&mesh, 0.0);
        initial.u_t = mesh.nodes().iter().map(|x| x * x).collect();
        let beam = Beam { a, ..Beam::default() };
        let problem = Problem { beam, obstacles: None, mesh: mesh.clone(), initial };
        let factor = problem.case(EULER_CRANK_NICOLSON, 1e-2).heat_contraction();
        // A hundred iterations, since more would overflow.
        let settings = Settings { solver: Solver::FixedPoint, ..Settings::default() };
        let outcome = simulate(&problem, Stepping { settings, ..stepping(1e-2) }).advance();
        assert_eq!((outcome.is_err(), factor > 1.0), (diverges, diverges), "{factor}");
        let Err(error) = outcome else { continue };
        let StepFailure::Diverged { contraction, of, .. } = error.failure else { panic!("{error}") };
        assert_eq!(of, Some(Loop::Heat));
        assert!((contraction - factor).abs() <= 0.03 * factor, "{contraction} for {factor}");
        let said = error.to_string();
        assert!(said.contains("rotation and temperature") && !said.contains("epsilon"), "{said}");
    }
}
