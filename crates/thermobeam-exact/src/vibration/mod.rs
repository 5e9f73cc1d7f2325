//! Free vibrations of the linear beam in closed form: a = β = ρ = 0, no obstacles, θ = 0.
//!
//! # Separation
//!
//! Both equations of (1.1) then have the form w_tt = L(w + ζ w_t) with the elastic operator L, and
//! (1.3) contains the same combination w + ζ w_t. So a solution is an undamped mode, L(U,
//! Φ) = -ω²(U, Φ), times a factor T(t) with
//!
//! `T'' + ζω² T' + ω² T = 0`:
//!
//! see [`TimeFactor`]. The mode satisfies
//!
//! ```text
//! U'' - Φ' = -ω² U,      Φ'' + U' - Φ = -ω² Φ,
//! U(0) = Φ(0) = 0,       U'(1) - Φ(1) = 0,    Φ'(1) = 0.
//! ```
//!
//! # Frequencies
//!
//! The exponential e^{px} solves the equations if `(p² + ω²)(p² + ω² - 1) + p² = 0`, that is,
//! `p² = -ω² ± ω`. With `κ±² = ω² ∓ ω`, C±(x) = cos κ± x and S±(x) = sin κ± x / κ± (the first pair
//! is hyperbolic for ω < 1, linear for ω = 1; as functions of κ±² both are entire), the two
//! solutions that are clamped at x = 0 are
//!
//! ```text
//! U = A [(1 - ω) S+ - (1 + ω) S-] + B [C+ - C-],
//! Φ = A [C+ - C-]                 + B ω [S+ + S-].
//! ```
//!
//! The two conditions at x = 1, divided by ω and with all functions at 1, are
//!
//! ```text
//! [(1 + ω) S- + (1 - ω) S+] A + (C+ + C-) B = 0,
//! -(C+ + C-) A + ω (S- - S+) B = 0,
//! ```
//!
//! with determinant `2 (1 + C+ C- - ω² S+ S-)`. For ω <= 1 it is at least 0.1, so there is no
//! frequency. For ω > 1 let
//!
//! ```text
//! ω = (E + 1/E)/2, E > 1,     s = (κ+ + κ-)/2 = √(E² + 1)/2,     (κ- - κ+)/2 = s/E.
//! ```
//!
//! The determinant is then a difference of two squares and vanishes for
//!
//! `|cos s| = r(s) := cos(s/E)/E`.
//!
//! # No frequency is missed
//!
//! r decreases from 0.76 (s = 1/√2, ω = 1) to 0, and |r'| < 0.7 < 0.87 < |sin s| at every root with
//! s >= 1; for s < 1,
//! |cos s| > r. So each interval of length π/2 between neighbouring zeros of sin s and cos s contains exactly one root, and
//! it is simple; this includes the first interval, which is searched from s = 1. The i-th frequency
//! is computed in its own interval. High frequencies come in pairs, ω ≈ (n - 1/2)π + (1/8 ∓
//! cos(1/2)/2)/ω, that is -0.314/ω and +0.564/ω (s is ω - 1/(8ω)), at which the determinant itself
//! has nearly double roots: a scan of its sign would miss them.
//!
//! ```
//! use thermobeam_exact::vibration::{Mode, TimeFactor};
//!
//! let lowest = Mode::new(0);
//! let factor = TimeFactor::new(lowest.omega(), 0.1, 1.0, 0.0)?;
//! let tip = |t: f64| lowest.u(1.0) * factor.value(t);
//! assert!((lowest.omega() - 1.27396492100).abs() < 1e-11);
//! assert!(tip(0.0) == 1.0 && tip(5.0).abs() < 1.0);
//! # Ok::<(), thermobeam::parameters::ParameterError>(())
//! ```

mod damped;
mod discrete;

use crate::stumpff::{c0, c1};
use std::f64::consts::FRAC_PI_2;
use thermobeam::bracket::bisect;

pub use damped::TimeFactor;
pub use discrete::{SpectrumError, discrete_frequencies, discrete_frequencies_until};

/// The `count` lowest frequencies ω, in increasing order.
pub fn frequencies(count: usize) -> Vec<f64> {
    (0..count).map(frequency).collect()
}

/// The frequency with index 0, 1, ..., with an error of a few units of round-off.
fn frequency(index: usize) -> f64 {
    // There is no root below s = 1, where the quotient has a zero at ω = 1 (s = 1/√2) that the
    // determinant does not have.
    let (from, to) = (FRAC_PI_2 * index as f64, FRAC_PI_2 * (index + 1) as f64);
    let root = bisect(
        |s| s.cos().abs() - (s / e(s)).cos() / e(s),
        from.max(1.0),
        to,
    );
    let e = e(root);
    0.5 * (e + 1.0 / e)
}

/// `E = √(4s² - 1)`.
fn e(s: f64) -> f64 {
    ((2.0 * s - 1.0) * (2.0 * s + 1.0)).sqrt()
}

/// A mode of vibration of the undamped beam, scaled to U(1) = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    omega: f64,
    a: f64,
    b: f64,
}

impl Mode {
    /// The mode with the given index; index 0 has the lowest frequency.
    ///
    /// U and Φ have an error of round-off times ω, because at high frequencies they are differences
    /// of two almost equal waves.
    pub fn new(index: usize) -> Self {
        let omega = frequency(index);
        let [plus, minus] = squares(omega);
        // The second condition at x = 1 or the first, whichever has the larger coefficients.
        let sum = c0(plus) + c0(minus);
        let rotation = omega * (c1(minus) - c1(plus));
        let shear = (1.0 + omega) * c1(minus) + (1.0 - omega) * c1(plus);
        let (a, b) = if rotation.abs() > shear.abs() {
            (rotation, sum)
        } else {
            (sum, -shear)
        };
        let unscaled = Self { omega, a, b };
        // U(1) ≠ 0: otherwise three conditions at the tip and two at the clamped end would exclude
        // the mode.
        let tip = unscaled.u(1.0);
        Self {
            omega,
            a: a / tip,
            b: b / tip,
        }
    }

    /// ω.
    pub fn omega(&self) -> f64 {
        self.omega
    }

    /// U at x in [0, 1].
    pub fn u(&self, x: f64) -> f64 {
        let [[c_plus, s_plus], [c_minus, s_minus]] = self.waves(x);
        self.a * ((1.0 - self.omega) * s_plus - (1.0 + self.omega) * s_minus)
            + self.b * (c_plus - c_minus)
    }

    /// U' at x.
    pub fn u_x(&self, x: f64) -> f64 {
        let [[c_plus, s_plus], [c_minus, s_minus]] = self.waves(x);
        let [plus, minus] = squares(self.omega);
        self.a * ((1.0 - self.omega) * c_plus - (1.0 + self.omega) * c_minus)
            + self.b * (minus * s_minus - plus * s_plus)
    }

    /// Φ at x.
    pub fn phi(&self, x: f64) -> f64 {
        let [[c_plus, s_plus], [c_minus, s_minus]] = self.waves(x);
        self.a * (c_plus - c_minus) + self.b * self.omega * (s_plus + s_minus)
    }

    /// Φ' at x.
    pub fn phi_x(&self, x: f64) -> f64 {
        let [[c_plus, s_plus], [c_minus, s_minus]] = self.waves(x);
        let [plus, minus] = squares(self.omega);
        self.a * (minus * s_minus - plus * s_plus) + self.b * self.omega * (c_plus + c_minus)
    }

    /// `[C±, S±]` at x.
    fn waves(&self, x: f64) -> [[f64; 2]; 2] {
        squares(self.omega).map(|square| [c0(square * x * x), x * c1(square * x * x)])
    }
}

/// `κ±² = ω² ∓ ω`.
fn squares(omega: f64) -> [f64; 2] {
    [omega * (omega - 1.0), omega * (omega + 1.0)]
}
