//! The Kirchhoff nonlinearity: the axial force N(u), (2.3), and its energy, a term of (2.5).

use crate::parameters::Beam;

/// Buckling force of the clamped-free Timoshenko beam: `κ²/(1 + κ²)` with κ = π/2, 0.711600.
///
/// `‖v_x - w‖² + ‖w_x‖² >= BUCKLING ‖v_x‖²` for all v, w that vanish at 0: for given v_x the
/// minimising w solves `-w'' + w = v_x`, `w(0) = w'(1) = 0`. On the modes `v_x = (1 + κ²) sin κx`,
/// `w = sin κx`, κ = (k - ½)π, which are complete and orthogonal, the quotient is κ²/(1 + κ²),
/// smallest for k = 1. The straight beam is stable for N > -BUCKLING.
pub const BUCKLING: f64 = {
    let kappa_squared = std::f64::consts::FRAC_PI_2 * std::f64::consts::FRAC_PI_2;
    kappa_squared / (1.0 + kappa_squared)
};

impl Beam {
    /// Axial force `N(u) = β + ρ ‖u_x‖²`, (2.3), for given `slope_squared` = ‖u_x‖².
    pub fn axial_force(&self, slope_squared: f64) -> f64 {
        self.beta + self.rho * slope_squared
    }

    /// Kirchhoff energy for given ‖u_x‖²: `N²/(4ρ)` of (2.5) for ρ > 0; `β/2 ‖u_x‖²` for the linear
    /// beam, which is the same up to the constant β²/(4ρ) in the limit ρ → 0.
    pub fn kirchhoff_energy(&self, slope_squared: f64) -> f64 {
        if self.rho > 0.0 {
            let n = self.axial_force(slope_squared);
            0.25 * n * n / self.rho
        } else {
            0.5 * self.beta * slope_squared
        }
    }

    /// Change of the Kirchhoff energy between two values of ‖u_x‖², without cancellation:
    /// `½ (N + N0)/2 (‖u_x‖² - ‖u0_x‖²)`, for every ρ >= 0.
    pub fn kirchhoff_energy_change(&self, slope_squared: f64, slope_squared_0: f64) -> f64 {
        let mean = self.beta + 0.5 * self.rho * (slope_squared + slope_squared_0);
        0.5 * mean * (slope_squared - slope_squared_0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_buckling_force_is_that_of_the_continuous_beam() {
        assert!((BUCKLING - 0.711600).abs() < 5e-7);
    }
}
