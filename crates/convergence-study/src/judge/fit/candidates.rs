//! The rate at h → 0 with an honest interval: several explanations of the same errors, side by side.
//!
//! # The rule
//!
//! Each *candidate* explains the levels k = 1..m by least squares in the logarithms:
//!
//! ```text
//!     straight:     log e_k = a + p log h_k                     m - 2 degrees of freedom
//!     polluted(r):  log e_k = a + p log h_k + b (h_k / h_1)^r   m - 3 degrees of freedom, needs m >= 4
//! ```
//!
//! the second for each r of [`POLLUTION_EXPONENTS`]: (a) of the [parent module](super) with log(1 + c h^r) ≈ c h^r.
//! With rss the sum of squared residuals, s² = rss / dof and `d` what is left of log h once the other columns are projected out,
//! a candidate says
//!
//! ```text
//!     p  ±  ( t_dof s / |d|  +  |p - q_m| ),        q_m: the finest pairwise rate.
//! ```
//!
//! * The first part is the usual Student-t interval of one coefficient; it answers for scatter, and for a wrong r,
//!   which leaves a residual too.
//! * The second is the correction that the extrapolation makes. It answers for the terms of (a) that were left out (c²h^2r,
//!   the next pollution): they are not seen in the residuals of smooth data, and they are smaller than what was corrected for
//!   whenever the levels are asymptotic. Without it the intervals of noise-free polluted data hold the order 70 to 88 times in 100.
//!
//! The interval is the hull over all candidates with rss <= [`PLAUSIBLE`] x the smallest rss: the data cannot tell these apart.
//! With 3 levels there is only the straight line with 1 degree of freedom. Its t = 12.7 gives a half-width of 3.7 |q_2 - q_1| (4.2 with the
//! second part) for step ratio 2, while pollution puts the order at q_2 + (q_2 - q_1) / (2^r - 1): it lies inside for r >= 0.4.
//!
//! How often the interval holds the order is not claimed but measured: [`calibration`](crate::judge::calibration).

use super::{Level, Quantiles, line::logarithms};

/// Exponents r of the polluted candidates.
///
/// Pollution of a scheme of integer orders has r = 1 (the next power), 2 (symmetric formulas), 3, 4; the values between serve the mixed
/// cases. Slower pollution than h^0.75 cannot be told from a change of the order itself with the levels that a study can pay for.
pub const POLLUTION_EXPONENTS: [f64; 8] = [0.75, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0];

/// A candidate is plausible when its residual deviation is at most twice the best one: 4 in squares.
///
/// Larger values widen the interval of 4 and 5 levels beyond use (the F-test's value would be 162 there); with 1 the best candidate
/// alone speaks, and first-order pollution is then covered 89 times in 100 only.
pub const PLAUSIBLE: f64 = 4.0;

/// Relative round-off of a logarithm of an error: no residual is known better, so no interval is narrower.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// The rate at h → 0 and the interval that holds it, by the rule of this module.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateInterval {
    /// Rate p of the candidate that leaves the smallest deviation.
    pub rate: f64,
    /// Its pollution exponent r; `None` for the straight line.
    pub pollution: Option<f64>,
    /// Hull over the plausible candidates; always holds `rate`.
    pub interval: [f64; 2],
}

/// One explanation of the data.
#[derive(Clone, Copy)]
struct Candidate {
    pollution: Option<f64>,
    rate: f64,
    rss: f64,
    half_width: f64,
}

/// Fits all the candidates over the levels given, which should be an asymptotic range, and takes the hull of the plausible ones.
///
/// * Returns `None` with fewer than 3 levels, or when a logarithm is not finite.
pub fn rate_interval(levels: &[Level], quantiles: &Quantiles) -> Option<RateInterval> {
    let data = Data::new(levels, quantiles)?;
    let mut candidates = vec![data.straight()];
    if levels.len() >= 4 {
        candidates.extend(POLLUTION_EXPONENTS.map(|exponent| data.polluted(exponent)));
    }
    let best = candidates.iter().copied().min_by(|a, b| a.rss.total_cmp(&b.rss))?;
    let plausible = candidates.iter().filter(|candidate| candidate.rss <= PLAUSIBLE * best.rss);
    let hull = plausible.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], c| {
        [low.min(c.rate - c.half_width), high.max(c.rate + c.half_width)]
    });
    let sound = best.rate.is_finite() && hull.iter().all(|end| end.is_finite());
    sound.then_some(RateInterval { rate: best.rate, pollution: best.pollution, interval: hull })
}

/// The logarithms, centred so that the constant a is projected out of everything.
struct Data<'a> {
    quantiles: &'a Quantiles,
    /// log(h_k / h_1), not centred.
    log_ratio: Vec<f64>,
    /// log h, centred.
    x: Vec<f64>,
    /// log e, centred.
    y: Vec<f64>,
    /// Square of the round-off in log e.
    round_off: f64,
    finest_rate: f64,
}

impl<'a> Data<'a> {
    fn new(levels: &[Level], quantiles: &'a Quantiles) -> Option<Self> {
        let (x, y) = logarithms(levels)?;
        let m = x.len();
        if m < 3 {
            return None;
        }
        let scale = y.iter().fold(1.0_f64, |scale, y| scale.max(y.abs()));
        Some(Self {
            quantiles,
            finest_rate: (y[m - 2] - y[m - 1]) / (x[m - 2] - x[m - 1]),
            round_off: (ROUND_OFF * scale).powi(2),
            log_ratio: x.iter().map(|value| value - x[0]).collect(),
            x: centred(x),
            y: centred(y),
        })
    }

    fn straight(&self) -> Candidate {
        self.candidate(&self.x, self.y.clone(), self.x.len() - 2, None)
    }

    fn polluted(&self, exponent: f64) -> Candidate {
        let z = centred(self.log_ratio.iter().map(|log_ratio| (exponent * log_ratio).exp()).collect());
        let direction = without(self.x.clone(), &z);
        self.candidate(&direction, without(self.y.clone(), &z), self.x.len() - 3, Some(exponent))
    }

    /// The coefficient of `direction`, which is log h with the other columns projected out (Frisch-Waugh), and its interval.
    ///
    /// * `rest`: log e with the same columns projected out.
    fn candidate(&self, direction: &[f64], rest: Vec<f64>, dof: usize, pollution: Option<f64>) -> Candidate {
        let square = dot(direction, direction);
        let rate = dot(direction, &rest) / square;
        let residual = without(rest, direction);
        let rss = dot(&residual, &residual) + dof as f64 * self.round_off;
        let student = self.quantiles.t(dof) * (rss / dof as f64 / square).sqrt();
        Candidate { pollution, rate, rss, half_width: student + (rate - self.finest_rate).abs() }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn centred(mut values: Vec<f64>) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter_mut().for_each(|value| *value -= mean);
    values
}

/// `values` less its projection on `direction`.
fn without(mut values: Vec<f64>, direction: &[f64]) -> Vec<f64> {
    let factor = dot(&values, direction) / dot(direction, direction);
    values.iter_mut().zip(direction).for_each(|(value, direction)| *value -= factor * direction);
    values
}
