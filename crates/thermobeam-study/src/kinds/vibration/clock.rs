//! How a mode moves in time: exactly, or as a time scheme moves it.
//!
//! A mode of the beam, exact or of a mesh, satisfies `A(x; y) = ω² B(x; y)` for all test functions y in its space. Put
//! `u = U q, φ = Φ q, û = U v, φ̂ = Φ v` into (3.7) with a = β = ρ = 0 and no obstacle: everything is a multiple of the
//! mode, and a step becomes one scalar equation for the velocity V that carries it,
//!
//! ```text
//! κ (V - v0) + ω² (q0 + dt V/2 + ζ V) = 0,      κ = inertia/dt,
//! V = (κ v0 - ω² q0) / (κ + ω² (ζ + dt/2)),     q = q0 + dt V,     v = v0 + inertia (V - v0).
//! ```
//!
//! So the time-discrete solution of a mode is known in closed form, in space exact or not, and either error of the
//! whole scheme can be had by itself:
//!
//! * *space*: the scheme on a mesh against the exact mode moved by [`Clock::Scheme`]: the time error cancels exactly;
//! * *time*: the scheme started from a mode of the mesh against that mode moved by [`Clock::Exact`] at its own ω: the
//!   space error is exactly zero;
//! * neither: a mode of the mesh moved by [`Clock::Scheme`] is what the solver has to give, to round-off.
//!
//! A temperature `sin kπx e^{-κ²t}`, κ = kπ, lives beside the beam without touching it for a = 0; Crank-Nicolson
//! multiplies it by `(1 - κ² dt/2)/(1 + κ² dt/2)` a step.

use thermobeam::scheme::Scheme;

use crate::exact::function::Factor;

/// Position and velocity of a mode at each time level n = 0..N.
pub(super) type Path = Vec<[f64; 2]>;

/// What moves the modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Clock {
    /// The equation in time.
    Exact,
    /// The time scheme.
    Scheme(Scheme),
}

/// Time levels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TimeLevels {
    /// δt.
    pub(super) dt: f64,
    /// N.
    pub(super) steps: usize,
}

impl TimeLevels {
    /// The path of an exact time factor.
    pub(super) fn exact(self, factor: &Factor) -> Path {
        let at = |n: usize| {
            let [value, slope, _] = factor.derivatives(n as f64 * self.dt);
            [value, slope]
        };
        (0..=self.steps).map(at).collect()
    }

    /// The path of a vibration of frequency ω by a scheme, from position and velocity.
    pub(super) fn vibration(self, scheme: Scheme, omega_squared: f64, zeta: f64, start: [f64; 2]) -> Path {
        let Self { dt, steps } = self;
        let kappa = scheme.inertia / dt;
        let step = |[q, v]: [f64; 2]| {
            let carrying = (kappa * v - omega_squared * q) / (kappa + omega_squared * (zeta + 0.5 * dt));
            [q + dt * carrying, v + scheme.inertia * (carrying - v)]
        };
        std::iter::successors(Some(start), |&state| Some(step(state))).take(steps + 1).collect()
    }

    /// The path of a temperature that decays like e^{-κ²t}, from `start`; its velocity is not asked for and zero.
    ///
    /// All schemes take the temperature by Crank-Nicolson.
    pub(super) fn temperature(self, kappa_squared: f64, start: f64) -> Path {
        let half = 0.5 * self.dt * kappa_squared;
        let ratio = (1.0 - half) / (1.0 + half);
        (0..=self.steps).map(|n| [start * ratio.powi(n as i32), 0.0]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::free_vibration::damped;
    use thermobeam::scheme::SCHEMES;

    #[test]
    fn the_schemes_paths_converge_at_their_order() {
        let start = [0.5, -1.0];
        let factor = damped(1.7_f64.sqrt(), 0.2, start).expect("a factor");
        for scheme in SCHEMES {
            let error = |steps: usize| {
                let levels = TimeLevels { dt: 2.0 / steps as f64, steps };
                let (exact, found) = (levels.exact(&factor)[steps], levels.vibration(scheme, 1.7, 0.2, start)[steps]);
                (exact[0] - found[0]).hypot(exact[1] - found[1])
            };
            let rate = (error(500) / error(1000)).log2();
            assert!((rate - scheme.order).abs() < 0.01, "{}: {rate}", scheme.name);
        }
    }
}
