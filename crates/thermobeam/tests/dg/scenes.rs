//! Problems that several tests share.

use std::f64::consts::PI;
use thermobeam::dg::{Dg, DgProblem, DgStepping, Field, InitialFunctions};
use thermobeam::mesh::Mesh;
use thermobeam::motion::Motion;
use thermobeam::parameters::{Beam, Obstacles};

/// The paper's seven experiments in section 5: β and θ_A.
pub(crate) const EXPERIMENTS: [(f64, f64); 7] = [
    (0.0, 0.0),
    (-0.5, 0.0),
    (5.0, 0.0),
    (0.0, 20.0),
    (-0.5, 20.0),
    (5.0, 20.0),
    (-0.8, 0.0),
];

/// (5.3), with (5.4) for a cold clamped end and (5.5) for a heated one.
pub(crate) fn initial(theta_a: f64) -> InitialFunctions {
    let theta = move |x: f64| {
        if theta_a == 0.0 {
            (PI * x).sin()
        } else {
            theta_a * (2.5 * PI * x).cos()
        }
    };
    InitialFunctions {
        u: Box::new(|x| 0.01 * x * (x - 2.0)),
        u_t: Box::new(|x| 20.0 * x * (x - 1.0) * (x - 1.0)),
        theta: Box::new(theta),
        ..InitialFunctions::at_rest(0.0)
    }
}

/// An experiment of section 5 on one element.
pub(crate) fn experiment(beta: f64, theta_a: f64, degree: usize) -> DgProblem {
    let beam = Beam {
        beta,
        theta_a,
        ..Beam::default()
    };
    let initial = initial(theta_a);
    DgProblem {
        beam,
        obstacles: Some(Obstacles::default()),
        mesh: Mesh::uniform(1).unwrap(),
        degree,
        initial,
    }
}

/// Equal steps.
pub(crate) fn equal_steps(q: usize, dt: f64) -> DgStepping {
    DgStepping {
        degree: q,
        dt,
        restart_dt: dt,
        tolerance: 1e-14,
        ..DgStepping::default()
    }
}

#[track_caller]
pub(crate) fn simulate(problem: DgProblem, stepping: DgStepping) -> Dg {
    Dg::new(problem, stepping).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
pub(crate) fn advanced(problem: DgProblem, stepping: DgStepping, t: f64) -> Dg {
    let mut simulation = simulate(problem, stepping);
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

#[track_caller]
pub(crate) fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected} to {tolerance:e}"
    );
}

/// The larger of two numbers; NaN if either is.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}
