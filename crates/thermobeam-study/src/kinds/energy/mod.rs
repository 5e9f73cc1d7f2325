//! Proposition 3.1 and a sharper form of it: the energy never rises, and its balance closes in
//! every step.
//!
//! An exactly solved step without loads satisfies, with the energy E of (3.9),
//!
//! ```text
//! E^n - E^{n-1} + dt ζ (‖v_x - w‖² + ‖w_x‖²) + dt ‖θ_x‖² (at n-½) + ½ (‖v - v0‖² + ‖w - w0‖²) + gap = 0,
//! ```
//!
//! where gap >= 0 comes from the contact term. Only the first difference can be negative, so E
//! cannot rise. An energy may decrease by chance, whereas a missing or wrong term opens the balance
//! in the first step in which it acts.
//!
//! A study file selects its scenes by one of three tables:
//!
//! | table | scenes |
//! | --- | --- |
//! | `[energy]` | scene files and smooth random beams, by every scheme listed: a fixed bound on rise and residual |
//! | `[[case]]` | single scenes at the limits of the allowed range, each with its own claim and the way its run must end |
//! | `[random]` | batches of random scenes, in lanes |
//!
//! Rise and residual of `[[case]]` and `[random]` are bounded by 1e-12 of the energy or, if that is
//! larger, by a bound on the rounding errors of the step.

pub mod random;
pub mod runs;

use std::f64::consts::PI;

use super::prelude::*;
pub use super::runs::end::End;
pub use super::runs::watch::Worst;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/energy",
    read,
    why: "An exactly solved step obeys a balance: the change of the energy, the viscous and the thermal dissipation, that of the \
          Euler scheme and the gap of the contact energy add up to zero. All but the first are not negative, so the energy \
          cannot rise (Proposition 3.1). Scenes at the limits of every range, and random ones, test it where nobody would look.",
    judged: "Every step of every run: the energy must not rise and the balance must close, up to rounding errors. A run must end \
             with its answer or, where the scene asks for it, with the failure that it names.",
    failure: "A term of the step or of the energy is wrong, or a step has not been solved. The balance shows the defect in the \
              very step in which it happens. Run the scene named alone.",
    settings: |header, item| {
        Topic::new("the energy's laws", ItemMethod::OneStep).settings(header, item)
    },
};

/// Reads a study of scenes, of cases or of random scenes, depending on the table in the file.
fn read(header: Header, root: &Section<'_>, folder: &Path) -> Result<Box<dyn Study>, InputError> {
    match only_table(
        root,
        ["energy", "case", "random"],
        "one of the tables [energy], [[case]] and [random]",
    )? {
        "random" => reader::<random::RandomScenes>(header, root, folder),
        _ => reader::<runs::EnergyRuns>(header, root, folder),
    }
}

/// The tables `[[case]]`, each with a unique name.
pub(in crate::kinds) fn named_cases<C>(
    root: &Section<'_>,
    read: impl Fn(&Section<'_>, String) -> Result<C, InputError>,
) -> Result<Vec<C>, InputError> {
    let mut names = std::collections::BTreeSet::new();
    root.tables("case", "", |section| {
        let name = section.require("name", "a text")?.text()?.to_owned();
        let case = read(section, name.clone())?;
        if names.insert(name.clone()) {
            return Ok(case);
        }
        Err(section.refuse(
            "name",
            format!("a second \"{name}\""),
            "a name that no other case has",
        ))
    })
}

/// Modes of the initial data.
const MODES: usize = 4;

/// A beam with moderate random coefficients and smooth random data, the same on every machine.
fn smooth(mesh: &Mesh, seed: u64) -> Problem {
    let mut random = SplitMix::new(seed);
    let mut between = |low: f64, high: f64| random.within([low, high]);
    let beam = Beam {
        zeta: 10f64.powf(between(-2.0, 0.0)),
        a: between(-1.0, 1.0),
        rho: if between(0.0, 1.0) < 0.2 {
            0.0
        } else {
            10f64.powf(between(-1.0, 2.0))
        },
        beta: between(-0.65, 6.0),
        theta_a: between(-20.0, 20.0),
    };
    let obstacles = Obstacles {
        epsilon: 10f64.powf(between(-5.0, -1.0)),
        g1: -between(0.0, 0.1),
        g2: between(0.0, 0.1),
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
fn wild(elements: usize, seed: u64) -> Result<(Problem, f64), MeshError> {
    let mut random = SplitMix::new(seed);
    let mesh = wild_mesh(&mut random, elements)?;
    let beam = wild_beam(&mut random);
    let gap = |random: &mut SplitMix| or_zero(random, |random| power(random, -6.0, 0.0));
    let mut pair = || Obstacles {
        epsilon: power(&mut random, -8.0, 1.0),
        g1: -gap(&mut random),
        g2: gap(&mut random),
    };
    let obstacles = pair();
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
) -> Initial {
    let clamped = |k: f64| k + 0.5;
    let mut theta = field(5.0, |k| k + 1.0);
    let last = theta.len() - 1;
    (theta[0], theta[last]) = (0.0, 0.0);
    for (theta, x) in theta.iter_mut().zip(mesh.nodes()) {
        *theta += theta_a * (1.0 - x);
    }
    Initial {
        u: field(0.1, clamped),
        u_t: field(2.0, clamped),
        phi: field(0.1, clamped),
        phi_t: field(2.0, clamped),
        theta,
    }
}

/// A sum of sines with random factors.
fn modes(random: &mut SplitMix, mesh: &Mesh, size: f64, wave: fn(f64) -> f64) -> Vec<f64> {
    let factors: [f64; MODES] =
        std::array::from_fn(|k| random.within([-size, size]) / (1.0 + k as f64));
    let value = |x: f64| {
        factors
            .iter()
            .enumerate()
            .map(|(k, c)| c * (wave(k as f64) * PI * x).sin())
            .sum::<f64>()
    };
    mesh.nodes().iter().map(|&x| value(x)).collect()
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
