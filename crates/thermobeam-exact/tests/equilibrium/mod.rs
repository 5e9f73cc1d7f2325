//! Steady states against reference values, the strong form, a discretisation, and the degree of the
//! energy's gradient.

mod buckling;
mod completeness;
mod discrete;
mod roots;

use crate::prelude::*;
use thermobeam_exact::equilibrium::equilibria;
use thermobeam_exact::norm::max_or_nan;

fn heated(beta: f64, theta_a: f64) -> Beam {
    Beam {
        beta,
        theta_a,
        ..Beam::default()
    }
}

/// A beam with the thermal moment aθ_A = `moment`.
fn loaded(beta: f64, rho: f64, moment: f64) -> Beam {
    Beam {
        zeta: 0.1,
        beta,
        rho,
        a: 1.0,
        theta_a: moment,
    }
}

fn obstacles(epsilon: f64, g1: f64, g2: f64) -> Option<Obstacles> {
    Some(Obstacles { epsilon, g1, g2 })
}

#[track_caller]
fn states(beam: &Beam, obstacles: Option<&Obstacles>) -> Vec<Equilibrium> {
    equilibria(beam, obstacles).unwrap_or_else(|error| panic!("{beam:?} {obstacles:?}: {error}"))
}

/// Scenes of all kinds: buckled or not, pushed up and down, hard, soft and no obstacles, strong
/// stretching.
fn scenes() -> Vec<(Beam, Option<Obstacles>)> {
    let paper = Some(Obstacles::default());
    vec![
        (heated(-0.5, 20.0), paper),
        (heated(0.0, 20.0), paper),
        (heated(5.0, 20.0), paper),
        (heated(-0.8, 0.0), paper),
        (heated(-0.8, 0.0), None),
        (heated(-0.8, 0.5), None),
        (heated(-0.97, 0.1), None),
        (heated(-0.99, 5.0), paper),
        (heated(-5.0, 20.0), paper),
        (loaded(-0.9, 1e4, -5.1), paper),
        (loaded(0.0, 1e6, -3000.0), None),
        (loaded(-0.985, 2.0, -0.3), obstacles(1e-8, -0.05, 0.0)),
        (loaded(-0.96, 0.5, 0.0), obstacles(1e-8, 0.0, 0.0)),
        (loaded(-0.75, 0.01, 0.02), obstacles(1.0, -0.3, 0.2)),
        (loaded(-2.0, 1.0, 1.5), obstacles(1.0, -0.3, 0.2)),
        (loaded(-5.0, 0.3, -2.0), obstacles(0.5, 0.0, 0.4)),
        (loaded(-5.0, 1.0, 0.0), obstacles(0.5, 0.0, 0.0)),
        (loaded(-5.0, 1.0, 0.0), None),
        (loaded(200.0, 0.0, -7.0), paper),
        (loaded(-0.8, 0.0, 0.3), paper),
    ]
}

/// Largest residual of both equations in the interior, with difference quotients of width h.
fn strong_residual(beam: &Beam, state: &Equilibrium, h: f64) -> f64 {
    let moment = beam.a * beam.theta_a;
    let residual = |x: f64| {
        let difference = |f: &dyn Fn(f64) -> f64| (f(x + h) - f(x - h)) / (2.0 * h);
        let second = |f: &dyn Fn(f64) -> f64| (f(x + h) - 2.0 * f(x) + f(x - h)) / (h * h);
        let (u, phi) = (|x| state.shape.u(x), |x| state.shape.phi(x));
        let force = (1.0 + state.n_value) * second(&u) - difference(&phi);
        let moment = second(&phi) + difference(&u) - phi(x) + moment;
        let slopes = (difference(&u) - state.shape.u_x(x)).abs()
            + (difference(&phi) - state.shape.phi_x(x)).abs();
        force.abs() + moment.abs() + slopes
    };
    (1..20)
        .map(|i| residual(f64::from(i) / 20.0))
        .fold(0.0, max_or_nan)
}

/// ∫ u_x².
fn slope_squared(state: &Equilibrium) -> f64 {
    integral(|x| state.shape.u_x(x).powi(2))
}

#[test]
fn every_state_solves_the_strong_form() {
    for (beam, obstacles) in scenes() {
        for state in states(&beam, obstacles.as_ref()) {
            let size = 1.0
                + (0..=20)
                    .map(|i| state.shape.u_x(f64::from(i) / 20.0).abs())
                    .fold(0.0, max_or_nan);
            let [coarse, fine] = [4e-3, 2e-3].map(|h| strong_residual(&beam, &state, h));
            assert!(
                fine <= 0.27 * coarse || fine <= 1e-8 * size,
                "{beam:?} {state:?}: {coarse:e} {fine:e}"
            );
            let stress = (1.0 + state.n_value) * state.shape.u_x(1.0) - state.shape.phi(1.0);
            close(stress, -state.contact_force, 1e-12 * size);
            for (found, name) in [
                (state.shape.u(0.0), "u(0)"),
                (state.shape.phi(0.0), "phi(0)"),
                (state.shape.phi_x(1.0), "phi_x(1)"),
            ] {
                assert!(
                    found.abs() <= 2e-13 * size,
                    "{name} = {found:e} of {beam:?} {state:?}"
                );
            }
            close(state.shape.u(1.0), state.u_tip, 2e-13 * size);
            let slope_squared = slope_squared(&state);
            close(
                state.n_value,
                beam.beta + beam.rho * slope_squared,
                1e-8 * (1.0 + beam.rho * slope_squared),
            );
            let force = obstacles.map_or([0.0; 2], |o| {
                let depth = (state.u_tip - o.g2).max(0.0) - (o.g1 - state.u_tip).max(0.0);
                let round_off = 4.0 * f64::EPSILON * state.u_tip.abs();
                [depth / o.epsilon, round_off / o.epsilon]
            });
            close(state.contact_force, force[0], force[1]);
        }
    }
    // To ten decimals, by an independent implementation.
    let hot = states(&heated(-0.5, 20.0), Some(&Obstacles::default()));
    close(hot[0].phi_tip, 0.1760200007, 5.1e-11);
}
