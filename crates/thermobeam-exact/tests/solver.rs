//! The solver against vibrations, which are known in closed form.

use crate::prelude::*;
use thermobeam::motion::Motion;
use thermobeam_exact::vibration::{Mode, TimeFactor};

/// The undamped mode as initial displacement of a linear beam, on one element.
fn vibrating(mode: Mode, zeta: f64, degree: usize) -> DgProblem {
    let initial = InitialFunctions {
        u: Box::new(move |x| mode.u(x)),
        phi: Box::new(move |x| mode.phi(x)),
        ..InitialFunctions::at_rest(0.0)
    };
    DgProblem {
        beam: Beam {
            zeta,
            a: 0.0,
            rho: 0.0,
            beta: 0.0,
            theta_a: 0.0,
        },
        obstacles: None,
        mesh: uniform(1),
        degree,
        initial,
    }
}

#[test]
fn damped_modes_are_met_to_eleven_digits_at_every_time() {
    for (index, zeta) in [(0, 0.1), (2, 0.02), (3, 2.0)] {
        let mode = Mode::new(index);
        let exact = TimeFactor::new(mode.omega(), zeta, 1.0, 0.0).unwrap();
        let stepping = DgStepping {
            degree: 5,
            dt: 0.01,
            ..DgStepping::default()
        };
        let mut simulation = Dg::new(vibrating(mode, zeta, 22), stepping).unwrap();
        while simulation.step(0.5).unwrap().is_some() {
            let (start, end) = (simulation.old_level().t, simulation.t());
            for t in [0.7 * start + 0.3 * end, end] {
                for x in [0.3, 0.77, 1.0] {
                    let velocity_tolerance = if t == end { 2e-11 } else { 5e-9 };
                    for (field, expected, tolerance) in [
                        (Field::U, mode.u(x) * exact.value(t), 1e-11),
                        (Field::Phi, mode.phi(x) * exact.value(t), 1e-11),
                        (Field::V, mode.u(x) * exact.slope(t), velocity_tolerance),
                    ] {
                        close(simulation.value(field, x, t).unwrap(), expected, tolerance);
                    }
                }
            }
        }
    }
}

/// The scheme is not L-stable: a step much longer than all periods multiplies u by (ζ - τ/2)/(ζ +
/// τ/2) for q = 0.
#[test]
fn stiff_modes_are_damped_by_viscosity_alone() {
    let mode = Mode::new(0);
    for (zeta, factor) in [(10.0, -40.0 / 60.0), (0.01, -49.99 / 50.01), (50.0, 0.0)] {
        let long = DgStepping {
            degree: 0,
            dt: 100.0,
            restart_dt: 100.0,
            ..DgStepping::default()
        };
        let mut simulation = Dg::new(vibrating(mode, zeta, 10), long).unwrap();
        simulation.advance(100.0).unwrap();
        let tip = simulation.value(Field::U, 1.0, simulation.t()).unwrap();
        close(tip, factor * mode.u(1.0), 1e-3);
    }
}
