//! Observed rates: from (step, error) levels to slopes, intervals and limits.
//!
//! The error of a convergent scheme is, for a step h small enough,
//!
//! ```text
//!     e(h) = C h^p (1 + c h^r + ...),        log e = log C + p log h + log(1 + c h^r + ...)      (a)
//! ```
//!
//! and the order p is what theory claims. The data are deterministic: the *pollution* c h^r bends
//! log e away from a straight line, and apparent noise is small. Each reading here answers one part
//! of the question:
//!
//! * [`pairwise_rates`]: the raw rates, level by level, nothing left out;
//! * [`fit_line`]: least squares with a Student-t interval, right when the scatter outweighs the
//!   bend;
//! * [`rate_interval`]: the line, or one with a bend where that is clearly better: right in both
//!   cases;
//! * [`extrapolated_rate`]: the limit of the pairwise rates (Aitken's process, for any step
//!   ratios);
//! * [`asymptotic_range`]: which levels any of these may use;

mod interval;
mod range;

use std::sync::LazyLock;

use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::interval::Interval;

pub use interval::{
    CLEARLY_BETTER, FACTOR, FACTOR_OF_THREE, POLLUTION_EXPONENTS, RateInterval, SLOWEST_POLLUTION,
    rate_interval,
};
pub(crate) use interval::{RegressionLine, RegressionLines};
pub(crate) use range::COMPARISON;
pub use range::{FLOOR_MARGIN, MOST_USED, SPREAD, asymptotic_range};

/// One level of a refinement study.
///
/// ```
/// let level = convergence_judge::Level { step: 0.1, error: 2.5e-3 };
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// Step size, h or dt; positive, and smaller from level to level.
    pub step: f64,
    /// Norm of the error at that step. Kept as measured: the judge deals with NaN, infinite, zero
    /// and negative values.
    pub error: f64,
}

/// Degrees of freedom for which quantiles are computed.
const MOST_DEGREES: usize = 30;

/// Two-sided 95 % quantiles of Student's t for 1, 2, ... degrees of freedom. They are computed
/// once, because the rule asks for one in every fit.
static STUDENT: LazyLock<[f64; MOST_DEGREES]> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let law = StudentsT::new(0.0, 1.0, (k + 1) as f64);
        // 97.5 % lie below the upper end of an interval that holds 95 %.
        law.map_or(f64::INFINITY, |law| law.inverse_cdf(0.975))
    })
});

/// `t` such that a Student variable with `dof` degrees of freedom lies in [-t, t] with
/// probability 0.95; infinite if `dof` is 0.
///
/// Above 30 degrees of freedom it returns the value for 30, which is larger and therefore safe.
pub fn student_t(dof: usize) -> f64 {
    dof.checked_sub(1)
        .map_or(f64::INFINITY, |above| STUDENT[above.min(MOST_DEGREES - 1)])
}

/// Rate between each level and the next: `(log e_k - log e_{k+1}) / (log h_k - log h_{k+1})`.
///
/// As measured: a negative or NaN error gives a NaN rate, and zero or infinity an infinite one,
/// each in its place. The logarithms are taken first, because the quotient of two negative errors
/// would look like a rate.
///
/// * Returns one rate fewer than there are levels.
///
/// ```
/// use convergence_judge::{Level, pairwise_rates};
///
/// let levels = [(0.4, 0.16), (0.2, 0.04), (0.1, 0.01)];
/// let rates = pairwise_rates(&levels.map(|(step, error)| Level { step, error }));
/// assert!(rates.len() == 2 && rates.iter().all(|rate| (rate - 2.0).abs() < 1e-12));
/// ```
pub fn pairwise_rates(levels: &[Level]) -> Vec<f64> {
    levels
        .windows(2)
        .map(|pair| {
            log_quotient(pair[0].error, pair[1].error) / log_quotient(pair[0].step, pair[1].step)
        })
        .collect()
}

/// `log(a / b)`, which a common unit of a and b does not enter but by rounding; of numbers whose
/// quotient is none, or that are not positive, `log a - log b`.
pub(crate) fn log_quotient(a: f64, b: f64) -> f64 {
    let quotient = a / b;
    if a > 0.0 && b > 0.0 && quotient.is_normal() {
        quotient.ln()
    } else {
        a.ln() - b.ln()
    }
}

/// What rounding moves each of the [`pairwise_rates`] by at most.
///
/// A step or an error is a decimal number, rounded to a double once, and once more in another unit:
/// it is off by 2 u of itself, u = 2^-53. The quotient of two is off by 5 u, and its logarithm by
/// a unit of its last place more, 2 u |L|. So L = log(e_k / e_(k+1)) is off by 5 u + 2 u |L|, ρ =
/// log(h_k / h_(k+1)) by 5 u + 2 u ρ, and the rate q = L / ρ, rounded once, by
///
/// ```text
///     5 u ((1 + |q|) / ρ + |q|)  <  2^-50 (|q| + (1 + |q|) / ρ),
/// ```
///
/// whatever the units of h and e. 8 in place of 5 is for steps that are computed, as 1/n or a root.
pub(crate) fn round_off_of_rates(levels: &[Level]) -> Vec<f64> {
    const UNITS: f64 = 4.0 * f64::EPSILON;
    let rates = pairwise_rates(levels).into_iter();
    let round_off = levels.windows(2).zip(rates).map(|(pair, rate)| {
        let ratio = log_quotient(pair[0].step, pair[1].step);
        UNITS * (rate.abs() + (1.0 + rate.abs()) / ratio)
    });
    round_off.collect()
}

/// Straight line log e = intercept + slope log h by least squares.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LineFit {
    /// The fitted rate.
    pub slope: f64,
    /// log C, at h = 1.
    pub intercept: f64,
    /// Residual standard deviation of log e, the root of (sum of squares) / dof; NaN when dof is 0.
    pub deviation: f64,
    /// Degrees of freedom, levels - 2.
    pub dof: usize,
    /// `slope ± t deviation / √Σ(log h - mean)²`; the whole real line when dof is 0.
    pub interval: Interval,
}

/// Least-squares fit of log e on log h over all the levels given, with the Student-t interval of
/// the slope.
///
/// The interval assumes scatter about a straight line. Convergence data bend instead: the slope is
/// then the mean of the pairwise rates, not their limit, and [`rate_interval`] is the one to trust.
///
/// * Returns `None` with fewer than two levels, or when a logarithm is not finite or the steps do
///   not differ.
///
/// ```
/// use convergence_judge::{Level, fit_line, rate_interval};
///
/// // Of first order, with a pollution that fades like h.
/// let levels = [0.4, 0.2, 0.1, 0.05, 0.025]
///     .map(|step| Level { step, error: step * (1.0 + 0.5 * step) });
/// let line = fit_line(&levels).expect("five levels");
/// let rate = rate_interval(&levels).expect("five levels");
/// // The slope is a mean of the rates; the interval at h -> 0 holds the order.
/// assert!(line.interval.low > 1.0);
/// assert!(rate.interval.holds(1.0));
/// ```
pub fn fit_line(levels: &[Level]) -> Option<LineFit> {
    let Logarithms { x, y } = Logarithms::new(levels)?;
    let n = x.len() as f64;
    let x_mean = x.iter().sum::<f64>() / n;
    let y_mean = y.iter().sum::<f64>() / n;
    let sxx: f64 = x.iter().map(|x| (x - x_mean).powi(2)).sum();
    let sxy: f64 = x
        .iter()
        .zip(&y)
        .map(|(x, y)| (x - x_mean) * (y - y_mean))
        .sum();
    let slope = sxy / sxx;
    let rss: f64 = x
        .iter()
        .zip(&y)
        .map(|(x, y)| (y - y_mean - slope * (x - x_mean)).powi(2))
        .sum();
    let dof = x.len() - 2;
    let deviation = (rss / dof as f64).sqrt();
    let half = if dof == 0 {
        f64::INFINITY
    } else {
        student_t(dof) * deviation / sxx.sqrt()
    };
    let interval = Interval::around(slope, half);
    slope.is_finite().then_some(LineFit {
        slope,
        intercept: y_mean - slope * x_mean,
        deviation,
        dof,
        interval,
    })
}

/// The logarithms of at least two levels, all finite.
struct Logarithms {
    /// log h.
    x: Vec<f64>,
    /// log e.
    y: Vec<f64>,
}

impl Logarithms {
    /// `None` when a value is not finite or there are fewer than two levels.
    fn new(levels: &[Level]) -> Option<Self> {
        let x: Vec<f64> = levels.iter().map(|level| level.step.ln()).collect();
        let y: Vec<f64> = levels.iter().map(|level| level.error.ln()).collect();
        let usable = x.len() >= 2 && x.iter().chain(&y).all(|value| value.is_finite());
        usable.then_some(Self { x, y })
    }

    /// The same of steps and errors in units of the finest ones.
    fn of_quotients(levels: &[Level]) -> Option<Self> {
        let finest = levels.last()?;
        Self::new(levels)?;
        let x = levels.iter();
        let x = x.map(|level| log_quotient(level.step, finest.step));
        let y = levels.iter();
        let y = y.map(|level| log_quotient(level.error, finest.error));
        Some(Self {
            x: x.collect(),
            y: y.collect(),
        })
    }
}

/// Range of pollution exponents that [`extrapolated_rate`] searches.
const EXPONENT_SEARCH: [f64; 2] = [0.25, 8.0];

/// Rates that differ by less than this are equal, in units of the round-off of a logarithm.
const SAME_RATE: f64 = 1e-9;

/// Limit of the pairwise rates as h → 0, from the last three of them.
///
/// A pollution c h^r in (a) of the [module](self) shifts the rate between h_k and h_{k+1} by c
/// w_k(r), to first order in c, where
///
/// ```text
///     w_k(r) = (h_k^r - h_{k+1}^r) / log(h_k / h_{k+1}).
/// ```
///
/// So (q_3 - q_2) / (q_2 - q_1) = (w_3 - w_2) / (w_2 - w_1) =: κ(r), which falls from level to
/// level as r grows; it is solved for r, and the limit is p = q_3 - (q_3 - q_2) w_3 / (w_3 - w_2).
/// For a constant step ratio κ = ratio^-r, and this is Aitken's p = q_3 - (q_3 - q_2)² / ((q_3 -
/// q_2) - (q_2 - q_1)).
///
/// * Returns the last rate when the three agree to round-off; `None` with fewer than three rates,
///   when one is not finite, or when they do not converge (scatter, or departure): no r in [1/4, 8]
///   explains them.
pub fn extrapolated_rate(levels: &[Level]) -> Option<f64> {
    let tail = levels.get(levels.len().checked_sub(4)?..)?;
    let rates = pairwise_rates(tail);
    let before = rates[1] - rates[0];
    let last = rates[2] - rates[1];
    if !(before.is_finite() && last.is_finite()) {
        return None;
    }
    if before.abs().max(last.abs()) <= SAME_RATE {
        return Some(rates[2]);
    }
    let exponent = solve_exponent(tail, last / before)?;
    let w = shifts(tail, exponent);
    Some(rates[2] - last * w[2] / (w[2] - w[1]))
}

/// w_1, w_2, w_3 of [`extrapolated_rate`], with steps in units of the coarsest of the four.
fn shifts(tail: &[Level], exponent: f64) -> [f64; 3] {
    let power = |k: usize| (tail[k].step / tail[0].step).powf(exponent);
    std::array::from_fn(|k| (power(k) - power(k + 1)) / (tail[k].step / tail[k + 1].step).ln())
}

/// Solves κ(r) = `contraction` by bisection; `None` when the search interval holds no solution.
fn solve_exponent(tail: &[Level], contraction: f64) -> Option<f64> {
    let excess = |exponent: f64| {
        let w = shifts(tail, exponent);
        (w[2] - w[1]) / (w[1] - w[0]) - contraction
    };
    let [mut low, mut high] = EXPONENT_SEARCH;
    if !(excess(low) >= 0.0 && excess(high) <= 0.0) {
        return None;
    }
    // 50 halvings of an interval of length 8 reach the spacing of doubles.
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}
