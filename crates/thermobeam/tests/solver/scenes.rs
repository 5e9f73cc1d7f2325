//! The paper's experiments, the meshes for them, and comparisons of levels.

use std::f64::consts::PI;
use thermobeam::mesh::Mesh;
use thermobeam::norms::{TheoremSquares, max_or_nan};
use thermobeam::one_step::{InitialValues, OneStep, Problem, Stepping};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{EULER_CRANK_NICOLSON, Scheme};
use thermobeam::solve::{Level, Settings};

/// (β, θ_A) of the paper's seven experiments in section 5, all with (5.1) and (5.3): (5.4) with
/// θ_A = 0, (5.5) with θ_A = 20, and the buckled beam.
pub(crate) const EXPERIMENTS: [(f64, f64); 7] = [
    (-0.5, 0.0),
    (0.0, 0.0),
    (5.0, 0.0),
    (-0.5, 20.0),
    (0.0, 20.0),
    (5.0, 20.0),
    (-0.8, 0.0),
];

/// An experiment of the paper on a mesh: its initial temperature is sin(πx), or 20 cos(5πx/2) for
/// θ_A = 20.
pub(crate) fn paper(mesh: Mesh, (beta, theta_a): (f64, f64)) -> Problem {
    let on_nodes = |f: &dyn Fn(f64) -> f64| mesh.nodes().iter().map(|&x| f(x)).collect::<Vec<_>>();
    let initial = InitialValues {
        u: on_nodes(&|x| 0.01 * x * (x - 2.0)),
        u_t: on_nodes(&|x| 20.0 * x * (x - 1.0) * (x - 1.0)),
        phi: on_nodes(&|_| 0.0),
        phi_t: on_nodes(&|_| 0.0),
        theta: on_nodes(&|x| {
            if theta_a == 0.0 {
                (PI * x).sin()
            } else {
                theta_a * (2.5 * PI * x).cos()
            }
        }),
    };
    Problem {
        beam: Beam {
            beta,
            theta_a,
            ..Beam::default()
        },
        obstacles: Some(Obstacles::default()),
        mesh,
        initial,
    }
}

pub(crate) fn uniform(elements: usize) -> Mesh {
    Mesh::uniform(elements).unwrap()
}

/// A mesh refined at both ends; its largest element is 4.4 times the smallest.
pub(crate) fn graded(elements: usize) -> Mesh {
    Mesh::mapped(elements, |s| s - 0.1 * (2.0 * PI * s).sin()).unwrap()
}

/// The paper's scheme and default settings.
pub(crate) fn stepping(dt: f64) -> Stepping {
    Stepping {
        scheme: EULER_CRANK_NICOLSON,
        settings: Settings::default(),
        dt,
        loaded: false,
    }
}

#[track_caller]
pub(crate) fn simulate(problem: &Problem, stepping: Stepping) -> OneStep {
    OneStep::new(problem.clone(), stepping).unwrap_or_else(|error| panic!("{error}"))
}

/// Does the given number of steps, each of which must succeed.
#[track_caller]
pub(crate) fn advance(simulation: &mut OneStep, steps: usize) {
    for _ in 0..steps {
        simulation
            .step_once()
            .unwrap_or_else(|error| panic!("{error}"));
    }
}

/// The problem with a level of another run as initial data.
pub(crate) fn from_level(problem: &Problem, level: &Level) -> Problem {
    let theta_a = problem.beam.theta_a;
    let theta = level
        .theta
        .iter()
        .zip(problem.mesh.nodes())
        .map(|(theta, x)| theta + theta_a * (1.0 - x))
        .collect();
    let initial = InitialValues {
        u: level.u.clone(),
        u_t: level.v.clone(),
        phi: level.phi.clone(),
        phi_t: level.w.clone(),
        theta,
    };
    Problem {
        initial,
        ..problem.clone()
    }
}

/// Distance of two levels in the norm of (3.14).
pub(crate) fn distance(mesh: &Mesh, a: &Level, b: &Level) -> f64 {
    let lengths: Vec<f64> = mesh.lengths().collect();
    let minus = |p: &[f64], q: &[f64]| p.iter().zip(q).map(|(p, q)| p - q).collect::<Vec<_>>();
    let squares = TheoremSquares::of(
        &lengths,
        &minus(&a.v, &b.v),
        &minus(&a.u, &b.u),
        &minus(&a.w, &b.w),
        &minus(&a.phi, &b.phi),
        &minus(&a.theta, &b.theta),
    );
    squares.norm()
}

/// The fields of a level with their names.
pub(crate) fn fields(level: &Level) -> [(&'static str, &[f64]); 5] {
    [
        ("u", &level.u),
        ("v", &level.v),
        ("phi", &level.phi),
        ("w", &level.w),
        ("theta", &level.theta),
    ]
}

/// Largest difference of nodal values, relative to the largest value of the field in `b`; NaN if
/// any value is NaN.
pub(crate) fn relative_difference(a: &Level, b: &Level) -> f64 {
    let mut worst = 0.0;
    for ((_, a), (_, b)) in fields(a).into_iter().zip(fields(b)) {
        let scale = max_or_nan(largest(b.iter().copied()), 1e-3);
        worst = max_or_nan(
            worst,
            largest(a.iter().zip(b).map(|(a, b)| (a - b) / scale)),
        );
    }
    worst
}

/// The largest absolute value; NaN if any value is NaN.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, max_or_nan)
}

/// Slope of log(error) over log(dt) between the last two of (dt, error).
pub(crate) fn last_rate(errors: &[(f64, f64)]) -> f64 {
    let [.., (dt0, e0), (dt1, e1)] = errors else {
        panic!("a rate needs two levels")
    };
    (e0 / e1).ln() / (dt0 / dt1).ln()
}

/// Both schemes and both kinds of mesh.
pub(crate) fn schemes_and_meshes(elements: usize) -> impl Iterator<Item = (Scheme, Mesh)> {
    let meshes = [uniform(elements), graded(elements)];
    thermobeam::scheme::SCHEMES
        .into_iter()
        .flat_map(move |scheme| meshes.clone().map(|mesh| (scheme, mesh)))
}
