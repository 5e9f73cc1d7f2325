//! The last sentence of Section 5: how many steady states there are, and in which a moving beam
//! comes to rest.

use super::AtRest;
use crate::kinds::prelude::*;
use convergence_study::Origin;
use thermobeam::kirchhoff::BUCKLING;

/// The β below which the paper's text claims several steady states.
const AS_PRINTED: f64 = -0.5;

/// A beam with a tip closer to zero than this is straight: bent tips start at some 0.01, the lower
/// obstacle.
const STRAIGHT: f64 = 1e-6;

/// How many steady states there are below β = -1/2, and in which a moving beam comes to rest.
pub(super) fn checks(rests: &[(f64, &AtRest)]) -> [Check; 3] {
    AxialForce::ALL.map(|range| {
        let mut holds = true;
        let mut evidence = vec![];
        for (beta, rest) in rests {
            if AxialForce::of(*beta) == Some(range) {
                holds &= range.is_as_claimed(rest);
                let count = rest.count();
                let [u, _] = rest.tip;
                evidence.push(format!(
                    "β = {beta}: {count} of them, at rest u(1) = {u:.2e}"
                ));
            }
        }
        if evidence.is_empty() {
            holds = false;
            evidence.push("no β in this range".to_owned());
        }
        if range == AxialForce::Refuted {
            evidence.push(format!(
                "the potential energy is strictly convex for β ≥ -(π²/4)/(1 + π²/4) = {:.6}",
                -BUCKLING
            ));
        }
        Check::that(holds, range.claim(), evidence.join("; "))
            .about(Subject::of(range.quantity()))
            .stated_by(range.origin())
    })
}

/// Where an axial force at rest lies, which decides what is claimed of it.
///
/// At β = -1/2 the paper claims nothing, and the straight beam is the only steady state, as above.
/// The same holds at β = -B: the quadratic part of the potential energy is not negative there, and
/// vanishes only along the buckling mode, along which ρ/4 ‖u_x‖⁴ is strictly convex. So both ends
/// belong to the range between them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum AxialForce {
    /// β > -1/2: one steady state, as the paper says.
    AsPrinted,
    /// -B <= β <= -1/2: one steady state, against the paper.
    Refuted,
    /// β < -B: several steady states.
    BeyondBuckling,
}

impl AxialForce {
    const ALL: [Self; 3] = [Self::AsPrinted, Self::Refuted, Self::BeyondBuckling];

    /// What is claimed of it.
    fn claim(self) -> &'static str {
        match self {
            Self::AsPrinted => {
                "uniqueness for β > -1/2: the straight beam is the only steady state, and moving beams come to rest in it"
            }
            Self::Refuted => {
                "not as printed (\"for β < -1/2 there are multiple steady-state solutions\"): for -0.7116 ≤ β ≤ -1/2 \
                 there is only one, the straight beam"
            }
            Self::BeyondBuckling => {
                "for β < -0.7116 there are several steady states, two of them stable, and moving beams come to rest bent"
            }
        }
    }

    fn is_as_claimed(self, rest: &AtRest) -> bool {
        let tip = rest.tip[0].abs();
        match self {
            Self::AsPrinted | Self::Refuted => rest.states == 1 && tip <= STRAIGHT,
            Self::BeyondBuckling => {
                rest.states >= 3 && rest.stable >= 2 && tip > STRAIGHT && rest.is_stable()
            }
        }
    }

    /// Whose statement the claim is.
    fn origin(self) -> Origin {
        match self {
            Self::AsPrinted => Origin::Source,
            Self::Refuted => Origin::Correction,
            Self::BeyondBuckling => Origin::Own,
        }
    }

    /// What is claimed of it, as a quantity.
    fn quantity(self) -> &'static str {
        match self {
            Self::AsPrinted => "steady states as printed",
            Self::Refuted => "steady states against the paper",
            Self::BeyondBuckling => "steady states beyond buckling",
        }
    }

    /// `None` for NaN alone.
    fn of(beta: f64) -> Option<Self> {
        if beta > AS_PRINTED {
            Some(Self::AsPrinted)
        } else if beta >= -BUCKLING {
            Some(Self::Refuted)
        } else if beta < -BUCKLING {
            Some(Self::BeyondBuckling)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermobeam::parameters::{Beam, Obstacles};
    use thermobeam_exact::equilibrium::equilibria;

    /// The number of steady states is that of the claim, at both ends of each range and next to
    /// them.
    #[test]
    fn each_axial_force_falls_under_the_claim_that_is_true_of_it() {
        let rows = [
            (-0.4999, AxialForce::AsPrinted),
            (-0.5, AxialForce::Refuted),
            (-0.6, AxialForce::Refuted),
            (-BUCKLING, AxialForce::Refuted),
            (-BUCKLING - 1e-6, AxialForce::BeyondBuckling),
            (-0.8, AxialForce::BeyondBuckling),
        ];
        for (beta, expected) in rows {
            assert_eq!(AxialForce::of(beta), Some(expected), "{beta}");
            let beam = Beam {
                beta,
                ..Beam::default()
            };
            let states = equilibria(&beam, Some(&Obstacles::default()))
                .unwrap()
                .len();
            let is_several = expected == AxialForce::BeyondBuckling;
            assert_eq!(states > 1, is_several, "β = {beta}: {states} states");
        }
        assert_eq!(AxialForce::of(f64::NAN), None);
    }
}
