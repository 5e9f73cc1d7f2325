//! The coefficients of (1.1) and (1.3) and their ranges.

use std::borrow::Cow;

use thiserror::Error;

/// A coefficient or a setting out of its range.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{name}: expected {allowed}, found {found}")]
pub struct ParameterError {
    /// Its name: for a coefficient, as in [`Beam`] or [`Obstacles`].
    pub name: &'static str,
    /// The value given.
    pub found: f64,
    /// The allowed range, in words.
    pub allowed: Cow<'static, str>,
}

/// Coefficients of the equations (1.1), all dimensionless.
///
/// The default is the paper's choice (5.1) with `beta = 0` and `theta_a = 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    /// Viscosity ζ > 0. Zero is accepted, but the theory of the paper needs ζ > 0.
    pub zeta: f64,
    /// Thermal coupling a.
    pub a: f64,
    /// Kirchhoff coefficient ρ >= 0; the beam is linear for ρ = 0.
    pub rho: f64,
    /// Axial force at rest β, of any sign.
    pub beta: f64,
    /// Temperature θ_A of the clamped end, (1.3).
    pub theta_a: f64,
}

impl Default for Beam {
    fn default() -> Self {
        Self {
            zeta: 0.1,
            a: 0.017,
            rho: 1.0,
            beta: 0.0,
            theta_a: 0.0,
        }
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
        Self {
            epsilon: 1e-3,
            g1: -0.01,
            g2: 0.1,
        }
    }
}

/// Refuses a value that is not a finite number > 0.
pub(crate) fn check_positive(name: &'static str, found: f64) -> Result<(), ParameterError> {
    check(
        name,
        found,
        found > 0.0 && found.is_finite(),
        "a finite number > 0",
    )
}

/// Refuses a tolerance and a limit with which no iteration can end as converged.
pub(crate) fn check_stopping(tolerance: f64, max_iterations: usize) -> Result<(), ParameterError> {
    check_positive("tolerance", tolerance)?;
    check(
        "max_iterations",
        max_iterations as f64,
        max_iterations > 0,
        "an integer >= 1",
    )
}

/// Refuses a value that is not allowed.
///
/// * `is_allowed` is false for NaN, as every comparison with NaN is.
/// * `allowed`: the values expected, in words.
///
/// # Errors
/// [`ParameterError`] with these words, unless `is_allowed`.
#[doc(hidden)]
pub fn check(
    name: &'static str,
    found: f64,
    is_allowed: bool,
    allowed: impl Into<Cow<'static, str>>,
) -> Result<(), ParameterError> {
    if is_allowed {
        Ok(())
    } else {
        Err(ParameterError {
            name,
            found,
            allowed: allowed.into(),
        })
    }
}

impl Beam {
    /// Checks the range of every coefficient.
    ///
    /// # Errors
    /// [`ParameterError`] for the first coefficient out of range.
    pub fn validate(&self) -> Result<(), ParameterError> {
        let finite = "a finite number";
        check(
            "zeta",
            self.zeta,
            self.zeta >= 0.0 && self.zeta.is_finite(),
            "a finite number >= 0",
        )?;
        check("a", self.a, self.a.is_finite(), finite)?;
        check(
            "rho",
            self.rho,
            self.rho >= 0.0 && self.rho.is_finite(),
            "a finite number >= 0",
        )?;
        check("beta", self.beta, self.beta.is_finite(), finite)?;
        check("theta_a", self.theta_a, self.theta_a.is_finite(), finite)
    }
}

impl Obstacles {
    /// Checks the range of every coefficient.
    ///
    /// # Errors
    /// [`ParameterError`] for the first coefficient out of range.
    pub fn validate(&self) -> Result<(), ParameterError> {
        check_positive("epsilon", self.epsilon)?;
        check(
            "g1",
            self.g1,
            self.g1 <= 0.0 && self.g1.is_finite(),
            "a finite number <= 0",
        )?;
        check(
            "g2",
            self.g2,
            self.g2 >= 0.0 && self.g2.is_finite(),
            "a finite number >= 0",
        )
    }
}
