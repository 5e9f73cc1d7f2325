//! All steady states of a beam, in closed form.
//!
//! # The static problem is linear once N is known
//!
//! Without motion the third equation of (1.1) leaves `θ = θ_A (1 - x)`. With `N = β + ρ‖u'‖²` the other two are
//!
//! ```text
//! ((1 + N) u' - φ)' = 0,        φ'' + u' - φ + aθ_A = 0,
//! u(0) = φ(0) = 0,   φ'(1) = 0,   (1 + N) u'(1) - φ(1) = c := -g(u(1)).
//! ```
//!
//! The first says that `(1 + N) u' - φ = c` everywhere. With `q = 1/(1 + N)`, u' = q (φ + c), and the second becomes
//!
//! ```text
//! φ'' + (q - 1) φ + d = 0,      d = aθ_A + cq,      q - 1 = -N/(1 + N) =: X.
//! ```
//!
//! With y = 1 - x and α = φ(1), the solution with φ'(1) = 0 is `φ = α C(y) - d W(y)`,
//!
//! ```text
//! N < 0, k² = X:      C = cos ky,     W = (1 - cos ky)/k²
//! N = 0:              C = 1,          W = y²/2
//! N > 0, k² = -X:     C = cosh ky,    W = (cosh ky - 1)/k²
//! ```
//!
//! which are the Stumpff functions `c_0(Xy²)` and `y² c_2(Xy²)`: one formula, smooth in N. φ(0) = 0 and the contact law
//! are two linear equations for (α, c):
//!
//! ```text
//! C(1) α - W(1) d = 0,        εc + u(1) = g  in contact with the obstacle at g,  or  c = 0  without,
//! u(1) = q (α c_1(X) - d c_3(X) + c).
//! ```
//!
//! Their determinant vanishes at the buckling values of the law. Free, that is where cos k = 0:
//! `N_k = -κ²/(1 + κ²)`, κ = (k - 1/2)π. In contact there is one value between N_{k+1} and N_k for each k,
//! and one more near N = -1 - 1/ε, where the spring gives way.
//!
//! # N is one scalar equation
//!
//! `N = β + ρ‖u'‖²`, ‖u'‖² in closed form too. `scan` shows why each law has at most two roots between two
//! of its buckling values, finds them all, and counts the unstable directions of each without any discretisation.
//! A contact state counts only if it presses (c < 0 on top, c > 0 below), a free one only if `g₁ <= u(1) <= g₂`.
//!
//! # Buckled states
//!
//! Where nothing loads the beam (aθ_A = 0, and no contact or contact with an obstacle at 0) the straight beam solves the
//! law for every N, and bent states sit exactly on the buckling values N_k > β: both signs of the mode, with the amplitude
//! that makes N_k = β + ρ‖u'‖². A small load splits each of these into two states on either side of N_k.
//!
//! # N <= -1, and β <= -1
//!
//! For N < -1 the sign of u'' turns: k² = 1 - q > 1, all hyperbolic, no free buckling value. At N = -1 exactly
//! φ = -c = 0 and u' = -aθ_A, a state where `ρ(aθ_A)² = -1 - β`. The second variation has infinitely many negative
//! directions at N <= -1: none of these is ever stable.
//! The buckling values N_k accumulate at -1 from above, so that for β <= -1 there are infinitely many states:
//! see [`equilibria`] for what is listed.
//!
//! Source: (1.1)-(1.3) of Bernardi and Copetti; the classification by N follows Sapir and Reiss for the beam without contact.

mod branch;
mod law;
mod polish;
mod scan;
mod shape;

use crate::parameters::{Beam, Obstacles, ParameterError};
use branch::Branch;
use law::{Law, Support, free_buckling};
use shape::Shape;
use thiserror::Error;

/// [`equilibria`] lists the states with N above the buckling value of this many quarter waves, plus one.
///
/// A state below it has at least `HALF_WAVES - 1` unstable directions, so every stable state is listed whatever β.
pub const HALF_WAVES: usize = 16;

/// Which obstacle the free end presses against.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Contact {
    /// None: `g₁ <= u(1) <= g₂`.
    Free,
    /// The upper one, `u(1) > g₂`.
    Upper,
    /// The lower one, `u(1) < g₁`.
    Lower,
}

/// Why the steady states could not be told.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EquilibriumError {
    /// A coefficient is out of its range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The linear beam (ρ = 0) at a buckling value: a continuum of states if nothing loads it, none otherwise.
    #[error("the linear beam buckles at N = {n_value} ({contact:?}): no state, or a continuum of them")]
    Resonance {
        /// The contact state.
        contact: Contact,
        /// N = β.
        n_value: f64,
    },
    /// β and a buckling value are so close, and the load so small, that round-off decides how many states there are.
    #[error("beta is within round-off of the buckling value N = {n_value} ({contact:?})")]
    Bifurcation {
        /// The contact state.
        contact: Contact,
        /// The buckling value.
        n_value: f64,
    },
    /// A state was found whose N = β + ρ‖u'‖² does not hold: the coefficients are too large for double precision.
    #[error("the state at N = {n_value} ({contact:?}) misses N = beta + rho |u'|^2 by {defect:e}")]
    Inaccurate {
        /// The contact state.
        contact: Contact,
        /// N.
        n_value: f64,
        /// How far the equation is from holding, relative.
        defect: f64,
    },
}

/// A steady state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equilibrium {
    /// Which obstacle is touched.
    pub contact: Contact,
    /// N = β + ρ‖u'‖².
    pub n_value: f64,
    /// u(1).
    pub u_tip: f64,
    /// φ(1).
    pub phi_tip: f64,
    /// g(u(1)): what the beam presses with, positive on the upper obstacle, negative on the lower, zero when free.
    pub contact_force: f64,
    /// The second variation of the potential energy is positive definite: a strict minimum.
    ///
    /// At a fold or a bifurcation it is only semidefinite, and this is false. Where the straight beam touches one obstacle
    /// without pressing, only one direction of u(1) is stiffened, which helps no minimum; where it touches both, both are.
    pub stable: bool,
    /// Negative directions of the second variation; none if there are infinitely many (N <= -1).
    pub unstable_directions: Option<usize>,
    shape: Shape,
}

impl Equilibrium {
    /// u at x in [0, 1].
    pub fn u(&self, x: f64) -> f64 {
        self.shape.u(x)
    }

    /// u' at x.
    pub fn u_x(&self, x: f64) -> f64 {
        self.shape.u_x(x)
    }

    /// φ at x.
    pub fn phi(&self, x: f64) -> f64 {
        self.shape.phi(x)
    }

    /// φ' at x.
    pub fn phi_x(&self, x: f64) -> f64 {
        self.shape.phi_x(x)
    }
}

/// Whether [`equilibria`] lists every steady state, which it does for β > -0.9996.
///
/// Every state has N >= β, so none is left out while β is at least the lowest buckling value looked at.
pub fn lists_all(beam: &Beam) -> bool {
    1.0 + beam.beta >= free_buckling(HALF_WAVES + 1)
}

/// All steady states, sorted by u(1), then N.
///
/// * `obstacles`: none leaves the tip free.
/// * Where β is so far down that states accumulate at N = -1 (see [`lists_all`]): all with N above the buckling value
///   N_{[`HALF_WAVES`] + 1} and all with N <= -1. Those in between are all unstable.
///
/// Errors: a coefficient out of range; ρ = 0 at a buckling value; β at a buckling value with a load at round-off level.
/// A state that touches an obstacle without pressing it, to round-off, may be missed or found twice; a fold is told from
/// two states, or none, to round-off of N.
///
/// ```
/// use thermobeam::equilibrium::{Contact, equilibria};
/// use thermobeam::parameters::{Beam, Obstacles};
///
/// let beam = Beam { beta: -0.8, ..Beam::default() };
/// let states = equilibria(&beam, Some(&Obstacles::default()))?;
/// let found: Vec<_> = states.iter().map(|state| (state.contact, state.stable)).collect();
/// assert_eq!(found, [(Contact::Lower, true), (Contact::Free, false), (Contact::Upper, true)]);
/// # Ok::<(), thermobeam::equilibrium::EquilibriumError>(())
/// ```
pub fn equilibria(beam: &Beam, obstacles: Option<&Obstacles>) -> Result<Vec<Equilibrium>, EquilibriumError> {
    beam.validate()?;
    if let Some(obstacles) = obstacles {
        obstacles.validate()?;
    }
    let mut found = Vec::new();
    for (contact, law) in laws(beam, obstacles) {
        let branch = Branch { beam, contact, law, pinch: pinch(obstacles) };
        let states = branch.states()?;
        found.extend(states.into_iter().filter(|state| is_consistent(state, obstacles)));
    }
    found.sort_by(|a, b| a.u_tip.total_cmp(&b.u_tip).then(a.n_value.total_cmp(&b.n_value)));
    Ok(found)
}

fn laws(beam: &Beam, obstacles: Option<&Obstacles>) -> Vec<(Contact, Law)> {
    let moment = beam.a * beam.theta_a;
    let mut laws = vec![(Contact::Free, Law { moment, support: None })];
    if let Some(&Obstacles { epsilon, g1, g2 }) = obstacles {
        let on = |position| Law { moment, support: Some(Support { epsilon, position }) };
        laws.push((Contact::Upper, on(g2)));
        laws.push((Contact::Lower, on(g1)));
    }
    laws
}

/// The spring that holds the tip at 0 in both directions, where both obstacles stand there.
fn pinch(obstacles: Option<&Obstacles>) -> Option<Law> {
    let touching = obstacles.filter(|o| o.g1 == 0.0 && o.g2 == 0.0)?;
    Some(Law { moment: 0.0, support: Some(Support { epsilon: touching.epsilon, position: 0.0 }) })
}

/// Whether the state is in the state of contact whose law it solves.
fn is_consistent(state: &Equilibrium, obstacles: Option<&Obstacles>) -> bool {
    match state.contact {
        Contact::Free => obstacles.is_none_or(|o| (o.g1..=o.g2).contains(&state.u_tip)),
        Contact::Upper => state.contact_force > 0.0,
        Contact::Lower => state.contact_force < 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_consistent_state_presses_its_obstacle_or_lies_between_both() {
        let obstacles = Obstacles { epsilon: 1.0, g1: -0.25, g2: 0.5 };
        let state = |contact, contact_force, u_tip| Equilibrium {
            contact,
            n_value: 0.0,
            u_tip,
            phi_tip: 0.0,
            contact_force,
            stable: true,
            unstable_directions: Some(0),
            shape: Shape::Line { slope: u_tip },
        };
        for (contact, presses) in [(Contact::Upper, [false, false, true]), (Contact::Lower, [true, false, false])] {
            let found = [-1.0, 0.0, 1.0].map(|force| is_consistent(&state(contact, force, 0.0), Some(&obstacles)));
            assert_eq!(found, presses, "{contact:?}");
        }
        let free = |u_tip| is_consistent(&state(Contact::Free, 0.0, u_tip), Some(&obstacles));
        assert_eq!([-0.26, -0.25, 0.0, 0.5, 0.51].map(free), [false, true, true, true, false]);
        assert!(is_consistent(&state(Contact::Free, 0.0, 7.0), None));
    }
}
