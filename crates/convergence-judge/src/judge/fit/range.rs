//! Which levels are asymptotic: decided by a rule, not after seeing the answer.

use std::ops::Range;

use super::{Level, pairwise_rates};

/// Factor from round-off to a floor: errors this many times larger carry 1e-3 of round-off in log e.
pub const FLOOR_MARGIN: f64 = 1e3;

/// Coarse levels are dropped while a pairwise rate there differs from the finest one by more than this, plus the scatter of the rates.
///
/// Pollution of c h^r shifts a rate by about r c h^r: at 0.3 the terms of order c², which no fit here contains, shift
/// it by less than 0.05 and fade twice as fast, and candidates with fading scatter trust coarse levels little.
/// The finest rate is no better known than the rates scatter: without that part 1 in 25 of the true claims on 8 levels no longer pass.
pub const PRE_ASYMPTOTIC_SPREAD: f64 = 0.3;

/// The same for the fourth finest level, if the changes of the last three rates fade like those of pollution: three levels cannot show its exponent, four can.
pub const FADING_SPREAD: f64 = 0.8;

/// Ratios of a change of the rate to the one before that count as fading: those of pollution h^4 to h on halved steps.
const FADING: std::ops::RangeInclusive<f64> = 0.0625..=0.5;

/// An error is off the line through its neighbours if it is larger or smaller by this factor.
const OFF_THE_LINE: f64 = 2.0;

/// How far the rate from one neighbour of an outlier to the other may be from the finest rate.
const SAME_RATE: f64 = 0.1;

/// The indices of the levels from which a rate may be read, by two rules applied in this order:
///
/// 1. Fine levels are dropped as long as the finest error is at most `floor`. The floor is an absolute number that the
///    caller knows ([`FLOOR_MARGIN`] times round-off or solver tolerance) and is *never* guessed from the data: errors
///    that stop falling above it are the signature of an inconsistent scheme, and dropping those levels would hide it.
/// 2. Coarse levels are dropped while the pairwise rate that starts there differs from the finest remaining rate by more
///    than [`PRE_ASYMPTOTIC_SPREAD`] and the [`scatter`] of the rates; the scatter does not count with 3 levels, or if a level
///    dropped without it is an outlier. Rates that fade toward the finest one keep a fourth level within [`FADING_SPREAD`].
///
/// The range may end up shorter than any fit needs; the judge deals with that. Errors must be positive and finite: a
/// NaN rate drops every level before it.
pub fn asymptotic_range(levels: &[Level], floor: f64) -> Range<usize> {
    let resolved = |level: &Level| level.error > floor;
    let end = levels.iter().rposition(resolved).map_or(0, |finest| finest + 1);
    let rates = pairwise_rates(&levels[..end]);
    let finest = rates.last().copied().unwrap_or(f64::NAN);
    let start_within = |spread: f64| {
        // Written this way round, a NaN rate is not near.
        let near = |rate: &&f64| (**rate - finest).abs() <= spread;
        rates.len() - rates.iter().rev().take_while(near).count()
    };
    let mut start = start_within(PRE_ASYMPTOTIC_SPREAD);
    if rates.len() > 2 && outlier(&levels[..end], start).is_none() {
        start = start_within(PRE_ASYMPTOTIC_SPREAD + scatter(&rates));
        let fourth = rates.len() - 3;
        if start == fourth + 1 && (rates[fourth] - finest).abs() <= FADING_SPREAD && fades(&rates[fourth..]) {
            start = fourth;
        }
    }
    start..end
}

/// Whether the changes of three rates fade like those of pollution.
fn fades(rates: &[f64]) -> bool {
    FADING.contains(&((rates[2] - rates[1]) / (rates[1] - rates[0])))
}

/// Changes of the rate between one refinement and the next.
pub(crate) fn changes(rates: &[f64]) -> Vec<f64> {
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

/// The coarsest level set aside that is off the line through its two neighbours, in logarithms, if the slope of that line is the finest rate.
///
/// Levels that are not yet asymptotic approach the finest rate together. If the neighbours are already on such a line
/// and the level between them is not, that level belongs to another problem: a case with a wrong setting.
///
/// * `levels`: those above the floor; the fit leaves out the `set_aside` coarsest.
pub(crate) fn outlier(levels: &[Level], set_aside: usize) -> Option<usize> {
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
}
