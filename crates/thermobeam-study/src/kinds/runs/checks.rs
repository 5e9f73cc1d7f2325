//! The checks that studies of runs share: each makes claim, evidence and subject in one place.
//!
//! A claim holds if each of its conditions does. A condition compares such that NaN fails.

use convergence_study::Prose;

use super::cases::End;
use super::watch::{Worst, of_allowed};
use crate::kinds::prelude::*;

/// A part of a claim, and the numbers that show whether it holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// False for NaN.
    holds: bool,
    /// In words; empty if another condition shows the numbers.
    evidence: Prose,
}

impl Condition {
    /// * `holds`: must be false for NaN.
    pub fn that(holds: bool, evidence: impl Into<Prose>) -> Self {
        Self {
            holds,
            evidence: evidence.into(),
        }
    }

    /// A condition that is worth a word only if it fails.
    pub fn or(holds: bool, complaint: &str) -> Self {
        Self::that(holds, if holds { "" } else { complaint })
    }
}

/// A claim about a run, in the words of its file, which holds if each of its conditions does.
///
/// * `of`: what the conditions are on, such as `the answer`.
pub fn all<const N: usize>(
    run: &str,
    of: &str,
    claim: &str,
    conditions: [Condition; N],
) -> Measured {
    let failing = conditions.iter().filter(|condition| !condition.holds);
    let failing = if N == 0 {
        None
    } else {
        Some(failing.count() as f64)
    };
    let mut evidence = Prose::default();
    for condition in &conditions {
        evidence = evidence.then(&condition.evidence);
    }
    measured(run, format!("conditions on {of} that do not hold"), failing)
        .words(evidence.to_string())
        .must_be(Must::Count(0))
        .stated(claim)
}

/// A number is at most its bound.
pub fn at_most(value: f64, bound: f64, evidence: impl Into<Prose>) -> Condition {
    Condition::that(value <= bound, evidence)
}

/// A run ends as its case says.
///
/// * `steps`: the number of steps that it has done.
pub fn ended(end: End, said: End, steps: usize) -> Condition {
    Condition::that(end == said, format!("{} after {steps} steps", end.name()))
}

/// In every step of every run the energy does not rise by more than the bound on rounding errors,
/// and its balance closes to 1e-12 of the energy, or to that bound.
///
/// * `all_step`: whether each run has done a step; otherwise it shows nothing.
pub fn energy_and_balance(worst: &Worst, all_step: bool) -> [Measured; 2] {
    let of_bound = |name: &str, share: f64, of_energy: f64| {
        let words = format!("{}, {of_energy:.1e} of the energy", of_allowed(share));
        measured("", name, all_step.then_some(share))
            .words(words)
            .must_be(Must::AtMost(1.0))
    };
    let Worst {
        rise,
        risen,
        residual,
        open,
    } = *worst;
    [
        of_bound(
            "rise of the energy in a step over its bound, largest",
            risen,
            rise,
        ),
        of_bound(
            "residual of the balance in a step over its bound, largest",
            open,
            residual,
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn holds<const N: usize>(conditions: [Condition; N]) -> bool {
        all("run", "a quantity", "claim", conditions).holds() == Some(true)
    }

    #[test]
    fn nan_meets_no_condition_and_a_claim_needs_one() {
        let nan = f64::NAN;
        assert!(holds([at_most(1.0, 1.0, "")]));
        for broken in [
            at_most(nan, 1.0, ""),
            at_most(1.0, nan, ""),
            ended(End::Indefinite, End::Answer, 3),
        ] {
            assert!(
                !holds([at_most(0.0, 1.0, ""), broken.clone()]),
                "{broken:?}"
            );
        }
        assert!(!holds([]));
    }

    #[test]
    fn rise_and_residual_are_held_against_their_own_bounds() {
        let are_met = |worst: Worst, all_step| {
            energy_and_balance(&worst, all_step).map(|number| number.holds() == Some(true))
        };
        let sound = Worst::default();
        assert_eq!(are_met(sound, true), [true, true]);
        assert_eq!(are_met(sound, false), [false, false]);
        assert_eq!(
            are_met(
                Worst {
                    risen: 1.1,
                    ..sound
                },
                true
            ),
            [false, true]
        );
        assert_eq!(
            are_met(
                Worst {
                    open: f64::NAN,
                    ..sound
                },
                true
            ),
            [true, false]
        );
    }
}
