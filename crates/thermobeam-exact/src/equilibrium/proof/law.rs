//! f, f', u(1) and the stress of one law in intervals, by formulas with one transcendental
//! function.
//!
//! With `x = 1/s - 1`, `τ = tan √x/√x` and `D = aθ_A`, the solution is `u' = A (cos √x y/cos √x -
//! s) - D`, see `completeness`. There `A = P/x`, and with `σ = (τ - 1)/x`, `R = σ' - σ² = V(τ)/x²`,
//!
//! ```text
//! S = u(1)² + P² R,
//! free:       P = D/s,                      u(1) = Dσ/s,
//! support:    P = (g + D + Dεs)/h,          u(1) = g - εc,     c = s (gs - Dσ)/h,
//!             h = s + σ + εs².
//! ```
//!
//! They hold for all s ≠ 0: below 0, and above 1, τ = tanh κ/κ with κ² = -x. σ and R have no pole
//! at x = 0, where N = 0. For |x| <= 1 they are quotients of Stumpff functions, and beyond they
//! follow from τ by `2xτ' = 1 + xτ² - τ`.

use super::super::law::{ForceLaw, Support};
use super::{Undecided, UndecidedReason};
use crate::interval::{Enclosure, sin_cos, stumpff, tanh};
use thermobeam::contact::Phase;

/// A law in intervals.
#[derive(Debug, Clone, Copy)]
pub(super) struct IntervalLaw {
    /// The contact of which it is the law.
    pub(super) contact: Phase,
    /// The law of the solver's numbers.
    pub(super) force: ForceLaw,
    /// aθ_A.
    pub(super) moment: Enclosure,
    /// 1 + β.
    pub(super) rest: Enclosure,
}

/// σ and R with their derivatives by s.
struct Flexure {
    sigma: Enclosure,
    sigma_s: Enclosure,
    r: Enclosure,
    r_s: Enclosure,
}

/// What a law gives at s = 1 + N.
#[derive(Debug, Clone, Copy)]
pub(super) struct Solution {
    /// `f = s - (1 + β) - ρS`.
    pub(super) f: Enclosure,
    /// f'.
    pub(super) slope: Enclosure,
    /// u(1).
    pub(super) u_tip: Enclosure,
    /// The stress c.
    pub(super) stress: Enclosure,
}

impl IntervalLaw {
    /// * `moment`: encloses the exact product aθ_A.
    pub(super) fn new(contact: Phase, force: ForceLaw, moment: Enclosure) -> Self {
        Self {
            contact,
            force,
            moment,
            rest: Enclosure::from(1.0) + force.beta,
        }
    }

    /// What is given up in a part of the law.
    pub(super) fn undecided(&self, reason: UndecidedReason, s: Enclosure, width: f64) -> Undecided {
        Undecided {
            contact: self.contact,
            n_value: s - 1.0,
            reason,
            width,
        }
    }

    /// f, f', u(1) and c; all real numbers where s may be a pole.
    pub(super) fn at(&self, s: Enclosure) -> Solution {
        let Flexure {
            sigma,
            sigma_s,
            r,
            r_s,
        } = Flexure::at(s);
        let d = self.moment;
        let p;
        let p_s;
        let u;
        let u_s;
        let stress;
        match self.force.support {
            None => {
                p = d / s;
                p_s = -p / s;
                u = d * sigma / s;
                u_s = d * (sigma_s - sigma / s) / s;
                stress = Enclosure::from(0.0);
            }
            Some(Support { epsilon, position }) => {
                let h = s + sigma + s.square() * epsilon;
                let h_s = sigma_s + 1.0 + s * (2.0 * epsilon);
                p = self.load(s) / h;
                p_s = (d * epsilon - p * h_s) / h;
                let n = s * position - d * sigma;
                let n_s = -d * sigma_s + position;
                stress = s * n / h;
                u = Enclosure::from(position) - stress * epsilon;
                u_s = -(n + s * n_s - stress * h_s) / h * epsilon;
            }
        }
        let squared = u.square() + p.square() * r;
        let squared_s = (u * u_s + p * p_s * r) * 2.0 + p.square() * r_s;
        Solution {
            f: s - self.rest - squared * self.force.rho,
            slope: -squared_s * self.force.rho + 1.0,
            u_tip: u,
            stress,
        }
    }

    /// `G = g + D (1 + εs)`, which a mode of the supported beam feels: at a pole it is not 0.
    pub(super) fn load(&self, s: Enclosure) -> Enclosure {
        self.force.support.map_or(self.moment, |support| {
            self.moment * (s * support.epsilon + 1.0) + support.position
        })
    }

    /// A positive multiple of the determinant at s: `cos √x`, times h with a support.
    pub(super) fn determinant(&self, s: Enclosure) -> Enclosure {
        let x = s_to_x(s);
        let cosine = if x.lo > 0.0 {
            sin_cos(x.sqrt())[1]
        } else {
            Enclosure::from(1.0)
        };
        match self.force.support {
            None => cosine,
            Some(support) => cosine * pole_function(support.epsilon, s),
        }
    }

    /// u(1)² of the mode at a pole with this ‖u'‖²: with a support h = 0 there, so that `u(1) = P
    /// (s + σ) = -P εs²`; without one, S = xu(1)²/2.
    pub(super) fn squared_tip_of_mode(&self, s: Enclosure, squared: Enclosure) -> Enclosure {
        let Some(Support { epsilon, .. }) = self.force.support else {
            return squared * 2.0 / s_to_x(s);
        };
        let reach = (s.square() * epsilon).square();
        squared * reach / (reach + Flexure::at(s).r)
    }

    /// The stress at which the support holds the tip at u(1), without a load.
    pub(super) fn stress(&self, u_tip: Enclosure) -> Enclosure {
        let zero = Enclosure::from(0.0);
        self.force
            .support
            .map_or(zero, |support| -u_tip / support.epsilon)
    }
}

/// h: its zeros are the poles of a supported beam.
pub(super) fn pole_function(epsilon: f64, s: Enclosure) -> Enclosure {
    s + Flexure::at(s).sigma + s.square() * epsilon
}

fn s_to_x(s: Enclosure) -> Enclosure {
    Enclosure::from(1.0) / s - 1.0
}

impl Flexure {
    fn at(s: Enclosure) -> Self {
        let x = s_to_x(s);
        let [sigma, sigma_x, r, r_x] = if x.lo >= -1.0 && x.hi <= 1.0 {
            by_series(x)
        } else if x.lo > 0.0 || x.hi < 0.0 {
            by_tangent(x)
        } else {
            [Enclosure::ENTIRE; 4]
        };
        let x_s = -Enclosure::from(1.0) / s.square();
        Self {
            sigma,
            sigma_s: sigma_x * x_s,
            r,
            r_s: r_x * x_s,
        }
    }
}

/// σ, σ', R and R' at |x| <= 1: `σ = (c_2 - c_3)/c_0`, and `c_k' = (k c_{k+2} - c_{k+1})/2`.
fn by_series(x: Enclosure) -> [Enclosure; 4] {
    let [c0, c1, c2, c3, c4, c5, c6, c7] = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| stumpff(k, x));
    let cosine_x = c1 * -0.5;
    let cosine_xx = (c2 - c3) * 0.25;
    let top_x = (c4 * 3.0 - c3 - c5 * 3.0) * 0.5;
    let top_xx = (c4 + c6 * 15.0 - c5 * 6.0 - c7 * 15.0) * 0.25;
    let sigma = (c2 - c3) / c0;
    let sigma_x = (top_x - sigma * cosine_x) / c0;
    let sigma_xx = (top_xx - sigma_x * cosine_x * 2.0 - sigma * cosine_xx) / c0;
    [
        sigma,
        sigma_x,
        sigma_x - sigma.square(),
        sigma_xx - sigma * sigma_x * 2.0,
    ]
}

/// The same away from x = 0, by τ and `V = (1 + xτ²)/2 + τ/2 - τ²`.
fn by_tangent(x: Enclosure) -> [Enclosure; 4] {
    let tau = if x.lo > 0.0 {
        let k = x.sqrt();
        let [sin, cos] = sin_cos(k);
        sin / (k * cos)
    } else {
        let kappa = (-x).sqrt();
        tanh(kappa) / kappa
    };
    let square = tau.square();
    let secant = x * square + 1.0;
    let tau_x = (secant - tau) / (x * 2.0);
    let sigma = (tau - 1.0) / x;
    let v = (secant + tau) * 0.5 - square;
    let v_x = (tau_x + square) * 0.5 + (x - 2.0) * tau * tau_x;
    [
        sigma,
        (tau_x - sigma) / x,
        v / x.square(),
        (v_x - v * 2.0 / x) / x.square(),
    ]
}
