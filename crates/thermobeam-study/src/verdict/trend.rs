//! Where the rates are going: what tells a lost order from noise.

use crate::fit::Level;

/// A fall goes on while the finest rate is lower than the one before by more than this.
const STILL_FALLING: f64 = 0.1;

/// Changes of the rate below this share of the tolerance are none.
const LEAST_CHANGE: f64 = 0.05;

/// Changes of the rate between one refinement and the next.
fn changes(rates: &[f64]) -> Vec<f64> {
    rates.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// How far the rates scatter: the largest part of two consecutive changes of opposite sign that cancels.
///
/// Pollution, plateaus and terms of another order change the rates one way and have a scatter of zero; noise changes them to and fro.
/// A single change (three levels) may be either, and counts as scatter.
pub fn scatter(rates: &[f64]) -> f64 {
    let changes = changes(rates);
    match changes[..] {
        [only] => only.abs(),
        _ => {
            let cancelled = |pair: &[f64]| if pair[0] * pair[1] < 0.0 { pair[0].abs().min(pair[1].abs()) } else { 0.0 };
            changes.windows(2).map(cancelled).fold(0.0, f64::max)
        }
    }
}

/// Whether the finest rate is zero or less beyond what scatter explains: no convergence.
pub fn grows(rates: &[f64]) -> bool {
    rates.last().is_some_and(|finest| finest + 2.0 * scatter(rates) <= 0.0)
}

/// Whether the rates fell on each of the last two refinements, are still falling, have fallen at least half of the way from the order to where
/// they are now, and ended more than half an order below the claim beyond what scatter explains.
///
/// Pollution fades, so it does the contrary. Errors that level off above the round-off floor do this, which is what a coefficient that differs
/// between the scheme and the sources leads to; dropping the levels where it shows would hide it. Rates that have always been low, or that
/// have come to rest, are those of a lost order: [`Reason::TooLow`](super::Reason::TooLow) says so, with the rate.
pub fn falls_away(rates: &[f64], order: f64) -> bool {
    let highest = rates.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    match rates {
        [.., before, middle, finest] => {
            let falling = before > middle && middle - finest > STILL_FALLING;
            let fell = highest - finest >= 0.5 * (order - finest);
            falling && fell && finest + 2.0 * scatter(rates) < order - 0.5
        }
        _ => false,
    }
}

/// Whether one of the last two changes of the rate is faster than any two powers of h that take over from each other make it.
///
/// Where `e = h^p + f h^q`, the rate changes by at most (p - q)²/4 for each unit of log h, half way between p and q. Here p is the order and q = -2, the
/// round-off of second differences. A steeper change is an outlier or noise on narrow steps, not an order that is lost.
pub(super) fn steep(levels: &[Level], rates: &[f64], order: f64) -> bool {
    let steepest = 0.25 * (order + 2.0).powi(2);
    // From the middle of one pair of levels to the middle of the next, in log h.
    let apart = |k: usize| 0.5 * (levels[k].step / levels[k + 2].step).ln();
    let too_steep = |(k, change): (usize, f64)| change.abs() > steepest * apart(k);
    changes(rates).into_iter().enumerate().rev().take(2).any(too_steep)
}

/// Whether the finest change of the rate is larger than every earlier one, than half the tolerance, and than scatter explains.
///
/// Changes shrink by ratio^-r where pollution fades. Where they grow, a term of lower order is emerging from below: the rates 2, 2, 1.98, 1.94
/// are on their way to 1, however well 2 fits.
pub fn moves_away(rates: &[f64], tolerance: f64) -> bool {
    match changes(rates).split_last() {
        Some((finest, earlier)) if !earlier.is_empty() => {
            let finest = finest.abs();
            let largest = earlier.iter().all(|change| change.abs() < finest);
            largest && finest > 0.5 * tolerance && finest > 2.0 * scatter(rates)
        }
        _ => false,
    }
}

/// Whether the last three changes of the rate have one sign and grow: a plateau, a wrong limit or a lower order about to show.
///
/// The rates 2.000, 2.000, 1.998, 1.993, 1.973 have hardly left 2, and are leaving it at a growing pace. Of noise this asks six times to be in a row:
/// it costs less than 1 in 100 of the passes. Changes below a twentieth of the tolerance are ignored.
pub fn departs(rates: &[f64], tolerance: f64) -> bool {
    match changes(rates)[..] {
        [.., first, second, third] => {
            let one_way = first * second > 0.0 && second * third > 0.0;
            let growing = first.abs() < second.abs() && second.abs() < third.abs();
            one_way && growing && third.abs() > LEAST_CHANGE * tolerance
        }
        _ => false,
    }
}
