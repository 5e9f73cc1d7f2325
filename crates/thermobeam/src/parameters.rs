//! The coefficients of (1.1) and (1.3), validated once.

use thiserror::Error;

/// A coefficient outside the range in which the model makes sense.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{name} = {found}: allowed is {allowed}")]
pub struct ParameterError {
    /// The coefficient, by the name it has in [`Beam`] or [`Obstacles`].
    pub name: &'static str,
    /// The value given.
    pub found: f64,
    /// The values allowed, in words.
    pub allowed: &'static str,
}

/// Coefficients of the equations (1.1), all dimensionless.
///
/// The default is the paper's choice (5.1) with `beta = 0` and `theta_a = 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    /// Viscosity ζ > 0. Zero is accepted: the scheme still runs, but the theory needs ζ > 0.
    pub zeta: f64,
    /// Thermal coupling a.
    pub a: f64,
    /// Kirchhoff coefficient ρ >= 0; 0 is the linear beam.
    pub rho: f64,
    /// Axial force at rest β, of any sign.
    pub beta: f64,
    /// Temperature θ_A of the clamped end.
    pub theta_a: f64,
}

impl Default for Beam {
    fn default() -> Self {
        Self { zeta: 0.1, a: 0.017, rho: 1.0, beta: 0.0, theta_a: 0.0 }
    }
}

/// The two obstacles at the free end and their normal compliance, (1.3).
///
/// The default is the paper's choice (5.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obstacles {
    /// Compliance ε > 0; rigid obstacles as ε → 0.
    pub epsilon: f64,
    /// Position of the lower obstacle, g₁ <= 0.
    pub g1: f64,
    /// Position of the upper obstacle, g₂ >= 0.
    pub g2: f64,
}

impl Default for Obstacles {
    fn default() -> Self {
        Self { epsilon: 1e-3, g1: -0.01, g2: 0.1 }
    }
}

fn check(name: &'static str, found: f64, ok: bool, allowed: &'static str) -> Result<(), ParameterError> {
    // `ok` is false for NaN, because every comparison with NaN is.
    if ok { Ok(()) } else { Err(ParameterError { name, found, allowed }) }
}

impl Beam {
    /// Says which coefficient, if any, lies outside its range.
    pub fn validate(&self) -> Result<(), ParameterError> {
        let finite = "a finite number";
        check("zeta", self.zeta, self.zeta >= 0.0 && self.zeta.is_finite(), "a finite number >= 0")?;
        check("a", self.a, self.a.is_finite(), finite)?;
        check("rho", self.rho, self.rho >= 0.0 && self.rho.is_finite(), "a finite number >= 0")?;
        check("beta", self.beta, self.beta.is_finite(), finite)?;
        check("theta_a", self.theta_a, self.theta_a.is_finite(), finite)
    }
}

impl Obstacles {
    /// Says which coefficient, if any, lies outside its range.
    pub fn validate(&self) -> Result<(), ParameterError> {
        check("epsilon", self.epsilon, self.epsilon > 0.0 && self.epsilon.is_finite(), "a finite number > 0")?;
        check("g1", self.g1, self.g1 <= 0.0 && self.g1.is_finite(), "a finite number <= 0")?;
        check("g2", self.g2, self.g2 >= 0.0 && self.g2.is_finite(), "a finite number >= 0")
    }
}
