//! A lower order behind scatter: errors that pass by their interval, but that a term of lower order
//! explains far better than the order claimed does.

use super::cause::line;
use crate::judge::fit::{Level, POLLUTION_EXPONENTS, log_quotient};

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
    let most = levels.len().min(MOST);
    let least = LEAST_CHANGE * tolerance;
    (FEWEST..=most).any(|count| hides_among(&levels[levels.len() - count..], order, least))
}

/// * `least`: the change of the finest rate below which a term of lower order counts for nothing.
fn hides_among(levels: &[Level], order: f64, least: f64) -> bool {
    let finest = levels[levels.len() - 1];
    // In units of the finest level, so that no power overflows.
    let x: Vec<f64> = levels
        .iter()
        .map(|level| log_quotient(level.step, finest.step))
        .collect();
    let heights: Vec<f64> = levels
        .iter()
        .zip(&x)
        .map(|(level, x)| log_quotient(level.error, finest.error) - order * x)
        .collect();
    let count = levels.len() as f64;
    let constant = squares(&heights, |_| mean(&heights)) * (count - 2.0) / (count - 1.0);
    let polluted = POLLUTION_EXPONENTS
        .iter()
        .map(|r| fitted(&x, &heights, *r).squares);
    let other = polluted.fold(constant, f64::min);
    let lower = BELOW
        .iter()
        .chain(std::iter::once(&order))
        .map(|d| (d, fitted(&x, &heights, -d)))
        .filter(|(d, fit)| *d * fit.slope > least)
        .map(|(_, fit)| fit)
        .map(|fit| fit.squares)
        .fold(f64::INFINITY, f64::min);
    lower + ROUND_OFF * count < SHARE * other
}

/// A line over a power of the step.
struct Fit {
    slope: f64,
    squares: f64,
}

/// The heights by least squares as a + b h^r.
fn fitted(x: &[f64], heights: &[f64], r: f64) -> Fit {
    let powers: Vec<f64> = x.iter().map(|x| (r * x).exp()).collect();
    let [constant, slope] = line(&powers, heights);
    Fit {
        slope,
        squares: squares(heights, |k| constant + slope * powers[k]),
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Sum of squares of what a model leaves.
fn squares(heights: &[f64], model: impl Fn(usize) -> f64) -> f64 {
    let residuals = heights.iter().enumerate();
    residuals.map(|(k, y)| (y - model(k)).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(errors: impl Fn(f64, usize) -> f64, count: usize) -> Vec<Level> {
        let level = |k: usize| {
            let step = 0.5_f64.powi(k as i32);
            Level {
                step,
                error: errors(step, k),
            }
        };
        (0..count).map(level).collect()
    }

    /// Scatter of about 1 %, without a trend.
    const SCATTER: [f64; 8] = [0.012, -0.008, 0.005, -0.011, 0.009, -0.004, 0.01, -0.012];

    fn scattered(h: f64, k: usize, share: f64) -> f64 {
        let finest = 0.5_f64.powi(7);
        h * h * (1.0 + share * finest / h) * SCATTER[k].exp()
    }

    #[test]
    fn a_lower_order_is_found_behind_scatter_and_scatter_alone_is_not() {
        assert!(hides(&levels(|h, k| scattered(h, k, 0.11), 8), 2.0, 0.25));
        assert!(!hides(&levels(|h, k| scattered(h, k, 0.0), 8), 2.0, 0.25));
        assert!(
            hides(&levels(|h, _| h * h + 1e-6, 8), 2.0, 0.25),
            "a plateau"
        );
    }

    #[test]
    fn pollution_and_plain_powers_hide_nothing() {
        for r in [0.5, 1.0, 1.5, 4.0] {
            for a in [-0.5, 0.3, 3.0] {
                let polluted = levels(|h, _| h * h * (1.0 + a * h.powf(r)), 8);
                assert!(!hides(&polluted, 2.0, 0.25), "{a} {r}");
            }
        }
        assert!(!hides(&levels(|h, _| 0.3 * h * h, 8), 2.0, 0.25));
        assert!(!hides(&levels(|h, _| h, 3), 2.0, 0.25), "three levels");
        // A plateau that changes the finest rate by 0.001.
        let hardly = levels(|h, _| h * h + 3e-8, 8);
        assert!(!hides(&hardly, 2.0, 0.25) && hides(&hardly, 2.0, 0.02));
    }

    #[test]
    fn a_coarser_level_never_removes_the_reason() {
        let hidden = levels(|h, k| scattered(h, k, 0.11), 8);
        for from in 0..8 {
            let coarser_too = (0..from).any(|other| hides(&hidden[other..], 2.0, 0.25));
            assert!(from == 0 || coarser_too || !hides(&hidden[from..], 2.0, 0.25));
        }
        assert!((1..5).any(|from| hides(&hidden[from..], 2.0, 0.25)));
    }
}
