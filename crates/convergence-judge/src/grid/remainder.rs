//! What is left of the finest error without the contributions of h and dt.

use super::{Adding, GridErrors, SpaceTime, contribution};
use crate::fit::{Level, pairwise_rates};
use crate::interval::Interval;
use crate::richardson::growth;
use crate::verdict::{Band, RateVerdict};

/// Bounds on the exponent r of h^r with which the rates approach the order.
pub const APPROACH: [f64; 2] = [0.4, 2.0];

/// The remainder is never known more accurately than this many misfits.
pub const MISFITS_OF_REST: f64 = 4.0;

/// An order so many half-widths of its interval away from the rate read is not that of the errors.
const FAR: f64 = 3.0;

/// Shares of the finest error: negligible, too large however uncertain, a limit.
const REST: [f64; 3] = [0.005, 0.075, 0.1];

/// What is left, in shares of the finest error.
#[derive(Debug, Clone, Copy)]
pub(super) struct Remainder {
    /// λ.
    pub(super) share: f64,
    uncertainty: f64,
    /// The change of λ from the order to an end of the interval, where that excludes the claim.
    change: f64,
}

impl Remainder {
    pub(super) fn new(
        grid: &GridErrors<'_>,
        adding: Adding,
        judged: &SpaceTime<RateVerdict>,
        claims: SpaceTime<Band>,
    ) -> Self {
        let power = adding.power();
        let mut left = Self {
            share: 1.0 / power,
            uncertainty: MISFITS_OF_REST * grid.misfit(adding),
            change: 0.0,
        };
        for (in_space, judged, claim) in [
            (true, &judged.space, claims.space),
            (false, &judged.time, claims.time),
        ] {
            let errors = grid.line(in_space, 0);
            let used = judged.used.end;
            let Meant {
                order,
                ends,
                is_read,
            } = Meant::of(judged, claim.order);
            let seen = Approach::new(&errors, used, power, order);
            let found = seen.finest(seen.exponent());
            left.share -= found;
            let linear = (found - seen.finest(1.0)).abs();
            left.uncertainty += linear.max(0.1 * (found - seen.difference).abs());
            let changes = [ends.low, ends.high].map(|end| {
                let other = Approach::new(&errors, used, power, end);
                (other.finest(other.exponent()) - found).abs()
            });
            let change = changes[0].max(changes[1]);
            left.change += change;
            if is_read {
                left.uncertainty += change;
            }
        }
        left
    }

    /// Whether nothing is left.
    pub(super) fn is_nothing(&self) -> bool {
        let [none, most, _] = REST;
        let size = self.share.abs();
        size + self.change <= most && size <= self.uncertainty.max(none)
    }

    /// Whether a limit that is not zero is left.
    pub(super) fn is_limit(&self) -> bool {
        let [_, _, limit] = REST;
        self.share.abs() > limit.max(2.0 * (self.uncertainty + self.change))
    }
}

/// The order with which a contribution goes on.
struct Meant {
    order: f64,
    /// What it may be as well.
    ends: Interval,
    /// Whether it is the rate read.
    is_read: bool,
}

impl Meant {
    /// The order claimed; the rate read if that order lies far outside its interval.
    fn of(judged: &RateVerdict, order: f64) -> Self {
        match (judged.fitted, judged.interval) {
            (Some(rate), Some(ends)) if !ends.holds(order) => {
                let is_read = (order - rate).abs() > 0.5 * FAR * (ends.high - ends.low);
                Self {
                    order: if is_read { rate } else { order },
                    ends,
                    is_read,
                }
            }
            _ => Self {
                order,
                ends: Interval::around(order, 0.0),
                is_read: false,
            },
        }
    }
}

/// How the rates of one contribution approach its order.
pub(super) struct Approach<'a> {
    errors: &'a [Level],
    /// The contributions of which rates are known, of this order.
    levels: Vec<Level>,
    power: f64,
    order: f64,
    /// The contribution at the finest level if its rate is the order from there on.
    difference: f64,
}

impl<'a> Approach<'a> {
    pub(super) fn new(errors: &'a [Level], used: usize, power: f64, order: f64) -> Self {
        let mut levels = contribution(errors, power, order);
        levels.truncate(used);
        let difference = match errors {
            [.., before, finest] => {
                let difference = (before.error / finest.error).powf(power) - 1.0;
                difference / power / growth(before.step / finest.step, power * order)
            }
            _ => f64::NAN,
        };
        Self {
            errors,
            levels,
            power,
            order,
            difference,
        }
    }

    /// The distances of the rates from the order.
    fn distances(&self) -> Vec<f64> {
        let rates = pairwise_rates(&self.levels).into_iter();
        rates.map(|rate| rate - self.order).collect()
    }

    /// r, from the last two rates, each taken for that at the middle of its steps.
    pub(super) fn exponent(&self) -> f64 {
        let [least, most] = APPROACH;
        match (&self.distances()[..], &self.levels[..]) {
            ([.., before, last], [.., coarse, _, fine]) => {
                let shrinks = before / last;
                let apart = 0.5 * (coarse.step / fine.step).ln();
                if shrinks > 0.0 {
                    (shrinks.ln() / apart).clamp(least, most)
                } else {
                    most
                }
            }
            _ => 1.0,
        }
    }

    /// K h^r of each difference, h in units of the finest step.
    fn pollution(&self, exponent: f64) -> Vec<f64> {
        let power = self.power * self.order;
        let finest = self.errors.last().map_or(f64::NAN, |level| level.step);
        let pairs = self.errors.windows(2).map(|pair| {
            let ratio = pair[0].step / pair[1].step;
            let k = growth(ratio, power + exponent) / growth(ratio, power);
            k * (pair[1].step / finest).powf(exponent)
        });
        pairs.collect()
    }

    /// The contribution at the finest level if its rates approach the order as h^r.
    pub(super) fn finest(&self, exponent: f64) -> f64 {
        let pollution = self.pollution(exponent);
        let (Some(last), [.., before, fine]) = (self.distances().last().copied(), &self.levels[..])
        else {
            return self.difference;
        };
        let place = self.levels.len() - 1;
        let fall = (pollution[place - 1] - pollution[place]) / (before.step / fine.step).ln();
        let of_finest = pollution[pollution.len() - 1] - 1.0;
        self.difference * (-self.power * last * of_finest / fall).exp()
    }
}
