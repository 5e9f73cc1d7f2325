//! A-posteriori bound on the distance of an iterate to the solution of its step.
//!
//! After a pass the residual of (3.7) is `((m⁺ - m) K u½ + (m - m̄) dt/2 K δV, 0, 0)`. Its dual
//! norm with respect to ‖V_x‖ is at most `c = |m⁺ - m| ‖u½_x‖ + |m - m̄| dt/2 ‖δV_x‖`. Test the
//! equation of the next increment with the increment itself: the couplings through a and C cancel
//! or complete squares, contact is monotone, and
//!
//! ```text
//! κ(‖V‖² + ‖W‖²) + s(‖V_x - W‖² + ‖W_x‖²) + m dt/2 ‖V_x‖² + 2/dt ‖Θ‖² + ‖Θ_x‖² <= c ‖V_x‖,   s = ζ + dt/2.
//! ```
//!
//! With `‖V_x - W‖² + ‖W_x‖² >= B ‖V_x‖²`, B the buckling force, this gives `λ ‖V_x‖² <= c ‖V_x‖`,
//! `λ = B s + m dt/2`. Each square of the norm of (3.14) is at most 2 dt times a term above, so the
//! next increment is at most `√(2 dt/λ) c`, times `√(1 + |m| dt/(2λ))` for m < 0. In the same way a
//! pass multiplies an error by at most `q = dt/λ (|m - m̄|/2 + ρ ‖u½_x‖ ‖u_x‖)`, so the distance to
//! the solution is at most that bound divided by 1 - q.

use crate::kirchhoff::BUCKLING;
use crate::lanes::Lane;
use crate::solve::newton::Newton;

/// The bounds after a pass.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bound {
    /// ½(N(u) + N(u0)) of the iterate.
    pub(super) m: f64,
    /// Bound on the next increment.
    pub(super) increment: f64,
    /// Bound on the distance to the solution.
    pub(super) remaining: f64,
    /// q, bound on the contraction factor.
    pub(super) contraction: f64,
}

impl<T: Lane, const B: usize> Newton<T, B> {
    /// Coercivity constant λ of the module documentation.
    pub(super) fn coercivity(&self, k: usize, m: f64) -> f64 {
        let case = &self.cases[k];
        BUCKLING * (case.beam.zeta + 0.5 * case.dt) + 0.5 * m * case.dt
    }

    /// The contribution of a factorisation for m̄ instead of m to q.
    pub(super) fn kept_contraction(&self, k: usize, m: f64) -> f64 {
        let lambda = self.coercivity(k, m);
        let lag = 0.5 * self.cases[k].dt * (m - self.controls[k].factorized).abs();
        if lag == 0.0 {
            0.0
        } else if lambda > 0.0 {
            lag / lambda
        } else {
            f64::INFINITY
        }
    }

    /// The bounds of the module documentation for the last pass.
    pub(super) fn bound(&self, k: usize) -> Bound {
        let (case, control) = (&self.cases[k], &self.controls[k]);
        let n = case.beam.axial_force(control.new_slope_squared);
        let m = 0.5 * (n + control.forces[0]);
        let slope = control.new_slope_squared.sqrt();
        // ‖u½_x‖ is at most the mean of the norms at both levels.
        let half_slope = 0.5 * (control.slope_squared.sqrt() + slope);
        let lag = (control.m - control.factorized).abs();
        let residual =
            (m - control.m).abs() * half_slope + 0.5 * lag * case.dt * control.increment_slope;
        if residual == 0.0 {
            return Bound {
                m,
                increment: 0.0,
                remaining: 0.0,
                contraction: 0.0,
            };
        }
        let lambda = self.coercivity(k, m);
        if !(lambda > 0.0) {
            return Bound {
                m,
                increment: f64::INFINITY,
                remaining: f64::INFINITY,
                contraction: f64::INFINITY,
            };
        }
        let negative = (1.0 + (-m).max(0.0) * case.dt / (2.0 * lambda)).sqrt();
        let increment = (2.0 * case.dt / lambda).sqrt() * negative * residual;
        let contraction = case.dt / lambda * (0.5 * lag + case.beam.rho * half_slope * slope);
        let remaining = if contraction < 0.5 {
            increment / (1.0 - contraction)
        } else {
            f64::INFINITY
        };
        Bound {
            m,
            increment,
            remaining,
            contraction,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Beam;
    use crate::scheme::SteppedBeam;
    use crate::solve::{Settings, TimeLevel};

    const DT: f64 = 0.5;

    /// One element, β and ρ as given, ζ = 1.
    fn stepper(beta: f64, rho: f64) -> Newton<f64, 2> {
        let beam = Beam {
            beta,
            rho,
            zeta: 1.0,
            ..Beam::default()
        };
        let case = SteppedBeam::free(beam, DT, &[1.0]);
        Newton::new(vec![case], Settings::default(), &[&TimeLevel::new(2)])
    }

    /// Sets the state after a pass with m and a factorisation for m̄: ‖u_x‖ is 1/2, and 1 at the
    /// old level.
    fn passed(newton: &mut Newton<f64, 2>, m: f64, factorized: f64) {
        let control = &mut newton.controls[0];
        (
            control.new_slope_squared,
            control.slope_squared,
            control.increment_slope,
        ) = (0.25, 1.0, 0.375);
        (control.m, control.factorized) = (m, factorized);
    }

    /// The formulas of the module documentation for compression and tension, with q below and above
    /// one half.
    #[test]
    fn the_bound_equals_the_documented_formula() {
        for (beta, rho, finite) in [
            (-2.0, 0.125, true),
            (-2.0, 2.0, false),
            (3.0, 0.125, true),
            (3.0, 8.0, false),
            (3.0, 0.5, true),
        ] {
            let mut newton = stepper(beta, rho);
            newton.controls[0].forces[0] = beta + 1.0;
            passed(&mut newton, beta + 0.75, beta + 0.625);
            let bound = newton.bound(0);

            let m = beta + (0.25 * rho + 1.0) / 2.0;
            let c = (m - (beta + 0.75)).abs() * 0.75 + 0.125 * 0.25 * 0.375;
            let lambda = BUCKLING * 1.25 + m * 0.25;
            let soft = if m < 0.0 {
                1.0 + m.abs() * 0.25 / lambda
            } else {
                1.0
            };
            let increment = (1.0 / lambda * soft).sqrt() * c;
            let q = 0.5 * (0.125 / 2.0 + rho * 0.75 * 0.5) / lambda;
            let close =
                |found: f64, expected: f64| (found - expected).abs() <= 1e-14 * expected.abs();
            assert!(
                lambda > 0.0 && (q < 0.5) == finite,
                "expected λ > 0 and q on the given side of 1/2: {lambda}, {q}"
            );
            assert_eq!(bound.m, m);
            assert!(
                close(bound.increment, increment) && close(bound.contraction, q),
                "{bound:?}, {increment}, {q}"
            );
            let remaining = if finite {
                increment / (1.0 - q)
            } else {
                f64::INFINITY
            };
            assert!(
                bound.remaining == remaining || close(bound.remaining, remaining),
                "{bound:?}, {remaining}"
            );
            assert!(close(newton.coercivity(0, m), lambda));
            let kept = newton.kept_contraction(0, m);
            assert!(
                close(kept, 0.25 * (m - (beta + 0.625)).abs() / lambda),
                "{kept}"
            );
        }
    }

    #[test]
    fn the_bound_is_zero_without_residual_and_infinite_without_coercivity() {
        let mut newton = stepper(1.0, 0.0);
        passed(&mut newton, 1.0, 1.0);
        let exact = newton.bound(0);
        assert_eq!(
            [exact.m, exact.increment, exact.remaining, exact.contraction],
            [1.0, 0.0, 0.0, 0.0]
        );
        assert_eq!(newton.kept_contraction(0, 1.0), 0.0);

        // λ = 1.25 B + m/4 is negative, and exactly zero.
        for beta in [-5.0, -5.0 * BUCKLING] {
            let mut newton = stepper(beta, 0.0);
            passed(&mut newton, -4.0, -4.0);
            let lost = newton.bound(0);
            let coercivity = newton.coercivity(0, beta);
            assert_eq!(coercivity == 0.0, beta > -5.0);
            assert!(coercivity <= 0.0);
            assert_eq!(
                [lost.increment, lost.remaining, lost.contraction],
                [f64::INFINITY; 3]
            );
            assert_eq!(
                [beta, -4.0].map(|m| newton.kept_contraction(0, m)),
                [f64::INFINITY, 0.0]
            );
        }
    }

    /// q = (m - m̄)/(4 λ) is exactly one half.
    #[test]
    fn the_bound_is_infinite_at_contraction_one_half() {
        let mut newton = stepper(1.0, 0.0);
        let lambda = newton.coercivity(0, 1.0);
        passed(&mut newton, 2.0 * lambda, 0.0);
        let half = newton.bound(0);
        assert!(
            half.contraction == 0.5 && half.increment.is_finite(),
            "{half:?}"
        );
        assert_eq!(half.remaining, f64::INFINITY);
    }
}
