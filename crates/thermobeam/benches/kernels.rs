//! Run times of the parts of a step against the number of elements: `cargo bench -p thermobeam`.
//!
//! Items are elements: a throughput of 100 Mitem/s is 10 ns per element.

#![allow(
    clippy::disallowed_methods,
    reason = "steps are timed without anything around them"
)]

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use thermobeam::ensemble::Ensemble;
use thermobeam::mesh::Mesh;
use thermobeam::norms::TheoremSquares;
use thermobeam::one_step::{InitialValues, OneStep, Problem, Stepping};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{EULER_CRANK_NICOLSON, MIDPOINT, Scheme};
use thermobeam::solve::{Level, Settings, Solver};
use thermobeam::tridiagonal::TridiagonalFactor;

/// Numbers of elements.
const SIZES: [usize; 4] = [10, 100, 1_000, 10_000];
const DT: f64 = 1e-4;

fn main() {
    divan::main();
}

/// The paper's beam, heated and moving towards its upper obstacle.
fn moving_beam(elements: usize) -> Problem {
    let mesh = Mesh::uniform(elements).expect("a mesh");
    let mut initial = InitialValues::at_rest(&mesh, 0.0);
    for (i, &x) in mesh.nodes().iter().enumerate() {
        initial.u_t[i] = 20.0 * x * (x - 1.0) * (x - 1.0);
        initial.theta[i] = x * (1.0 - x);
    }
    Problem {
        beam: Beam::default(),
        obstacles: Some(Obstacles::default()),
        mesh,
        initial,
    }
}

fn simulation(elements: usize, scheme: Scheme, solver: Solver) -> OneStep {
    let settings = Settings {
        solver,
        ..Settings::default()
    };
    OneStep::new(
        moving_beam(elements),
        Stepping {
            scheme,
            settings,
            dt: DT,
            loaded: false,
        },
    )
    .expect("a simulation")
}

/// A simulation after eleven steps, and its last two levels.
fn moved(elements: usize) -> (OneStep, Level, Level) {
    let mut simulation = simulation(elements, EULER_CRANK_NICOLSON, Solver::Newton);
    for _ in 0..10 {
        simulation.step_once().expect("a step");
    }
    let old = simulation.level();
    simulation.step_once().expect("a step");
    let new = simulation.level();
    (simulation, old, new)
}

fn steps(bencher: Bencher<'_, '_>, mut simulation: OneStep) {
    let elements = simulation.lengths().len();
    bencher
        .counter(ItemsCount::new(elements))
        .bench_local(|| simulation.step_once());
}

#[divan::bench(args = SIZES)]
fn step_newton(bencher: Bencher<'_, '_>, elements: usize) {
    steps(
        bencher,
        simulation(elements, EULER_CRANK_NICOLSON, Solver::Newton),
    );
}

#[divan::bench(args = SIZES)]
fn step_midpoint(bencher: Bencher<'_, '_>, elements: usize) {
    steps(bencher, simulation(elements, MIDPOINT, Solver::Newton));
}

#[divan::bench(args = SIZES)]
fn step_fixed_point(bencher: Bencher<'_, '_>, elements: usize) {
    steps(
        bencher,
        simulation(elements, EULER_CRANK_NICOLSON, Solver::FixedPoint),
    );
}

/// Items are the elements of all four cases.
#[divan::bench(args = SIZES)]
fn step_in_lanes(bencher: Bencher<'_, '_>, elements: usize) {
    let problems = vec![moving_beam(elements); 4];
    let mut ensemble = Ensemble::new(
        problems,
        &[DT; 4],
        EULER_CRANK_NICOLSON,
        Settings::default(),
    )
    .expect("an ensemble");
    bencher
        .counter(ItemsCount::new(elements * 4))
        .bench_local(|| ensemble.step_once());
}

/// Items are the elements of all four cases.
#[divan::bench(args = SIZES)]
fn balances_in_lanes(bencher: Bencher<'_, '_>, elements: usize) {
    let problems = vec![moving_beam(elements); 4];
    let mut ensemble = Ensemble::new(
        problems,
        &[DT; 4],
        EULER_CRANK_NICOLSON,
        Settings::default(),
    )
    .expect("an ensemble");
    ensemble.step_once();
    let mut balances = vec![];
    bencher
        .counter(ItemsCount::new(elements * 4))
        .bench_local(|| ensemble.balances(black_box(&mut balances)));
}

#[divan::bench(args = SIZES)]
fn set_up(bencher: Bencher<'_, '_>, elements: usize) {
    let build = || simulation(elements, EULER_CRANK_NICOLSON, Solver::Newton);
    bencher
        .counter(ItemsCount::new(elements))
        .bench_local(build);
}

#[divan::bench(args = SIZES)]
fn observe(bencher: Bencher<'_, '_>, elements: usize) {
    let (simulation, _, mut level) = moved(elements);
    bencher
        .counter(ItemsCount::new(elements))
        .bench_local(|| simulation.observe(black_box(&mut level)));
}

#[divan::bench(args = SIZES)]
fn energy(bencher: Bencher<'_, '_>, elements: usize) {
    let (simulation, _, level) = moved(elements);
    bencher
        .counter(ItemsCount::new(elements))
        .bench_local(|| simulation.energy(black_box(&level)));
}

#[divan::bench(args = SIZES)]
fn energy_scale(bencher: Bencher<'_, '_>, elements: usize) {
    let (simulation, _, level) = moved(elements);
    bencher
        .counter(ItemsCount::new(elements))
        .bench_local(|| simulation.energy_scale(black_box(&level)));
}

#[divan::bench(args = SIZES)]
fn balance(bencher: Bencher<'_, '_>, elements: usize) {
    let (simulation, old, new) = moved(elements);
    bencher
        .counter(ItemsCount::new(elements))
        .bench_local(|| simulation.balance(black_box(&old), black_box(&new)));
}

#[divan::bench(args = SIZES)]
fn rounding(bencher: Bencher<'_, '_>, elements: usize) {
    let (simulation, old, new) = moved(elements);
    bencher
        .counter(ItemsCount::new(elements))
        .bench_local(|| simulation.rounding(black_box(&old), black_box(&new)));
}

#[divan::bench(args = SIZES)]
fn norm_of_theorem_3_4(bencher: Bencher<'_, '_>, elements: usize) {
    let (simulation, _, level) = moved(elements);
    bencher.counter(ItemsCount::new(elements)).bench_local(|| {
        let Level {
            u,
            v,
            phi,
            w,
            theta,
            ..
        } = black_box(&level);
        TheoremSquares::of(simulation.lengths(), v, u, w, phi, theta).norm()
    });
}

#[divan::bench(args = SIZES)]
fn tridiagonal_factorize(bencher: Bencher<'_, '_>, elements: usize) {
    let lengths = vec![1.0 / elements as f64; elements];
    let mut factor = TridiagonalFactor::new(elements);
    bencher
        .counter(ItemsCount::new(elements))
        .bench_local(|| factor.factorize(black_box(&lengths), 1.0, 0.0, 1.0));
}

#[divan::bench(args = SIZES)]
fn tridiagonal_solve(bencher: Bencher<'_, '_>, elements: usize) {
    let lengths = vec![1.0 / elements as f64; elements];
    let mut factor = TridiagonalFactor::new(elements);
    factor
        .factorize(&lengths, 1.0, 0.0, 0.0)
        .expect("a definite matrix");
    let mut right = vec![1.0; elements + 1];
    bencher
        .counter(ItemsCount::new(elements))
        .bench_local(|| factor.solve_in_place(black_box(&mut right)));
}
