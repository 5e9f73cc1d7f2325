//! Errors that scatter about one power of the step: each level tells as much as any other, and all
//! of them count.
//!
//! [The rule](crate::verdict), step 5, states what is computed here, and what each constant
//! buys.

use super::trend::Rates;
use crate::fit::{FACTOR, Level, RateInterval, RegressionLine, RegressionLines};

/// Fewest levels on which scatter can be distinguished from a trend.
const FEWEST: usize = 6;
/// Most: the time that is taken grows with the square of the number.
const MOST: usize = 30;
/// Least share of the pairs of consecutive changes of the rate that have opposite signs. Of
/// independent numbers most have; of pollution, plateaus and lower orders none.
const TURNS: f64 = 0.4;
/// Largest standard deviation of log e about the line.
const LARGEST: f64 = 0.125;
/// Largest quotient of the sums of squares that lines through either half of the levels leave:
/// scatter of one size leaves as much to both.
const HALVES: f64 = 30.0;
/// A power h^r that lowers the sum of squares by more than this many times what it leaves for each
/// degree of freedom, five standard errors, is no chance.
const BEND: f64 = 25.0;

/// Levels that scatter about a power, and their rate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scattered {
    /// The number of finest levels.
    pub count: usize,
    /// Of the straight line through all of them.
    pub rate: RateInterval,
}

impl Scattered {
    /// The most finest levels that scatter about one power.
    ///
    /// * `levels`: above the floor, coarsest first.
    /// * `rates`: between them.
    pub(super) fn of(levels: &[Level], rates: &Rates) -> Option<Self> {
        let counts = (FEWEST..=levels.len().min(MOST)).rev();
        let mut turning = counts.filter(|&count| {
            let pairs = (count - 3) as f64;
            rates.turns_of_finest(count) as f64 >= TURNS * pairs
        });
        turning.find_map(|count| {
            let rate = rate_of(&levels[levels.len() - count..])?;
            Some(Self { count, rate })
        })
    }
}

/// The rate of a straight line; `None` if the levels do more than scatter about it.
///
/// The half-width of its interval reaches to the rate of every line with a power h^r: pollution
/// that scatter hides moves the rate by no more.
fn rate_of(levels: &[Level]) -> Option<RateInterval> {
    let lines = RegressionLines::of(levels)?;
    let straight = lines.straight;
    if straight.variance.sqrt() > LARGEST || !is_of_one_size(levels)? {
        return None;
    }
    let polluted = lines.polluted();
    let bends = |line: &RegressionLine| {
        straight.sum_of_squares() - line.sum_of_squares() > BEND * line.variance
    };
    if polluted.iter().any(bends) {
        return None;
    }
    let half = polluted
        .iter()
        .map(|line| (line.rate - straight.rate).abs())
        .fold(FACTOR * straight.half_width(), f64::max);
    Some(RateInterval {
        residual: lines.residual_of_finest(),
        ..straight.with_half_width(half)?
    })
}

/// Whether the coarser and the finer half of the levels scatter alike.
fn is_of_one_size(levels: &[Level]) -> Option<bool> {
    let (coarse, fine) = levels.split_at(levels.len() / 2);
    let coarse = RegressionLines::of(coarse)?.straight.sum_of_squares();
    let fine = RegressionLines::of(fine)?.straight.sum_of_squares();
    Some(coarse.max(fine) <= HALVES * coarse.min(fine))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{SCATTER, scattered, with_errors};
    use crate::verdict::{Judge, Reason};

    fn count_of(levels: &[Level]) -> Option<usize> {
        Scattered::of(levels, &Rates::of(levels)).map(|scattered| scattered.count)
    }

    /// The numbers of another program.
    #[test]
    fn the_interval_is_that_of_all_levels_that_scatter() {
        let errors = [
            1.02, 0.26, 0.0635, 0.0146, 0.004_09, 0.000_999, 0.000_238, 6.28e-5,
        ];
        let levels = with_errors(1.0, &errors);
        let judged = Judge::default().judge(&levels, 2.0);
        let interval = judged.interval.expect("a rate");
        assert_eq!(judged.code, Reason::Agrees);
        assert_eq!(judged.used, 0..8);
        assert!((interval.low - 1.976_514_73).abs() < 1e-7, "{interval:?}");
        assert!((interval.high - 2.027_889_25).abs() < 1e-7, "{interval:?}");
        for wrong in [1.5, 2.5] {
            assert!(!Judge::default().judge(&levels, wrong).verdict.is_pass());
        }
    }

    #[test]
    fn levels_that_do_more_than_scatter_are_told() {
        let scatter = |size: f64| scattered(8, |h, s| h * h * (size * s).exp());
        assert_eq!(count_of(&scatter(0.05)), Some(8));
        assert_eq!(count_of(&scatter(0.05)[3..]), None, "five levels");
        assert_eq!(count_of(&scatter(0.2)), None, "large scatter");
        let trend = scattered(8, |h, _| h * h * (1.0 + 0.3 * h));
        assert_eq!(count_of(&trend), None, "no turn");
        let bend = scattered(8, |h, s| h * h * (1.0 + 0.5 * h) * (0.01 * s).exp());
        assert_eq!(count_of(&bend), Some(6), "the coarse levels bend");
        let bend = scattered(8, |h, s| h * h * (1.0 + 3.0 * h) * (0.001 * s).exp());
        assert_eq!(count_of(&bend), None, "a bend far above the scatter");
        let grows = scattered(8, |h, s| h * h * (0.002 / h * s).exp());
        assert_eq!(count_of(&grows), None, "scatter of two sizes");
    }

    #[test]
    fn of_many_levels_the_finest_thirty_count() {
        let level = |k: usize| Level {
            step: 0.9_f64.powi(k as i32),
            error: (0.02 * SCATTER[k % 8]).exp() * 0.9_f64.powi(2 * k as i32),
        };
        let many: Vec<Level> = (0..1000).map(level).collect();
        assert_eq!(count_of(&many), Some(MOST));
    }

    #[test]
    fn a_coarse_level_that_is_no_power_is_left_out() {
        let mut wrong = scattered(8, |h, s| h * h * (0.02 * s).exp());
        wrong[0].error *= 2.0;
        assert_eq!(count_of(&wrong), Some(7));
    }
}
