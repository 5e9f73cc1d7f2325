//! The last sentence of Section 5: how many steady states there are, and in which a moving beam
//! comes to rest.
//!
//! At β = -1/2 the paper claims nothing, and the straight beam is the only steady state, as above.
//! The same holds at β = -B: the quadratic part of the potential energy is not negative there, and
//! vanishes only along the buckling mode, along which ρ/4 ‖u_x‖⁴ is strictly convex. So both ends
//! belong to the range between them.

use crate::studies::prelude::*;
use crate::studies::steady::AtRest;
use thermobeam::kirchhoff::BUCKLING;

/// The β below which the paper's text claims several steady states.
const AS_PRINTED: f64 = -0.5;

/// A beam with a tip closer to zero than this is straight: bent tips start at some 0.01, the lower
/// obstacle.
const STRAIGHT: f64 = 1e-6;

/// Several β, each with its run to rest.
type Rests<'r> = [(f64, &'r AtRest)];

/// Uniqueness for β > -1/2, as printed.
pub(super) fn unique(rests: &Rests<'_>) -> Sheet {
    let words = "Uniqueness for β > -1/2: the straight beam is the only steady state, and moving beams come to rest in it";
    straight(words, rests, |beta| beta > AS_PRINTED)
}

/// Uniqueness for -B <= β <= -1/2, against the paper.
pub(super) fn unique_below(rests: &Rests<'_>) -> Sheet {
    let words = "Not as printed (\"for β < -1/2 there are multiple steady-state solutions\"): for -0.7116 ≤ β ≤ -1/2 there is only one, \
                 the straight beam, since the potential energy is strictly convex";
    straight(words, rests, |beta| {
        (-BUCKLING..=AS_PRINTED).contains(&beta)
    })
}

/// Several steady states beyond buckling.
pub(super) fn several(rests: &Rests<'_>) -> Sheet {
    let words = "For β < -0.7116 there are several steady states, two of them stable, and moving beams come to rest bent";
    let beyond = rests.iter().filter(|(beta, _)| *beta < -BUCKLING);
    let numbers = beyond.flat_map(|(beta, rest)| {
        let claims = [
            Must::AtLeast(3.0),
            Must::AtLeast(2.0),
            Must::Above(STRAIGHT),
        ]
        .map(Some);
        let case = format!("β = {beta}");
        let unstable = none_of(
            &case,
            "rests where it is not stable",
            usize::from(!rest.is_stable()),
        );
        at_rest(case, rest, claims).into_iter().chain([unstable])
    });
    Sheet::new(words, "axial force", numbers)
}

/// One steady state, in which beams come to rest.
fn straight(words: &str, rests: &Rests<'_>, is_chosen: impl Fn(f64) -> bool) -> Sheet {
    let chosen = rests.iter().filter(|(beta, _)| is_chosen(*beta));
    let numbers = chosen.flat_map(|(beta, rest)| {
        let claims = [Some(Must::Count(1)), None, Some(Must::AtMost(STRAIGHT))];
        at_rest(format!("β = {beta}"), rest, claims)
    });
    Sheet::new(words, "axial force", numbers)
}

/// * `claims`: what the number of steady states, that of the stable ones and |u(1)| must be.
fn at_rest(case: String, rest: &AtRest, [states, stable, tip]: [Option<Must>; 3]) -> [Measured; 5] {
    let one = |name: &str, value: f64| measured(&case, name, value);
    [
        one("steady states", rest.states as f64)
            .words(rest.count())
            .must_be(states),
        one("stable", rest.stable as f64).fixed(0).must_be(stable),
        one("|u(1)| at rest", rest.tip[0].abs())
            .scientific(6)
            .must_be(tip),
        one("distance to the nearest", rest.distance()).scientific(1),
        one("at rest by t", rest.t).fixed(0),
    ]
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
        for (beta, place) in [
            (-0.4999, 0),
            (-0.5, 1),
            (-0.6, 1),
            (-BUCKLING, 1),
            (-BUCKLING - 1e-6, 2),
            (-0.8, 2),
        ] {
            let beam = Beam {
                beta,
                ..Beam::default()
            };
            let states = equilibria(&beam, Some(&Obstacles::default())).expect("states");
            let rest = AtRest {
                t: 1.0,
                tip: [0.0; 2],
                states: states.len(),
                is_complete: true,
                stable: states.iter().filter(|state| state.stable).count(),
                nearest: None,
            };
            let sheets = [unique, unique_below, several].map(|sheet| sheet(&[(beta, &rest)]));
            for (k, sheet) in sheets.iter().enumerate() {
                assert_eq!(sheet.measured.is_empty(), k != place, "β = {beta}: {k}");
            }
            let counts = &sheets[place].measured[..2];
            let hold = counts.iter().all(|count| count.holds() != Some(false));
            assert!(hold, "β = {beta}: {counts:?}");
        }
    }
}
