//! The rate at h → 0 with an honest interval: several explanations of the same errors, weighed against each other.
//!
//! [The rule](crate::judge::verdict), section "interval", states what is computed here and the reason for every constant.

use super::{Level, logarithms, student_t};

/// Exponents r of the polluted candidates.
///
/// Pollution of a scheme of integer orders has r = 1 (the next power), 2 (symmetric formulas), 3, 4; 3/2 and 3/4 serve the mixed cases. 1/2 and 1/3,
/// singularities and boundary layers, guard against overconfidence: without them wrong claims pass ten times as often (0.6 instead of 0.06 %).
pub const POLLUTION_EXPONENTS: [f64; 8] = [1.0 / 3.0, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0];

/// Exponents s of the scatter: residuals of log e are expected to be proportional to h^s.
///
/// s = 0 is noise of the same relative size on all levels. s = 1 trusts fine levels more than coarse ones, which is
/// right if terms that no candidate has fade: without it intervals of h^p (1 + a h^r), r from 1 to 4, hold the order 97.9
/// instead of 99.7 times in 100. Adding s = 1/2 and 3/2 gains nothing.
pub const SCATTER_EXPONENTS: [f64; 2] = [0.0, 1.0];

/// The weight of a candidate with k parameters is `rss^(-m/2) exp(-PENALTY k)`: likelihood against freedom.
///
/// Each further unit lets 1 in 100 more of the sound tables pass and costs 1 in 100 of coverage where errors scatter.
pub const PENALTY: f64 = 6.0;

/// Candidates with pollution slower than h^[`SLOW`] weigh e^-3 less: such pollution is rare, and 5 levels can hardly tell it from rates that wander.
pub const SLOW_PENALTY: f64 = 3.0;

/// Exponent below which pollution counts as slow.
pub const SLOW: f64 = 0.75;

/// Factor on the half-width of every candidate, for terms that no candidate has: the intervals of the [calibration](crate::judge::calibration) then
/// hold the order 92.0 times in 100 in the worst family of errors that is declared; with a factor of 1, 88.8 times.
pub const SAFETY: f64 = 1.25;

/// Exponent of the pollution that three levels may hide: so slow that three levels can never rule it out.
pub const SLOWEST_POLLUTION: f64 = 1.0 / 3.0;

/// Relative round-off of the logarithm of an error: no residual is known more accurately, so no interval is narrower.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// The rate at h → 0 and the interval that holds it, by the rule of this module.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateInterval {
    /// Weighted mean of the candidates' rates.
    pub rate: f64,
    /// Pollution exponent r of the heaviest candidate; `None` for a straight line.
    pub pollution: Option<f64>,
    /// `rate` ± its half-width.
    pub interval: [f64; 2],
    /// How far log e of the finest level may lie from its law, at the confidence of the interval.
    pub scatter: f64,
}

/// One explanation of the data.
#[derive(Clone, Copy)]
struct Candidate {
    pollution: Option<f64>,
    rate: f64,
    log_weight: f64,
    half_width: f64,
    /// Student's quantile times the deviation of log e at the finest level.
    scatter: f64,
}

/// Fits all the candidates to the levels given, which should be an asymptotic range, and takes their weighted mean.
///
/// * Returns `None` with fewer than 3 levels, when a logarithm is not finite, or when steps do not differ.
pub fn rate_interval(levels: &[Level]) -> Option<RateInterval> {
    let data = Data::new(levels)?;
    // Three levels cannot tell fading scatter from pollution.
    let scatters = if data.pollutions.is_empty() { &SCATTER_EXPONENTS[..1] } else { &SCATTER_EXPONENTS };
    let candidates: Vec<Candidate> = scatters.iter().flat_map(|&s| Weighted::new(&data, s).candidates()).collect();
    let heaviest = candidates.iter().copied().max_by(|a, b| a.log_weight.total_cmp(&b.log_weight))?;
    let mean = |value: &dyn Fn(&Candidate) -> f64| {
        let weight = |candidate: &Candidate| (candidate.log_weight - heaviest.log_weight).exp();
        let sum: f64 = candidates.iter().map(|candidate| weight(candidate) * value(candidate)).sum();
        sum / candidates.iter().map(weight).sum::<f64>()
    };
    let rate = mean(&|candidate| candidate.rate);
    // Two standard deviations between the candidates, and the root mean square of their half-widths.
    let half = mean(&|c| c.half_width.powi(2) + 4.0 * (c.rate - rate).powi(2)).sqrt();
    let scatter = mean(&|c| c.scatter.powi(2)).sqrt();
    let sound = rate.is_finite() && half.is_finite();
    sound.then_some(RateInterval { rate, pollution: heaviest.pollution, interval: [rate - half, rate + half], scatter })
}

/// The logarithms of steps and errors.
struct Data {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Square of the round-off in log e.
    round_off: f64,
    /// The finest pairwise rate q.
    finest_rate: f64,
    /// log of the finest step ratio.
    finest_ratio: f64,
    /// The columns (h_k / h_1)^r for each r of [`POLLUTION_EXPONENTS`]; empty with too few levels to fit one.
    pollutions: Vec<Vec<f64>>,
}

impl Data {
    fn new(levels: &[Level]) -> Option<Self> {
        let (x, y) = logarithms(levels)?;
        let m = x.len();
        if m < 3 {
            return None;
        }
        let scale = y.iter().fold(1.0_f64, |scale, y| scale.max(y.abs()));
        let finest_ratio = x[m - 2] - x[m - 1];
        let finest_rate = (y[m - 2] - y[m - 1]) / finest_ratio;
        if !finest_rate.is_finite() {
            return None;
        }
        let column = |r: &f64| x.iter().map(|value| (r * (value - x[0])).exp()).collect();
        let pollutions = if m > 3 { POLLUTION_EXPONENTS.iter().map(column).collect() } else { vec![] };
        let round_off = (ROUND_OFF * scale).powi(2);
        Some(Self { finest_rate, finest_ratio, round_off, pollutions, x, y })
    }

    /// The limit of the last two pairwise rates if only the slowest pollution moves them.
    fn slow_limit(&self) -> f64 {
        let [coarse, middle] = [3, 2].map(|from_end| self.x.len() - from_end);
        let power = |k: usize| (SLOWEST_POLLUTION * (self.x[k] - self.x[coarse])).exp();
        let shift = |k: usize| (power(k) - power(k + 1)) / (self.x[k] - self.x[k + 1]);
        let coarse_rate = (self.y[coarse] - self.y[middle]) / (self.x[coarse] - self.x[middle]);
        let (before, last) = (shift(coarse), shift(middle));
        self.finest_rate - (self.finest_rate - coarse_rate) * last / (last - before)
    }
}

/// The data with the constant a projected out, in the scalar product `Σ w_k a_k b_k`, `w_k = (h_k / h̄)^-2s`.
///
/// h̄ is the geometric mean of the steps: the weights multiply to 1, so that sums of squares of different s can be compared as likelihoods.
struct Weighted<'a> {
    data: &'a Data,
    weights: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
}

impl<'a> Weighted<'a> {
    fn new(data: &'a Data, scatter: f64) -> Self {
        let mean = data.x.iter().sum::<f64>() / data.x.len() as f64;
        let weights = data.x.iter().map(|x| (-2.0 * scatter * (x - mean)).exp()).collect();
        let mut weighted = Self { data, weights, x: vec![], y: vec![] };
        let (mut x, mut y) = (data.x.clone(), data.y.clone());
        weighted.centre(&mut x);
        weighted.centre(&mut y);
        (weighted.x, weighted.y) = (x, y);
        weighted
    }

    /// The straight line, and a polluted line for each exponent.
    fn candidates(&self) -> Vec<Candidate> {
        let mut candidates = Vec::with_capacity(1 + POLLUTION_EXPONENTS.len());
        candidates.push(self.candidate(&self.x, &mut self.y.clone(), None));
        let [mut z, mut direction, mut rest] = [vec![], vec![], vec![]];
        for (&exponent, column) in POLLUTION_EXPONENTS.iter().zip(&self.data.pollutions) {
            z.clone_from(column);
            self.centre(&mut z);
            direction.clone_from(&self.x);
            self.project_out(&z, &mut direction);
            rest.clone_from(&self.y);
            self.project_out(&z, &mut rest);
            candidates.push(self.candidate(&direction, &mut rest, Some(exponent)));
        }
        candidates
    }

    /// The coefficient of `direction`, which is log h with the other columns projected out (Frisch-Waugh), and its half-width.
    ///
    /// * `rest`: log e with the same columns projected out; the residual afterwards.
    fn candidate(&self, direction: &[f64], rest: &mut [f64], pollution: Option<f64>) -> Candidate {
        let m = self.x.len();
        let parameters = if pollution.is_some() { 3 } else { 2 };
        let dof = m - parameters;
        let square = self.dot(direction, direction);
        let rate = self.dot(direction, rest) / square;
        self.project_out(direction, rest);
        let rss = self.dot(rest, rest) + dof as f64 * self.data.round_off;
        let variance = rss / dof as f64;
        let student = student_t(dof) * (variance / square).sqrt();
        let scatter_of_pair =
            (variance * (1.0 / self.weights[m - 2] + 1.0 / self.weights[m - 1])).sqrt() / self.data.finest_ratio;
        let correction = ((rate - self.data.finest_rate).abs() - scatter_of_pair).max(0.0);
        let half_width = match m {
            // No polluted candidate can be fitted to three levels: the line itself must allow for pollution.
            3 => (student + correction).max((rate - self.data.slow_limit()).abs()),
            _ => SAFETY * (student + correction),
        };
        let rare = if pollution.is_some_and(|r| r < SLOW) { SLOW_PENALTY } else { 0.0 };
        let log_weight = -0.5 * m as f64 * rss.ln() - PENALTY * parameters as f64 - rare;
        let scatter = student_t(dof) * (variance / self.weights[m - 1]).sqrt();
        Candidate { pollution, rate, log_weight, half_width, scatter }
    }

    // Plain loops: a calibration spends its time in these three.

    fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        let mut sum = 0.0;
        for (k, weight) in self.weights.iter().enumerate() {
            sum += weight * a[k] * b[k];
        }
        sum
    }

    fn centre(&self, values: &mut [f64]) {
        let (mut sum, mut total) = (0.0, 0.0);
        for (k, weight) in self.weights.iter().enumerate() {
            sum += weight * values[k];
            total += weight;
        }
        let mean = sum / total;
        values.iter_mut().for_each(|value| *value -= mean);
    }

    /// Subtracts from `values` their projection on `direction`.
    fn project_out(&self, direction: &[f64], values: &mut [f64]) {
        let factor = self.dot(values, direction) / self.dot(direction, direction);
        for (k, value) in values.iter_mut().enumerate() {
            *value -= factor * direction[k];
        }
    }
}
