//! What a sequence of errors says by itself, independent of any claim.

use std::ops::Range;

use super::cause::Cause;
use super::reason::Reason;
use super::scatter::Scattered;
use super::tendency::Tendency;
use super::trend::Rates;
use super::words::{Aside, SetAside};
use super::{FEWEST_LEVELS, Floor, lower_order, repeats, significant_digits};
use crate::fit::{
    Level, MOST_USED, RateInterval, SPREAD, asymptotic_range, extrapolated_rate, pairwise_rates,
    rate_interval,
};
use crate::interval::Interval;

/// Two steps that are rounded, in another unit once more, and divided have a ratio that is off by
/// five units of 2^-53.
const SPAN_ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// What is known of errors that were printed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Printed<'a> {
    /// Their digits leave the rate uncertain by this: its interval is wider by it at either end.
    pub doubt: f64,
    /// The number of significant digits of each error, coarsest first; empty: those of the shortest
    /// decimal.
    pub digits: &'a [usize],
}

/// A sequence of errors, read once and held against any number of claims: see
/// [`Judge::read`](super::Judge::read).
#[derive(Debug, Clone)]
pub struct Reading<'a> {
    sequence: &'a [Level],
    /// Number of levels.
    pub(super) levels: usize,
    /// All rates between neighbouring levels.
    pub(super) pairwise: Vec<f64>,
    /// The asymptotic range.
    range: Range<usize>,
    /// Levels of the fit: the asymptotic range or, if that is shorter, the three finest levels
    /// above the floor.
    pub(super) used: Range<usize>,
    /// The rate at h → 0 with its interval; `None` if the levels have none.
    pub fit: Option<RateInterval>,
    /// What makes rates impossible to form.
    unusable: Option<Reason>,
    /// The rates between levels above the floor.
    rates: Rates,
    /// What is known of round-off.
    floor: Floor,
    /// The number of printed digits of each error; empty if they are those of the numbers.
    digits: &'a [usize],
    /// Whether the numbers are the errors of levels, each from a run of its own.
    are_errors: bool,
    /// Whether the levels used scatter about one power.
    is_scattered: bool,
}

impl<'a> Reading<'a> {
    pub(crate) fn new(sequence: &'a [Level], floor: Floor) -> Self {
        let unusable = defect(sequence, floor.value());
        let range = match unusable {
            Some(_) => 0..0,
            None => asymptotic_range(sequence, floor.value()),
        };
        let end = range.end;
        let rates = Rates::of(&sequence[..end]);
        let scattered = Scattered::of(&sequence[..end], &rates);
        let range = scattered.map_or(range, |scattered| end - scattered.count..end);
        let start = if range.len() < FEWEST_LEVELS {
            end.saturating_sub(FEWEST_LEVELS)
        } else {
            range.start
        };
        let fit = match scattered {
            Some(scattered) => Some(scattered.rate),
            None => rate_interval(&sequence[start..end]),
        };
        let used = if fit.is_some() { start..end } else { 0..0 };
        Self {
            sequence,
            levels: sequence.len(),
            pairwise: pairwise_rates(sequence),
            rates,
            range,
            used,
            fit,
            unusable,
            floor,
            digits: &[],
            are_errors: true,
            is_scattered: scattered.is_some(),
        }
    }

    /// Whether rates can be formed of the levels.
    pub(super) fn is_usable(&self) -> bool {
        self.unusable.is_none()
    }

    /// The same with a rate of all levels, found by another rule.
    pub(super) fn with_fit(self, fit: RateInterval) -> Self {
        Self {
            used: 0..self.levels,
            fit: Some(fit),
            ..self
        }
    }

    /// The same of differences, two of which may be equal.
    pub(crate) fn of_differences(self) -> Self {
        Self {
            are_errors: false,
            ..self
        }
    }

    /// The same of errors that were printed.
    pub(crate) fn printed(mut self, printed: Printed<'a>) -> Self {
        self.widen(printed.doubt);
        Self {
            digits: printed.digits,
            ..self
        }
    }

    /// Extends the interval at either end.
    pub(crate) fn widen(&mut self, doubt: f64) {
        if let Some(RateInterval { interval, .. }) = &mut self.fit {
            interval.low -= doubt;
            interval.high += doubt;
        }
    }

    /// The number of significant digits of the error at a level.
    fn digits(&self, level: usize) -> usize {
        let printed = self.digits.get(level).copied();
        printed.unwrap_or_else(|| significant_digits(self.sequence[level].error))
    }

    /// The first level above the floor that repeats the error of the one before.
    pub(super) fn repeated(&self) -> Option<usize> {
        repeats::repeated(self.above_floor(), |level| self.digits(level))
    }

    /// Limit of the finest pairwise rates that the fit uses.
    pub(super) fn extrapolated(&self) -> Option<f64> {
        extrapolated_rate(&self.sequence[self.used.clone()])
    }

    /// The reason in a few words, with the level if it concerns one.
    pub(super) fn words(&self, reason: Reason) -> String {
        let level = self.repeated().filter(|_| reason == Reason::Repeats);
        level.map_or_else(|| reason.brief().to_owned(), repeats::words_of_level)
    }

    /// The constant C of error = C step^rate for the fitted rate, through the finest level that the
    /// fit uses; of levels that scatter, that of their line.
    ///
    /// The rate is that at h → 0, to which the finest level is the closest; the curve of a constant
    /// fitted to all levels that do not scatter would miss them all.
    pub(super) fn constant(&self) -> Option<f64> {
        let finest = self.sequence[self.used.clone()].last()?;
        // In logarithms: a power of a small step may underflow.
        let fit = self.fit?;
        let constant = (finest.error.ln() - fit.residual - fit.rate * finest.step.ln()).exp();
        Some(constant).filter(|constant| constant.is_finite())
    }

    /// The law that explains the levels above the floor, if rates can be formed.
    pub(super) fn cause(&self, order: f64) -> Option<Cause> {
        self.fit
            .and_then(|_| Cause::of(self.above_floor(), order, |_| 0.0))
    }

    /// What the errors above the floor tend to.
    pub(super) fn tendency(&self) -> Option<Tendency> {
        match self.unusable {
            None => Tendency::of(self.above_floor()),
            Some(Reason::ZeroError) => Tendency::of(self.sequence),
            Some(_) => None,
        }
    }

    /// The levels that the fit leaves out.
    pub(super) fn set_aside(&self) -> Vec<SetAside> {
        if self.unusable.is_some() {
            return vec![];
        }
        let above_floor = self.range.end;
        let coarse = if self.used.is_empty() {
            self.range.start
        } else {
            self.used.start
        };
        let finest = self.rates.values().last().copied().unwrap_or(f64::NAN);
        // The level next to the range was dropped for its rate, or because the range is as long as
        // it may be.
        let is_full = self.used.len() == MOST_USED;
        let because = match coarse.checked_sub(1) {
            Some(next) if is_full && !((self.pairwise[next] - finest).abs() > SPREAD) => {
                Aside::BeyondFive
            }
            _ => Aside::PreAsymptotic,
        };
        let mut set_aside = vec![];
        for level in 0..coarse {
            set_aside.push(SetAside { level, because });
        }
        for level in above_floor..self.levels {
            let because = Aside::AtFloor;
            set_aside.push(SetAside { level, because });
        }
        set_aside
    }

    /// What would fail any claim.
    pub(super) fn defect(&self) -> Option<Reason> {
        self.unusable.filter(|reason| reason.is_final())
    }

    /// The reason for the verdict on a claim: the steps of the rule, in their order.
    pub(super) fn reason(&self, order: f64, tolerance: f64) -> Reason {
        if let Some(reason @ (Reason::NonFiniteError | Reason::NegativeError)) = self.unusable {
            return reason;
        }
        let is_sensible = order > 0.0 && order.is_finite();
        if !is_sensible {
            return Reason::ClaimUnusable;
        }
        if tolerance >= order {
            return Reason::ToleranceTooWide;
        }
        if let Some(reason) = self.unusable {
            return reason;
        }
        if self.range.end < FEWEST_LEVELS {
            return Reason::RoundOffFloor;
        }
        let decided = self.decided(order, tolerance);
        if !self.are_errors {
            return decided;
        }
        repeats::doubted(
            decided,
            self.above_floor(),
            &self.rates,
            |level| self.digits(level),
            self.floor,
        )
    }

    /// The reason that the rates between levels above the floor give.
    fn decided(&self, order: f64, tolerance: f64) -> Reason {
        if self.span() < super::LEAST_SPAN * (1.0 - SPAN_ROUND_OFF) {
            return Reason::LevelsTooClose;
        }
        if self.rates.jumps() {
            return Reason::Jump;
        }
        if self.rates.falls_away(order) {
            return Reason::FallsAway;
        }
        if self.range.len() < FEWEST_LEVELS {
            return Reason::NotAsymptotic;
        }
        match self.fit {
            Some(fit) => self.compare(fit.interval, order, tolerance),
            None => Reason::TooFewLevels,
        }
    }

    /// Steps 6 to 8: the trend of the rates, and the interval against the band.
    fn compare(&self, interval: Interval, order: f64, tolerance: f64) -> Reason {
        let rates = &self.rates;
        if !self.is_scattered && rates.departs(tolerance) && !rates.approaches(order, tolerance) {
            return Reason::Departs;
        }
        let grows = rates.values().last().is_none_or(|finest| *finest <= 0.0);
        match compare(interval, order, tolerance) {
            Reason::TooLow if grows => Reason::ErrorGrows,
            Reason::TooLow => Reason::TooLow,
            // The finest error is not smaller, which scatter may explain: there is no order that
            // could agree.
            _ if grows => Reason::IntervalTooWide,
            Reason::Agrees if rates.emerges(order, tolerance) => Reason::NotAsymptotic,
            Reason::Agrees if self.hides_a_lower_order(order, tolerance) => {
                Reason::LowerOrderLikely
            }
            reason => reason,
        }
    }

    fn hides_a_lower_order(&self, order: f64, tolerance: f64) -> bool {
        if self.is_scattered {
            let used = &self.sequence[self.used.clone()];
            lower_order::hides_behind_scatter(used, order, tolerance)
        } else {
            lower_order::hides(self.above_floor(), order, tolerance)
        }
    }

    /// Whether levels that scatter hide an order below their own.
    ///
    /// * `least`: the order claimed, which their own is or exceeds.
    pub(crate) fn hides_below_own_order(&self, least: f64, tolerance: f64) -> bool {
        let used = &self.sequence[self.used.clone()];
        self.is_scattered && lower_order::hides_below(used, least, tolerance)
    }

    /// Ratio of the coarsest step above the floor to the finest.
    fn span(&self) -> f64 {
        let levels = self.above_floor();
        levels
            .first()
            .zip(levels.last())
            .map_or(f64::INFINITY, |(coarse, fine)| coarse.step / fine.step)
    }

    /// The levels above the floor.
    fn above_floor(&self) -> &'a [Level] {
        &self.sequence[..self.range.end]
    }
}

/// Steps 1 and 2 of the rule, except for what depends on the claim.
///
/// * `floor`: fine levels that are zero are dropped with those up to it, if it is known.
fn defect(levels: &[Level], floor: f64) -> Option<Reason> {
    let end = levels.iter().rposition(|level| level.error > floor);
    let above_floor = if floor > 0.0 {
        &levels[..end.map_or(0, |finest| finest + 1)]
    } else {
        levels
    };
    let decreasing = levels
        .iter()
        .all(|level| level.step > 0.0 && level.step.is_finite())
        && levels.windows(2).all(|pair| pair[1].step < pair[0].step);
    if levels.iter().any(|level| !level.error.is_finite()) {
        Some(Reason::NonFiniteError)
    } else if levels.iter().any(|level| level.error < 0.0) {
        Some(Reason::NegativeError)
    } else if levels.len() < FEWEST_LEVELS {
        Some(Reason::TooFewLevels)
    } else if above_floor.iter().any(|level| level.error == 0.0) {
        Some(Reason::ZeroError)
    } else if !decreasing {
        Some(Reason::StepsNotDecreasing)
    } else {
        None
    }
}

/// The interval against the band.
pub(super) fn compare(Interval { low, high }: Interval, order: f64, tolerance: f64) -> Reason {
    let least = order - tolerance;
    let most = order + tolerance;
    if least <= low && high <= most {
        Reason::Agrees
    } else if high < least {
        Reason::TooLow
    } else if low > most {
        Reason::TooHigh
    } else if high - low > 2.0 * tolerance {
        Reason::IntervalTooWide
    } else {
        Reason::AtTheEdge
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::with_errors;

    #[test]
    fn no_level_of_a_short_table_is_coarser_than_five_others() {
        for rates in [[2.0, 3.0, 2.1], [2.0, 2.0, 4.0], [0.5, 2.0, 2.0]] {
            let mut errors = vec![1.0];
            for rate in rates {
                errors.push(errors[errors.len() - 1] / 2_f64.powf(rate));
            }
            let levels = with_errors(1.0, &errors);
            for aside in Reading::new(&levels, Floor::NONE).set_aside() {
                assert_eq!(aside.because, Aside::PreAsymptotic, "{rates:?}");
            }
        }
    }

    #[test]
    fn an_interval_is_compared_with_its_ends_and_those_of_the_band() {
        for (interval, reason) in [
            ([0.75, 1.25], Reason::Agrees),
            ([0.875, 1.0], Reason::Agrees),
            ([0.5, 0.625], Reason::TooLow),
            ([1.375, 1.5], Reason::TooHigh),
            // They share a point with the band.
            ([0.5, 0.75], Reason::AtTheEdge),
            ([1.25, 1.5], Reason::AtTheEdge),
            ([0.5, 1.0], Reason::AtTheEdge),
            ([1.0, 1.5], Reason::AtTheEdge),
            ([0.5, 1.0625], Reason::IntervalTooWide),
            ([0.5, 1.5], Reason::IntervalTooWide),
        ] {
            let [low, high] = interval;
            let found = compare(Interval { low, high }, 1.0, 0.25);
            assert_eq!(found, reason, "{interval:?}");
        }
    }
}
