//! Random beams and time steps, the same on every machine.

use std::f64::consts::PI;

use convergence_judge::random::SplitMix;
use thermobeam::{
    mesh::{Mesh, MeshError},
    one_step::{InitialValues, Problem},
    parameters::{Beam, Obstacles},
};

/// Modes of the initial data.
const MODES: usize = 4;

/// A beam with moderate random coefficients and smooth random data, the same on every machine.
pub(super) fn smooth(mesh: &Mesh, seed: u64) -> Problem {
    let mut random = SplitMix::new(seed);
    let beam = Beam {
        zeta: power(&mut random, -2.0, 0.0),
        a: random.within([-1.0, 1.0]),
        rho: if random.within([0.0, 1.0]) < 0.2 {
            0.0
        } else {
            power(&mut random, -1.0, 2.0)
        },
        beta: random.within([-0.65, 6.0]),
        theta_a: random.within([-20.0, 20.0]),
    };
    let obstacles = Obstacles {
        epsilon: power(&mut random, -5.0, -1.0),
        g1: -random.within([0.0, 0.1]),
        g2: random.within([0.0, 0.1]),
    };
    let initial = random_data(mesh, beam.theta_a, |size, wave| {
        modes(&mut random, mesh, size, wave)
    });
    Problem {
        beam,
        obstacles: Some(obstacles),
        mesh: mesh.clone(),
        initial,
    }
}

/// A random beam and its time step, the same on every machine: every coefficient over its whole
/// range including zero, element lengths that differ by a factor of up to 1000, initial data either
/// smooth or independent from node to node.
pub(super) fn wild(elements: usize, seed: u64) -> Result<(Problem, f64), MeshError> {
    let mut random = SplitMix::new(seed);
    let mesh = wild_mesh(&mut random, elements)?;
    let beam = wild_beam(&mut random);
    let obstacles = wild_obstacles(&mut random);
    let without = random.uniform() < 0.1;
    let dt = power(&mut random, -6.0, 1.0);
    let rough = random.uniform() < 0.3;
    let initial = random_data(&mesh, beam.theta_a, |size, wave| {
        if rough {
            noise(&mut random, &mesh, size)
        } else {
            modes(&mut random, &mesh, size, wave)
        }
    });
    Ok((
        Problem {
            beam,
            obstacles: (!without).then_some(obstacles),
            mesh,
            initial,
        },
        dt,
    ))
}

/// Ten to a random power between the two.
fn power(random: &mut SplitMix, low: f64, high: f64) -> f64 {
    10f64.powf(random.within([low, high]))
}

/// Zero in one of ten cases.
fn or_zero(random: &mut SplitMix, value: impl FnOnce(&mut SplitMix) -> f64) -> f64 {
    let value = value(random);
    if random.uniform() < 0.1 { 0.0 } else { value }
}

fn wild_obstacles(random: &mut SplitMix) -> Obstacles {
    Obstacles {
        epsilon: power(random, -8.0, 1.0),
        g1: -or_zero(random, |random| power(random, -6.0, 0.0)),
        g2: or_zero(random, |random| power(random, -6.0, 0.0)),
    }
}

fn wild_beam(random: &mut SplitMix) -> Beam {
    let sign = if random.uniform() < 0.5 { 1.0 } else { -1.0 };
    Beam {
        zeta: or_zero(random, |random| power(random, -6.0, 1.0)),
        a: sign * or_zero(random, |random| power(random, -3.0, 0.0)),
        rho: or_zero(random, |random| power(random, -2.0, 6.0)),
        beta: if random.uniform() < 0.5 {
            random.within([-2.0, 2.0])
        } else {
            power(random, 0.0, 3.0)
        },
        theta_a: or_zero(random, |random| random.within([-50.0, 50.0])),
    }
}

fn wild_mesh(random: &mut SplitMix, elements: usize) -> Result<Mesh, MeshError> {
    let spread = random.within([0.0, 3.0]);
    let lengths: Vec<f64> = (0..elements).map(|_| power(random, -spread, 0.0)).collect();
    let total: f64 = lengths.iter().sum();
    let sums = lengths.iter().scan(0.0, |x, h| {
        *x += h / total;
        Some(*x)
    });
    let mut nodes: Vec<f64> = std::iter::once(0.0).chain(sums).collect();
    nodes[elements] = 1.0;
    Mesh::from_nodes(nodes)
}

/// The five fields, each from `field(size, wave numbers in π)`; the temperature satisfies its
/// boundary conditions.
fn random_data(
    mesh: &Mesh,
    theta_a: f64,
    mut field: impl FnMut(f64, fn(f64) -> f64) -> Vec<f64>,
) -> InitialValues {
    let mut theta = field(5.0, |k| k + 1.0);
    let last = theta.len() - 1;
    (theta[0], theta[last]) = (0.0, 0.0);
    for (theta, x) in theta.iter_mut().zip(mesh.nodes()) {
        *theta += theta_a * (1.0 - x);
    }
    InitialValues {
        u: field(0.1, clamped_wave),
        u_t: field(2.0, clamped_wave),
        phi: field(0.1, clamped_wave),
        phi_t: field(2.0, clamped_wave),
        theta,
    }
}

/// The wave number of mode k, in π, of a field that is clamped at x = 0 and free at x = 1.
fn clamped_wave(k: f64) -> f64 {
    k + 0.5
}

/// A sum of sines with random factors.
fn modes(random: &mut SplitMix, mesh: &Mesh, size: f64, wave: fn(f64) -> f64) -> Vec<f64> {
    let factors: [f64; MODES] =
        std::array::from_fn(|k| random.within([-size, size]) / (1.0 + k as f64));
    let mut values = vec![];
    for x in mesh.nodes() {
        let terms = factors.iter().enumerate();
        values.push(
            terms
                .map(|(k, c)| c * (wave(k as f64) * PI * x).sin())
                .sum(),
        );
    }
    values
}

/// Independent values at the nodes, zero at the clamped end.
fn noise(random: &mut SplitMix, mesh: &Mesh, size: f64) -> Vec<f64> {
    mesh.nodes()
        .iter()
        .map(|&x| {
            if x == 0.0 {
                0.0
            } else {
                random.within([-size, size])
            }
        })
        .collect()
}
