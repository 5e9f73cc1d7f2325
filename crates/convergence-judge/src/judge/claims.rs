//! Claims other than an order within a tolerance, each judged by what the [rule](super::verdict)
//! reads.
//!
//! `RULE.md` has a paragraph on each; the crate `convergence-calibration` measures how often it
//! errs.

use std::fmt;

use super::fit::Level;
use super::verdict::{Judge, RateVerdict, Reason, against_claim};

/// What theory claims about an error.
///
/// ```
/// use convergence_judge::{Claim, Judge, Level, Reason};
///
/// let levels = [0.4, 0.2, 0.1, 0.05].map(|step| Level { step, error: 3.0 * step * step });
/// let judge = Judge::default();
/// let claim = Claim { constant: Some([2.9, 3.1]), ..Claim::new(2.0, 0.1) };
/// assert_eq!(claim.judge(&judge, &levels).kind, Reason::Agrees);
/// let bound = Claim { at_least: true, ..Claim::new(1.0, 0.1) };
/// assert_eq!(bound.judge(&judge, &levels).kind, Reason::Agrees);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Claim {
    /// The order.
    pub order: f64,
    /// How far the rate may differ from it in either direction.
    pub tolerance: f64,
    /// Whether the order is a lower bound, so that no rate is too high.
    pub at_least: bool,
    /// The two numbers between which the constant must lie, if that is claimed.
    pub constant: Option<[f64; 2]>,
}

impl Claim {
    /// An order within a tolerance.
    pub const fn new(order: f64, tolerance: f64) -> Self {
        Self {
            order,
            tolerance,
            at_least: false,
            constant: None,
        }
    }

    /// The rate of these levels, held against everything claimed. (The tolerance of `judge` is not
    /// used.)
    pub fn judge(&self, judge: &Judge, levels: &[Level]) -> RateVerdict {
        self.judge_rounded(judge, levels, 0.0)
    }

    /// The same for a rate that is uncertain by `doubt`, see [`Judge::judge_rounded`].
    pub fn judge_rounded(&self, judge: &Judge, levels: &[Level], doubt: f64) -> RateVerdict {
        let rate = judge.judge_rounded(levels, self.order, doubt);
        let rate = if self.at_least { at_least(rate) } else { rate };
        match self.constant {
            Some(between) => with_constant(levels, rate, between),
            None => rate,
        }
    }
}

impl fmt::Display for Claim {
    /// `2 ± 0.1`, `at least 2 ± 0.1`, with the constant after it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let least = if self.at_least { "at least " } else { "" };
        write!(f, "{least}{} ± {}", self.order, self.tolerance)?;
        self.constant.map_or(Ok(()), |[least, most]| {
            write!(f, ", constant {least} to {most}")
        })
    }
}

/// An order as people write it: `2`, or `>= 2` for a lower bound; `None` if it is neither.
pub fn order_from_text(text: &str) -> Option<(f64, bool)> {
    let least = text.trim().strip_prefix(">=");
    let order = least.unwrap_or(text).trim().parse::<f64>().ok()?;
    (order > 0.0 && order.is_finite()).then_some((order, least.is_some()))
}

/// Half-width of the interval of a constant, in half-widths of the interval of the rate over the
/// finest refinement: it then holds the constant of errors with noise and pollution at least 9
/// times in 10 for any number of levels.
const DOUBT_OF_A_CONSTANT: f64 = 5.0;

/// The step for judging an error over degrees: `e = C F^-p` is a power `e = C step^(log F)` of it.
///
/// * `degree`: p or q of the elements, or another count; each increment divides the error by the
///   factor.
pub fn step_of_degree(degree: f64) -> f64 {
    (-degree).exp()
}

/// The order in [`step_of_degree`] of an error that falls by this factor per degree; > 0 for a
/// factor > 1.
pub fn order_of_factor(factor: f64) -> f64 {
    factor.ln()
}

/// The same rate judged against a lower bound on the order: a higher rate does not fail.
///
/// The interval must lie above the band's lower end; rates that move upwards do not depart.
pub fn at_least(rate: RateVerdict) -> RateVerdict {
    let least = rate.order - rate.tolerance;
    let rates = &rate.pairwise[..rate.used.end.saturating_sub(1)];
    let (Some([low, _]), [.., before, last]) = (rate.interval, rates) else {
        return rate;
    };
    let is_allowed = match rate.kind {
        Reason::TooHigh | Reason::AtTheEdge | Reason::IntervalTooWide => true,
        Reason::Departs => last > before,
        _ => false,
    };
    if low >= least && is_allowed {
        rate.with_reason(Reason::Agrees, Reason::Agrees.text())
    } else {
        rate
    }
}

/// The interval of the constant C of `e = C h^p` at h → 0, p being the order claimed; `None` if
/// there is no rate.
///
/// Beyond the finest level, h and e, the rates are assumed to approach p from q, the finest,
/// halving the remaining distance at each refinement by ρ, so that `log C` changes by
/// `(p - q) log ρ` in all. Five half-widths of the rate's interval, times log ρ, allow for slower
/// pollution and for scatter.
pub fn constant(levels: &[Level], rate: &RateVerdict) -> Option<[f64; 2]> {
    let [low, high] = rate.interval?;
    let [.., before, finest] = levels.get(rate.used.clone())? else {
        return None;
    };
    let ratio = (before.step / finest.step).ln();
    let last = (before.error / finest.error).ln() / ratio;
    let middle = finest.error.ln() - rate.order * finest.step.ln() + (rate.order - last) * ratio;
    let half = DOUBT_OF_A_CONSTANT * 0.5 * (high - low) * ratio;
    Some([(middle - half).exp(), (middle + half).exp()])
}

/// The same rate, whose constant must also lie between two numbers: a mistake of the scheme's own
/// order changes nothing else.
pub fn with_constant(levels: &[Level], rate: RateVerdict, [least, most]: [f64; 2]) -> RateVerdict {
    if !rate.verdict.is_pass() {
        return rate;
    }
    let Some([low, high]) = constant(levels, &rate) else {
        return rate;
    };
    let kind = if high < least || low > most {
        Reason::ConstantOff
    } else if low < least || high > most {
        Reason::ConstantUnsure
    } else {
        return rate;
    };
    let interval = format!("{low:.4} to {high:.4}");
    let numbers = against_claim(&interval, &format!("{least} to {most}"));
    rate.with_reason(kind, &format!("{} ({numbers})", kind.text()))
}

/// The largest error, and whether all errors are at most `bound`, for results that are exact up to
/// round-off. NaN never passes.
pub fn exact(errors: impl IntoIterator<Item = f64>, bound: f64) -> (f64, bool) {
    let largest = errors
        .into_iter()
        .map(f64::abs)
        .fold(f64::NEG_INFINITY, crate::text::number::max_or_nan);
    (largest, largest <= bound && largest >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::super::verdict::{Judge, Verdict};
    use super::*;

    fn levels(error: impl Fn(f64) -> f64) -> Vec<Level> {
        (1..7)
            .map(|k| 0.5_f64.powi(k))
            .map(|step| Level {
                step,
                error: error(step),
            })
            .collect()
    }

    fn judged(levels: &[Level], order: f64) -> RateVerdict {
        Judge::default().judge(levels, order)
    }

    #[test]
    fn a_higher_rate_is_at_least_the_order_and_a_lower_one_is_not() {
        let least =
            |order: f64, error: fn(f64) -> f64| at_least(judged(&levels(error), order)).kind;
        assert_eq!(least(2.0, |h| h.powi(3)), Reason::Agrees);
        assert_eq!(least(2.0, |h| h * h), Reason::Agrees);
        assert_eq!(least(2.0, |h| h.powf(1.5)), Reason::TooLow);
        // Between the ends of the band, and at the lower one.
        assert_eq!(least(1.8, |h| h * h), Reason::Agrees);
        assert_ne!(least(2.25, |h| h * h * (1.0 - 0.8 * h)), Reason::Agrees);
        // On their way up from the order, and down from above it.
        assert_eq!(least(2.0, |h| h * h - 0.004 * h), Reason::Agrees);
        assert_eq!(least(2.0, |h| h * h + 0.004 * h), Reason::Departs);
        assert_eq!(least(2.0, |h| h.powi(3) + 0.002 * h), Reason::FallsAway);
        assert_eq!(least(2.0, |_| f64::NAN), Reason::NonFiniteError);
    }

    #[test]
    fn errors_over_degrees_have_a_factor() {
        let by_factor = |factor: f64| {
            let levels = (1..6).map(f64::from).map(|p| Level {
                step: step_of_degree(p),
                error: 3.0 * factor.powf(-p),
            });
            levels.collect::<Vec<_>>()
        };
        assert_eq!(
            judged(&by_factor(5.0), order_of_factor(5.0)).verdict,
            Verdict::Pass
        );
        assert_eq!(
            judged(&by_factor(3.0), order_of_factor(5.0)).kind,
            Reason::TooLow
        );
        assert_eq!(
            at_least(judged(&by_factor(9.0), order_of_factor(5.0))).verdict,
            Verdict::Pass
        );
    }

    #[test]
    fn a_constant_is_held_against_its_interval() {
        let with = |levels: &[Level], least: f64, most: f64| {
            with_constant(levels, judged(levels, 2.0), [least, most]).kind
        };
        let smooth = levels(|h| 3.0 * h * h * (1.0 + 0.3 * h));
        let [low, high] = constant(&smooth, &judged(&smooth, 2.0)).expect("a rate");
        assert!(low < 3.0 && 3.0 < high && high / low < 1.1, "{low} {high}");
        assert_eq!(with(&smooth, 2.7, 3.3), Reason::Agrees);
        assert_eq!(with(&smooth, 3.3, 4.0), Reason::ConstantOff);
        assert_eq!(with(&smooth, 2.0, 2.7), Reason::ConstantOff);
        assert_eq!(with(&smooth, 3.0, 4.0), Reason::ConstantUnsure);
        assert_eq!(with(&smooth, 2.0, 3.0), Reason::ConstantUnsure);
        let lost = levels(|h| 3.0 * h);
        assert_eq!(with(&lost, 2.7, 3.3), Reason::TooLow);
        assert_eq!(constant(&smooth, &judged(&smooth[..2], 2.0)), None);
    }

    #[test]
    fn what_is_exact_has_no_error_above_the_bound() {
        assert_eq!(exact([1e-13, -2e-13], 1e-12), (2e-13, true));
        assert_eq!(exact([1e-13, -2e-12], 1e-12), (2e-12, false));
        assert!(!exact([1e-13, f64::NAN], 1e-12).1 && !exact([], 1e-12).1);
    }
}
