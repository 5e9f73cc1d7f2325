//! Which levels are asymptotic: decided by a rule, not after seeing the answer.

use std::ops::Range;

use super::{Level, pairwise_rates};

/// Factor from round-off to a floor: errors this many times larger carry 1e-3 of round-off in log e.
pub const FLOOR_MARGIN: f64 = 1e3;

/// Coarse levels are dropped while a pairwise rate there differs from the finest one by more than this.
///
/// Pollution of c h^r shifts a rate by about r c h^r: at 0.4 the terms of order c², which no fit here contains, shift
/// it by less than 0.1 and fade twice as fast, and candidates with fading scatter trust coarse levels little. At 0.2
/// scattered data lose levels needlessly, and 2 in 100 sound tables no longer pass; above 0.4 coverage falls.
pub const PRE_ASYMPTOTIC_SPREAD: f64 = 0.4;

/// The levels from which a rate may be read, and how many were set aside on either side.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AsymptoticRange {
    /// Indices of the levels used.
    pub used: Range<usize>,
    /// Coarse levels set aside: their rates are still changing.
    pub pre_asymptotic: usize,
    /// Fine levels set aside: at the round-off floor.
    pub at_floor: usize,
}

/// The asymptotic range, by two rules applied in this order:
///
/// 1. Fine levels are dropped as long as the finest error is at most `floor`. The floor is an absolute number that the
///    caller knows ([`FLOOR_MARGIN`] times round-off or solver tolerance) and is *never* guessed from the data: errors
///    that stop falling above it are the signature of an inconsistent scheme, and dropping those levels would hide it.
/// 2. Coarse levels are dropped while the pairwise rate that starts there differs from the finest remaining rate by more
///    than [`PRE_ASYMPTOTIC_SPREAD`]: all the rates in the range then lie within that distance of the finest.
///
/// The range may end up shorter than any fit needs; the judge deals with that. Errors must be positive and finite: a
/// NaN rate drops every level before it.
pub fn asymptotic_range(levels: &[Level], floor: f64) -> AsymptoticRange {
    let resolved = |level: &Level| level.error > floor;
    let end = levels.iter().rposition(resolved).map_or(0, |finest| finest + 1);
    let rates = pairwise_rates(&levels[..end]);
    let finest = rates.last().copied().unwrap_or(f64::NAN);
    // Written this way round, a NaN rate is not near.
    let near = |rate: &&f64| (**rate - finest).abs() <= PRE_ASYMPTOTIC_SPREAD;
    let start = rates.len() - rates.iter().rev().take_while(near).count();
    AsymptoticRange { used: start..end, pre_asymptotic: start, at_floor: levels.len() - end }
}
