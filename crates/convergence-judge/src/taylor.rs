//! Is a derivative right? The Taylor test along one direction, with its order and its size.
//!
//! J is a number that depends on m, `dJ·d` its claimed derivative along d, `d'Hd` its claimed
//! second derivative. By Taylor's theorem the remainders
//!
//! ```text
//! R1(ε) = |J(m + εd) - J(m) - ε dJ·d|                    = |J''| ε²/2 + O(ε³)
//! R2(ε) = |J(m + εd) - J(m) - ε dJ·d - ε² d'Hd/2|        = |J'''| ε³/6 + O(ε⁴)
//! ```
//!
//! fall with the orders 2 and 3 if the derivatives are right. A derivative that is off by δ adds
//! `δε` to R1, which shows only where ε < 2δ/|J''|: a gradient off by 1e-5 has a rate of 1.999 at
//! the steps 0.1, 0.05, 0.025, 0.0125. So the steps go down to the noise of J, and beside the order
//! stands the size: the quotients `(J(m + εd) - J(m))/ε = J' + J'' ε/2 + ...` are a polynomial in ε
//! but for noise, and their value at ε = 0 is J' with a bar. The second derivative is
//! that of `(J(m + εd) - 2 J(m) + J(m - εd))/ε²`, a polynomial in ε². Where R1 or R2 changes its
//! sign two of its terms cancel, and its rates deny no order.
//!
//! Three things make a remainder say nothing about its order, and levels end before them:
//! [`FLOOR_MARGIN`] times the noise of J, and ten times what the claimed derivatives may be off
//! once their size is confirmed (`10 (|dJ·d - J'| + bar) ε`): it is known, and it is allowed.
//!
//! The noise is the largest of the round-off of J, the difference of two calls at m, and what the
//! finest steps show: a divided difference of third order of J at 0 and three steps, which is zero
//! for a parabola, in units of the root of the sum of its squared weights. A J of few digits, as it
//! is printed, has at least half a unit of the last one; and where the finest step does not change
//! J at all, the noise is at least the smallest change that another step shows.

use serde::Serialize;

use super::claims::{Bound, Claim};
use super::fit::{FLOOR_MARGIN, Level};
use super::verdict::{DEFAULT_TOLERANCE, FEWEST_LEVELS, Floor, RateVerdict, Verdict, last_place};

mod extrapolate;
#[cfg(test)]
mod tests;
mod words;

use extrapolate::Extrapolated;

/// The part of the derivative by which it may be off, by default.
pub const DEFAULT_TO: f64 = 1e-6;

/// The share of what J changes over the coarsest step below which a derivative counts as zero: it
/// has no relative error.
const VANISHING: f64 = 1e-9;

/// How often what a confirmed derivative may be off fits into a remainder that is used, and the
/// noise into what is no noise.
const MARGIN: f64 = 10.0;

/// A derivative is wrong if it is off by more than so many bars. They rest on a noise that four
/// numbers tell: one in a hundred such estimates is less than half of the noise.
const BARS_OF_A_WRONG_ONE: f64 = 2.0;

/// J along a direction d from m, and what is claimed about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Along {
    /// ε: positive, falling.
    pub steps: Vec<f64>,
    /// J(m + εd) at each step.
    pub forward: Vec<f64>,
    /// J(m), called twice.
    pub here: [f64; 2],
    /// dJ·d.
    pub slope: f64,
    /// The second derivative, if one is claimed.
    pub second: Option<Second>,
}

/// What a test of the second derivative takes besides.
#[derive(Debug, Clone, PartialEq)]
pub struct Second {
    /// J(m - εd) at each step.
    pub backward: Vec<f64>,
    /// d'Hd.
    pub curvature: f64,
}

/// What a Taylor test has found about one derivative.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Finding {
    /// Order and size are confirmed.
    Right,
    /// The size is not that of J.
    Wrong,
    /// The remainder falls at too low an order, or does not fall.
    OrderTooLow,
    /// The remainder does not confirm its order, and does not deny it.
    OrderUndecided,
    /// The noise of J is too large for the size that is asked for.
    Noisy,
    /// The derivative is zero along the direction: it has no relative error.
    Vanishes,
    /// The remainder is zero but for noise: J is a line (a parabola for the second derivative), for
    /// which wrong terms of higher order are invisible.
    NothingTested,
    /// J, or its derivative, is NaN or infinite.
    NotFinite,
}

impl Finding {
    /// The verdict that follows.
    pub fn verdict(self) -> Verdict {
        match self {
            Self::Right => Verdict::Pass,
            Self::Wrong | Self::OrderTooLow | Self::NotFinite => Verdict::Fail,
            Self::OrderUndecided | Self::Noisy | Self::Vanishes | Self::NothingTested => {
                Verdict::Inconclusive
            }
        }
    }
}

/// A claimed derivative beside that of J itself.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Derivative {
    /// What is claimed.
    pub claimed: f64,
    /// What the differences of J tend to.
    pub found: f64,
    /// How far `found` may be off.
    pub bar: f64,
    /// What J changes over the coarsest step ε, over ε (over ε² for the second derivative).
    pub change: f64,
}

impl Derivative {
    /// How far the claim may be off, in units of the derivative; NaN if it vanishes.
    pub fn right_to(&self) -> f64 {
        self.off_at_most() / self.size()
    }

    fn size(&self) -> f64 {
        self.claimed.abs().max(self.found.abs())
    }

    fn off(&self) -> f64 {
        (self.claimed - self.found).abs()
    }

    fn off_at_most(&self) -> f64 {
        self.off() + self.bar
    }

    fn is_zero(&self) -> bool {
        self.size() <= VANISHING * self.change
    }

    /// Whether the claim is right to the part `to`.
    fn size_verdict(&self, to: f64) -> Verdict {
        let allowed = to * self.size();
        if self.off_at_most() <= allowed {
            Verdict::Pass
        } else if self.off() - BARS_OF_A_WRONG_ONE * self.bar > allowed {
            Verdict::Fail
        } else {
            Verdict::Inconclusive
        }
    }
}

/// The test of one derivative along one direction.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Judged {
    /// 1 for dJ·d, 2 for d'Hd.
    pub derivative: u8,
    /// What was found.
    pub finding: Finding,
    /// The derivative and what J says it is.
    pub size: Derivative,
    /// The part by which it may be off.
    pub to: f64,
    /// The remainders that say something about their order, coarsest first.
    #[serde(skip)]
    pub levels: Vec<Level>,
    /// Whether there are three once the size of the derivative is confirmed: a larger `to` confirms
    /// it, but shows no order without them.
    #[serde(skip)]
    pub can_show_order: bool,
    /// Their rate, held against at least 2 or 3; `None` with fewer than three.
    #[serde(skip)]
    pub rate: Option<RateVerdict>,
    /// The noise of J.
    pub noise: f64,
}

impl Judged {
    /// The verdict on this derivative.
    pub fn verdict(&self) -> Verdict {
        self.finding.verdict()
    }
}

impl Along {
    /// The tests of the derivatives that are claimed: the first, then the second.
    ///
    /// * `to`: the part of a derivative by which it may be off.
    pub fn judge(&self, to: f64) -> Vec<Judged> {
        let noise = self.noise();
        let slope = Derivative {
            claimed: self.slope,
            ..self.slope_of_j(noise)
        };
        let first = self.judged(1, slope, to, noise, [slope.off_at_most(), 0.0]);
        let Some(second) = &self.second else {
            return vec![first];
        };
        let curvature = Derivative {
            claimed: second.curvature,
            ..self.curvature_of_j(second, noise)
        };
        let off = [slope.off_at_most(), curvature.off_at_most() / 2.0];
        vec![first, self.judged(2, curvature, to, noise, off)]
    }

    fn is_finite(&self) -> bool {
        let second = self.second.iter();
        let second = second.flat_map(|second| [&second.backward[..], &[second.curvature]].concat());
        let values = self.forward.iter().chain(&self.here);
        let mut values = values.copied().chain([self.slope]).chain(second);
        values.all(f64::is_finite)
    }

    /// How far this value of J is from that at m.
    fn change(&self, value: f64) -> f64 {
        value - self.here[0]
    }

    fn slope_of_j(&self, noise: f64) -> Derivative {
        let quotients = self.steps.iter().zip(&self.forward);
        let quotients: Vec<f64> = quotients.map(|(e, j)| self.change(*j) / e).collect();
        let noises: Vec<f64> = self.steps.iter().map(|step| 2.0 * noise / step).collect();
        self.derivative(extrapolate::to_zero(&self.steps, &quotients, &noises), 1)
    }

    fn curvature_of_j(&self, second: &Second, noise: f64) -> Derivative {
        let squares: Vec<f64> = self.steps.iter().map(|step| step * step).collect();
        let sides = self.forward.iter().zip(&second.backward);
        let quotients = sides.zip(&squares);
        let quotients: Vec<f64> = quotients
            .map(|((ahead, behind), e)| (self.change(*ahead) + self.change(*behind)) / e)
            .collect();
        let noises: Vec<f64> = squares.iter().map(|square| 4.0 * noise / square).collect();
        self.derivative(extrapolate::to_zero(&squares, &quotients, &noises), 2)
    }

    fn derivative(&self, limit: Extrapolated, derivative: i32) -> Derivative {
        let coarsest = self.steps.iter().zip(&self.forward).next();
        let change =
            coarsest.map(|(step, value)| self.change(*value).abs() / step.powi(derivative));
        Derivative {
            claimed: f64::NAN,
            found: limit.value,
            bar: limit.bar,
            change: change.unwrap_or(f64::NAN),
        }
    }

    /// * `off`: by how much the claimed derivatives may be off, as factors of ε and ε².
    fn judged(
        &self,
        derivative: u8,
        size: Derivative,
        to: f64,
        noise: f64,
        off: [f64; 2],
    ) -> Judged {
        let of_noise = FLOOR_MARGIN * noise;
        let if_confirmed = |step: f64| of_noise.max(MARGIN * (off[0] + off[1] * step) * step);
        let remainders = self.remainders(derivative);
        let pairs = self.steps.iter().zip(&remainders);
        let levels = pairs.map(|(step, remainder)| Level {
            step: *step,
            error: remainder.abs(),
        });
        let all: Vec<Level> = levels.collect();
        let confirmed = above(&all, if_confirmed);
        let can_show_order = confirmed.len() >= FEWEST_LEVELS;
        let levels = match size.size_verdict(to) {
            Verdict::Pass => confirmed,
            _ => above(&all, |_| of_noise),
        };
        let rate = (levels.len() >= FEWEST_LEVELS).then(|| order_of(derivative, &levels));
        let finding = if !self.is_finite() {
            Finding::NotFinite
        } else if self.is_constant(noise) {
            let is_coarse = self.resolution() > FLOOR_MARGIN * f64::EPSILON * self.here[0].abs();
            if is_coarse {
                Finding::Noisy
            } else {
                Finding::NothingTested
            }
        } else if size.is_zero() {
            Finding::Vanishes
        } else {
            // Two terms of it cancel where it changes its sign, and its rates tell no order.
            let mut pairs = remainders[..levels.len()].windows(2);
            let crosses_zero = pairs.any(|pair| pair[0] * pair[1] < 0.0);
            let order = rate.as_ref().map(|rate| rate.verdict);
            let order = order.map(|order| match order {
                Verdict::Fail if crosses_zero => Verdict::Inconclusive,
                order => order,
            });
            found_by(size.size_verdict(to), order, self.bends(derivative, noise))
        };
        Judged {
            derivative,
            finding,
            size,
            to,
            levels,
            can_show_order,
            rate,
            noise,
        }
    }

    /// Whether J, and what is claimed of it, stays the same along d, but for noise.
    fn is_constant(&self, noise: f64) -> bool {
        let mut changes = self.forward.iter().map(|value| self.change(*value));
        let claimed = self.steps.first().map_or(0.0, |step| self.slope * step);
        changes.all(|change| change.abs() <= FLOOR_MARGIN * noise)
            && claimed.abs() <= FLOOR_MARGIN * noise
    }

    /// Whether J is no line, or no parabola for the second derivative, over its coarsest steps:
    /// beyond its noise, whatever is claimed.
    fn bends(&self, derivative: u8, noise: f64) -> bool {
        let here = self.here[0];
        let shown = match (derivative, &self.steps[..], &self.forward[..]) {
            (1, [far, near, ..], [first, second, ..]) => {
                extrapolate::noise_of([0.0, *near, *far], [here, *second, *first])
            }
            (_, [far, middle, near, ..], [first, second, third, ..]) => {
                extrapolate::noise_of([0.0, *near, *middle, *far], [here, *third, *second, *first])
            }
            _ => 0.0,
        };
        shown > MARGIN * noise
    }

    /// R1 or R2 at each step, with its sign.
    fn remainders(&self, derivative: u8) -> Vec<f64> {
        let curvature = match &self.second {
            Some(second) if derivative == 2 => second.curvature,
            _ => 0.0,
        };
        let pairs = self.steps.iter().zip(&self.forward);
        let remainders = pairs.map(|(step, value)| {
            let claimed = (self.slope + 0.5 * curvature * step) * step;
            self.change(*value) - claimed
        });
        remainders.collect()
    }

    /// What J is known to, if it has few digits: half a unit of the last one, and the smallest
    /// change that a step shows if the finest one shows none. 0 where J does not change.
    fn resolution(&self) -> f64 {
        let changes = self.forward.iter().map(|value| self.change(*value).abs());
        let changes = changes.filter(|change| *change > 0.0);
        let Some(smallest) = changes.reduce(f64::min) else {
            return 0.0;
        };
        let is_still = self.forward.last() == Some(&self.here[0]);
        let still = if is_still { smallest } else { 0.0 };
        let values = self.forward.iter().chain(&self.here);
        still.max(0.5 * last_place(values.copied()))
    }

    /// The noise of J: see the head of the module.
    fn noise(&self) -> f64 {
        let largest = self
            .forward
            .iter()
            .fold(self.here[0].abs(), |a, b| a.max(b.abs()));
        let called_twice = (self.here[0] - self.here[1]).abs();
        let windows = self.steps.windows(3).zip(self.forward.windows(3));
        let shown = windows.rev().take(3).map(|(steps, values)| {
            extrapolate::noise_of(
                [0.0, steps[2], steps[1], steps[0]],
                [self.here[0], values[2], values[1], values[0]],
            )
        });
        let noise = called_twice.max(f64::EPSILON * largest);
        shown.fold(noise.max(self.resolution()), f64::max)
    }
}

/// The remainders down to the last one above a floor.
fn above(levels: &[Level], floor: impl Fn(f64) -> f64) -> Vec<Level> {
    let last = levels
        .iter()
        .rposition(|level| level.error > floor(level.step));
    levels[..last.map_or(0, |last| last + 1)].to_vec()
}

/// The rate of remainders against that of Taylor's theorem. A derivative of J that is zero makes
/// it higher.
fn order_of(derivative: u8, levels: &[Level]) -> RateVerdict {
    let claim = Claim {
        bound: Bound::AnyAbove,
        ..Claim::new(f64::from(derivative) + 1.0, DEFAULT_TOLERANCE)
    };
    claim.judge(levels, Floor::NONE)
}

/// What follows from the size, the order if it can be seen, and whether J bends.
fn found_by(size: Verdict, order: Option<Verdict>, bends: bool) -> Finding {
    match (size, order) {
        (Verdict::Fail, _) => Finding::Wrong,
        (_, Some(Verdict::Fail)) => Finding::OrderTooLow,
        (Verdict::Inconclusive, _) => Finding::Noisy,
        (Verdict::Pass, Some(Verdict::Pass)) => Finding::Right,
        (Verdict::Pass, Some(Verdict::Inconclusive)) => Finding::OrderUndecided,
        (Verdict::Pass, None) if bends => Finding::OrderUndecided,
        (Verdict::Pass, None) => Finding::NothingTested,
    }
}
