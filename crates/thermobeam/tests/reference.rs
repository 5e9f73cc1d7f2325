//! Numbers of an independent implementation of the scheme.

use std::f64::consts::PI;
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::EULER_CRANK_NICOLSON;
use thermobeam::simulation::{Initial, Problem, Simulation, Stepping};
use thermobeam::solve::{Settings, Solver};

/// The paper's data (5.3) with a temperature and a β.
fn paper(elements: usize, beta: f64, theta_a: f64, theta: impl Fn(f64) -> f64) -> Problem {
    let mesh = Mesh::uniform(elements).unwrap();
    let on_nodes = |f: &dyn Fn(f64) -> f64| mesh.nodes().iter().map(|&x| f(x)).collect::<Vec<_>>();
    let initial = Initial {
        u: on_nodes(&|x| 0.01 * x * (x - 2.0)),
        u_t: on_nodes(&|x| 20.0 * x * (x - 1.0) * (x - 1.0)),
        phi: on_nodes(&|_| 0.0),
        phi_t: on_nodes(&|_| 0.0),
        theta: on_nodes(&theta),
    };
    Problem { beam: Beam { beta, theta_a, ..Beam::default() }, obstacles: Some(Obstacles::default()), mesh, initial }
}

#[test]
fn both_solvers_reach_the_reference_to_nine_digits() {
    type Row = (f64, f64, fn(f64) -> f64, [f64; 3]);
    let rows: [Row; 2] = [
        (0.0, 0.0, |x| (PI * x).sin(), [-1.174001195293e-2, -9.730912695990e-2, 4.539642780254e-1]),
        (-0.5, 20.0, |x| 20.0 * (2.5 * PI * x).cos(), [-1.094811531838e-2, -2.193974223913e-2, 5.155906791580e-1]),
    ];
    for (beta, theta_a, theta, expected) in rows {
        for solver in Solver::ALL {
            let settings = Settings { solver, tolerance: 1e-12, ..Settings::default() };
            let stepping = Stepping { scheme: EULER_CRANK_NICOLSON, settings, dt: 1e-3, loaded: false };
            let mut simulation = Simulation::new(paper(20, beta, theta_a, theta), stepping).unwrap();
            for _ in 0..1000 {
                simulation.advance().unwrap();
            }
            let level = simulation.level();
            let found = [level.u[20], level.phi[20], simulation.energy(&level).total()];
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9 * expected.abs(), "{solver:?}: {found} for {expected}");
            }
        }
    }
}
