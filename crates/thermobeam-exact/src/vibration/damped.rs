//! The time factor of a damped mode.

use thermobeam::parameters::{ParameterError, check};

/// The factor T of a damped mode: `T'' + ζω² T' + ω² T = 0` with T(0) and T'(0) given.
///
/// With a [`Mode`](super::Mode), `u = U(x) T(t)`, `φ = Φ(x) T(t)` is an exact solution of (1.1) for
/// a = β = ρ = 0, θ = 0.
///
/// The roots of λ² + ζω²λ + ω² = 0 are complex for ζω < 2 (oscillation), equal for ζω = 2, and real
/// for ζω > 2 (overdamped), as for all high modes with ζ > 0. The mode may be one of the beam or of
/// a mesh, each with its own ω.
///
/// ```
/// use thermobeam::dg::{Dg, DgProblem, DgStepping, Field, InitialFunctions};
/// use thermobeam::mesh::Mesh;
/// use thermobeam::motion::Motion;
/// use thermobeam::parameters::Beam;
/// use thermobeam_exact::vibration::{Mode, TimeFactor};
///
/// let mode = Mode::new(0);
/// let beam = Beam { zeta: 0.1, a: 0.0, rho: 0.0, beta: 0.0, theta_a: 0.0 };
/// let initial = InitialFunctions {
///     u: Box::new(move |x| mode.u(x)),
///     phi: Box::new(move |x| mode.phi(x)),
///     ..InitialFunctions::at_rest(0.0)
/// };
/// let mesh = Mesh::uniform(1)?;
/// let problem = DgProblem { beam, obstacles: None, mesh, degree: 12, initial };
/// let stepping = DgStepping { degree: 3, dt: 0.1, restart_dt: 0.1, ..DgStepping::default() };
/// let mut simulation = Dg::new(problem, stepping)?;
/// simulation.advance(1.0)?;
/// let tip = simulation.value(Field::U, 1.0, 1.0).expect("the last step ends there");
/// let exact = TimeFactor::new(mode.omega(), beam.zeta, 1.0, 0.0)?.value(1.0);
/// assert!((tip - exact).abs() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeFactor {
    omega: f64,
    zeta: f64,
    start: (f64, f64),
}

impl TimeFactor {
    /// T with `T(0) = position` and `T'(0) = velocity`.
    ///
    /// * `omega`: the frequency ω >= 0.
    /// * `zeta`: the viscosity ζ >= 0.
    ///
    /// # Errors
    /// [`ParameterError`] if ω or ζ is negative or not finite, or T(0) or T'(0) is not finite.
    pub fn new(
        omega: f64,
        zeta: f64,
        position: f64,
        velocity: f64,
    ) -> Result<Self, ParameterError> {
        for (name, value) in [("omega", omega), ("zeta", zeta)] {
            check(
                name,
                value,
                value >= 0.0 && value.is_finite(),
                "a finite number >= 0",
            )?;
        }
        for (name, value) in [("T(0)", position), ("T'(0)", velocity)] {
            check(name, value, value.is_finite(), "a finite number")?;
        }
        Ok(Self {
            omega,
            zeta,
            start: (position, velocity),
        })
    }

    /// T at t >= 0.
    pub fn value(&self, t: f64) -> f64 {
        self.evolve(self.start.0, self.start.1, t)
    }

    /// T' at t >= 0.
    pub fn slope(&self, t: f64) -> f64 {
        // T' satisfies the same equation with the initial values T'(0) and T''(0).
        let acceleration = -self.omega.powi(2) * (self.start.0 + self.zeta * self.start.1);
        self.evolve(self.start.1, acceleration, t)
    }

    /// The solution with the given value and slope at 0.
    fn evolve(&self, value: f64, slope: f64, t: f64) -> f64 {
        let omega = self.omega;
        let gamma = 0.5 * self.zeta * omega * omega;
        // γ² - ω², without the cancellation near critical damping.
        let excess = (gamma - omega) * (gamma + omega);
        if excess < 0.0 {
            let angle = (-excess).sqrt() * t;
            let sinc = if angle == 0.0 {
                1.0
            } else {
                angle.sin() / angle
            };
            return (-gamma * t).exp() * (value * angle.cos() + (slope + gamma * value) * t * sinc);
        }
        // The root of smaller size by Vieta's formula: -γ + √(γ² - ω²) would cancel. For ω = 0 both
        // roots are 0, and T is linear.
        let slow = if omega == 0.0 {
            0.0
        } else {
            -omega * omega / (gamma + excess.sqrt())
        };
        let gap = 2.0 * excess.sqrt();
        // (1 - e^{-gap t})/gap, equal to t at critical damping.
        let ramp = if gap == 0.0 {
            t
        } else {
            -(-gap * t).exp_m1() / gap
        };
        (slow * t).exp() * (value + (slope - slow * value) * ramp)
    }
}
