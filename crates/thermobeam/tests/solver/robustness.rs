//! Newton's method converges on the paper's data for all compliances, time steps and Kirchhoff
//! coefficients.

use crate::prelude::*;

const BETAS: [f64; 4] = [-0.8, -0.5, 0.0, 5.0];

/// The paper's data with other ρ and ε.
fn scene(mesh: Mesh, experiment: (f64, f64), rho: f64, epsilon: f64) -> Problem {
    let mut problem = paper(mesh, experiment);
    problem.beam.rho = rho;
    problem.obstacles = Some(soft(epsilon));
    problem
}

/// Does 50 steps; returns the largest number of iterations, and the largest residual of the balance
/// relative to the energy.
fn run(problem: &Problem, stepping: Stepping) -> (usize, f64) {
    let mut simulation = simulate(problem, stepping);
    let mut old = simulation.level();
    let mut new = TimeLevel::new(old.u.len());
    let scale = simulation.energy(&old).total().abs();
    let (mut most, mut worst) = (0, 0.0);
    for _ in 0..50 {
        let report = simulation.step_once().unwrap_or_else(|error| {
            panic!(
                "{:?} {:?} dt = {:e}: {error}",
                problem.beam, problem.obstacles, stepping.dt
            );
        });
        simulation.observe(&mut new);
        most = most.max(report.iterations);
        worst = max_or_nan(worst, simulation.balance(&old, &new).residual.abs() / scale);
        std::mem::swap(&mut old, &mut new);
    }
    (most, worst)
}

#[test]
fn newton_converges_for_every_compliance_step_force_and_stiffness() {
    let (mut most, mut worst) = (0, 0.0);
    for mesh in [uniform(30), graded(30)] {
        for beta in BETAS {
            for rho in [0.0, 1.0, 1e4] {
                for log_epsilon in [-8, -6, -4, -3, -2, 0] {
                    for log_dt in -6..=0 {
                        for theta_a in [0.0, 20.0] {
                            let (epsilon, dt) = (10f64.powi(log_epsilon), 10f64.powi(log_dt));
                            let problem = scene(mesh.clone(), (beta, theta_a), rho, epsilon);
                            let rough = with(EULER_CRANK_NICOLSON, from(Start::Previous), dt);
                            let (iterations, balance) = run(&problem, rough);
                            most = most.max(iterations);
                            worst = max_or_nan(worst, balance);
                        }
                    }
                }
            }
        }
    }
    assert!(most <= 20, "a step took {most} iterations");
    assert!(
        worst <= 1e-11,
        "the largest residual of a balance is {worst:e}"
    );
}

#[test]
fn both_schemes_converge_from_the_extrapolated_start() {
    for scheme in SCHEMES {
        for beta in BETAS {
            for rho in [1.0, 1e4] {
                for epsilon in [1e-8, 1e-3] {
                    for log_dt in -5..=0 {
                        let problem = scene(graded(30), (beta, 20.0), rho, epsilon);
                        let dt = 10f64.powi(log_dt);
                        let (iterations, _) = run(&problem, with(scheme, Settings::default(), dt));
                        assert!(
                            iterations <= 30,
                            "{} {beta} {rho} {epsilon:e}: {iterations}",
                            scheme.name
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_step_succeeds_despite_a_bad_prediction_of_the_axial_force() {
    let mut done = 0;
    for dt in [2.0, 4.0, 6.0] {
        for rho in [1.0, 100.0, 1e4] {
            let problem = scene(uniform(30), (-0.8, 0.0), rho, 1e-3);
            let outcome = |start| {
                let stepping = with(EULER_CRANK_NICOLSON, from(start), dt);
                let mut simulation = simulate(&problem, stepping);
                (0..100).map_while(|_| simulation.step_once().ok()).count()
            };
            let (rough, extrapolated) = (outcome(Start::Previous), outcome(Start::Extrapolated));
            assert_eq!(extrapolated, rough, "dt = {dt}, rho = {rho}");
            done += rough;
        }
    }
    assert!(done > 300, "{done}");
}

/// With one element, stiff obstacles and all ρ the rounding errors of F exceed those of m.
#[test]
fn the_safeguarded_iteration_stops_when_the_bracket_reaches_round_off() {
    for epsilon in [1e-8, 3e-8, 1e-7, 1e-6] {
        for rho in [20.0, 100.0, 1e3, 1e4, 1e5] {
            for dt in [1e-3, 3e-3, 1e-2, 0.1, 1.0] {
                for scheme in SCHEMES {
                    let mut problem = scene(uniform(1), (0.5, 20.0), rho, epsilon);
                    problem.obstacles = Some(Obstacles {
                        epsilon,
                        g1: -1e-4,
                        g2: 1e-4,
                    });
                    problem.initial.u_t[1] = 2.0;
                    after(&problem, with(scheme, Settings::default(), dt), 100);
                }
            }
        }
    }
}
