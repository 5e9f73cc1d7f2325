//! Claims other than an order within a tolerance, each judged by what the [rule](super::verdict)
//! reads.
//!
//! `RULE.md` has a paragraph on each; the crate `convergence-calibration` measures how often it
//! errs.

mod constant;
mod degrees;

use std::fmt;

use super::fit::Level;
use super::verdict::{
    Band, DEFAULT_TOLERANCE, Floor, Judge, Printed, RateVerdict, Reading, Reason, judge_band,
    judged_in_words,
};
use crate::interval::Interval;
use crate::text::number::{committed_rate, order_text};

pub use constant::{constant, with_constant};
pub use degrees::{order_of_factor, step_of_degree, unless_algebraic};

/// Which rates above an order agree with it.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "kebab-case")]
pub enum Bound {
    /// Those within the tolerance, as below it.
    #[default]
    Both,
    /// Those up to one order more, `>=P`: beyond, the whole interval is
    /// [too good](Reason::TooGood).
    AtLeast,
    /// Any, `>=P..`.
    AnyAbove,
}

impl Bound {
    /// Whether rates above the order agree no more than those below.
    pub(super) fn is_both(&self) -> bool {
        *self == Self::Both
    }

    /// Whether the order is a lower bound.
    pub fn is_least(self) -> bool {
        !self.is_both()
    }

    /// The rate judged against the order, held against this bound.
    pub(super) fn held_against(self, rate: RateVerdict) -> RateVerdict {
        let rate = RateVerdict {
            bound: self,
            ..rate
        };
        match self {
            Self::Both => rate,
            Self::AtLeast => at_least(rate),
            Self::AnyAbove => any_above(rate),
        }
    }

    /// A claim as people write it, without its bound: `2`, `>= 2`, `>= 2..`.
    pub fn split(text: &str) -> (Self, &str) {
        let text = text.trim();
        let Some(order) = text.strip_prefix(">=") else {
            return (Self::Both, text);
        };
        match order.strip_suffix("..") {
            // "2..." is a slip.
            Some(least) if !least.ends_with('.') => (Self::AnyAbove, least.trim()),
            _ => (Self::AtLeast, order.trim()),
        }
    }

    /// A claim of this order as people write it.
    pub fn written(self, order: impl fmt::Display) -> String {
        match self {
            Self::Both => order.to_string(),
            Self::AtLeast => format!(">={order}"),
            Self::AnyAbove => format!(">={order}.."),
        }
    }

    /// What comes before the order in a sentence.
    pub fn words(self) -> &'static str {
        if self.is_least() { "at least " } else { "" }
    }
}

/// What theory claims about an error.
///
/// ```
/// use convergence_judge::{Bound, Claim, Floor, Interval, Level, Reason};
///
/// let levels = [0.4, 0.2, 0.1, 0.05].map(|step| Level { step, error: 3.0 * step * step });
/// let between = Interval { low: 2.9, high: 3.1 };
/// let claim = Claim { constant: Some(between), ..Claim::new(2.0, 0.1) };
/// assert_eq!(claim.judge(&levels, Floor::NONE).code, Reason::Agrees);
/// let bound = Claim { bound: Bound::AtLeast, ..Claim::new(1.0, 0.1) };
/// assert_eq!(bound.judge(&levels, Floor::NONE).code, Reason::Agrees);
/// ```
///
/// The tolerance is that of the claim. A rule with a tolerance of its own beside it is not
/// accepted:
///
/// ```compile_fail,E0308
/// # use convergence_judge::{Claim, Level, verdict::Judge};
/// # let levels = [0.4, 0.2, 0.1, 0.05].map(|step| Level { step, error: 3.0 * step * step });
/// Claim::new(2.0, 0.01).judge(&Judge::default(), &levels);
/// ```
///
/// No claim is no order: a rate that is observed has none.
///
/// ```compile_fail,E0308
/// # use convergence_judge::{Floor, Level, observe};
/// # let levels = [0.4, 0.2, 0.1, 0.05].map(|step| Level { step, error: 3.0 * step * step });
/// let order: f64 = observe(&levels, Floor::NONE).order();
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Claim {
    /// The order.
    pub order: f64,
    /// How far the rate may differ from it in either direction.
    pub tolerance: f64,
    /// Which higher rates agree, too.
    pub bound: Bound,
    /// The two numbers between which the constant must lie, if that is claimed.
    pub constant: Option<Interval>,
}

impl Claim {
    /// An order within a tolerance.
    pub const fn new(order: f64, tolerance: f64) -> Self {
        Self {
            order,
            tolerance,
            bound: Bound::Both,
            constant: None,
        }
    }

    /// The same within the tolerance of a claim that names none: [`DEFAULT_TOLERANCE`], but at most
    /// half a small order, and a quarter of one that is a lower bound.
    pub fn usual(order: f64, bound: Bound) -> Self {
        let share = if bound.is_least() { 0.25 } else { 0.5 };
        Self {
            bound,
            ..Self::new(order, DEFAULT_TOLERANCE.min(share * order))
        }
    }

    /// Whether order and tolerance are those of a claim.
    pub(super) fn is_usable(&self) -> bool {
        let is_order = self.order > 0.0 && self.order.is_finite();
        is_order && self.tolerance < self.order && Judge::new(self.tolerance).is_ok()
    }

    /// The rates that are accepted.
    pub fn band(&self) -> Band {
        Band {
            order: self.order,
            tolerance: self.tolerance,
        }
    }

    /// The rate of these levels, coarsest first, held against everything claimed. A claim with an
    /// order or a tolerance that is no claim is inconclusive; the rate is still given. Where the
    /// finest errors may be round-off, a floor that makes it pass is
    /// [offered](RateVerdict::offered_floor).
    pub fn judge(&self, levels: &[Level], floor: Floor) -> RateVerdict {
        let judge = |floor: Floor| self.judge_printed(levels, floor, Printed::default());
        judge(floor).offering(levels, floor, judge)
    }

    /// The same for errors that were printed; no floor is offered.
    pub fn judge_printed(
        &self,
        levels: &[Level],
        floor: Floor,
        printed: Printed<'_>,
    ) -> RateVerdict {
        let reading = Reading::new(levels, floor).printed(printed);
        let rate = self.bound.held_against(judge_band(&reading, self.band()));
        let hides =
            self.bound.is_least() && reading.hides_below_own_order(self.order, self.tolerance);
        self.with_constant_if(levels, rate.unless_lower_order(hides))
    }

    /// The same rate, whose constant must be the one claimed, if one is.
    pub(super) fn with_constant_if(&self, levels: &[Level], rate: RateVerdict) -> RateVerdict {
        match self.constant {
            Some(between) => with_constant(levels, rate, between),
            None => rate,
        }
    }

    /// The answer to this claim: the rate, the claim, and why it passes or does not.
    ///
    /// * `shown`: the rate in words.
    pub fn answer(&self, rate: &RateVerdict, shown: &str) -> String {
        let claim = if self.bound.is_least() {
            self.to_string()
        } else {
            self.band().to_string()
        };
        let why = match rate.verdict.is_pass() {
            true if self.bound.is_least() => {
                let least = order_text(committed_rate(self.order - self.tolerance));
                format!("at least {least}")
            }
            true => self.band().excludes(),
            false => rate.because.to_string(),
        };
        judged_in_words(shown, &claim, &why)
    }
}

impl fmt::Display for Claim {
    /// `2 ± 0.1`, `at least 2 ± 0.1`, with `, any rate` where any higher one agrees, and the
    /// constant after it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}{} ± {}",
            self.bound.words(),
            self.order,
            self.tolerance
        )?;
        if self.bound == Bound::AnyAbove {
            f.write_str(", any rate")?;
        }
        self.constant.map_or(Ok(()), |Interval { low, high }| {
            write!(f, ", constant {low} to {high}")
        })
    }
}

/// An order as people write it: `2`, or `>= 2` for a lower bound, or `>= 2..` where any higher rate
/// will do; `None` if it is none of them.
pub fn order_from_text(text: &str) -> Option<(f64, Bound)> {
    let (bound, order) = Bound::split(text);
    let order = order.parse::<f64>().ok()?;
    (order > 0.0 && order.is_finite()).then_some((order, bound))
}

/// Most that a scheme gains over its order: superconvergence.
const MOST_GAIN: f64 = 1.0;

/// The same rate judged against a lower bound on the order: a higher rate does not fail, but is
/// too good where its whole interval lies more than an order above the band. Rates that rise more
/// and more are those of a limit or a lower order of the other sign, which is about to show.
pub fn at_least(rate: RateVerdict) -> RateVerdict {
    if rate.code == Reason::Departs {
        return rate;
    }
    let rate = any_above(rate);
    let (Some(band), Some(interval)) = (rate.claimed, rate.interval) else {
        return rate;
    };
    if rate.verdict.is_pass() && interval.low > band.order + MOST_GAIN + band.tolerance {
        rate.with_reason(Reason::TooGood, Reason::TooGood.text())
    } else {
        rate
    }
}

/// The same where any higher rate will do.
///
/// The interval must lie above the band's lower end; rates that move upwards do not depart.
pub fn any_above(rate: RateVerdict) -> RateVerdict {
    let rates = &rate.pairwise[..rate.used.end.saturating_sub(1)];
    let (Some(band), Some(interval), [.., before, last]) = (rate.claimed, rate.interval, rates)
    else {
        return rate;
    };
    let least = band.order - band.tolerance;
    let is_allowed = match rate.code {
        Reason::TooHigh | Reason::AtTheEdge | Reason::IntervalTooWide => true,
        Reason::Departs => last > before,
        _ => false,
    };
    if interval.low >= least && is_allowed {
        rate.with_reason(Reason::Agrees, Reason::Agrees.text())
    } else {
        rate
    }
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
    use super::super::verdict::{judge, observe};
    use super::*;
    use crate::tests::{halved, scattered};

    fn levels(error: impl Fn(f64) -> f64) -> Vec<Level> {
        halved(0.5, 6, error)
    }

    fn judged(levels: &[Level], order: f64) -> RateVerdict {
        judge(levels, order, 0.25)
    }

    #[test]
    fn a_verdict_says_a_least_order_as_such() {
        for (bound, words) in [
            (Bound::Both, "2 ± 0.25"),
            (Bound::AtLeast, "at least 2 ± 0.25"),
            (Bound::AnyAbove, "at least 2 ± 0.25"),
        ] {
            let claim = Claim::usual(2.0, bound);
            let rate = claim.judge(&levels(|h| h * h), Floor::default());
            assert_eq!(rate.claim(), words);
            assert!(rate.line().contains(&format!("claimed {}", rate.claim())));
        }
    }

    #[test]
    fn a_higher_rate_is_at_least_the_order_and_a_lower_one_is_not() {
        for (order, error, expected) in [
            (2.0, (|h| h.powi(3)) as fn(f64) -> f64, Reason::Agrees),
            (2.0, |h| h * h, Reason::Agrees),
            (2.0, |h| h.powf(1.5), Reason::TooLow),
            // Between the ends of the band.
            (1.8, |h| h * h, Reason::Agrees),
            // On their way up from the order, and down from above it: first order in the end.
            (2.0, |h| h * h - 0.004 * h, Reason::Departs),
            (2.0, |h| h * h + 0.004 * h, Reason::Departs),
            (2.0, |h| h.powi(3) + 0.002 * h, Reason::FallsAway),
            (2.0, |_| f64::NAN, Reason::NonFiniteError),
        ] {
            let found = at_least(judged(&levels(error), order));
            assert_eq!(found.code, expected, "{found:?}");
        }
        let rising = levels(|h| h * h - 0.004 * h);
        assert_eq!(any_above(judged(&rising, 2.0)).code, Reason::Agrees);
        // At the lower end of the band.
        let edge = levels(|h| h * h * (1.0 - 0.8 * h));
        assert_ne!(at_least(judged(&edge, 2.25)).code, Reason::Agrees);
    }

    #[test]
    fn a_lower_bound_passes_no_limit_behind_scatter_and_every_power_above_it() {
        let code = |bound, law: fn(f64) -> f64| {
            let levels = scattered(8, |h, s| law(h) * (0.02 * s).exp());
            Claim::usual(2.0, bound).judge(&levels, Floor::NONE).code
        };
        for bound in [Bound::AtLeast, Bound::AnyAbove] {
            assert_eq!(code(bound, |h| h.powi(3)), Reason::Agrees);
            assert_eq!(code(bound, |h| h.powf(2.8)), Reason::Agrees);
            let limit = code(bound, |h| h.powi(3) + 0.5 * 2_f64.powi(-21));
            assert_eq!(limit, Reason::LowerOrderLikely);
        }
    }

    #[test]
    fn the_tolerance_of_a_claim_decides() {
        let levels = levels(|h| h.powf(2.1));
        let kind = |tolerance| Claim::new(2.0, tolerance).judge(&levels, Floor::NONE).code;
        assert_eq!(kind(0.25), Reason::Agrees);
        assert_eq!(kind(0.01), Reason::TooHigh);
        assert_eq!(kind(0.7), Reason::ToleranceTooWide);
        // As wide as the order is: errors that do not fall would agree.
        let slow = |tolerance| Claim::new(0.3, tolerance).judge(&levels, Floor::NONE).code;
        assert_eq!(slow(0.3), Reason::ToleranceTooWide);
        assert_eq!(slow(0.29), Reason::TooHigh);
        let usual = |order, bound| Claim::usual(order, bound).tolerance;
        let orders = [0.25, 0.5, 1.0, 2.0];
        assert_eq!(
            orders.map(|p| usual(p, Bound::Both)),
            [0.125, 0.25, 0.25, 0.25]
        );
        assert_eq!(
            orders.map(|p| usual(p, Bound::AtLeast)),
            [0.0625, 0.125, 0.25, 0.25]
        );
        assert_eq!(usual(0.5, Bound::AnyAbove), 0.125);
        assert_eq!(kind(f64::NAN), Reason::ClaimUnusable);
        assert_eq!(observe(&levels, Floor::NONE).code, Reason::NotClaimed);
    }

    #[test]
    fn what_is_exact_has_no_error_above_the_bound() {
        assert_eq!(exact([1e-13, -2e-13], 1e-12), (2e-13, true));
        assert_eq!(exact([1e-13, -2e-12], 1e-12), (2e-12, false));
        assert!(!exact([1e-13, f64::NAN], 1e-12).1 && !exact([], 1e-12).1);
    }
}
