//! Run times of the parts of a step against the number of elements: `cargo bench -p thermobeam`.
//! `cargo xtask bench` has those of whole steps, in
//! lanes too, and of runs.
//!
//! Items are elements: a throughput of 100 Mitem/s is 10 ns per element.

#![allow(
    clippy::disallowed_methods,
    reason = "steps are timed without anything around them"
)]

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use thermobeam::mesh::Mesh;
use thermobeam::norms::TheoremSquares;
use thermobeam::one_step::{InitialValues, OneStep, Problem, Stepping};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::EULER_CRANK_NICOLSON;
use thermobeam::solve::{Settings, TimeLevel};
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

fn simulation(elements: usize) -> OneStep {
    let stepping = Stepping {
        scheme: EULER_CRANK_NICOLSON,
        settings: Settings::default(),
        dt: DT,
        loaded: false,
    };
    OneStep::new(moving_beam(elements), stepping).expect("a simulation")
}

fn timed<T>(bencher: Bencher<'_, '_>, elements: usize, part: impl FnMut() -> T) {
    bencher.counter(ItemsCount::new(elements)).bench_local(part);
}

/// Times what is computed from a simulation after eleven steps and its last two levels.
fn observed<T>(
    bencher: Bencher<'_, '_>,
    elements: usize,
    part: impl Fn(&OneStep, &TimeLevel, &TimeLevel) -> T,
) {
    let mut simulation = simulation(elements);
    for _ in 0..10 {
        simulation.step_once().expect("a step");
    }
    let old = simulation.level();
    simulation.step_once().expect("a step");
    let new = simulation.level();
    timed(bencher, elements, || {
        part(&simulation, black_box(&old), black_box(&new))
    });
}

#[divan::bench(args = SIZES)]
fn energy(bencher: Bencher<'_, '_>, elements: usize) {
    observed(bencher, elements, |simulation, _, level| {
        simulation.energy(level)
    });
}

#[divan::bench(args = SIZES)]
fn energy_scale(bencher: Bencher<'_, '_>, elements: usize) {
    observed(bencher, elements, |simulation, _, level| {
        simulation.energy_scale(level)
    });
}

#[divan::bench(args = SIZES)]
fn balance(bencher: Bencher<'_, '_>, elements: usize) {
    observed(bencher, elements, OneStep::balance);
}

#[divan::bench(args = SIZES)]
fn rounding(bencher: Bencher<'_, '_>, elements: usize) {
    observed(bencher, elements, OneStep::rounding);
}

#[divan::bench(args = SIZES)]
fn norm_of_theorem_3_4(bencher: Bencher<'_, '_>, elements: usize) {
    observed(bencher, elements, |simulation, _, level| {
        let TimeLevel {
            u,
            v,
            phi,
            w,
            theta,
            ..
        } = level;
        TheoremSquares::of(simulation.lengths(), v, u, w, phi, theta).norm()
    });
}

#[divan::bench(args = SIZES)]
fn observe(bencher: Bencher<'_, '_>, elements: usize) {
    let simulation = simulation(elements);
    let mut level = simulation.level();
    timed(bencher, elements, || {
        simulation.observe(black_box(&mut level));
    });
}

#[divan::bench(args = SIZES)]
fn set_up(bencher: Bencher<'_, '_>, elements: usize) {
    timed(bencher, elements, || simulation(elements));
}

#[divan::bench(args = SIZES)]
fn tridiagonal_factorize(bencher: Bencher<'_, '_>, elements: usize) {
    let lengths = vec![1.0 / elements as f64; elements];
    let mut factor = TridiagonalFactor::new(elements);
    timed(bencher, elements, || {
        factor.factorize(black_box(&lengths), 1.0, 0.0, 1.0)
    });
}

#[divan::bench(args = SIZES)]
fn tridiagonal_solve(bencher: Bencher<'_, '_>, elements: usize) {
    let lengths = vec![1.0 / elements as f64; elements];
    let mut factor = TridiagonalFactor::new(elements);
    factor
        .factorize(&lengths, 1.0, 0.0, 0.0)
        .expect("a definite matrix");
    let mut right = vec![1.0; elements + 1];
    timed(bencher, elements, || {
        factor.solve_in_place(black_box(&mut right));
    });
}
