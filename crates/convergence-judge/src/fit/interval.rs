//! The rate at h → 0 with an interval: a straight line, or a line with one pollution term where
//! that is clearly better.
//!
//! [The rule](crate::verdict), step 5, states what is computed here, and what each constant
//! buys.

use super::{Level, Logarithms, student_t};
use crate::interval::Interval;

/// Exponents r of the polluted lines. 1/3 and 2/3 are singularities and boundary layers; they keep
/// intervals from being too narrow.
pub const POLLUTION_EXPONENTS: [f64; 5] = [1.0 / 3.0, 2.0 / 3.0, 1.0, 2.0, 3.0];

/// A polluted line replaces the straight one if this many times its sum of squares is less.
pub const CLEARLY_BETTER: f64 = 20.0;

/// A polluted line is not excluded by another one if its sum of squares is less than this many
/// times that of the other: the interval then reaches to its rate.
const NOT_EXCLUDED: f64 = 4.0;

/// Factor on the half-width, for what no model has.
pub const FACTOR: f64 = 1.1;

/// Half-width for three levels, in corrections by pollution h^[`SLOWEST_POLLUTION`].
pub const FACTOR_OF_THREE: f64 = 1.5;

/// Exponent of the pollution that three levels may hide: so slow that three levels can never rule
/// it out.
pub const SLOWEST_POLLUTION: f64 = 1.0 / 3.0;

/// Relative round-off of the logarithm of an error: no residual is known more accurately, so no
/// interval is narrower.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// The rate at h → 0 and its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct RateInterval {
    /// The rate of the line chosen; for three levels the finest pairwise rate.
    pub rate: f64,
    /// Its pollution exponent r; `None` for a straight line.
    pub pollution: Option<f64>,
    /// `rate` ± its half-width.
    pub interval: Interval,
    /// How far log e of the finest level may lie from its line: Student's quantile
    /// times the standard deviation of the residuals.
    pub scatter: f64,
    /// log e of the finest level less that of the curve of the constant; 0 where the curve passes
    /// through it.
    pub residual: f64,
}

impl RateInterval {
    /// Of a straight line through samples.
    pub(crate) fn of_samples(rate: f64, interval: Interval) -> Self {
        Self {
            rate,
            pollution: None,
            interval,
            scatter: 0.0,
            residual: 0.0,
        }
    }
}

/// The rate of the levels given, which should be those of
/// [`asymptotic_range`](super::asymptotic_range).
///
/// * Returns `None` with fewer than 3 levels, when a logarithm is not finite, or when steps do not
///   differ.
pub fn rate_interval(levels: &[Level]) -> Option<RateInterval> {
    let lines = RegressionLines::of(levels)?;
    let Logarithms { x, y } = &lines.logarithms;
    let m = x.len();
    let finest_ratio = x[m - 2] - x[m - 1];
    let finest_rate = (y[m - 2] - y[m - 1]) / finest_ratio;
    if m == 3 {
        // Pollution h^r makes the two rates p + c h^r at the middles of their pairs, in log h.
        let apart = (0.5 * SLOWEST_POLLUTION * (x[0] - x[2])).exp_m1();
        let before = (y[0] - y[1]) / (x[0] - x[1]);
        let change = (finest_rate - before).abs() + lines.round_off / finest_ratio;
        let line = RegressionLine {
            rate: finest_rate,
            ..lines.straight
        };
        return line.with_half_width(FACTOR_OF_THREE * change / apart);
    }
    let polluted = lines.polluted();
    let line = lines.straight.or_clearly_better(&polluted);
    let deviation_of_pair = (2.0 * line.variance).sqrt() / finest_ratio;
    let correction = ((line.rate - finest_rate).abs() - deviation_of_pair).max(0.0);
    let half = FACTOR * (line.half_width() + correction);
    line.with_half_width(half.max(line.farthest_rate(&polluted)))
}

/// The models of the logarithms of three levels or more.
pub(crate) struct RegressionLines {
    logarithms: Logarithms,
    /// Without their means.
    centred: [Vec<f64>; 2],
    round_off: f64,
    /// The line without another column.
    pub(crate) straight: RegressionLine,
}

impl RegressionLines {
    pub(crate) fn of(levels: &[Level]) -> Option<Self> {
        let logarithms = Logarithms::of_quotients(levels)?;
        let Logarithms { x, y } = &logarithms;
        let m = x.len();
        if m < 3 || x[m - 2] == x[m - 1] {
            return None;
        }
        let round_off = ROUND_OFF * y.iter().fold(1.0_f64, |scale, y| scale.max(y.abs()));
        let centred = [x, y].map(|values| centred(values));
        let [log_h, log_e] = &centred;
        let straight = RegressionLine::fit(log_h, log_e, round_off, None);
        Some(Self {
            logarithms,
            centred,
            round_off,
            straight,
        })
    }

    /// log e of the finest level less that of the straight line.
    pub(crate) fn residual_of_finest(&self) -> f64 {
        let [log_h, log_e] = &self.centred;
        let finest = log_h.len() - 1;
        log_e[finest] - self.straight.rate * log_h[finest]
    }

    /// The lines with a column h^r of pollution.
    pub(crate) fn polluted(&self) -> [RegressionLine; 5] {
        POLLUTION_EXPONENTS.map(|r| self.with_power(r))
    }

    /// The line with a column h^r.
    pub(crate) fn with_power(&self, r: f64) -> RegressionLine {
        let x = &self.logarithms.x;
        let powers: Vec<f64> = x.iter().map(|x_k| (r * (x_k - x[0])).exp()).collect();
        let column = centred(&powers);
        let [log_h, log_e] = &self.centred;
        RegressionLine::fit(
            &project_out(&column, log_h),
            &project_out(&column, log_e),
            self.round_off,
            Some(r),
        )
    }
}

/// One model of the logarithms: `y = a + q x`, or `y = a + q x + c (h / h_1)^r`.
#[derive(Clone, Copy)]
pub(crate) struct RegressionLine {
    pollution: Option<f64>,
    /// q.
    pub(crate) rate: f64,
    /// Number of levels without that of parameters.
    dof: usize,
    /// Sum of squared residuals over `dof`, and the round-off.
    pub(crate) variance: f64,
    /// Square of what is left of x without the other columns: the variance of q is
    /// `variance / square`.
    square: f64,
}

impl RegressionLine {
    /// Least squares.
    ///
    /// * `x`, `y`: what the projection on the other columns leaves of them (Frisch-Waugh).
    fn fit(x: &[f64], y: &[f64], round_off: f64, pollution: Option<f64>) -> Self {
        let dof = x.len().saturating_sub(2 + usize::from(pollution.is_some()));
        let square = dot(x, x);
        let rate = dot(x, y) / square;
        let rest = project_out(x, y);
        let variance = dot(&rest, &rest) / dof as f64 + round_off.powi(2);
        Self {
            pollution,
            rate,
            dof,
            variance,
            square,
        }
    }

    /// The best of the others if it is [`CLEARLY_BETTER`] than this one.
    fn or_clearly_better(self, others: &[Self]) -> Self {
        let best = others
            .iter()
            .copied()
            .min_by(|a, b| a.sum_of_squares().total_cmp(&b.sum_of_squares()));
        best.filter(|best| CLEARLY_BETTER * best.sum_of_squares() < self.sum_of_squares())
            .unwrap_or(self)
    }

    /// The largest distance from its rate to that of another polluted line which it does not
    /// exclude; 0 for a straight line.
    fn farthest_rate(&self, others: &[Self]) -> f64 {
        if self.pollution.is_none() {
            return 0.0;
        }
        let limit = NOT_EXCLUDED * self.sum_of_squares();
        others
            .iter()
            .filter(|other| other.sum_of_squares() < limit)
            .map(|other| (other.rate - self.rate).abs())
            .fold(0.0, f64::max)
    }

    /// Half the width of Student's interval of the rate.
    pub(crate) fn half_width(&self) -> f64 {
        student_t(self.dof) * (self.variance / self.square).sqrt()
    }

    /// Its rate with an interval; `None` if one of them is not finite.
    pub(crate) fn with_half_width(&self, half: f64) -> Option<RateInterval> {
        let is_regular = self.rate.is_finite() && half.is_finite();
        is_regular.then(|| RateInterval {
            rate: self.rate,
            pollution: self.pollution,
            interval: Interval::around(self.rate, half),
            scatter: student_t(self.dof) * self.variance.sqrt(),
            residual: 0.0,
        })
    }

    /// Of the residuals.
    pub(crate) fn sum_of_squares(&self) -> f64 {
        self.variance * self.dof as f64
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn centred(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| value - mean).collect()
}

/// The values without their projection on `direction`.
fn project_out(direction: &[f64], values: &[f64]) -> Vec<f64> {
    let factor = dot(values, direction) / dot(direction, direction);
    values
        .iter()
        .zip(direction)
        .map(|(value, along)| value - factor * along)
        .collect()
}
