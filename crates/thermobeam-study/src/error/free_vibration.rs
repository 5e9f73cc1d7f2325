//! Free vibrations of the linear beam as exact solutions in the form of the manufactured ones.
//!
//! For a = β = ρ = 0, no obstacles and θ = 0 each damped mode solves (1.1) without any load. Written as products of a
//! function of x and a function of t it serves every reader of manufactured solutions, and its loads are all zero.

use crate::expression::{Expression, ExpressionError, Variable};
use crate::kinds::tables::{Manufactured, Product};
use thermobeam::parameters::Beam;
use thermobeam::vibration::Mode;

/// The beam that vibrates freely with viscosity ζ: everything else is switched off.
pub fn beam(zeta: f64) -> Beam {
    Beam { zeta, a: 0.0, rho: 0.0, beta: 0.0, theta_a: 0.0 }
}

/// U(x) and Φ(x) of a mode, as functions that can be read.
///
/// With `κ±² = ω² ∓ ω`, positive because every ω is above 1, `U = A [(1 - ω) S+ - (1 + ω) S-] + B [C+ - C-]` and
/// `Φ = A [C+ - C-] + B ω [S+ + S-]`; A and B follow from the slopes at the clamped end.
pub fn shape(mode: &Mode) -> [String; 2] {
    let omega = mode.omega();
    let [plus, minus] = [omega * (omega - 1.0), omega * (omega + 1.0)].map(f64::sqrt);
    let (a, b) = (-mode.u_x(0.0) / (2.0 * omega), mode.phi_x(0.0) / (2.0 * omega));
    let cosines = format!("cos({plus:e}*x) - cos({minus:e}*x)");
    let (u_plus, u_minus) = (a * (1.0 - omega) / plus, -a * (1.0 + omega) / minus);
    let (phi_plus, phi_minus) = (b * omega / plus, b * omega / minus);
    [
        format!("({u_plus:e})*sin({plus:e}*x) + ({u_minus:e})*sin({minus:e}*x) + ({b:e})*({cosines})"),
        format!("({a:e})*({cosines}) + ({phi_plus:e})*sin({plus:e}*x) + ({phi_minus:e})*sin({minus:e}*x)"),
    ]
}

/// T(t) of a mode of frequency ω released at rest with T(0) = `amplitude`; `None` where it does not ring (ζω >= 2).
pub fn factor(omega: f64, zeta: f64, amplitude: f64) -> Option<String> {
    let gamma = 0.5 * zeta * omega * omega;
    let square = (omega - gamma) * (omega + gamma);
    (square > 0.0).then(|| {
        let (ring, sine) = (square.sqrt(), amplitude * gamma / square.sqrt());
        format!("exp(-({gamma:e})*t)*(({amplitude:e})*cos({ring:e}*t) + ({sine:e})*sin({ring:e}*t))")
    })
}

/// The exact solution made of `modes`, each with its index from 0 and its tip displacement at t = 0, released at rest.
///
/// `None` where a mode does not ring: ζω >= 2.
///
/// # Errors
/// [`ExpressionError`] never, for finite amplitudes.
pub fn vibration(modes: &[(usize, f64)], zeta: f64) -> Result<Option<Manufactured>, ExpressionError> {
    let mut exact = Manufactured::default();
    for &(index, amplitude) in modes {
        let mode = Mode::new(index);
        let Some(factor) = factor(mode.omega(), zeta, amplitude) else { return Ok(None) };
        let t = Expression::parse(&factor, Variable::T)?;
        for (field, x) in [&mut exact.u, &mut exact.phi].into_iter().zip(shape(&mode)) {
            field.push(Product { x: Expression::parse(&x, Variable::X)?, t: t.clone() });
        }
    }
    Ok(Some(exact))
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermobeam::vibration::DampedMode;

    #[test]
    fn the_functions_are_those_of_the_mode() {
        for index in 0..4 {
            let mode = Mode::new(index);
            let damped = DampedMode::new(mode, 0.1).unwrap();
            let exact = vibration(&[(index, 1.0)], 0.1).unwrap().unwrap();
            for i in 0..=10 {
                let (x, t) = (f64::from(i) / 10.0, 0.3 * f64::from(i));
                assert!((exact.u[0].x.eval(x) - mode.u(x)).abs() < 1e-13, "mode {index}, u at {x}");
                assert!((exact.phi[0].x.eval(x) - mode.phi(x)).abs() < 1e-13, "mode {index}, phi at {x}");
                assert!((exact.u[0].t.eval(t) - damped.factor(t)).abs() < 1e-13, "mode {index}, factor at {t}");
            }
        }
        assert_eq!(vibration(&[(40, 1.0)], 0.1), Ok(None));
    }
}
