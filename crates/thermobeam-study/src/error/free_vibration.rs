//! Free vibrations of the linear beam as exact solutions in the form of the manufactured ones.
//!
//! For a = β = ρ = 0 and no obstacles each damped mode solves (1.1) without any load, and so does
//! `sin kπx e^{-κ²t}`, κ = kπ, as a temperature. Sums of such products work wherever manufactured
//! solutions do; their loads are zero.

use std::f64::consts::PI;

use crate::exact::function::Factor;
use crate::exact::solution::{Manufactured, Product};
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, ParameterError};
use thermobeam_exact::vibration::{Mode, TimeFactor};

/// The freely vibrating beam with viscosity ζ: all other terms are switched off.
pub fn beam(zeta: f64) -> Beam {
    Beam {
        zeta,
        a: 0.0,
        rho: 0.0,
        beta: 0.0,
        theta_a: 0.0,
    }
}

/// The P1 function with the given values at the nodes of a mesh; its second derivative is 0 on each
/// element.
pub(crate) fn piecewise_linear(mesh: &Mesh, values: Vec<f64>) -> Factor {
    let nodes = mesh.nodes().to_vec();
    Factor::new(move |x: f64| {
        let left = nodes
            .partition_point(|node| *node <= x)
            .clamp(1, nodes.len() - 1)
            - 1;
        let length = nodes[left + 1] - nodes[left];
        let fraction = (x - nodes[left]) / length;
        let value = (1.0 - fraction) * values[left] + fraction * values[left + 1];
        [value, (values[left + 1] - values[left]) / length, 0.0]
    })
}

/// T of a mode of frequency ω with T(0) and T'(0); its second derivative by `T'' = -ω² (T + ζ T')`.
///
/// # Errors
/// [`ParameterError`] if ω or ζ is negative or not finite.
pub(crate) fn damped(omega: f64, zeta: f64, start: [f64; 2]) -> Result<Factor, ParameterError> {
    let factor = TimeFactor::new(omega, zeta, start[0], start[1])?;
    Ok(Factor::new(move |t: f64| {
        let (value, slope) = (factor.value(t), factor.slope(t));
        [value, slope, -omega.powi(2) * (value + zeta * slope)]
    }))
}

/// A temperature that decays: `start e^{-rate t}`.
pub(crate) fn decay(rate: f64, start: f64) -> Factor {
    Factor::new(move |t: f64| {
        let value = start * (-rate * t).exp();
        [value, -rate * value, rate * rate * value]
    })
}

/// Adds a mode by its index from 0, with its tip displacement and velocity at t = 0.
///
/// # Errors
/// [`ParameterError`] if ζ is negative or not finite.
pub(crate) fn add_mode(
    exact: &mut Manufactured,
    index: usize,
    zeta: f64,
    start: [f64; 2],
) -> Result<(), ParameterError> {
    let mode = Mode::new(index);
    let (t, square) = (damped(mode.omega(), zeta, start)?, mode.omega().powi(2));
    // Second derivatives by the mode's equations `U'' = Φ' - ω² U` and `Φ'' = Φ - U' - ω² Φ`.
    exact.u.push(Product {
        x: Factor::new(move |x| [mode.u(x), mode.u_x(x), mode.phi_x(x) - square * mode.u(x)]),
        t: t.clone(),
    });
    exact.phi.push(Product {
        x: Factor::new(move |x| {
            [
                mode.phi(x),
                mode.phi_x(x),
                mode.phi(x) - mode.u_x(x) - square * mode.phi(x),
            ]
        }),
        t,
    });
    Ok(())
}

/// Adds the temperature `amplitude sin kπx e^{-κ²t}`, κ = kπ.
pub(crate) fn add_temperature(exact: &mut Manufactured, k: usize, amplitude: f64) {
    let kappa = k as f64 * PI;
    exact.theta.push(Product {
        x: Factor::new(move |x: f64| {
            let (sine, cosine) = (kappa * x).sin_cos();
            [sine, kappa * cosine, -kappa * kappa * sine]
        }),
        t: decay(kappa * kappa, amplitude),
    });
}

/// The exact solution made of `modes`, each with its index from 0 and its tip displacement at t =
/// 0, released at rest.
///
/// # Errors
/// [`ParameterError`] if ζ is negative or not finite.
pub fn vibration(modes: &[(usize, f64)], zeta: f64) -> Result<Manufactured, ParameterError> {
    let mut exact = Manufactured::default();
    modes
        .iter()
        .try_for_each(|&(index, amplitude)| add_mode(&mut exact, index, zeta, [amplitude, 0.0]))?;
    Ok(exact)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares derivatives with central differences, to a tolerance far above round-off.
    #[track_caller]
    fn check(function: &Factor, at: f64, size: f64) {
        const H: f64 = 1e-4;
        let [left, middle, right] = [at - H, at, at + H].map(|x| function.eval(x));
        let [value, first, second] = function.derivatives(at);
        assert_eq!(value, middle, "{at}");
        assert!(
            (first - (right - left) / (2.0 * H)).abs() < 1e-6 * size,
            "{at}: {first}"
        );
        assert!(
            (second - (right - 2.0 * middle + left) / (H * H)).abs() < 1e-4 * size,
            "{at}: {second}"
        );
    }

    #[test]
    fn derivatives_are_those_of_the_functions() {
        // Two oscillating modes, and an overdamped one of index 20.
        let mut exact = vibration(&[(0, 1.0), (3, 0.2), (20, 1e-4)], 0.1).expect("a vibration");
        add_temperature(&mut exact, 3, 2.0);
        for x in [0.1, 0.37, 0.8] {
            exact.u[..2]
                .iter()
                .chain(&exact.phi[..2])
                .chain(&exact.theta)
                .for_each(|product| check(&product.x, x, 1e3));
            exact
                .u
                .iter()
                .chain(&exact.theta)
                .for_each(|product| check(&product.t, x, 1e3));
        }
    }

    #[test]
    fn a_piecewise_linear_function_has_its_values_at_the_nodes_to_the_last_bit() {
        let mesh = Mesh::from_nodes(vec![0.0, 0.3, 0.7, 1.0]).expect("a mesh");
        let values = vec![0.1, -1.0 / 3.0, 2.0, 0.7];
        let function = piecewise_linear(&mesh, values.clone());
        for (x, value) in mesh.nodes().iter().zip(values) {
            assert_eq!(function.eval(*x), value);
        }
        let [value, slope, curvature] = function.derivatives(0.5);
        assert!(
            (value - 2.5 / 3.0).abs() < 1e-15
                && (slope - 17.5 / 3.0).abs() < 1e-14
                && curvature == 0.0
        );
    }
}
