//! Times of the paper's first experiment by the scheme of any order:
//! `cargo bench -p thermobeam --bench any_order`.

#![allow(
    clippy::disallowed_methods,
    reason = "steps are timed without anything around them"
)]

use divan::Bencher;
use std::f64::consts::PI;
use thermobeam::dg::{Dg, DgProblem, DgStepping, InitialFunctions};
use thermobeam::mesh::Mesh;
use thermobeam::motion::Motion;
use thermobeam::parameters::{Beam, Obstacles};

/// Elements (with two, the last one is a tenth of the beam); their degree; degree in time, largest
/// step, first step, growth; end. Comments give the error of u(1) at the end, and the largest at
/// any time.
const RUNS: [(usize, usize, usize, f64, f64, f64, f64); 7] = [
    // 3e-7, 2e-4
    (1, 10, 1, 0.02, 1e-3, 1.5, 1.0),
    // 6e-9, 1e-5
    (1, 14, 2, 0.02, 1e-3, 1.5, 1.0),
    // 8e-11, 3e-6
    (1, 16, 3, 0.02, 1e-3, 1.5, 1.0),
    // 4e-11, 5e-9
    (2, 14, 4, 0.005, 1e-3, 1.3, 1.0),
    // 2e-14, 7e-11
    (2, 18, 5, 0.004, 3e-4, 1.3, 1.0),
    // 3e-11, 1e-5
    (1, 14, 2, 0.02, 1e-3, 1.5, 10.0),
    // 1e-14, 7e-10
    (2, 16, 5, 0.008, 5e-4, 1.3, 10.0),
];

fn main() {
    divan::main();
}

fn simulation(run: usize) -> (Dg, f64) {
    let (elements, degree, q, dt, restart_dt, growth, end) = RUNS[run];
    let initial = InitialFunctions {
        u: Box::new(|x| 0.01 * x * (x - 2.0)),
        u_t: Box::new(|x| 20.0 * x * (x - 1.0) * (x - 1.0)),
        theta: Box::new(|x| (PI * x).sin()),
        ..InitialFunctions::at_rest(0.0)
    };
    let nodes = if elements == 1 {
        vec![0.0, 1.0]
    } else {
        vec![0.0, 0.9, 1.0]
    };
    let mesh = Mesh::from_nodes(nodes).expect("a mesh");
    let problem = DgProblem {
        beam: Beam::default(),
        obstacles: Some(Obstacles::default()),
        mesh,
        degree,
        initial,
    };
    let stepping = DgStepping {
        degree: q,
        dt,
        restart_dt,
        growth,
        tolerance: 1e-12,
        ..DgStepping::default()
    };
    (Dg::new(problem, stepping).expect("a simulation"), end)
}

#[divan::bench(args = 0..RUNS.len())]
fn first_experiment(bencher: Bencher<'_, '_>, run: usize) {
    bencher
        .with_inputs(|| simulation(run))
        .bench_local_values(|(mut simulation, end)| {
            simulation.advance(end).expect("steps");
            simulation
        });
}
