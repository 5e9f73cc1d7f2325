//! What errors tend to where a claim does not pass: what to look for depends on it. Advice, no part
//! of the verdict.

use crate::fit::{Level, pairwise_rates};
use crate::text::number::{error_text, plain_text};
use crate::three_values::{StepValue, correction, observed_order};

/// Rates below this are those of errors that have stopped falling.
const STOPPED: f64 = 0.5;
/// Largest difference between two steady rates.
const STEADY: f64 = 0.2;
/// Least share of the finest error that a limit has; errors that tend to zero have none.
const LEAST_LIMIT: f64 = 0.7;
/// Errors that fall by more at the last refinement have not stopped, whatever their rate: steps of
/// degrees are far apart.
const MOST_FALL: f64 = 4.0;
/// An error so many times that of the coarser level is the result of a run that has broken down.
const BROKEN: f64 = 1e3;

/// What the errors tend to as the step does to zero.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Tendency {
    /// They fall steadily, then stop.
    Plateau {
        /// The rate with which they fall.
        rate: f64,
        /// The error at which they stop.
        error: f64,
    },
    /// A constant that is not zero.
    Constant {
        /// The constant, if the differences go on falling as the last two.
        limit: f64,
    },
    /// They grow at every refinement.
    Growth,
    /// One of them is far above that of the coarser level.
    Breakdown {
        /// The largest such error.
        error: f64,
    },
    /// The finest, and no other, is zero.
    ZeroAtTheFinest,
}

impl Tendency {
    /// What it means, and what to do.
    pub fn advice(self) -> String {
        match self {
            Self::Plateau { rate, error } => format!(
                "The errors fall with rate {rate:.2} down to {}, then stop. What stays there: the solver's tolerance, \
                 the reference solution, round-off (set a floor), the error of the other axis, a coefficient that is \
                 slightly wrong?",
                error_text(error)
            ),
            Self::Constant { limit } => format!(
                "The errors tend to about {}, not to zero: the scheme solves another problem (a coefficient, a sign, \
                 the source, a boundary or initial value), its solver stops too early (a tolerance), the reference is off, \
                 or an axis that is not refined dominates.",
                plain_text(limit)
            ),
            Self::Growth => "The errors grow at every refinement: the scheme is unstable, or the errors do not stand \
                 beside their own steps. Finer levels do not help."
                .to_owned(),
            Self::Breakdown { error } => format!(
                "An error of {} is far above that of the coarser level: that run has broken down. Finer levels do not \
                 help; mend that case.",
                error_text(error)
            ),
            Self::ZeroAtTheFinest => "The error is zero on the finest level only. Is that level its own reference? \
                 Leave it out."
                .to_owned(),
        }
    }

    /// The limit E of `e = E + C h^q` through the three finest levels, if it is most of the finest
    /// number, which then hardly changes; for numbers of one sign.
    pub fn limit(levels: &[Level]) -> Option<f64> {
        let [.., coarse, middle, fine] = levels else {
            return None;
        };
        let rate = (middle.error / fine.error).ln() / (middle.step / fine.step).ln();
        let falls = middle.error > MOST_FALL * fine.error;
        if rate.is_nan() || rate.abs() >= STOPPED || falls {
            return None;
        }
        let limit = if middle.error == fine.error {
            fine.error
        } else {
            let values = [coarse, middle, fine].map(|level| StepValue {
                step: level.step,
                value: level.error,
            });
            let order = observed_order(values).ok()?;
            fine.error + correction(middle.error, fine.error, middle.step / fine.step, order)
        };
        let share = limit / fine.error;
        (share > LEAST_LIMIT && share < 1.0 / LEAST_LIMIT).then_some(limit)
    }

    /// What these errors, coarsest first and above the round-off, tend to; `None` for errors that
    /// go on falling, or scatter.
    pub(super) fn of(levels: &[Level]) -> Option<Self> {
        let (finest, coarser) = levels.split_last()?;
        if finest.error == 0.0 && coarser.iter().all(|level| level.error > 0.0) {
            return Some(Self::ZeroAtTheFinest);
        }
        if !levels
            .iter()
            .all(|level| level.error > 0.0 && level.error.is_finite() && level.step > 0.0)
        {
            return None;
        }
        let rates = pairwise_rates(levels);
        // Errors that grow towards a constant have that tendency.
        broken(levels)
            .or_else(|| plateau(levels, &rates))
            .or_else(|| Self::limit(levels).map(|limit| Self::Constant { limit }))
            .or_else(|| growth(&rates))
    }
}

/// The largest error that is far above that of the coarser level.
fn broken(levels: &[Level]) -> Option<Tendency> {
    let pairs = levels.windows(2);
    let broken = pairs.filter(|pair| pair[1].error > BROKEN * pair[0].error);
    let error = broken.map(|pair| pair[1].error).reduce(f64::max)?;
    Some(Tendency::Breakdown { error })
}

/// Errors that grow at every refinement.
fn growth(rates: &[f64]) -> Option<Tendency> {
    let grow = rates.len() > 1 && rates.iter().all(|rate| *rate < 0.0);
    grow.then_some(Tendency::Growth)
}

/// Errors that fall at a steady rate down to one at which they stop.
fn plateau(levels: &[Level], rates: &[f64]) -> Option<Tendency> {
    let last = rates.last()?;
    let stop = (2..rates.len()).find(|&k| {
        let steady = rates[k - 1];
        let stops = rates[k..].iter().all(|rate| *rate < steady - STOPPED)
            && *last < 0.5 * steady
            && steady > STOPPED;
        stops && (rates[k - 2] - steady).abs() <= STEADY
    })?;
    Some(Tendency::Plateau {
        rate: rates[stop - 1],
        error: levels[stop].error,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::with_errors;

    fn of(steps: &[f64], error: impl Fn(f64) -> f64) -> Option<Tendency> {
        let level = |&step: &f64| Level {
            step,
            error: error(step),
        };
        Tendency::of(&steps.iter().map(level).collect::<Vec<_>>())
    }

    const HALVED: [f64; 5] = [0.1, 0.05, 0.025, 0.0125, 0.00625];
    const UNEQUAL: [f64; 5] = [0.1, 0.06, 0.03, 0.02, 0.0125];

    #[test]
    fn errors_that_tend_to_zero_however_slowly_have_no_tendency() {
        for steps in [HALVED, UNEQUAL] {
            for power in [0.1, 0.2, 0.5, 1.0, 2.0] {
                assert_eq!(of(&steps, |h| 0.3 * h.powf(power)), None, "{power}");
            }
            assert_eq!(of(&steps, |h| 1.0 / (1.0 / h).ln()), None);
            assert_eq!(of(&steps, |h| h * h + 0.02 * h), None);
        }
        // A power of the degree, over steps that are exponentials of it.
        let degrees = [2.0_f64, 4.0, 8.0, 16.0, 32.0].map(|p| (-p).exp());
        assert_eq!(of(&degrees, |h| (-h.ln()).powi(-6)), None);
    }

    /// 1 + 0.3 h² has most of its finest number in its limit, and still falls by the order 0.76.
    #[test]
    fn errors_that_fall_by_more_than_half_an_order_have_no_limit() {
        let limit = |share: f64| {
            let levels = with_errors(4.0, &[16.0, 4.0, 1.0].map(|square| 1.0 + share * square));
            Tendency::limit(&levels)
        };
        assert_eq!(limit(0.3), None);
        let found = limit(0.1).expect("a limit");
        assert!((found - 1.0).abs() < 1e-12, "{found}");
    }

    #[test]
    fn a_wrong_problem_tends_to_a_constant_which_is_said() {
        for steps in [HALVED, UNEQUAL] {
            for (share, power) in [(3.0, 1.0), (0.5, 2.0), (-2.0, 1.0), (0.0, 1.0)] {
                let found = of(&steps, |h: f64| 0.03 * (1.0 + share * h.powf(power)));
                let Some(Tendency::Constant { limit }) = found else {
                    panic!("{share} {power}: {found:?}");
                };
                assert!((limit - 0.03).abs() < 1e-6, "{share} {power}: {limit}");
            }
        }
        let advice = Tendency::Constant { limit: 0.03 }.advice();
        assert!(advice.contains("about 0.03, not to zero"), "{advice}");
    }

    #[test]
    fn what_stops_grows_or_breaks_down_is_told_apart() {
        let of = |errors: &[f64]| Tendency::of(&with_errors(0.1, errors));
        let stops = of(&[0.01, 0.0025, 0.000625, 0.00015625, 3.9e-5, 4.3e-5]);
        assert!(
            matches!(stops, Some(Tendency::Plateau { error, .. }) if error == 3.9e-5),
            "{stops:?}"
        );
        assert_eq!(of(&[1e-3, 4e-3, 1.6e-2, 6.4e-2]), Some(Tendency::Growth));
        assert_eq!(
            of(&[1e-2, 2.5e-3, 5e14, 1e-3]),
            Some(Tendency::Breakdown { error: 5e14 })
        );
        // In any unit of the errors.
        for unit in [1e-9, 1e9] {
            let error = 4e3 * unit;
            assert_eq!(
                of(&[4.0 * unit, unit, error]),
                Some(Tendency::Breakdown { error })
            );
            let fine = of(&[4.0 * unit, unit, 0.9e3 * unit]);
            assert!(
                !matches!(fine, Some(Tendency::Breakdown { .. })),
                "{fine:?}"
            );
        }
        assert_eq!(of(&[1e-2, 2.5e-3, 0.0]), Some(Tendency::ZeroAtTheFinest));
        assert_eq!(of(&[1e-2, 0.0, 0.0]), None);
        assert_eq!(of(&[1e-2, f64::NAN, 1e-3]), None);
    }
}
