//! The solver against steady states and vibrations, which are known in closed form.

use std::f64::consts::PI;
use thermobeam::dg::{Dg, DgProblem, DgStepping, Field, InitialFunctions};
use thermobeam::mesh::Mesh;
use thermobeam::motion::Motion;
use thermobeam::one_step::{InitialValues, OneStep, Problem, Stepping};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::EULER_CRANK_NICOLSON;
use thermobeam::solve::{Settings, Stopping};
use thermobeam_exact::equilibrium::{Phase, equilibria};
use thermobeam_exact::vibration::{Mode, TimeFactor};

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected} to {tolerance:e}"
    );
}

/// The beam of Section 5 with θ_A = 20, and its initial data (5.3) and (5.5).
fn heated(beta: f64) -> Beam {
    Beam {
        beta,
        theta_a: 20.0,
        ..Beam::default()
    }
}

fn displacement(x: f64) -> f64 {
    0.01 * x * (x - 2.0)
}

fn velocity(x: f64) -> f64 {
    20.0 * x * (x - 1.0) * (x - 1.0)
}

fn temperature(x: f64) -> f64 {
    20.0 * (2.5 * PI * x).cos()
}

/// The experiment on P1 elements.
fn paper(beta: f64, elements: usize) -> Problem {
    let mesh = Mesh::uniform(elements).unwrap();
    let interpolate = |f: fn(f64) -> f64| mesh.nodes().iter().map(|&x| f(x)).collect();
    let initial = InitialValues {
        u: interpolate(displacement),
        u_t: interpolate(velocity),
        theta: interpolate(temperature),
        ..InitialValues::at_rest(&mesh, 0.0)
    };
    Problem {
        beam: heated(beta),
        obstacles: Some(Obstacles::default()),
        mesh,
        initial,
    }
}

/// The experiment on one element.
fn experiment(beta: f64, degree: usize) -> DgProblem {
    let initial = InitialFunctions {
        u: Box::new(displacement),
        u_t: Box::new(velocity),
        theta: Box::new(temperature),
        ..InitialFunctions::at_rest(0.0)
    };
    DgProblem {
        beam: heated(beta),
        obstacles: Some(Obstacles::default()),
        mesh: Mesh::uniform(1).unwrap(),
        degree,
        initial,
    }
}

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
        mesh: Mesh::uniform(1).unwrap(),
        degree,
        initial,
    }
}

/// The current value of a field at the free end.
fn tip(simulation: &Dg, field: Field) -> f64 {
    simulation
        .value(field, 1.0, simulation.t())
        .expect("the present time")
}

/// Errors of u(1), φ(1) and the contact force in the steady state with the given number of
/// elements.
fn errors(beta: f64, contact: Phase, elements: usize) -> [f64; 3] {
    let problem = paper(beta, elements);
    let states = equilibria(&problem.beam, problem.obstacles.as_ref()).unwrap();
    let [state] = states.as_slice() else {
        panic!("{states:?}")
    };
    assert_eq!(state.contact, contact);
    let settings = Settings {
        stopping: Stopping::below(1e-12),
        ..Settings::default()
    };
    let stepping = Stepping {
        scheme: EULER_CRANK_NICOLSON,
        settings,
        dt: 0.05,
        loaded: false,
    };
    let mut simulation = OneStep::new(problem, stepping).unwrap();
    // Backward Euler damps every mode; the slowest thermal mode decays by 13 digits until t = 3.
    for _ in 0..4000 {
        simulation.step_once().unwrap();
    }
    let level = simulation.level();
    let motion = level
        .v
        .iter()
        .chain(&level.w)
        .chain(&level.theta)
        .fold(0.0, |sum: f64, value| sum + value.abs());
    assert!(motion <= 1e-10, "beta = {beta}: still moving, {motion:e}");
    [
        level.u[elements] - state.u_tip,
        level.phi[elements] - state.phi_tip,
        level.contact_force - state.contact_force,
    ]
}

#[test]
fn a_hot_end_drives_the_beam_to_its_steady_state_at_second_order_in_h() {
    for (beta, contact) in [
        (-0.5, Phase::Upper),
        (0.0, Phase::Upper),
        (5.0, Phase::Free),
    ] {
        let [coarse, fine] = [16, 32].map(|elements| errors(beta, contact, elements));
        for (k, (coarse, fine)) in coarse.into_iter().zip(fine).enumerate() {
            if k == 2 && contact == Phase::Free {
                assert_eq!((coarse, fine), (0.0, 0.0));
                continue;
            }
            let rate = (coarse / fine).log2();
            assert!(
                (rate - 2.0).abs() <= 0.05,
                "beta = {beta}, quantity {k}: {coarse:e} {fine:e}, rate {rate}"
            );
        }
        assert!(
            fine[0].abs() <= 1e-4 && fine[1].abs() <= 1e-4,
            "beta = {beta}: {fine:?}"
        );
    }
}

#[test]
fn a_hot_end_drives_the_beam_to_its_steady_state() {
    for beta in [-0.5, 0.0, 5.0] {
        let problem = experiment(beta, 16);
        let states = equilibria(&problem.beam, problem.obstacles.as_ref()).unwrap();
        let [state] = states.as_slice() else {
            panic!("{states:?}")
        };
        let stepping = DgStepping {
            degree: 1,
            dt: 0.1,
            ..DgStepping::default()
        };
        let mut simulation = Dg::new(problem, stepping).unwrap();
        simulation.advance(300.0).unwrap();
        close(tip(&simulation, Field::U), state.u_tip, 1e-12);
        close(tip(&simulation, Field::Phi), state.phi_tip, 1e-11);
        close(tip(&simulation, Field::V), 0.0, 1e-10);
        let expected = if state.contact == Phase::Upper {
            Phase::Upper
        } else {
            Phase::Free
        };
        assert_eq!(simulation.phase(), expected);
        for x in [0.2, 0.6] {
            close(
                simulation.value(Field::U, x, simulation.t()).unwrap(),
                state.shape.u(x),
                1e-11,
            );
            close(
                simulation.temperature(x, simulation.t()).unwrap(),
                20.0 * (1.0 - x),
                1e-10,
            );
        }
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
                    close(
                        simulation.value(Field::U, x, t).unwrap(),
                        mode.u(x) * exact.value(t),
                        1e-11,
                    );
                    close(
                        simulation.value(Field::Phi, x, t).unwrap(),
                        mode.phi(x) * exact.value(t),
                        1e-11,
                    );
                    let velocity_tolerance = if t == end { 2e-11 } else { 5e-9 };
                    close(
                        simulation.value(Field::V, x, t).unwrap(),
                        mode.u(x) * exact.slope(t),
                        velocity_tolerance,
                    );
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
        close(tip(&simulation, Field::U), factor * mode.u(1.0), 1e-3);
    }
}
