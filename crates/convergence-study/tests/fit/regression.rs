//! Lines and candidates compared with multiple linear regression over the same columns, by a general library.

use convergence_study::judge::fit::{
    Level, PENALTY, POLLUTION_EXPONENTS, SAFETY, SCATTER_EXPONENTS, SLOW_PENALTY, SLOWEST_POLLUTION, fit_line,
    rate_interval, student_t,
};
use nalgebra::{DMatrix, DVector};

use super::{HALVED, UNEVEN, levels};

/// The result of ordinary least squares for `y` = X c.
pub(crate) struct Regression {
    pub(crate) coefficients: DVector<f64>,
    pub(crate) rss: f64,
    /// (XᵀX)⁻¹.
    pub(crate) inverse: DMatrix<f64>,
}

pub(crate) fn regression(columns: &[Vec<f64>], y: &[f64]) -> Regression {
    let columns: Vec<_> = columns.iter().map(|column| DVector::from_column_slice(column)).collect();
    let (x, y) = (DMatrix::from_columns(&columns), DVector::from_column_slice(y));
    let pseudo_inverse = x.clone().pseudo_inverse(0.0).expect("not negative");
    let coefficients = &pseudo_inverse * &y;
    let rss = (&y - &x * &coefficients).norm_squared();
    Regression { coefficients, rss, inverse: &pseudo_inverse * pseudo_inverse.transpose() }
}

/// 1, log h, and (h / h_1)^r if there is an r.
fn columns(levels: &[Level], pollution: Option<f64>) -> Vec<Vec<f64>> {
    let column = |f: &dyn Fn(f64) -> f64| levels.iter().map(|level| f(level.step)).collect();
    let polluted = pollution.map(|r| column(&|h| (h / levels[0].step).powf(r)));
    [Some(column(&|_| 1.0)), Some(column(&f64::ln)), polluted].into_iter().flatten().collect()
}

/// One candidate by weighted least squares: rate, pollution, logarithm of its weight, half-width.
struct Explanation {
    rate: f64,
    pollution: Option<f64>,
    log_weight: f64,
    half_width: f64,
}

/// The result of the candidate with this pollution and scatter proportional to h^s, every row divided by its expected deviation.
fn explain(levels: &[Level], pollution: Option<f64>, s: f64) -> Explanation {
    let m = levels.len();
    let mean = levels.iter().map(|level| level.step.ln()).sum::<f64>() / m as f64;
    let deviations: Vec<f64> = levels.iter().map(|level| (s * (level.step.ln() - mean)).exp()).collect();
    let scaled = |column: &[f64]| column.iter().zip(&deviations).map(|(value, d)| value / d).collect::<Vec<_>>();
    let y: Vec<f64> = levels.iter().map(|level| level.error.ln()).collect();
    let columns: Vec<Vec<f64>> = columns(levels, pollution).iter().map(|column| scaled(column)).collect();
    let fit = regression(&columns, &scaled(&y));
    let dof = m - columns.len();
    let variance = fit.rss / dof as f64;
    let ratio = (levels[m - 2].step / levels[m - 1].step).ln();
    let finest = (y[m - 2] - y[m - 1]) / ratio;
    let rate = fit.coefficients[1];
    let pair = variance.sqrt() * deviations[m - 2].hypot(deviations[m - 1]) / ratio;
    let correction = ((rate - finest).abs() - pair).max(0.0);
    let student = student_t(dof) * (variance * fit.inverse[(1, 1)]).sqrt();
    let mut half_width = SAFETY * (student + correction);
    if m == 3 {
        // Rates p + c (h_k^r - h_k+1^r) / log(h_k / h_k+1): two equations for p and c.
        let step = |k: usize| levels[k].step;
        let shift = |k: usize| {
            (step(k).powf(SLOWEST_POLLUTION) - step(k + 1).powf(SLOWEST_POLLUTION)) / (step(k) / step(k + 1)).ln()
        };
        let coarse = (y[0] - y[1]) / (step(0) / step(1)).ln();
        let limit = (finest * shift(0) - coarse * shift(1)) / (shift(0) - shift(1));
        half_width = (student + correction).max((rate - limit).abs());
    }
    let rare = if pollution.is_some_and(|r| r < 0.7) { SLOW_PENALTY } else { 0.0 };
    let log_weight = -0.5 * m as f64 * fit.rss.ln() - PENALTY * columns.len() as f64 - rare;
    Explanation { rate, pollution, log_weight, half_width }
}

/// Rate, pollution and interval by the rule as the module states it.
fn by_the_rule(levels: &[Level]) -> (f64, Option<f64>, [f64; 2]) {
    let all = || {
        let pollutions = std::iter::once(None).chain(POLLUTION_EXPONENTS.map(Some));
        pollutions.flat_map(|pollution| SCATTER_EXPONENTS.map(|s| (pollution, s)))
    };
    let candidates: Vec<Explanation> = if levels.len() < 4 {
        vec![explain(levels, None, 0.0)]
    } else {
        all().map(|(pollution, s)| explain(levels, pollution, s)).collect()
    };
    let heaviest = candidates.iter().max_by(|a, b| a.log_weight.total_cmp(&b.log_weight)).expect("at least one");
    let weights: Vec<f64> = candidates.iter().map(|c| (c.log_weight - heaviest.log_weight).exp()).collect();
    let total: f64 = weights.iter().sum();
    let rate = candidates.iter().zip(&weights).map(|(c, w)| w * c.rate).sum::<f64>() / total;
    let mean = |value: &dyn Fn(&Explanation) -> f64| {
        candidates.iter().zip(&weights).map(|(c, w)| w * value(c)).sum::<f64>() / total
    };
    let half = mean(&|c| c.half_width.powi(2)).sqrt().hypot(2.0 * mean(&|c| (c.rate - rate) * (c.rate - rate)).sqrt());
    (rate, heaviest.pollution, [rate - half, rate + half])
}

/// Errors of order 1.4 with pollution of either sign and scatter of some percent, on the first `m` of the steps.
fn data(steps: &[f64], m: usize, case: usize) -> Vec<Level> {
    let pollution = [0.0, 0.5, -0.4][case % 3];
    let scatter = [1e-5, 1e-3, 0.03][case / 3];
    levels(&steps[..m], |h| 0.7 * h.powf(1.4) * (1.0 + pollution * h + scatter * (1.0 / h + case as f64).sin()))
}

#[test]
fn lines_are_those_of_linear_regression() {
    for steps in [HALVED, UNEVEN] {
        for (m, case) in (3..=6).flat_map(|m| (0..9).map(move |case| (m, case))) {
            let data = data(&steps, m, case);
            let x: Vec<f64> = data.iter().map(|level| level.step.ln()).collect();
            let y: Vec<f64> = data.iter().map(|level| level.error.ln()).collect();
            let reference = regression(&[vec![1.0; m], x], &y);
            let line = fit_line(&data).expect("regular");
            let variance = reference.rss / (m - 2) as f64;
            let half = student_t(m - 2) * (variance * reference.inverse[(1, 1)]).sqrt();
            let [intercept, slope] = [reference.coefficients[0], reference.coefficients[1]];
            let expected = [slope, intercept, variance.sqrt(), slope - half, slope + half];
            let found = [line.slope, line.intercept, line.deviation, line.interval[0], line.interval[1]];
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9, "{m} levels, case {case}: {line:?}, {expected}");
            }
            assert_eq!(line.dof, m - 2);
        }
    }
}

#[test]
fn two_levels_make_a_line_that_says_nothing_and_one_makes_none() {
    let line = fit_line(&levels(&HALVED[..2], |h| h)).expect("a line");
    assert_eq!((line.slope, line.dof, line.interval), (1.0, 0, [f64::NEG_INFINITY, f64::INFINITY]));
    assert_eq!(fit_line(&levels(&HALVED[..1], |h| h)), None);
    assert_eq!(fit_line(&levels(&[0.5, 0.5], |h| h)), None, "the steps do not differ");
    assert_eq!(fit_line(&levels(&HALVED, |h| h - 0.25)), None, "a zero and negative errors");
}

#[test]
fn candidates_are_those_of_multiple_regression() {
    for steps in [HALVED, UNEVEN] {
        for (m, case) in (3..=6).flat_map(|m| (0..9).map(move |case| (m, case))) {
            let data = data(&steps, m, case);
            let found = rate_interval(&data).expect("regular");
            let (rate, pollution, interval) = by_the_rule(&data);
            let close = |found: f64, expected: f64| (found - expected).abs() <= 1e-8 * (1.0 + expected.abs());
            assert!(close(found.rate, rate), "{m} levels, case {case}: {found:?}, {rate}");
            assert_eq!(found.pollution, pollution, "{m} levels, case {case}");
            let ends = found.interval.iter().zip(interval).all(|(&found, expected)| close(found, expected));
            assert!(ends, "{m} levels, case {case}: {found:?}, {interval:?}");
        }
    }
}

/// e = h: every candidate gives 1 with no residual, so that only the round-off of the logarithms remains.
#[test]
fn an_interval_is_never_narrower_than_the_round_off_of_the_logarithms() {
    for (m, unit) in [(3, 5.0), (3, 1e-9), (4, 5.0), (6, 1.0), (6, 1e-9)] {
        let data = levels(&UNEVEN[..m].iter().map(|h| unit * h).collect::<Vec<_>>(), |h| h);
        let scale = data.iter().fold(1.0_f64, |scale, level| scale.max(level.error.ln().abs()));
        let inverse = regression(&columns(&data, None), &vec![0.0; m]).inverse;
        let straight = SAFETY * student_t(m - 2) * 8.0 * f64::EPSILON * scale * inverse[(1, 1)].sqrt();
        let found = rate_interval(&data).expect("regular");
        for ratio in found.interval.map(|end| (end - 1.0).abs() / straight) {
            assert!((0.7..10.0).contains(&ratio), "{m} levels, unit {unit}: {found:?}, {straight:e}");
        }
    }
}

#[test]
fn no_interval_without_three_levels_whose_steps_differ() {
    assert_eq!(rate_interval(&levels(&HALVED[..2], |h| h)), None);
    assert!(rate_interval(&levels(&HALVED[..3], |h| h)).is_some());
    for steps in [[0.5, 0.25, 0.125, 0.125], [0.5, 0.5, 0.5, 0.5]] {
        let data: Vec<Level> =
            steps.iter().zip([0.5, 0.25, 0.12, 0.11]).map(|(&step, error)| Level { step, error }).collect();
        assert_eq!(rate_interval(&data), None, "{steps:?}");
    }
}
