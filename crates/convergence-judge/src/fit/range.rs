//! Which levels are used: decided by a rule, not after seeing the answer.

use std::ops::Range;

use super::{Level, pairwise_rates, round_off_of_rates};

/// Factor from round-off to a floor: errors this many times larger carry 1e-3 of round-off in log
/// e.
pub const FLOOR_MARGIN: f64 = 1e3;

/// The number of finest levels that are used. Coarser ones say less about h → 0 than they can
/// spoil.
pub const MOST_USED: usize = 5;

/// Of these, coarse levels are dropped while a rate between the remaining ones differs from the
/// finest rate by more than this.
pub const SPREAD: f64 = 0.55;

/// A comparison of rates leaves this many times the round-off of a rate to chance: the most that
/// one adds up is ten, where a change is compared with four times another.
pub(crate) const COMPARISON: f64 = 16.0;

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
    let round_off = round_off_of_rates(&levels[..end]);
    let finest = rates.last().copied().unwrap_or(f64::NAN);
    let last = round_off.last().copied().unwrap_or(0.0);
    let near = rates
        .iter()
        .zip(&round_off)
        .rev()
        .take(MOST_USED - 1)
        .take_while(|(rate, round_off)| {
            (**rate - finest).abs() <= SPREAD + COMPARISON * round_off.max(last)
        });
    rates.len() - near.count()..end
}
