//! A lower order behind scatter: errors that pass by their interval, but that a term of lower order
//! explains far better than the order claimed does.

use super::cause::line;
use super::{RateVerdict, Reason};
use crate::fit::{Level, POLLUTION_EXPONENTS, log_quotient, pairwise_rates};

/// Most of the finest levels that are looked at.
const MOST: usize = 8;
/// Fewest: three levels leave one degree of freedom, with which chance explains anything.
const FEWEST: usize = 4;
/// Exponents by which a lower order lies below the one claimed, beside that order itself, which
/// leaves a constant.
pub(super) const BELOW: [f64; 2] = [0.5, 1.0];
/// A lower order must leave less than this share of what the claimed order leaves.
const SHARE: f64 = 0.2;
/// A term of lower order counts if it changes the finest rate by more than this share of the
/// tolerance.
pub(super) const LEAST_CHANGE: f64 = 1.0 / 60.0;
/// Standard errors above which a term of lower order shows in levels that scatter.
const SHOWN: f64 = 2.5;
/// Squares of residuals below this are round-off of logarithms.
const ROUND_OFF: f64 = 1e-24;

/// Whether a term of lower order explains the errors, with the order claimed, at least five times
/// as well as any pollution of it.
///
/// With p the order claimed, `y - p x = log(e / h^p)` is fitted by a constant a, by a + b h^r with
/// the exponents r of pollution, and by a + b h^-d, d = 1/2, 1 and p, with b > 0. The sum of
/// squares of the constant is scaled by its degrees of freedom. Scatter of one size leaves as much
/// to all of them; a lower order leaves less to the last kind.
///
/// A coarser level never removes the reason: the finest four, five, ... levels are looked at one
/// after another.
///
/// The term b h^-d changes the finest rate by b d, h being 1 there.
///
/// * `levels`: above the floor, coarsest first.
pub(super) fn hides(levels: &[Level], order: f64, tolerance: f64) -> bool {
    hides_from(FEWEST, levels, order, tolerance)
}

/// The same of levels that scatter about the order: there, a term that is [`SHOWN`] standard errors
/// is enough.
///
/// * `levels`: those that scatter, coarsest first.
pub(super) fn hides_behind_scatter(levels: &[Level], order: f64, tolerance: f64) -> bool {
    let heights = Heights::of(levels, order);
    let mut lower = heights.lower_orders(order, tolerance);
    hides_from(FEWEST + 1, levels, order, tolerance) || lower.any(|term| term.shows())
}

/// The same of levels that scatter about an order of their own, where they only have to have the
/// one claimed or more: the multiple of 1/2 next to the middle one of their rates. There, the term
/// must also leave less than a plain power of any order does.
pub(super) fn hides_below(levels: &[Level], least: f64, tolerance: f64) -> bool {
    let mut rates = pairwise_rates(levels);
    rates.sort_by(f64::total_cmp);
    let own = (2.0 * rates[rates.len() / 2]).round() / 2.0;
    let heights = Heights::of(levels, own.max(least));
    let by_power = heights.of_any_power();
    let mut lower = heights.lower_orders(own.max(least), tolerance);
    lower.any(|term| term.shows() && term.squares < by_power)
}

impl RateVerdict {
    /// The same rate, which does not pass if the levels [hide](Reason::LowerOrderLikely) a lower
    /// order.
    pub(crate) fn unless_lower_order(self, hides: bool) -> Self {
        match self.verdict.is_pass() && hides {
            true => self.with_reason(Reason::LowerOrderLikely, Reason::LowerOrderLikely.text()),
            false => self,
        }
    }
}

/// * `fewest`: levels that are looked at.
fn hides_from(fewest: usize, levels: &[Level], order: f64, tolerance: f64) -> bool {
    let most = levels.len().min(MOST);
    (fewest..=most).any(|count| {
        let heights = Heights::of(&levels[levels.len() - count..], order);
        let other = heights.of_others();
        let lower = heights
            .lower_orders(order, tolerance)
            .map(|term| term.squares);
        lower.fold(f64::INFINITY, f64::min) + ROUND_OFF * (count as f64) < SHARE * other
    })
}

/// log(e / h^p) of levels, in units of the finest one, so that no power overflows.
struct Heights {
    /// log h.
    x: Vec<f64>,
    heights: Vec<f64>,
}

impl Heights {
    fn of(levels: &[Level], order: f64) -> Self {
        let finest = levels[levels.len() - 1];
        let step = |level: &Level| log_quotient(level.step, finest.step);
        let error = |level: &Level| log_quotient(level.error, finest.error);
        Self {
            x: levels.iter().map(step).collect(),
            heights: levels
                .iter()
                .map(|level| error(level) - order * step(level))
                .collect(),
        }
    }

    /// The least that the order claimed leaves: by a constant, scaled by its degrees of freedom, or
    /// by pollution.
    fn of_others(&self) -> f64 {
        let count = self.heights.len() as f64;
        let constant = squares(&self.heights, |_| mean(&self.heights));
        let polluted = POLLUTION_EXPONENTS.map(|r| self.fitted(r).squares);
        let constant = constant * (count - 2.0) / (count - 1.0);
        polluted.into_iter().fold(constant, f64::min)
    }

    /// What a straight line leaves: a power of another order.
    fn of_any_power(&self) -> f64 {
        let [constant, slope] = line(&self.x, &self.heights);
        squares(&self.heights, |k| constant + slope * self.x[k])
    }

    /// The terms of lower order that change the finest rate by enough.
    fn lower_orders(&self, order: f64, tolerance: f64) -> impl Iterator<Item = Term> {
        let least = LEAST_CHANGE * tolerance;
        let exponents = [BELOW[0], BELOW[1], order];
        let terms = exponents.into_iter().map(|d| (d, self.fitted(-d)));
        terms.filter_map(move |(d, term)| (d * term.slope > least).then_some(term))
    }

    /// By least squares as a + b h^r.
    fn fitted(&self, r: f64) -> Term {
        let powers: Vec<f64> = self.x.iter().map(|x| (r * x).exp()).collect();
        let [constant, slope] = line(&powers, &self.heights);
        let squares_left = squares(&self.heights, |k| constant + slope * powers[k]);
        let variance = squares_left / (powers.len() as f64 - 2.0);
        Term {
            slope,
            standard_error: (variance / squares(&powers, |_| mean(&powers))).sqrt(),
            squares: squares_left,
        }
    }
}

/// A term b h^r beside a constant.
struct Term {
    /// b.
    slope: f64,
    /// Of b.
    standard_error: f64,
    /// What both leave.
    squares: f64,
}

impl Term {
    fn shows(&self) -> bool {
        self.slope > SHOWN * self.standard_error
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Sum of squares of what a model leaves.
pub(crate) fn squares(heights: &[f64], model: impl Fn(usize) -> f64) -> f64 {
    let residuals = heights.iter().enumerate();
    residuals.map(|(k, y)| (y - model(k)).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{halved, scattered};

    fn levels(count: usize, errors: impl Fn(f64) -> f64) -> Vec<Level> {
        halved(1.0, count, errors)
    }

    /// Scatter of about 1 %, and a term of this share of the finest error.
    fn noisy(share: f64) -> Vec<Level> {
        let finest = 0.5_f64.powi(7);
        let law = |h: f64| h * h * (1.0 + share * finest / h);
        scattered(8, |h, s| law(h) * (0.01 * s).exp())
    }

    #[test]
    fn a_lower_order_is_found_behind_scatter_and_scatter_alone_is_not() {
        assert!(hides(&noisy(0.11), 2.0, 0.25));
        assert!(!hides(&noisy(0.0), 2.0, 0.25));
        assert!(hides(&levels(8, |h| h * h + 1e-6), 2.0, 0.25), "a plateau");
    }

    #[test]
    fn pollution_and_plain_powers_hide_nothing() {
        for r in [0.5, 1.0, 1.5, 4.0] {
            for a in [-0.5, 0.3, 3.0] {
                let polluted = levels(8, |h| h * h * (1.0 + a * h.powf(r)));
                assert!(!hides(&polluted, 2.0, 0.25), "{a} {r}");
            }
        }
        assert!(!hides(&levels(8, |h| 0.3 * h * h), 2.0, 0.25));
        assert!(!hides(&levels(3, |h| h), 2.0, 0.25), "three levels");
        // A plateau that changes the finest rate by 0.001.
        let hardly = levels(8, |h| h * h + 3e-8);
        assert!(!hides(&hardly, 2.0, 0.25) && hides(&hardly, 2.0, 0.02));
    }

    #[test]
    fn a_term_of_lower_order_shows_above_its_standard_errors() {
        for (share, expected) in [(0.0, false), (0.02, false), (0.05, true), (0.11, true)] {
            let found = hides_behind_scatter(&noisy(share), 2.0, 0.25);
            assert_eq!(found, expected, "{share}");
        }
    }

    #[test]
    fn a_coarser_level_never_removes_the_reason() {
        let hidden = noisy(0.11);
        for from in 0..8 {
            let coarser_too = (0..from).any(|other| hides(&hidden[other..], 2.0, 0.25));
            assert!(from == 0 || coarser_too || !hides(&hidden[from..], 2.0, 0.25));
        }
        assert!((1..5).any(|from| hides(&hidden[from..], 2.0, 0.25)));
    }
}
