//! The trend of the rates: it tells a lost order from noise.

use std::ops::Range;

use crate::fit::{COMPARISON, Level, pairwise_rates, round_off_of_rates};

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

/// Largest rate of errors that stand still between two levels that are one run.
const STILL: f64 = 0.1;

/// Least rate of errors that fall.
const FALLS: f64 = 0.5;

/// Least distance of a rate from both its neighbours that no error law explains.
const JUMP: f64 = 3.0;

/// Rates that differ by less are clean. (Rates of 2.66, 6.38 and 3.15 are those of meshes that are
/// too coarse.)
const CLEAN: f64 = 0.25;

/// Rates between neighbouring levels, with what rounding moves them by at most.
///
/// "More" and "less" below mean by more than rounding explains, and a change of the rate that
/// rounding explains is zero: so the units of h and e decide nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rates {
    values: Vec<f64>,
    /// Of each rate, times [`COMPARISON`].
    round_off: Vec<f64>,
}

impl Rates {
    /// The rates of levels, coarsest first.
    pub fn of(levels: &[Level]) -> Self {
        let round_off = round_off_of_rates(levels).into_iter();
        Self {
            values: pairwise_rates(levels),
            round_off: round_off.map(|one| COMPARISON * one).collect(),
        }
    }

    /// Rates without round-off.
    pub fn exact(values: &[f64]) -> Self {
        Self {
            values: values.to_vec(),
            round_off: vec![0.0; values.len()],
        }
    }

    /// As measured.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// What rounding may do to a comparison of these rates.
    fn round_off(&self, rates: Range<usize>) -> f64 {
        self.round_off[rates].iter().copied().fold(0.0, f64::max)
    }

    /// The same of the finest rates, this many.
    fn round_off_of_finest(&self, count: usize) -> f64 {
        let rates = self.values.len();
        self.round_off(rates.saturating_sub(count)..rates)
    }

    /// Changes of the rate between one refinement and the next; zero if rounding explains it.
    fn changes(&self) -> Vec<f64> {
        self.changes_from(0)
    }

    /// The same of the rates from the first one on.
    fn changes_from(&self, first: usize) -> Vec<f64> {
        let pairs = self.values.windows(2).enumerate();
        let changes = pairs.skip(first).map(|(k, pair)| {
            let change = pair[1] - pair[0];
            if change.abs() <= self.round_off(k..k + 2) {
                0.0
            } else {
                change
            }
        });
        changes.collect()
    }

    /// How far the rates scatter: the largest cancelling part of two consecutive changes of
    /// opposite sign.
    ///
    /// Pollution, plateaus and terms of another order change the rates one way and have a scatter
    /// of zero; noise changes them to and fro.
    pub fn scatter(&self) -> f64 {
        let mut scatter: f64 = 0.0;
        for pair in self.changes().windows(2) {
            if pair[0] * pair[1] < 0.0 {
                scatter = scatter.max(pair[0].abs().min(pair[1].abs()));
            }
        }
        scatter
    }

    /// How many pairs of consecutive changes of the rates of the finest levels, this many, have
    /// opposite signs.
    pub(super) fn turns_of_finest(&self, levels: usize) -> usize {
        let rates = levels - 1;
        let changes = self.changes_from(self.values.len().saturating_sub(rates));
        let turns = changes.windows(2).filter(|pair| pair[0] * pair[1] < 0.0);
        turns.count()
    }

    /// Whether the rates fell on each of the last two refinements, are still falling, and ended
    /// more than half an order below the claim, by more than scatter explains.
    ///
    /// Pollution fades, so it does the opposite. Errors that level off above the round-off floor do
    /// this, for example if a coefficient differs between the scheme and the sources; dropping the
    /// levels where it shows would hide it. Rates that have come to rest are those of a lost order:
    /// [`Reason::TooLow`](super::Reason::TooLow) says so, with the rate.
    pub fn falls_away(&self, order: f64) -> bool {
        let ([.., before, last], [.., finest]) = (&self.changes()[..], &self.values[..]) else {
            return false;
        };
        let round_off = self.round_off(0..self.values.len());
        *before < 0.0
            && *last < -STILL_FALLING - round_off
            && finest + 2.0 * self.scatter() < order - 0.5 - round_off
    }

    /// Whether the last changes of the rate grow; those of fading pollution shrink. A plateau, a
    /// wrong limit or a lower order is about to show.
    ///
    /// The rates 2.000, 2.000, 1.998, 1.993, 1.973 have hardly left 2, but are leaving it at a
    /// growing pace. The behaviour of coarse levels is no excuse: only the last three changes
    /// count, and another level at the coarse end can add reasons but never remove one.
    pub fn departs(&self, tolerance: f64) -> bool {
        let round_off = self.round_off_of_finest(4);
        let [three, two, one] = DEPARTED.map(|share| share * tolerance + round_off);
        let changes = self.changes();
        let [.., before, last] = changes[..] else {
            return false;
        };
        let larger = |from: f64, to: f64, factor: f64| larger(from, to, factor, round_off);
        // Rates that stood still have no direction that the last change could turn.
        let goes_on = larger(before, last, GROWTH) || before == 0.0;
        if goes_on && (before + last).abs() > two {
            return true;
        }
        let [.., first, _, _] = changes[..] else {
            return false;
        };
        let in_a_row = larger(first, before, GROWTH) && larger(before, last, GROWTH);
        let turns = before * last <= 0.0 && last.abs() > TURN * before.abs() + round_off;
        in_a_row && (first + before + last).abs() > three
            || larger(before, first, 1.0) && turns && last.abs() > one
    }

    /// Whether rates that [depart](Self::departs) come nearer to the order and have hardly anything
    /// left: the last four lie within a tenth of the tolerance of it, on one side, and each is
    /// nearer than the one before.
    ///
    /// The rates 1.9872, 1.9888, 1.9917, 1.9961 rise at a growing pace, towards 2. Rates that move
    /// away from the order, however little, stay a reason: h² (1 + s h_min/h) has them.
    pub(super) fn approaches(&self, order: f64, tolerance: f64) -> bool {
        let Some(last) = self.values.len().checked_sub(4) else {
            return false;
        };
        let round_off = self.round_off_of_finest(4);
        let distances: Vec<f64> = self.values[last..]
            .iter()
            .map(|rate| order - rate)
            .map(|distance| {
                if distance.abs() <= round_off {
                    0.0
                } else {
                    distance
                }
            })
            .collect();
        let is_near = distances[0].abs() <= NEAR * tolerance + round_off;
        let are_nearer =
            |pair: &[f64]| pair[0] * pair[1] >= 0.0 && pair[1].abs() < pair[0].abs() - round_off;
        is_near && distances.windows(2).all(are_nearer)
    }

    /// Whether a rate is far from both its neighbours, which agree, or zero between rates of errors
    /// that fall: the levels before and after it are those of two tables, in other units, or those
    /// of one mesh, which was used twice.
    pub(super) fn jumps(&self) -> bool {
        self.values.windows(3).enumerate().any(|(k, three)| {
            let [before, rate, after] = [three[0], three[1], three[2]];
            let round_off = self.round_off(k..k + 3);
            let is_far =
                (rate - before).abs() > JUMP + round_off && (rate - after).abs() > JUMP + round_off;
            let is_still = rate.abs() < STILL - round_off && before.min(after) > FALLS + round_off;
            (before - after).abs() < CLEAN - round_off && (is_far || is_still)
        })
    }

    /// Whether every second rate is zero, two of them or more, and the others are those of errors
    /// that fall.
    pub(super) fn alternate(&self) -> bool {
        let round_off = self.round_off(0..self.values.len());
        (0..2).any(|first| {
            let mut still = self.values.iter().skip(first).step_by(2);
            let mut others = self.values.iter().skip(1 - first).step_by(2);
            self.values.len() > 2 + first
                && still.all(|rate| rate.abs() <= STILL + round_off)
                && others.all(|rate| *rate >= FALLS - round_off)
        })
    }

    /// Whether the rates of three or four levels, too few for [`departs`](Self::departs) to see,
    /// may be leaving the order.
    ///
    /// Four levels: their two changes grow steadily. Three such changes are a departure; two may be
    /// chance, and a fifth level tells. Three levels: the second rate is farther from the order
    /// than the first.
    pub(super) fn emerges(&self, order: f64, tolerance: f64) -> bool {
        let round_off = self.round_off_of_finest(3);
        match (&self.values[..], &self.changes()[..]) {
            (_, &[before, last]) => {
                larger(before, last, GROWTH, round_off)
                    && (before + last).abs() > DEPARTED[0] * tolerance + round_off
            }
            (&[first, second], _) => {
                (second - order).abs() > (first - order).abs() + LEFT * tolerance + round_off
            }
            _ => false,
        }
    }
}

/// Whether the second change has the sign of the first and is larger by more than the factor.
fn larger(from: f64, to: f64, factor: f64, round_off: f64) -> bool {
    from * to > 0.0 && to.abs() > factor * from.abs() + round_off
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scatter_is_what_goes_to_and_fro() {
        let scatter = |rates: &[f64]| Rates::exact(rates).scatter();
        assert_eq!(scatter(&[]), 0.0);
        assert_eq!(scatter(&[1.0]), 0.0);
        assert_eq!(scatter(&[1.0, 0.75]), 0.0);
        assert_eq!(scatter(&[1.0, 1.25, 1.5, 2.5]), 0.0, "one way");
        assert_eq!(scatter(&[1.0, 1.5, 1.25]), 0.25);
        assert_eq!(scatter(&[1.0, 1.25, 0.5, 1.0, 1.125]), 0.5);
    }

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
            assert_eq!(Rates::exact(rates).falls_away(order), expected, "{rates:?}");
        }
    }

    /// Rates from 2 on with these changes.
    fn departs_by(changes: &[f64], tolerance: f64) -> bool {
        let mut rates = vec![2.0];
        changes
            .iter()
            .for_each(|change| rates.push(rates[rates.len() - 1] + change));
        Rates::exact(&rates).departs(tolerance)
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
            // After none.
            (&[0.0, -1.5], 8.5, true),
            (&[0.0, 1.5], 8.5, true),
            (&[0.0, 1.5], 9.5, false),
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
            assert_eq!(
                Rates::exact(rates).approaches(order, 0.25),
                expected,
                "{rates:?}"
            );
            let earlier = [&[1.5][..], rates].concat();
            assert_eq!(
                Rates::exact(&earlier).approaches(order, 0.25),
                expected,
                "{earlier:?}"
            );
        }
    }

    #[test]
    fn a_jump_stands_between_rates_that_agree() {
        let jumps = |rates: &[f64]| Rates::exact(rates).jumps();
        assert!(jumps(&[2.0, 17.0, 2.0]) && jumps(&[1.9, 2.0, -2.0, 2.1]));
        // One mesh twice.
        assert!(jumps(&[2.0, 0.001, 2.0, 2.0]) && !jumps(&[2.0, 0.2, 2.0]));
        for rates in [
            &[2.0, 17.0][..],
            &[2.0, 4.0, 2.0],
            &[12.0, -8.0, 2.0],
            &[1.0, 17.0, 2.0],
        ] {
            assert!(!jumps(rates), "{rates:?}");
        }
    }

    /// By more than rounding explains.
    #[test]
    fn rounding_is_no_jump() {
        for (rates, expected) in [
            ([2.0, 17.0, 2.15], true),
            ([2.0, 17.0, 2.2], false),
            ([2.0, 5.09, 2.05], false),
            ([2.05, 5.09, 2.0], false),
            ([0.6, 0.03, 0.6], true),
            ([0.6, 0.05, 0.6], false),
            ([0.53, 0.03, 0.55], false),
        ] {
            let rounded = Rates {
                round_off: vec![0.0625; 3],
                ..Rates::exact(&rates)
            };
            assert_eq!(rounded.jumps(), expected, "{rates:?}");
        }
    }

    #[test]
    fn rates_alternate_where_every_second_one_is_zero() {
        for (rates, expected) in [
            (&[0.0, 2.0, 0.0][..], true),
            (&[2.0, 0.0, 2.0, 0.0], true),
            (&[-0.1, 0.5, 0.1, 4.0, 0.0], true),
            // One of them; not zero; errors that do not fall.
            (&[2.0, 0.0, 2.0], false),
            (&[0.0, 2.0], false),
            (&[0.0, 2.0, 0.11], false),
            (&[0.0, 0.4, 0.0], false),
            (&[0.0, 0.0, 0.0], false),
            (&[2.0, 2.0, 2.0, 2.0], false),
            (&[0.5, 4.0, 0.5, 4.0], false),
        ] {
            assert_eq!(Rates::exact(rates).alternate(), expected, "{rates:?}");
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
            assert_eq!(
                Rates::exact(rates).emerges(2.0, tolerance),
                expected,
                "{rates:?}"
            );
        }
    }
}
