//! What became of the order in a variant.
//!
//! A rate alone does not tell that an order is back: a variant may make the part that is lost small
//! beside the other errors, so that it would show on finer levels only. So that part is measured.
//! With the order p that is claimed and the lower order q of the study's errors, the three finest
//! levels of a variant give
//!
//! `error = a h^p + b h^q + c h^(p+2)`.
//!
//! The order is back if the rate passes by the rule, b h^q is less than [`SHARE`] of the finest
//! error, and b, in proportion to the size of the solution, less than [`LEFT`] of that of the
//! study: the lost part is gone, not hidden. The order is lost if the rule refuses it, and a lower
//! order explains more than [`SHARE`]: a rate that rises to the claim is not lost. A variant whose
//! interval holds the order that is claimed is never lost.
//!
//! Measured on a plane problem of advection and diffusion at 8 to 64 cells, 16 variants of a right
//! program have shares from -0.025 to 0.017; a variant of a program with upwind differences, whose
//! rate passes at 1.95, has 0.046, and 17 % of the study's part.

use crate::run::Fate;
use crate::study::Outcome;
use convergence_judge::fit::Level;
use convergence_judge::verdict::{Band, RateVerdict, Reason, Tendency};

/// Errors this much smaller than those of the file's own solution are round-off, or what solvers
/// leave.
const ROUND_OFF: f64 = 1e-8;

/// Most of the finest error that a lower order may explain.
const SHARE: f64 = 0.1;

/// Most that may be left of the part that the study has lost.
const LEFT: f64 = 0.1;

/// Errors of a study or of a variant, and the size of its solution.
#[derive(Clone, Copy)]
pub(super) struct Sized<'o> {
    pub(super) outcome: &'o Outcome,
    pub(super) size: f64,
}

/// What became of the order of all these errors: it is lost if it is for one.
pub(super) fn fate(errors: &[String], base: Sized<'_>, variant: Sized<'_>) -> Fate {
    let fates: Vec<Fate> = errors
        .iter()
        .map(|error| fate_of(error, base, variant))
        .collect();
    [Fate::Lost, Fate::Unknown, Fate::RoundOff]
        .into_iter()
        .find(|fate| fates.contains(fate))
        .unwrap_or(Fate::Back)
}

fn fate_of(error: &str, base: Sized<'_>, variant: Sized<'_>) -> Fate {
    if largest(error, variant.outcome) <= ROUND_OFF * largest(error, base.outcome) {
        return Fate::RoundOff;
    }
    let rates = [base, variant].map(|sized| sized.outcome.rate(error));
    let [Some(of_base), Some(of_variant)] = rates else {
        return Fate::Unknown;
    };
    let left = Left::of(error, base, variant, of_base);
    match of_variant.code {
        Reason::TooLow | Reason::FallsAway | Reason::ErrorGrows | Reason::WrongLimit
            if holds_claim(of_variant) =>
        {
            Fate::Unknown
        }
        Reason::FallsAway | Reason::ErrorGrows | Reason::WrongLimit => Fate::Lost,
        Reason::TooLow if left.is_none_or(Left::is_seen) => Fate::Lost,
        // A higher order is not a lost one; a constant belongs to the solution.
        kind if is_order_reached(kind) && left.is_some_and(Left::is_gone) => Fate::Back,
        _ => Fate::Unknown,
    }
}

/// Whether the interval holds the order that is claimed.
fn holds_claim(rate: &RateVerdict) -> bool {
    let interval = rate.interval.zip(rate.claimed);
    interval.is_some_and(|(interval, Band { order, .. })| {
        interval.low <= order && order <= interval.high
    })
}

fn is_order_reached(reason: Reason) -> bool {
    matches!(
        reason,
        Reason::Agrees | Reason::TooHigh | Reason::ConstantOff | Reason::ConstantUnsure
    )
}

/// NaN if one of the errors is.
fn largest(error: &str, outcome: &Outcome) -> f64 {
    let errors = outcome.levels.iter().map(|level| level.error(error));
    errors.fold(0.0, crate::text::number::max_or_nan)
}

/// The order of the part that is lost: the rate to the nearest half.
fn lower_order(rate: &RateVerdict, order: f64) -> f64 {
    if matches!(rate.tendency, Some(Tendency::Constant { .. })) {
        return 0.0;
    }
    let nearest = (2.0 * rate.fitted.unwrap_or(order - 1.0)).round() / 2.0;
    nearest.min(order - 0.5).max(0.0)
}

/// What a variant leaves of the part that the study has lost.
#[derive(Debug, Clone, Copy)]
struct Left {
    /// The share of the variant's finest error that the lower order explains.
    share: f64,
    /// The coefficient of the lower order over that of the study, both in proportion to the size of
    /// the solution; `None` where the study shows none, as one that is inconclusive may.
    of_study: Option<f64>,
}

impl Left {
    /// `None` without a claim or three levels.
    fn of(error: &str, base: Sized<'_>, variant: Sized<'_>, rate: &RateVerdict) -> Option<Self> {
        let Band { order, .. } = rate.claimed?;
        let lower = lower_order(rate, order);
        let lost = Lost { order, lower };
        let of_base = lost.part(&base.outcome.levels_of(error))?;
        let of_variant = lost.part(&variant.outcome.levels_of(error))?;
        let relative = (of_variant.coefficient / variant.size) / (of_base.coefficient / base.size);
        Some(Self {
            share: of_variant.share,
            of_study: (of_base.coefficient > 0.0).then_some(relative),
        })
    }

    fn is_gone(self) -> bool {
        self.share <= SHARE && self.of_study.is_none_or(|left| left <= LEFT)
    }

    fn is_seen(self) -> bool {
        self.share > SHARE
    }
}

/// The order that is claimed, and the one of the part that is lost.
#[derive(Debug, Clone, Copy)]
struct Lost {
    order: f64,
    lower: f64,
}

/// What a lower order explains of errors.
#[derive(Debug, Clone, Copy)]
struct LowerOrderPart {
    /// The b of b h^q.
    coefficient: f64,
    /// Its share of the finest error.
    share: f64,
}

impl Lost {
    /// The part of the lower order; `None` without three levels.
    fn part(self, levels: &[Level]) -> Option<LowerOrderPart> {
        let [.., coarse, middle, fine] = levels else {
            return None;
        };
        let rows = [fine, middle, coarse].map(|level| {
            // In units of the finest step and of its error.
            let ratio = level.step / fine.step;
            let power = |exponent: f64| ratio.powf(exponent);
            [
                power(self.order),
                power(self.lower),
                power(self.order + 2.0),
                level.error / fine.error,
            ]
        });
        let without = |column: usize| {
            rows.map(|mut row| {
                row[column] = row[3];
                [row[0], row[1], row[2]]
            })
        };
        let matrix = rows.map(|row| [row[0], row[1], row[2]]);
        // Cramer's rule.
        let share = determinant(without(1)) / determinant(matrix);
        let coefficient = share * fine.error / fine.step.powf(self.lower);
        coefficient
            .is_finite()
            .then_some(LowerOrderPart { coefficient, share })
    }
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::{LevelErrors, NamedRate};
    use crate::text::named::NamedNumber;
    use convergence_judge::fit::Level;
    use convergence_judge::verdict::judge_pairs;

    const STEPS: [f64; 4] = [1.0 / 8.0, 1.0 / 16.0, 1.0 / 32.0, 1.0 / 64.0];

    fn outcome(errors: [f64; 4]) -> Outcome {
        let pairs = STEPS.into_iter().zip(errors);
        let rate = NamedRate::new("L2", judge_pairs(pairs.clone(), 2.0, 0.25));
        let levels = pairs.map(|(step, error)| LevelErrors {
            parameters: vec![],
            step: Some(step),
            work: None,
            errors: vec![NamedNumber::new("L2", error)],
            without: vec![],
        });
        Outcome {
            levels: levels.collect(),
            ..Outcome::new("", vec![rate], vec![])
        }
    }

    fn of(base: [f64; 4], variant: [f64; 4], size: f64) -> Fate {
        let [base, variant] = [base, variant].map(outcome);
        fate(
            &["L2".to_owned()],
            Sized {
                outcome: &base,
                size: 1.0,
            },
            Sized {
                outcome: &variant,
                size,
            },
        )
    }

    #[test]
    fn the_part_of_a_lower_order_is_that_of_the_law() {
        let law = |step: f64| 3.0 * step.powi(2) + 0.5 * step + 20.0 * step.powi(4);
        let levels = STEPS.map(|step| Level {
            step,
            error: law(step),
        });
        let lost = Lost {
            order: 2.0,
            lower: 1.0,
        };
        let part = lost.part(&levels).unwrap();
        assert!((part.coefficient - 0.5).abs() < 1e-10, "{part:?}");
        let expected = 0.5 * STEPS[3] / law(STEPS[3]);
        assert!((part.share - expected).abs() < 1e-10, "{part:?}");
        assert!(lost.part(&levels[..2]).is_none());
    }

    /// Errors of the solver of advection and diffusion with upwind differences along y.
    const UPWIND: [f64; 4] = [1.633e-3, 5.365e-4, 4.485e-4, 2.764e-4];

    #[test]
    fn a_rate_that_passes_is_not_back_while_the_lost_part_may_hide() {
        // Flat at both faces of x: rates 1.69, 1.92, 1.95.
        let hidden = [2.36e-2, 7.33e-3, 1.941e-3, 5.02e-4];
        assert!(outcome(hidden).rate("L2").unwrap().verdict.is_pass());
        assert_eq!(of(UPWIND, hidden, 0.4), Fate::Unknown);
        // The same of the right program, and constant along y of the wrong one.
        let right = [2.37e-2, 7.377e-3, 1.9529e-3, 4.953e-4];
        assert_eq!(of(UPWIND, right, 0.4), Fate::Back);
        let constant = [6.14e-3, 1.538e-3, 3.843e-4, 9.6e-5];
        assert_eq!(of(UPWIND, constant, 1.0), Fate::Back);
        // Flat at the first time: rates 1.87, 1.89, 1.84, in a solution that is small.
        let share = [8.95e-5, 2.455e-5, 6.62e-6, 1.856e-6];
        assert_eq!(of(UPWIND, share, 0.03), Fate::Unknown);
    }

    #[test]
    fn a_variant_whose_interval_holds_the_claim_is_never_lost() {
        // Rates 1.8, 1.0, 1.2: the interval is wide.
        let drifting = [1e-2, 2.87e-3, 1.44e-3, 6.25e-4];
        let rate = outcome(drifting).rate("L2").unwrap().clone();
        assert!(holds_claim(&rate), "{rate:?}");
        assert_eq!(of(UPWIND, drifting, 1.0), Fate::Unknown);
    }

    #[test]
    fn a_rate_that_rises_to_the_claim_is_not_lost() {
        // Rates 1.3, 1.8, 1.9, as with a bubble.
        let rising = STEPS.map(|step| step.powi(2) / (1.0 + 40.0 * step.powi(2)));
        assert_ne!(of(UPWIND, rising, 1.0), Fate::Lost);
    }

    #[test]
    fn lost_and_round_off_are_told_from_each_other() {
        let first = STEPS.map(|step| 0.3 * step);
        assert_eq!(of(UPWIND, first, 1.0), Fate::Lost);
        assert_eq!(
            of(UPWIND, [1e-13, 2e-13, 1e-13, 3e-13], 1.0),
            Fate::RoundOff
        );
        assert_eq!(of(UPWIND, [f64::NAN, 1e-3, 1e-4, 1e-5], 1.0), Fate::Unknown);
        let fourth = STEPS.map(|step| step.powi(4));
        assert_eq!(of(UPWIND, fourth, 1.0), Fate::Back);
    }
}
