//! Times of the paper's first experiment by the scheme of any order: `cargo bench -p thermobeam --bench any_order`.

use divan::Bencher;
use std::f64::consts::PI;
use thermobeam::dg::{Initial, Problem, Simulation, Stepping};
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};

/// Degree of the elements, degree in time, largest step, end. The comments give the largest error of u(1, t).
const RUNS: [(usize, usize, f64, f64); 5] = [
    (10, 1, 0.02, 1.0),
    // 1e-8
    (14, 2, 0.02, 1.0),
    // 1e-10
    (16, 3, 0.02, 1.0),
    // 1e-9
    (14, 2, 0.02, 10.0),
    (16, 3, 0.02, 10.0),
];

fn main() {
    divan::main();
}

fn simulation(degree: usize, q: usize, dt: f64) -> Simulation {
    let initial = Initial {
        u: Box::new(|x| 0.01 * x * (x - 2.0)),
        u_t: Box::new(|x| 20.0 * x * (x - 1.0) * (x - 1.0)),
        theta: Box::new(|x| (PI * x).sin()),
        ..Initial::at_rest(0.0)
    };
    let mesh = Mesh::uniform(1).expect("a mesh");
    let problem = Problem { beam: Beam::default(), obstacles: Some(Obstacles::default()), mesh, degree, initial };
    Simulation::new(problem, Stepping { degree: q, dt, ..Stepping::default() }).expect("a simulation")
}

#[divan::bench(args = 0..RUNS.len())]
fn first_experiment(bencher: Bencher<'_, '_>, run: usize) {
    let (degree, q, dt, end) = RUNS[run];
    bencher.with_inputs(|| simulation(degree, q, dt)).bench_local_values(|mut simulation| {
        simulation.advance(end).expect("steps");
        simulation
    });
}
