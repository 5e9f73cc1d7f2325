//! Contraction factors of the paper's fixed-point iteration (4.1)-(4.5).
//!
//! The paper does not analyse the convergence of its iteration. Two of the quantities that (4.2) takes from the
//! previous iterate determine it:
//!
//! * g(u) in the first equation: in contact an error is multiplied by [`contact_contraction`] in each iteration;
//! * u and û in the second equation: without contact an error is multiplied by [`coupling_contraction`].
//!
//! The iteration diverges for a factor above 1. The effects of the previous N(u) and φ̂ in the first and third equation
//! are smaller, of order dt².

use crate::norms::{l2_squared, slope_squared};
use crate::parameters::{Beam, Obstacles};
use crate::scheme::{ContactRule, Scheme};
use crate::tridiagonal::TridiagonalFactor;

/// Contraction factor of the fixed point while the tip is in contact, `α = dt g' [A_u⁻¹]_nn`.
///
/// `A_u = κ M + (ζ + dt (1 + N)/2) K` is the matrix of the first equation of (4.2), κ = inertia/dt, and g' the slope of
/// the contact force: 1/ε, or half of it for the discrete gradient. The contact force of the previous iterate enters
/// the right- hand side at the tip only, so an error e of u(1) becomes -α e. On a fine mesh `α ≈ dt^{3/2}/(ε √ζ)`, up
/// to terms in dt/ζ.
///
/// * `lengths`: length of each element.
/// * `n_value`: the mean axial force ½(N(u) + N(u0)) of the step.
/// * Returns infinity if A_u is not positive definite: then the fixed point cannot do the step.
pub fn contact_contraction(
    beam: &Beam,
    obstacles: &Obstacles,
    lengths: &[f64],
    scheme: &Scheme,
    dt: f64,
    n_value: f64,
) -> f64 {
    let slope = match scheme.contact {
        ContactRule::Implicit => 1.0 / obstacles.epsilon,
        ContactRule::DiscreteGradient => 0.5 / obstacles.epsilon,
    };
    let stiffness = beam.zeta + 0.5 * dt * (1.0 + n_value);
    let mut factor = TridiagonalFactor::new(lengths.len());
    match factor.factorize(lengths, scheme.inertia / dt, stiffness, n_value) {
        Ok(()) => dt * slope * factor.last_of_inverse(),
        Err(_) => f64::INFINITY,
    }
}

/// Largest number of power iterations, and the relative change of the quotient at which they stop.
const ITERATIONS: usize = 300;
const RELATIVE_CHANGE: f64 = 1e-13;

/// Contraction factor of the fixed point without contact, from the coupling of rotation and displacement.
///
/// An error of V enters the second equation of (4.2) as `s Cᵀ V`, and the resulting error of W enters the first as
/// `s C W`. The factor is therefore the largest eigenvalue of `s² A_u⁻¹ C A_φ⁻¹ Cᵀ`, with
///
/// ```text
/// A_u = κ M + s' K,   A_φ = (κ + s) M + s K,   κ = inertia/dt,   s = ζ + dt/2,   s' = s + dt N/2.
/// ```
///
/// A wave of wavenumber k in the interior has the factor `s²k²/((κ + s' k²)(κ + s (1 + k²)))`, at most about dt s/4.
/// A layer at the free end has a larger one, `s²/(s' (κ + s) + √(s s' κ (κ + s)))` if it is thin, about dt s/2.
/// For N = 0 the factor is below `1/(1 + π²/4) = 0.2884` for all dt, its limit for dt → ∞.
///
/// * `lengths`: length of each element.
/// * `n_value`: the mean axial force ½(N(u) + N(u0)) of the step.
/// * Returns infinity if A_u is not positive definite.
pub fn coupling_contraction(beam: &Beam, lengths: &[f64], scheme: &Scheme, dt: f64, n_value: f64) -> f64 {
    let n = lengths.len();
    let (kappa, s) = (scheme.inertia / dt, beam.zeta + 0.5 * dt);
    let stiffness_u = s + 0.5 * dt * n_value;
    let (mut of_u, mut of_phi) = (TridiagonalFactor::new(n), TridiagonalFactor::new(n));
    let factorized = of_u
        .factorize(lengths, kappa, stiffness_u, n_value)
        .and_then(|()| of_phi.factorize(lengths, kappa + s, s, n_value));
    if factorized.is_err() {
        return f64::INFINITY;
    }
    // A load at the tip starts in the layer there and contains every mode.
    let mut v = vec![0.0; n + 1];
    v[n] = 1.0;
    of_u.solve_in_place(&mut v);
    let (mut w, mut image) = (vec![0.0; n + 1], vec![0.0; n + 1]);
    let mut factor = 0.0;
    for _ in 0..ITERATIONS {
        let size = (kappa * l2_squared(lengths, &v) + stiffness_u * slope_squared(lengths, &v)).sqrt();
        v.iter_mut().for_each(|v| *v /= size);
        to_rotation(s, &v, &mut w);
        of_phi.solve_in_place(&mut w);
        to_displacement(s, &w, &mut image);
        // The quotient (V, s C W)/(V, A_u V).
        let quotient: f64 = v.iter().zip(&image).map(|(v, image)| v * image).sum();
        image[0] = 0.0;
        of_u.solve_in_place(&mut image);
        std::mem::swap(&mut v, &mut image);
        let change = (quotient - factor).abs();
        factor = quotient;
        if change <= RELATIVE_CHANGE * factor {
            break;
        }
    }
    factor
}

/// `w = s Cᵀ v`, zero at the clamped node.
fn to_rotation(s: f64, v: &[f64], w: &mut [f64]) {
    w.fill(0.0);
    for i in 0..v.len() - 1 {
        let shear = 0.5 * s * (v[i + 1] - v[i]);
        w[i] += shear;
        w[i + 1] += shear;
    }
    w[0] = 0.0;
}

/// `v = s C w`.
fn to_displacement(s: f64, w: &[f64], v: &mut [f64]) {
    v.fill(0.0);
    for i in 0..w.len() - 1 {
        let stress = 0.5 * s * (w[i] + w[i + 1]);
        v[i] -= stress;
        v[i + 1] += stress;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scheme::{EULER_CRANK_NICOLSON, MIDPOINT};

    #[test]
    fn the_contact_factor_agrees_with_measured_values() {
        // Measured with an independent implementation, 100 elements, to the digits given.
        let rows = [
            (1e-3, 0.1, 1e-4, 0.00234, 5e-6),
            (1e-3, 0.1, 1e-3, 0.0959, 5e-5),
            (1e-3, 0.1, 3e-3, 0.509, 5e-4),
            (1e-4, 0.1, 1e-3, 0.959, 5e-4),
            (1e-3, 0.01, 1e-3, 0.230, 5e-4),
        ];
        for (epsilon, zeta, dt, expected, half_a_digit) in rows {
            let (beam, obstacles) = (Beam { zeta, ..Beam::default() }, Obstacles { epsilon, ..Obstacles::default() });
            let alpha = contact_contraction(&beam, &obstacles, &[0.01; 100], &EULER_CRANK_NICOLSON, dt, 0.0);
            assert!((alpha - expected).abs() <= 1.5 * half_a_digit, "{alpha} for {expected}");
        }
    }

    #[test]
    fn on_one_element_the_contact_factor_is_the_closed_formula() {
        let (beam, obstacles) =
            (Beam { zeta: 0.3, ..Beam::default() }, Obstacles { epsilon: 0.01, ..Obstacles::default() });
        let (dt, n_value) = (0.1, 2.0);
        for (scheme, slope) in [(EULER_CRANK_NICOLSON, 100.0), (MIDPOINT, 50.0)] {
            // The tip's hat function has the mass 1/3 and the stiffness 1.
            let operator = scheme.inertia / dt / 3.0 + 0.3 + 0.5 * dt * 3.0;
            let found = contact_contraction(&beam, &obstacles, &[1.0], &scheme, dt, n_value);
            assert!((found / (dt * slope / operator) - 1.0).abs() < 1e-14, "{found}");
        }
    }

    #[test]
    fn the_coupling_factor_is_that_of_a_thin_layer_at_the_free_end() {
        let beam = Beam { zeta: 0.1, ..Beam::default() };
        for scheme in [EULER_CRANK_NICOLSON, MIDPOINT] {
            for (dt, n_value) in [(1e-3, 0.0), (1e-3, 200.0), (1e-2, -0.5)] {
                let (kappa, s) = (scheme.inertia / dt, beam.zeta + 0.5 * dt);
                let stiffness_u = s + 0.5 * dt * n_value;
                let layer = s * s / (stiffness_u * (kappa + s) + (s * stiffness_u * kappa * (kappa + s)).sqrt());
                let found = coupling_contraction(&beam, &[1e-3; 1000], &scheme, dt, n_value);
                assert!((found - layer).abs() <= 0.01 * layer, "{found} for {layer}");
            }
        }
    }

    #[test]
    fn the_coupling_factor_stays_below_its_limit_for_large_steps() {
        let limit = 1.0 / (1.0 + std::f64::consts::PI.powi(2) / 4.0);
        let of = |dt| coupling_contraction(&Beam::default(), &[0.01; 100], &EULER_CRANK_NICOLSON, dt, 0.0);
        let mut last = 0.0;
        for exponent in -4..=4 {
            let factor = of(10f64.powi(exponent));
            assert!(last < factor && factor < limit, "{factor}");
            last = factor;
        }
        assert!((last - limit).abs() <= 1e-3 * limit, "{last} for {limit}");
    }

    #[test]
    fn the_contraction_factor_of_an_indefinite_operator_is_infinite() {
        let (beam, obstacles) = (Beam::default(), Obstacles::default());
        let alpha = contact_contraction(&beam, &obstacles, &[0.1; 10], &EULER_CRANK_NICOLSON, 10.0, -3.0);
        assert_eq!(alpha, f64::INFINITY);
        assert_eq!(coupling_contraction(&beam, &[0.1; 10], &EULER_CRANK_NICOLSON, 10.0, -3.0), f64::INFINITY);
    }
}
