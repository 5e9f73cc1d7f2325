//! Which levels are used: decided by a rule, not after seeing the answer.

use std::ops::Range;

use super::{Level, pairwise_rates};

/// Factor from round-off to a floor: errors this many times larger carry 1e-3 of round-off in log
/// e.
pub const FLOOR_MARGIN: f64 = 1e3;

/// The number of finest levels that are used. Coarser ones say less about h → 0 than they can
/// spoil.
pub const MOST_USED: usize = 5;

/// Of these, coarse levels are dropped while a rate between the remaining ones differs from the
/// finest rate by more than this.
pub const SPREAD: f64 = 0.55;

/// The indices of the levels from which a rate may be read, by three rules applied in this order:
///
/// 1. Fine levels are dropped as long as the finest error is at most `floor`. The floor is an
///    absolute number that the caller knows ([`FLOOR_MARGIN`] times round-off or solver tolerance)
///    and is *never* guessed from the data: errors that stop falling above it are the signature of
///    an inconsistent scheme, and dropping those levels would hide it.
/// 2. The [`MOST_USED`] finest levels are kept.
/// 3. Coarse levels are dropped while the pairwise rate that starts there differs from the finest
///    rate by more than [`SPREAD`].
///
/// The range may end up shorter than any fit needs; the judge deals with that. Errors must be
/// positive and finite: a NaN rate drops every level before it.
pub fn asymptotic_range(levels: &[Level], floor: f64) -> Range<usize> {
    let end = levels
        .iter()
        .rposition(|level| level.error > floor)
        .map_or(0, |finest| finest + 1);
    let rates = pairwise_rates(&levels[..end]);
    let finest = rates.last().copied().unwrap_or(f64::NAN);
    let near = rates
        .iter()
        .rev()
        .take(MOST_USED - 1)
        .take_while(|rate| (**rate - finest).abs() <= SPREAD);
    rates.len() - near.count()..end
}

/// Changes of the rate between one refinement and the next.
pub(crate) fn changes(rates: &[f64]) -> Vec<f64> {
    rates.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// How far the rates scatter: the largest cancelling part of two consecutive changes of opposite
/// sign.
///
/// Pollution, plateaus and terms of another order change the rates one way and have a scatter of
/// zero; noise changes them to and fro.
pub fn scatter(rates: &[f64]) -> f64 {
    let mut scatter: f64 = 0.0;
    for pair in changes(rates).windows(2) {
        if pair[0] * pair[1] < 0.0 {
            scatter = scatter.max(pair[0].abs().min(pair[1].abs()));
        }
    }
    scatter
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scatter_is_what_goes_to_and_fro() {
        assert_eq!(scatter(&[]), 0.0);
        assert_eq!(scatter(&[1.0]), 0.0);
        assert_eq!(scatter(&[1.0, 0.75]), 0.0);
        assert_eq!(scatter(&[1.0, 1.25, 1.5, 2.5]), 0.0, "one way");
        assert_eq!(scatter(&[1.0, 1.5, 1.25]), 0.25);
        assert_eq!(scatter(&[1.0, 1.25, 0.5, 1.0, 1.125]), 0.5);
    }
}
