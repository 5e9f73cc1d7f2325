//! The trend of the rates: it tells a lost order from noise.

use crate::judge::fit::{Level, changes, scatter};

/// A fall is still going on if the finest rate is lower than the one before by more than this.
const STILL_FALLING: f64 = 0.1;

/// Least growth of a change of the rate over the one before, of the same sign, that reveals a term of lower order.
const GROWTH: f64 = 1.3;

/// The same if nothing but a term half an order lower, or one that vanishes more slowly, can be meant: all changes grow.
///
/// For `e = h^p (1 + f h^-δ)` on halved steps the changes grow by `2^δ (1 + s) / (1 + 4^δ s)`, s = f h^-δ in the middle of the coarsest of the
/// three pairs of levels. For δ = 1/2 that is more than 1.1 up to s = 0.4; pollution 1 + 3 h^(1/3), still far from fading, makes them grow by less.
const STEADY_GROWTH: f64 = 1.1;

/// Least growth over a change of the other sign: noise makes changes of similar size to and fro.
const TURN: f64 = 4.0;

/// Shares of the tolerance above which changes count: three in a row, two in a row, one against the one before, one against fading pollution.
const DEPARTED: [f64; 4] = [1.0 / 40.0, 1.0 / 6.0, 1.0, 0.1];

/// Whether the second change has the sign of the first and is larger by more than the factor.
fn larger(from: f64, to: f64, factor: f64) -> bool {
    from * to > 0.0 && to.abs() > factor * from.abs()
}

/// Whether the finest rate is zero or less, by more than scatter explains: no convergence.
pub fn grows(rates: &[f64]) -> bool {
    rates.last().is_some_and(|finest| finest + 2.0 * scatter(rates) <= 0.0)
}

/// Whether the rates fell on each of the last two refinements, are still falling, have fallen at least half of the way from the order to their
/// present value, and ended more than half an order below the claim, by more than scatter explains.
///
/// Pollution fades, so it does the opposite. Errors that level off above the round-off floor do this, for example if a coefficient differs
/// between the scheme and the sources; dropping the levels where it shows would hide it. Rates that have always been low, or that have come to
/// rest, are those of a lost order: [`Reason::TooLow`](super::Reason::TooLow) says so, with the rate.
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

/// Whether one of the last two changes of the rate is faster than two powers of h that take over from each other can make it.
///
/// For `e = h^p + f h^q`, the rate changes by at most (p - q)²/4 per unit of log h, half way between p and q. Here p is the order and q = -2, the
/// round-off of second differences. A steeper change is an outlier or noise on narrow steps, not a lost order.
pub(super) fn steep(levels: &[Level], rates: &[f64], order: f64) -> bool {
    let steepest = 0.25 * (order + 2.0).powi(2);
    // From the middle of one pair of levels to the middle of the next, in log h.
    let apart = |k: usize| 0.5 * (levels[k].step / levels[k + 2].step).ln();
    let too_steep = |(k, change): (usize, f64)| change.abs() > steepest * apart(k);
    changes(rates).into_iter().enumerate().rev().take(2).any(too_steep)
}

/// Whether the last changes of the rate grow; those of fading pollution shrink. A plateau, a wrong limit or a lower order is about to show.
///
/// The rates 2.000, 2.000, 1.998, 1.993, 1.973 have hardly left 2, but are leaving it at a growing pace. The behaviour of coarse levels is
/// no excuse: only the last three changes count, and another level at the coarse end can add reasons but never remove one.
pub fn departs(rates: &[f64], tolerance: f64) -> bool {
    let [three, two, one, after_pollution] = DEPARTED.map(|share| share * tolerance);
    let changes = changes(rates);
    let [.., before, last] = changes[..] else { return false };
    let turns = before * last <= 0.0 && last.abs() > TURN * before.abs();
    let of_two = larger(before, last, GROWTH) && (before + last).abs() > two || turns && last.abs() > one;
    let of_three = |first: f64| {
        let in_a_row = larger(first, before, STEADY_GROWTH) && larger(before, last, STEADY_GROWTH);
        let fading = larger(before, first, 1.0);
        in_a_row && (first + before + last).abs() > three || fading && turns && last.abs() > after_pollution
    };
    of_two || changes.len().checked_sub(3).is_some_and(|first| of_three(changes[first]))
}

/// Whether four levels are all there are, and their two changes grow steadily: a term half an order lower may be about to show.
///
/// Three such changes are a departure. Two may be chance, and a fifth level tells.
pub(super) fn emerges(rates: &[f64], tolerance: f64) -> bool {
    let [before, last] = changes(rates)[..] else { return false };
    larger(before, last, STEADY_GROWTH) && (before + last).abs() > DEPARTED[0] * tolerance
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_grow_when_scatter_does_not_explain_it() {
        for (rates, expected) in [
            (&[0.0, 0.0][..], true),
            (&[0.0, 0.0, 0.0], true),
            (&[1.0, 1.0, -0.5], true),
            (&[1.0, -0.25], false),
            (&[1.0, 1.125, 1.0, -0.25], true),
            (&[1.0, 1.125, 1.0, -0.125], false),
            (&[1.0, 1.0, 0.125], false),
            (&[], false),
        ] {
            assert_eq!(grows(rates), expected, "{rates:?}");
        }
    }

    #[test]
    fn a_fall_is_one_that_goes_on() {
        for (rates, order, expected) in [
            // Always low, come to rest, half of the way, beyond scatter.
            (&[1.5, 1.25, 1.0][..], 2.0, true),
            (&[1.02, 1.01, 1.0], 2.0, false),
            (&[2.0, 1.5, 1.25, 1.125, 1.0625], 2.0, false),
            (&[1.25, 1.125, 1.0], 2.0, false),
            (&[1.5, 1.25, 1.0], 2.25, false),
            (&[2.0, 1.0, 1.5, 1.25, 1.0], 2.0, false),
        ] {
            assert_eq!(falls_away(rates, order), expected, "{rates:?}");
        }
    }

    /// Rates from 2 on with these changes.
    fn departs_by(changes: &[f64], tolerance: f64) -> bool {
        let mut rates = vec![2.0];
        changes.iter().for_each(|change| rates.push(rates[rates.len() - 1] + change));
        departs(&rates, tolerance)
    }

    #[test]
    fn a_departure_is_a_change_that_grows() {
        for (changes, tolerance, expected) in [
            // Three in a row, each larger than the one before by more than 1.1, over more than a fortieth of the tolerance.
            (&[-1.0, -1.25, -1.5][..], 64.0, true),
            (&[1.0, 1.25, 1.5], 64.0, true),
            (&[-1.0, -1.25, -1.5], 149.0, true),
            (&[-1.0, -1.25, -1.5], 151.0, false),
            (&[-1.0, -1.09, -1.25], 64.0, false),
            (&[-1.0, -1.25, -1.36], 64.0, false),
            (&[-1.0, -1.12, -1.25], 64.0, true),
            (&[-1.5, -1.25, -1.5], 32.0, false),
            (&[-1.0, -1.5, -1.5], 32.0, false),
            (&[1.0, -1.25, -1.5], 32.0, false),
            (&[-1.25, -1.5], 32.0, false),
            // Two in a row, the second larger by more than 1.3, over more than a sixth.
            (&[-1.0, -1.5], 14.5, true),
            (&[1.0, 1.5], 14.5, true),
            (&[-1.0, -1.5], 15.5, false),
            (&[-1.0, -1.25], 8.0, false),
            // One against the one before and four times as large, over more than the tolerance.
            (&[1.0, -4.5], 4.25, true),
            (&[-1.0, 4.5], 4.25, true),
            (&[0.0, -4.5], 4.25, true),
            (&[1.0, -4.5], 4.75, false),
            (&[1.0, -3.5], 2.0, false),
            (&[0.5, 1.0, -4.5], 5.0, false),
            // After fading pollution, four times as large, over more than a tenth.
            (&[1.5, 1.0, -4.5], 44.0, true),
            (&[-1.5, -1.0, 4.5], 44.0, true),
            (&[1.5, 1.0, -4.5], 46.0, false),
            (&[1.5, 1.0, -3.75], 6.0, false),
            (&[0.5, 1.0, -4.5], 12.0, false),
            (&[1.5, -1.0, -1.25], 12.0, false),
            (&[1.5], 0.1, false),
            (&[], 0.1, false),
        ] {
            assert_eq!(departs_by(changes, tolerance), expected, "{changes:?} {tolerance}");
            let earlier: Vec<f64> = [-30.0, 40.0].into_iter().chain(changes.iter().copied()).collect();
            assert!(!expected || departs_by(&earlier, tolerance), "disarmed: {changes:?} {tolerance}");
        }
    }

    #[test]
    fn an_order_emerges_where_four_levels_change_faster_and_faster() {
        for (rates, tolerance, expected) in [
            (&[2.0, 1.75, 1.4375][..], 22.0, true),
            (&[2.0, 2.25, 2.5625], 22.0, true),
            (&[2.0, 1.75, 1.4375], 23.0, false),
            (&[2.0, 1.75, 1.484375], 1.0, false),
            (&[2.0, 1.75, 2.25], 1.0, false),
            (&[2.25, 2.0, 1.75, 1.4375], 1.0, false),
            (&[2.0, 1.75], 1.0, false),
        ] {
            assert_eq!(emerges(rates, tolerance), expected, "{rates:?}");
        }
    }

    #[test]
    fn two_powers_never_take_over_from_each_other_steeply() {
        for (p, q) in [(2.0, 0.0), (1.0, -1.0), (3.0, -2.0), (2.0, 1.0)] {
            for shift in 0..40 {
                let f = 2.0_f64.powi(-shift);
                let level = |k: i32| 1.3_f64.powi(-k);
                let levels: Vec<Level> =
                    (0..8).map(level).map(|h| Level { step: h, error: h.powf(p) + f * h.powf(q) }).collect();
                assert!(!steep(&levels, &crate::judge::fit::pairwise_rates(&levels), p), "{p} {q} {f}");
            }
        }
        let levels: Vec<Level> =
            [1.0, 0.5, 0.25, 0.5].iter().zip(0..).map(|(&error, k)| Level { step: 1.1_f64.powi(-k), error }).collect();
        assert!(steep(&levels, &crate::judge::fit::pairwise_rates(&levels), 1.0));
    }
}
