//! The paper's experiments by both methods, meshes and steps for them, and comparisons of levels.

use crate::prelude::*;
use std::f64::consts::PI;
use std::fmt::Display;

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

/// An experiment of the paper on one element: its initial temperature is sin(πx), or 20 cos(5πx/2)
/// for θ_A = 20.
pub(crate) fn experiment((beta, theta_a): (f64, f64), degree: usize) -> DgProblem {
    let theta = move |x: f64| {
        if theta_a == 0.0 {
            (PI * x).sin()
        } else {
            theta_a * (2.5 * PI * x).cos()
        }
    };
    let initial = InitialFunctions {
        u: Box::new(|x| 0.01 * x * (x - 2.0)),
        u_t: Box::new(|x| 20.0 * x * (x - 1.0) * (x - 1.0)),
        theta: Box::new(theta),
        ..InitialFunctions::at_rest(0.0)
    };
    DgProblem {
        beam: Beam {
            beta,
            theta_a,
            ..Beam::default()
        },
        obstacles: Some(Obstacles::default()),
        mesh: uniform(1),
        degree,
        initial,
    }
}

/// The same on P1 elements.
pub(crate) fn paper(mesh: Mesh, experiment: (f64, f64)) -> Problem {
    on_mesh(&self::experiment(experiment, 1), mesh)
}

pub(crate) fn on_nodes(mesh: &Mesh, f: &dyn Fn(f64) -> f64) -> Vec<f64> {
    mesh.nodes().iter().map(|&x| f(x)).collect()
}

/// A problem on P1 elements, its initial data interpolated.
pub(crate) fn on_mesh(problem: &DgProblem, mesh: Mesh) -> Problem {
    let initial = &problem.initial;
    let initial = InitialValues {
        u: on_nodes(&mesh, &initial.u),
        u_t: on_nodes(&mesh, &initial.u_t),
        phi: on_nodes(&mesh, &initial.phi),
        phi_t: on_nodes(&mesh, &initial.phi_t),
        theta: on_nodes(&mesh, &initial.theta),
    };
    Problem {
        beam: problem.beam,
        obstacles: problem.obstacles,
        mesh,
        initial,
    }
}

/// A cold beam whose u starts with the nodal displacements and velocities of these functions.
pub(crate) fn launched(
    mesh: Mesh,
    beam: Beam,
    obstacles: Option<Obstacles>,
    [u, u_t]: [&dyn Fn(f64) -> f64; 2],
) -> Problem {
    let initial = InitialValues {
        u: on_nodes(&mesh, u),
        u_t: on_nodes(&mesh, u_t),
        ..InitialValues::at_rest(&mesh, 0.0)
    };
    Problem {
        beam,
        obstacles,
        mesh,
        initial,
    }
}

/// The paper's obstacles with another compliance.
pub(crate) fn soft(epsilon: f64) -> Obstacles {
    Obstacles {
        epsilon,
        ..Obstacles::default()
    }
}

pub(crate) fn uniform(elements: usize) -> Mesh {
    Mesh::uniform(elements).unwrap()
}

/// A mesh refined at both ends; its largest element is 4.4 times the smallest.
pub(crate) fn graded(elements: usize) -> Mesh {
    Mesh::mapped(elements, |s| s - 0.1 * (2.0 * PI * s).sin()).unwrap()
}

/// Both schemes and both kinds of mesh.
pub(crate) fn schemes_and_meshes(elements: usize) -> impl Iterator<Item = (Scheme, Mesh)> {
    let meshes = [uniform(elements), graded(elements)];
    SCHEMES
        .into_iter()
        .flat_map(move |scheme| meshes.clone().map(|mesh| (scheme, mesh)))
}

/// A step is solved until its increment is below a number.
pub(crate) fn below(tolerance: f64) -> Settings {
    Settings {
        stopping: Stopping::below(tolerance),
        ..Settings::default()
    }
}

pub(crate) fn by(solver: Solver) -> Settings {
    Settings {
        solver,
        ..Settings::default()
    }
}

pub(crate) fn from(start: Start) -> Settings {
    Settings {
        start,
        ..Settings::default()
    }
}

/// The paper's scheme and default settings.
pub(crate) fn stepping(dt: f64) -> Stepping {
    with(EULER_CRANK_NICOLSON, Settings::default(), dt)
}

pub(crate) fn with(scheme: Scheme, settings: Settings, dt: f64) -> Stepping {
    Stepping {
        scheme,
        settings,
        dt,
        loaded: false,
    }
}

/// Default steps of this degree.
pub(crate) fn of_degree(degree: usize) -> DgStepping {
    DgStepping {
        degree,
        ..DgStepping::default()
    }
}

/// Equal steps.
pub(crate) fn equal_steps(degree: usize, dt: f64) -> DgStepping {
    DgStepping {
        dt,
        restart_dt: dt,
        tolerance: 1e-14,
        ..of_degree(degree)
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

/// The level after this number of steps.
#[track_caller]
pub(crate) fn after(problem: &Problem, stepping: Stepping, steps: usize) -> TimeLevel {
    let mut simulation = simulate(problem, stepping);
    advance(&mut simulation, steps);
    simulation.level()
}

#[track_caller]
pub(crate) fn of_any_order(problem: DgProblem, stepping: DgStepping) -> Dg {
    Dg::new(problem, stepping).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
pub(crate) fn advanced(problem: DgProblem, stepping: DgStepping, t: f64) -> Dg {
    let mut simulation = of_any_order(problem, stepping);
    simulation
        .advance(t)
        .unwrap_or_else(|error| panic!("{error}"));
    simulation
}

/// The current value of a field at the free end.
#[track_caller]
pub(crate) fn tip(simulation: &Dg, field: Field) -> f64 {
    simulation
        .value(field, 1.0, simulation.t())
        .expect("the present time")
}

/// Largest difference of a nodal value of these fields, θ lifted.
pub(crate) fn difference(simulation: &Dg, level: &TimeLevel, fields: &[Field]) -> f64 {
    let mut largest = 0.0;
    for field in fields {
        let values = match field {
            Field::U => &level.u,
            Field::V => &level.v,
            Field::Phi => &level.phi,
            Field::W => &level.w,
            Field::Theta => &level.theta,
        };
        for (x, value) in simulation.space().mesh().nodes().iter().zip(values) {
            let found = simulation
                .value(*field, *x, simulation.t())
                .expect("the present time");
            largest = max_or_nan(largest, (found - value).abs());
        }
    }
    largest
}

#[track_caller]
pub(crate) fn close(found: f64, expected: f64, tolerance: f64) {
    near("", found, expected, tolerance);
}

/// The same in one of several cases.
#[track_caller]
pub(crate) fn near(case: impl Display, found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{case}: {found} is not {expected} to {tolerance:e}"
    );
}

/// The problem with a level of another run as initial data.
pub(crate) fn from_level(problem: &Problem, level: &TimeLevel) -> Problem {
    let theta_a = problem.beam.theta_a;
    let lifted = level.theta.iter().zip(problem.mesh.nodes());
    let initial = InitialValues {
        u: level.u.clone(),
        u_t: level.v.clone(),
        phi: level.phi.clone(),
        phi_t: level.w.clone(),
        theta: lifted
            .map(|(theta, x)| theta + theta_a * (1.0 - x))
            .collect(),
    };
    Problem {
        initial,
        ..problem.clone()
    }
}

/// Distance of two levels in the norm of (3.14).
pub(crate) fn distance(mesh: &Mesh, a: &TimeLevel, b: &TimeLevel) -> f64 {
    let lengths: Vec<f64> = mesh.lengths().collect();
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

/// u, v, φ, w and θ~ at the nodes.
pub(crate) fn fields(level: &TimeLevel) -> [&[f64]; 5] {
    [&level.u, &level.v, &level.phi, &level.w, &level.theta]
}

/// Largest difference of nodal values, relative to the largest value of the field in `b`; NaN if
/// any value is NaN.
pub(crate) fn relative_difference(a: &TimeLevel, b: &TimeLevel) -> f64 {
    let largest = |values: &[f64]| {
        let sizes = values.iter().map(|value| value.abs());
        sizes.fold(0.0, max_or_nan)
    };
    let mut worst = 0.0;
    for (a, b) in fields(a).into_iter().zip(fields(b)) {
        let scale = max_or_nan(largest(b), 1e-3);
        let difference = largest(&minus(a, b));
        worst = max_or_nan(worst, difference / scale);
    }
    worst
}

/// log2 of the quotient of two errors.
pub(crate) fn rate([coarse, fine]: [f64; 2]) -> f64 {
    (coarse / fine).log2()
}
