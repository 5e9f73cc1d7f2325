//! The trend of the rates: it tells a lost order from noise.

use crate::judge::fit::Level;

/// A fall is still going on if the finest rate is lower than the one before by more than this.
const STILL_FALLING: f64 = 0.1;

/// Least growth of a change of the rate over the one before, of the same sign, that reveals a term of lower order.
const GROWTH: f64 = 1.3;

/// Least growth over a change of the other sign: noise makes changes of similar size to and fro.
const TURN: f64 = 3.0;

/// The same if that change itself follows a larger one of its sign, like those of pollution.
const TURN_AFTER_POLLUTION: f64 = 2.0;

/// Shares of the tolerance above which changes count: three in a row, two in a row, one against the one before, one against fading pollution.
const DEPARTED: [f64; 4] = [0.05, 1.0 / 6.0, 1.0, 0.15];

/// An error is off the line through its neighbours if it is larger or smaller by this factor.
const OFF_THE_LINE: f64 = 2.0;

/// How far the rate from one neighbour of an outlier to the other may be from the finest rate.
const SAME_RATE: f64 = 0.1;

/// Changes of the rate between one refinement and the next.
fn changes(rates: &[f64]) -> Vec<f64> {
    rates.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// How far the rates scatter: the largest cancelling part of two consecutive changes of opposite sign.
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

/// The coarsest level set aside that is off the line through its two neighbours, in logarithms, if the slope of that line is the finest rate.
///
/// Levels that are not yet asymptotic approach the finest rate together. If the neighbours are already on such a line
/// and the level between them is not, that level belongs to another problem: a case with a wrong setting.
///
/// * `levels`: those above the floor; the fit leaves out the `set_aside` coarsest.
pub(super) fn outlier(levels: &[Level], set_aside: usize) -> Option<usize> {
    let [.., before, last] = levels else { return None };
    let rate = |coarse: &Level, fine: &Level| (coarse.error / fine.error).ln() / (coarse.step / fine.step).ln();
    let finest = rate(before, last);
    let is_off = |(_, three): &(usize, &[Level])| {
        let [coarse, level, fine] = three else { return false };
        let across = rate(coarse, fine);
        let expected = fine.error.ln() + across * (level.step / fine.step).ln();
        (level.error.ln() - expected).abs() > OFF_THE_LINE.ln() && (across - finest).abs() <= SAME_RATE
    };
    let found = levels.windows(3).enumerate().take(set_aside.saturating_sub(1)).find(is_off);
    found.map(|(coarse, _)| coarse + 1)
}

/// Whether the last changes of the rate grow; those of fading pollution shrink. A plateau, a wrong limit or a lower order is about to show.
///
/// The rates 2.000, 2.000, 1.998, 1.993, 1.973 have hardly left 2, but are leaving it at a growing pace. The behaviour of coarse levels is
/// no excuse: only the last three changes count, and another level at the coarse end can add reasons but never remove one.
pub fn departs(rates: &[f64], tolerance: f64) -> bool {
    let [three, two, one, after_pollution] = DEPARTED.map(|share| share * tolerance);
    let changes = changes(rates);
    let [.., before, last] = changes[..] else { return false };
    let grows = |from: f64, to: f64, factor: f64| from * to > 0.0 && to.abs() > factor * from.abs();
    let turns = |factor: f64| before * last <= 0.0 && last.abs() > factor * before.abs();
    let of_two = grows(before, last, GROWTH) && (before + last).abs() > two || turns(TURN) && last.abs() > one;
    let of_three = |first: f64| {
        let in_a_row = grows(first, before, 1.0) && grows(before, last, 1.0);
        let fading = grows(before, first, 1.0);
        in_a_row && (first + before + last).abs() > three
            || fading && turns(TURN_AFTER_POLLUTION) && last.abs() > after_pollution
    };
    of_two || changes.len().checked_sub(3).is_some_and(|first| of_three(changes[first]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scatter_is_what_goes_to_and_fro() {
        assert_eq!(scatter(&[]), 0.0);
        assert_eq!(scatter(&[1.0]), 0.0);
        assert_eq!(scatter(&[1.0, 0.75]), 0.25, "a single change may be either");
        assert_eq!(scatter(&[1.0, 1.25, 1.5, 2.5]), 0.0, "one way");
        assert_eq!(scatter(&[1.0, 1.5, 1.25]), 0.25);
        assert_eq!(scatter(&[1.0, 1.25, 0.5, 1.0, 1.125]), 0.5);
    }

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
            // Three in a row, each larger than the one before, over more than a twentieth of the tolerance.
            (&[-1.0, -1.25, -1.5][..], 32.0, true),
            (&[1.0, 1.25, 1.5], 32.0, true),
            (&[-1.0, -1.25, -1.5], 74.0, true),
            (&[-1.0, -1.25, -1.5], 76.0, false),
            (&[-1.5, -1.25, -1.5], 32.0, false),
            (&[-1.0, -1.5, -1.5], 32.0, false),
            (&[1.0, -1.25, -1.5], 32.0, false),
            (&[-1.25, -1.5], 32.0, false),
            // Two in a row, the second larger by more than 1.3, over more than a sixth.
            (&[-1.0, -1.5], 14.5, true),
            (&[1.0, 1.5], 14.5, true),
            (&[-1.0, -1.5], 15.5, false),
            (&[-1.0, -1.25], 8.0, false),
            // One against the one before and three times as large, over more than the tolerance.
            (&[1.0, -3.5], 3.25, true),
            (&[-1.0, 3.5], 3.25, true),
            (&[0.0, -3.5], 3.25, true),
            (&[1.0, -3.5], 3.75, false),
            (&[1.0, -2.5], 2.0, false),
            (&[0.5, 1.0, -3.5], 4.0, false),
            // After fading pollution, twice as large, over more than 0.15.
            (&[1.5, 1.0, -2.5], 16.0, true),
            (&[-1.5, -1.0, 2.5], 16.0, true),
            (&[1.5, 1.0, -2.5], 17.0, false),
            (&[1.5, 1.0, -1.75], 6.0, false),
            (&[0.5, 1.0, -2.5], 12.0, false),
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
    fn an_outlier_is_a_level_off_the_line_through_its_neighbours() {
        let levels = |rates: &[f64]| {
            let mut levels = vec![Level { step: 1.0, error: 1.0 }];
            for rate in rates {
                let Level { step, error } = levels[levels.len() - 1];
                levels.push(Level { step: 0.5 * step, error: error * 0.5_f64.powf(*rate) });
            }
            levels
        };
        for (rates, set_aside, expected) in [
            // Three times too large, then too small.
            (&[2.0, 0.415, 3.585, 2.0, 2.0][..], 3, Some(2)),
            (&[3.585, 0.415, 2.0, 2.0], 2, Some(1)),
            // Not twice; the levels around it not on the line; the coarsest level of all; nothing set aside.
            (&[2.0, 1.125, 2.875, 2.0, 2.0], 3, None),
            (&[0.25, 3.25, 2.0, 2.0], 2, None),
            (&[-1.0, 2.0, 2.0, 2.0], 1, None),
            (&[2.0, 0.415, 3.585], 0, None),
            (&[], 0, None),
        ] {
            assert_eq!(outlier(&levels(rates), set_aside), expected, "{rates:?}");
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
