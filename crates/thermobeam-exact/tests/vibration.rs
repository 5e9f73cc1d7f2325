//! Exact modes against the equations, and frequencies against a dense eigenvalue problem.

use crate::prelude::*;
use thermobeam_exact::vibration::{
    Mode, SpectrumError, TimeFactor, discrete_frequencies, frequencies,
};

use crate::p1::P1Matrices;

/// All ω of the pencil (K, M) on n elements, by Cholesky of M and dense eigenvalues.
fn dense_frequencies(elements: usize) -> Vec<f64> {
    let beam = P1Matrices::new(&uniform(elements));
    let inverse = beam.mass_of_both().cholesky().expect("a positive mass").l();
    let inverse = inverse.try_inverse().expect("regular");
    let standard = &inverse * beam.stiffness_form(0.0) * inverse.transpose();
    let mut all: Vec<f64> = standard
        .symmetric_eigenvalues()
        .iter()
        .map(|lambda| lambda.sqrt())
        .collect();
    all.sort_by(f64::total_cmp);
    all
}

#[test]
fn frequencies_are_the_zeros_of_the_determinant() {
    let all = frequencies(60);
    close(all[0], 1.27396492100, 5.1e-12);
    for (i, &omega) in all.iter().enumerate() {
        let (plus, minus) = (
            (omega * omega - omega).sqrt(),
            (omega * omega + omega).sqrt(),
        );
        let determinant = 1.0 + plus.cos() * minus.cos()
            - omega * omega * (plus.sin() / plus) * (minus.sin() / minus);
        close(determinant, 0.0, 4e-15 * (1.0 + omega));
        assert!(i == 0 || omega > all[i - 1]);
    }
    // High frequencies come in pairs near (n - 1/2)π, but not symmetrically about it: none is
    // missed.
    let middle = 29.5 * std::f64::consts::PI;
    let split = 0.5 * 0.5_f64.cos();
    close(all[58], middle + (0.125 - split) / middle, 1e-5);
    close(all[59], middle + (0.125 + split) / middle, 1e-5);
}

#[test]
fn modes_solve_the_equations_and_the_boundary_conditions() {
    for index in [0, 1, 2, 3, 7, 30, 101] {
        let mode = Mode::new(index);
        let (omega, h) = (mode.omega(), 1e-4);
        let size = 1.0 + omega * omega;
        for i in 1..40 {
            let x = f64::from(i) / 40.0;
            let slope = |f: &dyn Fn(f64) -> f64| (f(x + h) - f(x - h)) / (2.0 * h);
            let truncation = 1e-8 * omega.powi(3) + 1e-10;
            close(slope(&|x| mode.u(x)), mode.u_x(x), truncation);
            close(slope(&|x| mode.phi(x)), mode.phi_x(x), truncation);
            let force = slope(&|x| mode.u_x(x)) - mode.phi_x(x) + omega * omega * mode.u(x);
            let moment =
                slope(&|x| mode.phi_x(x)) + mode.u_x(x) + (omega * omega - 1.0) * mode.phi(x);
            close(force, 0.0, truncation * size);
            close(moment, 0.0, truncation * size);
        }
        close(mode.u(1.0), 1.0, 1e-14);
        let at_ends = [
            mode.u(0.0),
            mode.phi(0.0),
            mode.u_x(1.0) - mode.phi(1.0),
            mode.phi_x(1.0),
        ];
        at_ends
            .iter()
            .for_each(|value| close(*value, 0.0, 1e-14 * size));
    }
}

/// T and T' by the Taylor series of the equation over short steps.
fn by_taylor(omega: f64, zeta: f64, start: (f64, f64), t: f64) -> (f64, f64) {
    let steps = 2000;
    let h = t / f64::from(steps);
    let (square, mut state) = (omega * omega, start);
    for _ in 0..steps {
        let (mut value, mut slope, mut derivative, mut power) = (0.0, 0.0, state, 1.0);
        for order in 1..=20 {
            value += derivative.0 * power;
            slope += derivative.1 * power;
            derivative = (derivative.1, -square * (derivative.0 + zeta * derivative.1));
            power *= h / f64::from(order);
        }
        state = (value, slope);
    }
    state
}

#[test]
fn the_time_factor_solves_its_equation_under_at_and_over_critical_damping() {
    let omega = Mode::new(0).omega();
    let critical = 2.0 / omega;
    for zeta in [
        0.0,
        0.1,
        critical * (1.0 - 1e-9),
        critical,
        critical * (1.0 + 1e-9),
        2.0 * critical,
        40.0,
    ] {
        for start in [(1.0, 0.0), (0.3, -2.0)] {
            let damped = TimeFactor::new(omega, zeta, start.0, start.1).expect("a viscosity");
            close(damped.value(0.0), start.0, 0.0);
            close(damped.slope(0.0), start.1, 0.0);
            for t in [1e-3, 0.5, 3.0, 10.0] {
                let (value, slope) = by_taylor(omega, zeta, start, t);
                close(damped.value(t), value, 3e-12);
                close(damped.slope(t), slope, 3e-12);
            }
        }
    }
}

#[test]
fn a_mode_without_frequency_moves_uniformly() {
    for zeta in [0.0, 0.1] {
        let uniform = TimeFactor::new(0.0, zeta, 0.3, -2.0).expect("a frequency");
        for t in [0.0, 0.5, 10.0] {
            assert_eq!((uniform.value(t), uniform.slope(t)), (0.3 - 2.0 * t, -2.0));
        }
    }
}

#[test]
fn an_invalid_viscosity_is_rejected() {
    let new = |zeta, velocity| TimeFactor::new(Mode::new(0).omega(), zeta, 1.0, velocity);
    for zeta in [-0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(new(zeta, 0.0).expect_err("no viscosity").name, "zeta");
    }
    assert!(new(0.1, f64::NAN).is_err() && new(0.1, 0.0).is_ok());
}

#[test]
fn overdamped_modes_are_accurate_for_long_times() {
    let damped = TimeFactor::new(Mode::new(5).omega(), 1e9, 1.0, 0.0).expect("a viscosity");
    // The slow root is -1/ζ up to 1/(ζω)²: after t = ζ the mode has fallen to 1/e.
    close(damped.value(1e9), (-1.0_f64).exp(), 1e-15);
    close(damped.slope(1e9), -(-1.0_f64).exp() * 1e-9, 1e-24);
}

#[test]
fn discrete_frequencies_are_those_of_the_dense_pencil() {
    for elements in [1, 2, 7, 40] {
        let dense = dense_frequencies(elements);
        let found = discrete_frequencies(&uniform(elements), 1, 2 * elements).expect("all of them");
        for (found, dense) in found.iter().zip(&dense) {
            close(*found, *dense, 1e-11 * dense.max(1.0) * elements as f64);
        }
    }
    let too_many = discrete_frequencies(&uniform(3), 1, 7);
    assert_eq!(
        too_many,
        Err(SpectrumError::Count {
            count: 7,
            available: 6
        })
    );
    for degree in [0, 41] {
        assert_eq!(
            discrete_frequencies(&uniform(3), degree, 1),
            Err(SpectrumError::Degree(degree))
        );
    }
}

#[test]
fn a_single_element_of_high_degree_has_the_frequencies_of_the_beam() {
    let exact = frequencies(6);
    for (degree, tolerance) in [(14, 1e-5), (20, 1e-12), (40, 1e-12)] {
        let found = discrete_frequencies(&uniform(1), degree, 6).expect("six of them");
        found
            .iter()
            .zip(&exact)
            .for_each(|(found, exact)| close(*found, *exact, tolerance));
    }
}

/// `∫₀^∞ T''² dt` of a mode that starts from 0 with velocity 1.
fn acceleration_squared(omega: f64, zeta: f64) -> f64 {
    let factor = TimeFactor::new(omega, zeta, 0.0, 1.0).expect("a mode");
    let square = omega.powi(2);
    // Every exponential has decayed to e^-15 at the end; early times have more nodes.
    let end = 15.0 / (0.5 * zeta * square).min(1.0 / zeta);
    integral(|s| {
        let t = end * s * s;
        let acceleration = -square * (zeta * factor.slope(t) + factor.value(t));
        acceleration.powi(2) * 2.0 * end * s
    })
}

#[test]
fn the_acceleration_of_a_mode_has_the_square_of_its_frequency() {
    for (index, zeta) in [(0, 0.1), (0, 1.0), (1, 0.3), (6, 0.1), (30, 0.1)] {
        let omega = Mode::new(index).omega();
        let expected = 0.5 * (zeta * omega.powi(2) + 1.0 / zeta);
        let found = acceleration_squared(omega, zeta);
        close(found / expected, 1.0, 1e-5);
    }
}

/// `∫₀^∞ ‖u_tt‖² + ‖φ_tt‖² dt` of the beam that starts straight with this velocity of u, by its
/// lowest modes.
fn acceleration_by_modes(velocity: impl Fn(f64) -> f64, zeta: f64, modes: usize) -> f64 {
    let share = |mode: Mode| {
        let norm = integral(|x| mode.u(x).powi(2) + mode.phi(x).powi(2));
        let product = integral(|x| velocity(x) * mode.u(x));
        product.powi(2) / norm * 0.5 * (zeta * mode.omega().powi(2) + 1.0 / zeta)
    };
    (0..modes).map(Mode::new).map(share).sum()
}

/// Proposition 2.7 needs (3.11): a velocity that does not vanish at the clamped end is in L², as
/// (2.7) asks, and its acceleration is not square integrable, as (2.4) asks.
#[test]
fn the_acceleration_is_square_integrable_if_the_velocity_has_a_slope() {
    let zeta = 0.1;
    // The paper's velocity (5.3), whose squares are in closed form.
    let (slope, value) = (400.0 * 2.0 / 15.0, 400.0 / 105.0);
    let expected = 0.5 * (zeta * slope + value / zeta);
    let of_paper = |modes| acceleration_by_modes(|x| 20.0 * x * (x - 1.0).powi(2), zeta, modes);
    close(of_paper(40), expected, 1e-3 * expected);

    let of_one = |modes| acceleration_by_modes(|_| 1.0, 1.0, modes);
    let [twenty, forty, eighty] = [20, 40, 80].map(of_one);
    close((eighty - forty) / (forty - twenty), 2.0, 0.02);
    // Each pair of modes adds ζ, half of ζω² times 2/ω²: there is no limit.
    close((eighty - forty) / 20.0, 1.0, 0.01);
}
