//! The formulas of the problem and of both time schemes, written here a second time.
//!
//! What the solver is judged by must not call what it judges: a mistake in a function that both
//! sides call would be in the loads as well, and no order would show it. So these functions share
//! with the solver only the numbers of a [`Beam`] and of its [`Obstacles`]. The operations have the
//! order that they have in the solver, so both sides compute the same bits.

use thermobeam::parameters::{Beam, Obstacles};

/// The axial force `N(u) = β + ρ ‖u_x‖²`, (2.3).
///
/// * `slope_squared`: `‖u_x‖²`.
pub fn axial_force(beam: &Beam, slope_squared: f64) -> f64 {
    beam.beta + beam.rho * slope_squared
}

/// The contact force `g(u) = ([u - g2]_+ - [g1 - u]_+)/ε` of (1.3), for `u = u(1)`; NaN for NaN.
pub fn contact_force(obstacles: &Obstacles, u: f64) -> f64 {
    penetration(obstacles, u) / obstacles.epsilon
}

/// `[u - g2]_+ - [g1 - u]_+`.
fn penetration(obstacles: &Obstacles, u: f64) -> f64 {
    if u > obstacles.g2 {
        u - obstacles.g2
    } else if u < obstacles.g1 {
        u - obstacles.g1
    } else {
        0.0 * u
    }
}

/// The discrete gradient `(G(u) - G(u0))/(u - u0)` of the contact energy, with G' = g; `g(u)` for
/// `u = u0`.
///
/// With the penetrations p and p0, `G(u) - G(u0) = (p² - p0²)/(2ε)`. On one side of both obstacles
/// `p - p0 = u - u0`, which is divided out: the rest does not cancel.
pub fn discrete_gradient(obstacles: &Obstacles, u: f64, u0: f64) -> f64 {
    let p = penetration(obstacles, u);
    let p0 = penetration(obstacles, u0);
    let double = 2.0 * obstacles.epsilon;
    if (p > 0.0 && p0 > 0.0) || (p < 0.0 && p0 < 0.0) {
        (p + p0) / double
    } else if p == 0.0 && p0 == 0.0 {
        0.0
    } else {
        (p.abs() - p0.abs()) * (p.abs() + p0.abs()) / (double * (u - u0))
    }
}

/// The formulas of a time scheme: of the project's by their names, of others as stated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SchemeFormulas {
    /// The paper's scheme, (3.7)-(3.8).
    EulerCrankNicolson,
    /// The implicit midpoint rule with the discrete gradient of the contact energy.
    Midpoint,
    /// A scheme of one's own, stated a second time beside the row that the solver steps.
    Own {
        /// The factor c of the inertia.
        inertia: f64,
        /// Whether the contact force is the discrete gradient; otherwise it is g at the new level.
        has_discrete_gradient: bool,
    },
}

impl SchemeFormulas {
    /// Those of the scheme with this name in scene and study files; `None` if it has none here.
    pub fn of(name: &str) -> Option<Self> {
        match name {
            "euler-crank-nicolson" => Some(Self::EulerCrankNicolson),
            "midpoint" => Some(Self::Midpoint),
            _ => None,
        }
    }

    /// The factor c of the inertia `c M (V - v0)/dt`; the new velocity is `c V + (1 - c) v0`.
    ///
    /// The carrying velocity `V = (u - u0)/dt` is the new velocity of the paper's scheme, and the
    /// mean of both by the midpoint rule.
    pub fn inertia(self) -> f64 {
        match self {
            Self::EulerCrankNicolson => 1.0,
            Self::Midpoint => 2.0,
            Self::Own { inertia, .. } => inertia,
        }
    }

    /// The contact force of a step that takes u(1) from `u0` to `u`.
    pub fn contact_force(self, obstacles: &Obstacles, u: f64, u0: f64) -> f64 {
        match self {
            Self::EulerCrankNicolson
            | Self::Own {
                has_discrete_gradient: false,
                ..
            } => contact_force(obstacles, u),
            Self::Midpoint
            | Self::Own {
                has_discrete_gradient: true,
                ..
            } => discrete_gradient(obstacles, u, u0),
        }
    }
}
