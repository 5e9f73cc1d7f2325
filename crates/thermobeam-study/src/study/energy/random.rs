//! Beams with random coefficients and random smooth initial data.

use crate::random::SplitMix;
use std::f64::consts::PI;
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::simulation::{Initial, Problem};

/// Modes of the initial data.
const MODES: usize = 4;

/// The beam of that seed: the same on every machine.
pub(super) fn problem(mesh: &Mesh, seed: u64) -> Problem {
    let mut random = SplitMix::new(seed);
    let mut between = |low: f64, high: f64| random.within([low, high]);
    let beam = Beam {
        zeta: 10f64.powf(between(-2.0, 0.0)),
        a: between(-1.0, 1.0),
        rho: if between(0.0, 1.0) < 0.2 { 0.0 } else { 10f64.powf(between(-1.0, 2.0)) },
        beta: between(-0.65, 6.0),
        theta_a: between(-20.0, 20.0),
    };
    let obstacles =
        Obstacles { epsilon: 10f64.powf(between(-5.0, -1.0)), g1: -between(0.0, 0.1), g2: between(0.0, 0.1) };
    let mut series = |size: f64, wave: fn(f64) -> f64| {
        let factors: [f64; MODES] = std::array::from_fn(|k| between(-size, size) / (1.0 + k as f64));
        let value = |x: f64| factors.iter().enumerate().map(|(k, c)| c * (wave(k as f64) * PI * x).sin()).sum::<f64>();
        mesh.nodes().iter().map(|&x| value(x)).collect::<Vec<f64>>()
    };
    let clamped = |k: f64| k + 0.5;
    let mut theta = series(5.0, |k| k + 1.0);
    for (theta, x) in theta.iter_mut().zip(mesh.nodes()) {
        *theta += beam.theta_a * (1.0 - x);
    }
    let initial = Initial {
        u: series(0.1, clamped),
        u_t: series(2.0, clamped),
        phi: series(0.1, clamped),
        phi_t: series(2.0, clamped),
        theta,
    };
    Problem { beam, obstacles: Some(obstacles), mesh: mesh.clone(), initial }
}
