//! The time schemes, each a row of a table.
//!
//! Both schemes solve one system per step for the velocities `V`, `W` that determine the
//! displacements, `u = u0 + dt V`, `phi = phi0 + dt W`, and for the mean temperature
//! `Θ = (theta + theta0)/2`. They differ in three entries:
//!
//! | scheme | V is | inertia `M (v - v0)/dt` | contact |
//! | --- | --- | --- | --- |
//! | `euler-crank-nicolson` | v at the new level | `M (V - v0)/dt` | g at the new level |
//! | `midpoint` | v at the middle | `2 M (V - v0)/dt`, because `v = 2 V - v0` | the discrete gradient of G |
//!
//! `V = c v + (1 - c) v0` with ½ <= c <= 1 is also a row, with inertia 1/c and order 1 for c > ½.

use crate::parameters::{Beam, Obstacles};

/// How the contact force enters a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactRule {
    /// g(u(1)) at the new time level, as in (3.7).
    Implicit,
    /// (G(u(1)) - G(u0(1)))/(u(1) - u0(1)), which conserves the contact energy exactly.
    DiscreteGradient,
}

/// A time scheme, a row of the table. Rows are identified by their names.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scheme {
    /// The name in scene and study files.
    pub name: &'static str,
    /// Theoretical order in dt for smooth solutions.
    pub order: f64,
    /// The factor of `M (V - v0)/dt`: 1 if V is the new velocity, 2 if V is the mean velocity,
    /// between 1 and 2 otherwise.
    pub inertia: f64,
    /// How the contact force enters.
    pub contact: ContactRule,
    /// Where the scheme is defined.
    pub source: &'static str,
}

/// A beam in elements with its obstacles, stepped by a scheme.
#[derive(Debug, Clone, PartialEq)]
pub struct SteppedBeam {
    /// Coefficients of (1.1).
    pub beam: Beam,
    /// The obstacles of (1.3), if any.
    pub obstacles: Option<Obstacles>,
    /// The time scheme.
    pub scheme: Scheme,
    /// Time step δt.
    pub dt: f64,
    /// Length of each element.
    pub lengths: Vec<f64>,
}

/// The paper's scheme (3.7)-(3.8): backward Euler for inertia, viscosity and contact,
/// Crank-Nicolson for the rest.
pub const EULER_CRANK_NICOLSON: Scheme = Scheme {
    name: "euler-crank-nicolson",
    order: 1.0,
    inertia: 1.0,
    contact: ContactRule::Implicit,
    source: "Bernardi and Copetti, (3.7)-(3.8)",
};

/// The implicit midpoint rule with a discrete gradient for the contact. It conserves the energy up
/// to the physical dissipation.
pub const MIDPOINT: Scheme = Scheme {
    name: "midpoint",
    order: 2.0,
    inertia: 2.0,
    contact: ContactRule::DiscreteGradient,
    source: "implicit midpoint rule with a discrete gradient for the contact",
};

/// All schemes.
pub const SCHEMES: [Scheme; 2] = [EULER_CRANK_NICOLSON, MIDPOINT];

/// The scheme with the given name; `None` if there is none.
#[doc(hidden)]
pub fn by_name(name: &str) -> Option<Scheme> {
    SCHEMES.into_iter().find(|scheme| scheme.name == name)
}

#[cfg(test)]
impl SteppedBeam {
    /// Without obstacles, by the paper's scheme.
    pub(crate) fn free(beam: Beam, dt: f64, lengths: &[f64]) -> Self {
        Self {
            beam,
            obstacles: None,
            scheme: EULER_CRANK_NICOLSON,
            dt,
            lengths: lengths.to_vec(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schemes_are_found_by_name() {
        assert_eq!(
            SCHEMES.map(|scheme| by_name(scheme.name)),
            SCHEMES.map(Some)
        );
        assert_ne!(SCHEMES[0].name, SCHEMES[1].name);
        assert_eq!(by_name("euler"), None);
    }
}
