//! All steady states of a beam, in closed form.
//!
//! # The static problem is linear for given N
//!
//! Without motion the third equation of (1.1) gives `θ = θ_A (1 - x)`. With `N = β + ρ‖u'‖²`,
//! (2.3), the other two are
//!
//! ```text
//! ((1 + N) u' - φ)' = 0,        φ'' + u' - φ + aθ_A = 0,
//! u(0) = φ(0) = 0,   φ'(1) = 0,   (1 + N) u'(1) - φ(1) = c := -g(u(1)).
//! ```
//!
//! By the first equation `(1 + N) u' - φ = c` for all x. With `q = 1/(1 + N)`, `u' = q (φ + c)`,
//! and the second becomes
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
//! which are the Stumpff functions `c_0(Xy²)` and `y² c_2(Xy²)`: a single formula, smooth in N. The
//! clamping φ(0) = 0 and the contact law are two linear equations for (α, c):
//!
//! ```text
//! C(1) α - W(1) d = 0,        εc + u(1) = g  in contact with the obstacle at g,  or  c = 0  without,
//! u(1) = q (α c_1(X) - d c_3(X) + c).
//! ```
//!
//! Their determinant vanishes at the buckling values of the law. Without contact these are the
//! zeros of cos k: `N_k = -κ²/(1 + κ²)`, κ = (k - 1/2)π. With contact there is one value between
//! N_{k+1} and N_k for each k, and one more below -1, where the negative stiffness of the beam has
//! the size of the obstacle's: near N = -1 - 1/ε for ε ≪ 1, and near N = -1 - 1/ε² for ε ≫ 1.
//!
//! # N is the root of one scalar equation
//!
//! `N = β + ρ‖u'‖²`, with ‖u'‖² in closed form. `scan` proves that each law has at most two roots
//! between neighbouring buckling values, finds all of them, and counts the unstable directions of
//! each state without a discretisation. A root is a contact state only if it presses the obstacle
//! (c < 0 on the upper, c > 0 on the lower one), and a free state only if `g₁ <= u(1) <= g₂`.
//!
//! # Buckled states
//!
//! Without a load (aθ_A = 0, and no contact or contact with an obstacle at 0) the straight beam
//! solves the law for every N, and bent states exist exactly at the buckling values N_k > β: the
//! mode with either sign, and with the amplitude for which N_k = β + ρ‖u'‖². A small load splits
//! each of these into two states, one on each side of N_k.
//!
//! ```
//! use thermobeam::kirchhoff::BUCKLING;
//! use thermobeam::parameters::Beam;
//! use thermobeam_exact::equilibrium::equilibria;
//!
//! let kappa = std::f64::consts::FRAC_PI_2;
//! assert!((BUCKLING - kappa.powi(2) / (1.0 + kappa.powi(2))).abs() < 1e-15);
//! let states = equilibria(&Beam { beta: -0.8, ..Beam::default() }, None)?;
//! let unstable: Vec<_> = states.iter().map(|state| state.unstable_directions).collect();
//! assert_eq!(unstable, [Some(0), Some(1), Some(0)]);
//! assert!((states[2].n_value + BUCKLING).abs() < 1e-12);
//! # Ok::<(), thermobeam_exact::equilibrium::EquilibriumError>(())
//! ```
//!
//! # N <= -1, and β <= -1
//!
//! For N < -1 the coefficient of u'' is negative: k² = 1 - q > 1, all functions are hyperbolic, and
//! there is no buckling value without contact. At N = -1 exactly φ = -c = 0 and u' = -aθ_A, a state
//! that exists for `ρ(aθ_A)² = -1 - β`. The second variation has infinitely many negative
//! directions at N <= -1: none of these states is stable. The buckling values N_k accumulate at -1
//! from above. For β > -1 the number of states is finite, because N >= β. For β <= -1 there are
//! infinitely many if θ_A = 0, or if -1 - β > (3/2) ρ (aθ_A)² and the obstacles admit u(1) = -aθ_A;
//! otherwise their number may be finite. [`completeness`] decides whether [`equilibria`] lists all.
//!
//! Source: the steady form of (1.1) and (1.3); the classification by N follows Sapir and Reiss
//! (reference \[16\] of the paper) for the beam without contact.

mod branch;
mod completeness;
mod law;
mod maximum;
mod polish;
mod proof;
mod scan;
mod shape;

use branch::Branch;
use law::{ForceLaw, Support};
use thermobeam::parameters::{Beam, Obstacles, ParameterError};
use thiserror::Error;

pub use completeness::{Completeness, completeness};
pub use maximum::maximize;
pub use proof::{Proof, ProvedState, Undecided, UndecidedReason, enclose_change, prove};
pub use shape::Shape;
pub use thermobeam::contact::Phase;

/// [`equilibria`] returns all states with N above the buckling value N_k of index k =
/// `BUCKLING_VALUES` + 1.
///
/// A state with smaller N has at least `BUCKLING_VALUES - 1` unstable directions, so every stable
/// state is returned for any β.
pub const BUCKLING_VALUES: usize = 16;

/// Why the steady states cannot be computed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EquilibriumError {
    /// A coefficient out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// ρ = 0 and β is a buckling value: the linear problem has infinitely many solutions without a
    /// load, and none with one.
    #[error(
        "the linear problem is singular at the buckling value N = {n_value} ({contact:?}): change beta, or take rho > 0"
    )]
    Resonance {
        /// The state of contact.
        contact: Phase,
        /// N = β.
        n_value: f64,
    },
    /// β is within round-off of a buckling value and the load is small: the number of states is
    /// undetermined.
    #[error(
        "beta is within round-off of the buckling value N = {n_value} ({contact:?}): change beta"
    )]
    Bifurcation {
        /// The state of contact.
        contact: Phase,
        /// The buckling value.
        n_value: f64,
    },
    /// A computed state violates N = β + ρ‖u'‖²: the coefficients are too large for double
    /// precision.
    #[error(
        "the state at N = {n_value} ({contact:?}) violates N = beta + rho |u'|^2 by a relative defect of {defect:e}: \
         take smaller coefficients"
    )]
    Inaccurate {
        /// The state of contact.
        contact: Phase,
        /// N of the state.
        n_value: f64,
        /// `N - β - ρ‖u'‖²` over one plus the largest of its terms.
        defect: f64,
    },
}

/// A steady state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equilibrium {
    /// The obstacle that the tip presses, `u(1) > g₂` or `u(1) < g₁`, if any.
    pub contact: Phase,
    /// Axial force N = β + ρ‖u'‖².
    pub n_value: f64,
    /// u(1).
    pub u_tip: f64,
    /// φ(1).
    pub phi_tip: f64,
    /// Contact force g(u(1)): positive at the upper obstacle, negative at the lower, zero without
    /// contact.
    pub contact_force: f64,
    /// Whether the second variation of the potential energy is positive definite: a strict minimum.
    ///
    /// False at a fold or a bifurcation, where it is only semidefinite. An obstacle that the
    /// straight beam touches without pressing stiffens one direction of u(1) only and does not
    /// count; two obstacles that hold the tip from both sides do.
    pub stable: bool,
    /// Number of negative directions of the second variation; `None` if there are infinitely many
    /// (N <= -1).
    pub unstable_directions: Option<usize>,
    /// The bent beam.
    pub shape: Shape,
}

/// All steady states, sorted by u(1), then N.
///
/// * `obstacles`: `None` leaves the tip free.
/// * All states with N above the buckling value of index [`BUCKLING_VALUES`] + 1 and all with N
///   <= -1. Those between, if there are any (see [`completeness`]), are unstable.
///
/// A state that touches an obstacle without pressing it, to round-off, may be missed or found
/// twice. Near a fold the number of states (none, one or two) is determined to round-off of N.
///
/// # Errors
/// [`EquilibriumError`] for a coefficient out of range, for ρ = 0 at a buckling value, for β at a
/// buckling value with a load of the size of round-off, and if the computed state is inaccurate.
///
/// ```
/// use thermobeam_exact::equilibrium::{Phase, equilibria};
/// use thermobeam::parameters::{Beam, Obstacles};
///
/// let beam = Beam { beta: -0.8, ..Beam::default() };
/// let states = equilibria(&beam, Some(&Obstacles::default()))?;
/// let found: Vec<_> = states.iter().map(|state| (state.contact, state.stable)).collect();
/// assert_eq!(found, [(Phase::Lower, true), (Phase::Free, false), (Phase::Upper, true)]);
/// # Ok::<(), thermobeam_exact::equilibrium::EquilibriumError>(())
/// ```
pub fn equilibria(
    beam: &Beam,
    obstacles: Option<&Obstacles>,
) -> Result<Vec<Equilibrium>, EquilibriumError> {
    beam.validate()?;
    obstacles.map_or(Ok(()), Obstacles::validate)?;
    let mut consistent = Vec::new();
    for (contact, law) in laws(beam, obstacles) {
        let branch = Branch {
            contact,
            law,
            held_tip: held_tip(obstacles),
        };
        let states = branch.states()?;
        consistent.extend(
            states
                .into_iter()
                .filter(|state| is_consistent(state, obstacles)),
        );
    }
    consistent.sort_by(|a, b| {
        a.u_tip
            .total_cmp(&b.u_tip)
            .then(a.n_value.total_cmp(&b.n_value))
    });
    Ok(consistent)
}

fn laws(beam: &Beam, obstacles: Option<&Obstacles>) -> Vec<(Phase, ForceLaw)> {
    let free = ForceLaw {
        moment: beam.a * beam.theta_a,
        beta: beam.beta,
        rho: beam.rho,
        support: None,
    };
    let mut laws = vec![(Phase::Free, free)];
    if let Some(&Obstacles { epsilon, g1, g2 }) = obstacles {
        for (contact, position) in [(Phase::Upper, g2), (Phase::Lower, g1)] {
            let support = Some(Support { epsilon, position });
            laws.push((contact, ForceLaw { support, ..free }));
        }
    }
    laws
}

/// The spring that holds the tip at 0 in both directions if both obstacles stand there.
fn held_tip(obstacles: Option<&Obstacles>) -> Option<ForceLaw> {
    let touching = obstacles.filter(|o| o.g1 == 0.0 && o.g2 == 0.0)?;
    Some(ForceLaw {
        support: Some(Support {
            epsilon: touching.epsilon,
            position: 0.0,
        }),
        ..ForceLaw::default()
    })
}

/// Whether a root satisfies the inequalities of the state of contact whose law it solves.
fn is_consistent(state: &Equilibrium, obstacles: Option<&Obstacles>) -> bool {
    match state.contact {
        Phase::Free => obstacles.is_none_or(|o| (o.g1..=o.g2).contains(&state.u_tip)),
        Phase::Upper => state.contact_force > 0.0,
        Phase::Lower => state.contact_force < 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_consistent_state_presses_its_obstacle_or_lies_between_both() {
        let obstacles = Obstacles {
            epsilon: 1.0,
            g1: -0.25,
            g2: 0.5,
        };
        let state = |contact, contact_force, u_tip| Equilibrium {
            contact,
            n_value: 0.0,
            u_tip,
            phi_tip: 0.0,
            contact_force,
            stable: true,
            unstable_directions: Some(0),
            shape: Shape::line(-u_tip),
        };
        for (contact, presses) in [
            (Phase::Upper, [false, false, true]),
            (Phase::Lower, [true, false, false]),
        ] {
            let found = [-1.0, 0.0, 1.0]
                .map(|force| is_consistent(&state(contact, force, 0.0), Some(&obstacles)));
            assert_eq!(found, presses, "{contact:?}");
        }
        let free = |u_tip| is_consistent(&state(Phase::Free, 0.0, u_tip), Some(&obstacles));
        assert_eq!(
            [-0.26, -0.25, 0.0, 0.5, 0.51].map(free),
            [false, true, true, true, false]
        );
        assert!(is_consistent(&state(Phase::Free, 0.0, 7.0), None));
    }
}
