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

/// The check of a claim with several conditions.
pub fn all<const N: usize>(
    claim: impl Into<Prose>,
    subject: Subject,
    conditions: [Condition; N],
) -> Check {
    let holds = N > 0 && conditions.iter().all(|condition| condition.holds);
    let mut evidence = Prose::default();
    for condition in conditions {
        evidence = evidence.then(&condition.evidence);
    }
    Check::that(holds, claim, evidence).about(subject)
}

/// A number is at most its bound.
pub fn at_most(value: f64, bound: f64, evidence: impl Into<Prose>) -> Condition {
    Condition::that(value <= bound, evidence)
}

/// Two runs agree.
///
/// * `runs`: what they are, such as `two discretisations`.
/// * `difference`: the largest one of their numbers.
pub fn agree(runs: &str, subject: Subject, difference: f64, bound: f64) -> Check {
    let evidence = format!("largest difference {difference:.1e}");
    let claim = format!("{runs} agree within {bound:e}");
    all(claim, subject, [at_most(difference, bound, evidence)])
}

/// A run ends as its case says.
///
/// * `steps`: the number of steps that it has done.
pub fn ended(end: End, said: End, steps: usize) -> Condition {
    Condition::that(end == said, format!("{} after {steps} steps", end.name()))
}

/// In every step of every run the energy does not rise, and its balance closes.
///
/// * `all_step`: whether each run has done a step; otherwise it shows nothing.
pub fn energy_and_balance(worst: &Worst, all_step: bool) -> [Check; 2] {
    let rise = format!(
        "largest rise {:.1e} of the energy, {}",
        worst.rise,
        of_allowed(worst.risen)
    );
    let residual = format!(
        "largest residual {:.1e} of the energy, {}",
        worst.residual,
        of_allowed(worst.open)
    );
    [
        all(
            "the energy never rises by more than the bound on rounding errors",
            Subject::of("energy"),
            [Condition::that(all_step && worst.risen <= 1.0, rise)],
        ),
        all(
            "the balance closes to 1e-12 of the energy, or to the bound on rounding errors",
            Subject::of("balance"),
            [Condition::that(all_step && worst.open <= 1.0, residual)],
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::reference::largest_difference;

    fn verdict<const N: usize>(conditions: [Condition; N]) -> Verdict {
        all("claim", Subject::of("quantity"), conditions).verdict
    }

    #[test]
    fn nan_meets_no_condition_and_a_claim_needs_one() {
        let nan = f64::NAN;
        assert_eq!(verdict([at_most(1.0, 1.0, "")]), Verdict::Pass);
        for broken in [
            at_most(nan, 1.0, ""),
            at_most(1.0, nan, ""),
            ended(End::Indefinite, End::Answer, 3),
        ] {
            assert_eq!(
                verdict([at_most(0.0, 1.0, ""), broken.clone()]),
                Verdict::Fail,
                "{broken:?}"
            );
        }
        assert_eq!(verdict([]), Verdict::Fail);
    }

    #[test]
    fn runs_agree_if_all_their_numbers_do() {
        let of = |one: &[f64], other: &[f64]| {
            agree(
                "two runs",
                Subject::of("u"),
                largest_difference(one, other),
                0.5,
            )
            .verdict
        };
        assert_eq!(of(&[1.0, 2.0], &[1.0, 2.5]), Verdict::Pass);
        assert_eq!(of(&[1.0, 2.0], &[1.0, 2.6]), Verdict::Fail);
        assert_eq!(of(&[f64::NAN, 2.0], &[1.0, 2.0]), Verdict::Fail);
        assert_eq!(of(&[1.0, 2.0], &[1.0]), Verdict::Fail);
        assert_eq!(of(&[], &[]), Verdict::Fail);
    }

    #[test]
    fn rise_and_residual_are_held_against_their_own_bounds() {
        let verdicts = |worst: Worst, all_step| {
            energy_and_balance(&worst, all_step).map(|check| check.verdict)
        };
        let (pass, fail) = (Verdict::Pass, Verdict::Fail);
        let sound = Worst::default();
        assert_eq!(verdicts(sound, true), [pass, pass]);
        assert_eq!(verdicts(sound, false), [fail, fail]);
        assert_eq!(
            verdicts(
                Worst {
                    risen: 1.1,
                    ..sound
                },
                true
            ),
            [fail, pass]
        );
        assert_eq!(
            verdicts(
                Worst {
                    open: f64::NAN,
                    ..sound
                },
                true
            ),
            [pass, fail]
        );
    }
}
