//! The trend of the rates: it tells a lost order from noise.

use crate::judge::fit::{changes, scatter};

/// A fall is still going on if the finest rate is lower than the one before by more than this.
const STILL_FALLING: f64 = 0.1;

/// Least growth of a change of the rate over the one before, of the same sign, that reveals a term
/// of lower order.
///
/// For `e = h^p (1 + f h^-δ)` on halved steps the changes grow by `2^δ (1 + s) / (1 + 4^δ s)`, s =
/// f h^-δ in the middle of the coarsest of the three pairs of levels. For δ = 1/2 that is more than
/// 1.1 up to s = 0.4; pollution 1 + 3 h^(1/3), still far from fading, makes them grow by less.
const GROWTH: f64 = 1.1;

/// Least growth over a change of the other sign: noise makes changes of similar size to and fro.
const TURN: f64 = 4.0;

/// Shares of the tolerance above which changes count: three in a row, two in a row, one against
/// fading pollution.
const DEPARTED: [f64; 3] = [1.0 / 40.0, 1.0 / 6.0, 1.0 / 10.0];

/// Share of the tolerance by which the second of two rates may be farther from the order than the
/// first.
const LEFT: f64 = 1.0 / 80.0;

/// Share of the tolerance within which rates that come nearer to the order are as good as there.
const NEAR: f64 = 0.1;

/// Least distance of a rate from both its neighbours that no error law explains.
const JUMP: f64 = 3.0;

/// Rates that differ by less are clean. (Rates of 2.66, 6.38 and 3.15 are those of meshes that are
/// too coarse.)
const CLEAN: f64 = 0.25;

/// Whether the second change has the sign of the first and is larger by more than the factor.
fn larger(from: f64, to: f64, factor: f64) -> bool {
    from * to > 0.0 && to.abs() > factor * from.abs()
}

/// Whether the rates fell on each of the last two refinements, are still falling, and ended more
/// than half an order below the claim, by more than scatter explains.
///
/// Pollution fades, so it does the opposite. Errors that level off above the round-off floor do
/// this, for example if a coefficient differs between the scheme and the sources; dropping the
/// levels where it shows would hide it. Rates that have come to rest are those of a lost order:
/// [`Reason::TooLow`](super::Reason::TooLow) says so, with the rate.
pub fn falls_away(rates: &[f64], order: f64) -> bool {
    let [.., before, middle, finest] = rates else {
        return false;
    };
    before > middle
        && middle - finest > STILL_FALLING
        && finest + 2.0 * scatter(rates) < order - 0.5
}

/// Whether the last changes of the rate grow; those of fading pollution shrink. A plateau, a wrong
/// limit or a lower order is about to show.
///
/// The rates 2.000, 2.000, 1.998, 1.993, 1.973 have hardly left 2, but are leaving it at a growing
/// pace. The behaviour of coarse levels is no excuse: only the last three changes count, and
/// another level at the coarse end can add reasons but never remove one.
pub fn departs(rates: &[f64], tolerance: f64) -> bool {
    let [three, two, one] = DEPARTED.map(|share| share * tolerance);
    let changes = changes(rates);
    let [.., before, last] = changes[..] else {
        return false;
    };
    if larger(before, last, GROWTH) && (before + last).abs() > two {
        return true;
    }
    let [.., first, _, _] = changes[..] else {
        return false;
    };
    let in_a_row = larger(first, before, GROWTH) && larger(before, last, GROWTH);
    let turns = before * last <= 0.0 && last.abs() > TURN * before.abs();
    in_a_row && (first + before + last).abs() > three
        || larger(before, first, 1.0) && turns && last.abs() > one
}

/// Whether rates that [`departs`] refuses come nearer to the order and have hardly anything left:
/// the last four lie within a tenth of the tolerance of it, on one side, and each is nearer than
/// the one before.
///
/// The rates 1.9872, 1.9888, 1.9917, 1.9961 rise at a growing pace, towards 2. Rates that move away
/// from the order, however little, stay a reason: h² (1 + s h_min/h) has them.
pub(super) fn approaches(rates: &[f64], order: f64, tolerance: f64) -> bool {
    let Some(last) = rates.len().checked_sub(4) else {
        return false;
    };
    let distances: Vec<f64> = rates[last..].iter().map(|rate| order - rate).collect();
    let is_near = distances[0].abs() <= NEAR * tolerance;
    let pairs = distances.windows(2);
    let are_nearer = |pair: &[f64]| pair[0] * pair[1] >= 0.0 && pair[1].abs() < pair[0].abs();
    is_near && pairs.clone().all(are_nearer)
}

/// Whether a rate is far from both its neighbours, which agree: the levels before and after it are
/// those of two tables, or in other units.
pub(super) fn jumps(rates: &[f64]) -> bool {
    rates.windows(3).any(|three| {
        let [before, rate, after] = [three[0], three[1], three[2]];
        (before - after).abs() < CLEAN
            && (rate - before).abs() > JUMP
            && (rate - after).abs() > JUMP
    })
}

/// Whether the rates of three or four levels, too few for [`departs`] to see, may be leaving the
/// order.
///
/// Four levels: their two changes grow steadily. Three such changes are a departure; two may be
/// chance, and a fifth level tells. Three levels: the second rate is farther from the order than
/// the first.
pub(super) fn emerges(rates: &[f64], order: f64, tolerance: f64) -> bool {
    match (rates, &changes(rates)[..]) {
        (_, &[before, last]) => {
            larger(before, last, GROWTH) && (before + last).abs() > DEPARTED[0] * tolerance
        }
        (&[first, second], _) => (second - order).abs() > (first - order).abs() + LEFT * tolerance,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fall_is_one_that_goes_on() {
        for (rates, order, expected) in [
            (&[1.5, 1.25, 1.0][..], 2.0, true),
            // Come to rest; not half an order below; not beyond scatter.
            (&[1.02, 1.01, 1.0], 2.0, false),
            (&[2.0, 1.5, 1.25, 1.125, 1.0625], 2.0, false),
            (&[1.5, 1.25, 1.0], 1.5, false),
            (&[2.0, 1.0, 1.5, 1.25, 1.0], 2.0, false),
            // One of the last two does not fall; two rates.
            (&[1.25, 1.5, 1.0], 2.0, false),
            (&[1.5, 1.0, 1.0], 2.0, false),
            (&[1.5, 1.0], 2.0, false),
            (&[1.5, f64::NAN, 1.0], 2.0, false),
        ] {
            assert_eq!(falls_away(rates, order), expected, "{rates:?}");
        }
    }

    /// Rates from 2 on with these changes.
    fn departs_by(changes: &[f64], tolerance: f64) -> bool {
        let mut rates = vec![2.0];
        changes
            .iter()
            .for_each(|change| rates.push(rates[rates.len() - 1] + change));
        departs(&rates, tolerance)
    }

    #[test]
    fn a_departure_is_a_change_that_grows() {
        for (changes, tolerance, expected) in [
            // Three in a row, each larger than the one before by more than 1.1, over more than a
            // fortieth of the tolerance.
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
            // Two in a row, the second larger by more than 1.1, over more than a sixth.
            (&[-1.0, -1.5], 14.5, true),
            (&[1.0, 1.5], 14.5, true),
            (&[-1.0, -1.5], 15.5, false),
            (&[-1.0, -1.09], 8.0, false),
            (&[-1.0, -1.12], 8.0, true),
            // After fading pollution, four times as large, over more than a tenth.
            (&[1.5, 1.0, -4.5], 44.0, true),
            (&[-1.5, -1.0, 4.5], 44.0, true),
            (&[1.5, 1.0, -4.5], 46.0, false),
            (&[1.5, 1.0, -3.75], 6.0, false),
            (&[0.5, 1.0, -4.5], 12.0, false),
            (&[1.5, -1.0, -1.25], 14.0, false),
            (&[1.5], 0.1, false),
            (&[], 0.1, false),
        ] {
            assert_eq!(
                departs_by(changes, tolerance),
                expected,
                "{changes:?} {tolerance}"
            );
            let earlier: Vec<f64> = [-30.0, 40.0]
                .into_iter()
                .chain(changes.iter().copied())
                .collect();
            assert!(
                !expected || departs_by(&earlier, tolerance),
                "disarmed: {changes:?} {tolerance}"
            );
        }
    }

    #[test]
    fn rates_that_end_near_the_order_approach_it() {
        for (rates, order, expected) in [
            (&[1.9872, 1.9888, 1.9917, 1.9961][..], 2.0, true),
            (&[2.0128, 2.0112, 2.0083, 2.0039], 2.0, true),
            // Farther than a tenth of the tolerance; away from the order; through it; three rates.
            (&[1.9672, 1.9688, 1.9717, 1.9761], 2.0, false),
            (&[1.9961, 1.9917, 1.9888, 1.9872], 2.0, false),
            (&[1.9961, 1.9977, 1.9995, 2.0004], 2.0, false),
            (&[1.9888, 1.9917, 1.9961], 2.0, false),
        ] {
            assert_eq!(approaches(rates, order, 0.25), expected, "{rates:?}");
            let earlier = [&[1.5][..], rates].concat();
            assert_eq!(approaches(&earlier, order, 0.25), expected, "{earlier:?}");
        }
    }

    #[test]
    fn a_jump_stands_between_rates_that_agree() {
        assert!(jumps(&[2.0, 17.0, 2.0]) && jumps(&[1.9, 2.0, -2.0, 2.1]));
        for rates in [
            &[2.0, 17.0][..],
            &[2.0, 4.0, 2.0],
            &[12.0, -8.0, 2.0],
            &[1.0, 17.0, 2.0],
        ] {
            assert!(!jumps(rates), "{rates:?}");
        }
    }

    #[test]
    fn an_order_emerges_where_three_or_four_levels_leave_the_claim() {
        for (rates, tolerance, expected) in [
            // Two changes that grow by more than 1.1, over more than a fortieth.
            (&[2.0, 1.75, 1.4375][..], 22.0, true),
            (&[2.0, 2.25, 2.5625], 22.0, true),
            (&[2.0, 1.75, 1.4375], 23.0, false),
            (&[2.0, 1.75, 1.484375], 1.0, false),
            (&[2.0, 1.75, 2.25], 1.0, false),
            (&[2.25, 2.0, 1.75, 1.4375], 1.0, false),
            // One change, away from the order by more than an eightieth.
            (&[2.0, 1.75], 19.0, true),
            (&[2.0, 1.75], 21.0, false),
            (&[2.5, 2.75], 19.0, true),
            (&[1.75, 2.0], 1.0, false),
            (&[1.75, 2.25], 0.1, false),
            (&[2.0], 0.1, false),
        ] {
            assert_eq!(emerges(rates, 2.0, tolerance), expected, "{rates:?}");
        }
    }
}
