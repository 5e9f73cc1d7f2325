//! Lines and candidates against multiple linear regression over the same columns, by a library that knows nothing of rates.

use convergence_study::judge::fit::{Level, PLAUSIBLE, POLLUTION_EXPONENTS, fit_line, rate_interval};
use nalgebra::{DMatrix, DVector};

use crate::{HALVED, UNEVEN, levels, quantiles};

/// What ordinary least squares says of `y` = X c.
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

/// 1, log h, and (h / h_1)^r where there is an r.
fn columns(levels: &[Level], pollution: Option<f64>) -> Vec<Vec<f64>> {
    let column = |f: &dyn Fn(f64) -> f64| levels.iter().map(|level| f(level.step)).collect();
    let polluted = pollution.map(|r| column(&|h| (h / levels[0].step).powf(r)));
    [Some(column(&|_| 1.0)), Some(column(&f64::ln)), polluted].into_iter().flatten().collect()
}

/// Rate, pollution and interval by the rule that the module states.
fn by_the_rule(levels: &[Level]) -> (f64, Option<f64>, [f64; 2]) {
    let y: Vec<f64> = levels.iter().map(|level| level.error.ln()).collect();
    let m = levels.len();
    let finest = (y[m - 1] - y[m - 2]) / (levels[m - 1].step.ln() - levels[m - 2].step.ln());
    let candidate = |pollution: Option<f64>| {
        let columns = columns(levels, pollution);
        let dof = m - columns.len();
        let fit = regression(&columns, &y);
        let rate = fit.coefficients[1];
        let deviation = (fit.rss / dof as f64 * fit.inverse[(1, 1)]).sqrt();
        (rate, pollution, fit.rss, quantiles().t(dof) * deviation + (rate - finest).abs())
    };
    let mut candidates = vec![candidate(None)];
    if m >= 4 {
        candidates.extend(POLLUTION_EXPONENTS.map(|r| candidate(Some(r))));
    }
    let best = candidates.iter().copied().min_by(|a, b| a.2.total_cmp(&b.2)).expect("at least one");
    let plausible = candidates.iter().filter(|candidate| candidate.2 <= PLAUSIBLE * best.2);
    let hull = plausible.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high]: [f64; 2], (rate, _, _, half)| {
        [low.min(rate - half), high.max(rate + half)]
    });
    (best.0, best.1, hull)
}

/// Errors of order 1.4 with pollution of one sign or the other and scatter of some percent, on the first `m` of the steps.
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
            let line = fit_line(&data, &quantiles()).expect("regular");
            let variance = reference.rss / (m - 2) as f64;
            let half = quantiles().t(m - 2) * (variance * reference.inverse[(1, 1)]).sqrt();
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
    let line = fit_line(&levels(&HALVED[..2], |h| h), &quantiles()).expect("a line");
    assert_eq!((line.slope, line.dof, line.interval), (1.0, 0, [f64::NEG_INFINITY, f64::INFINITY]));
    assert_eq!(fit_line(&levels(&HALVED[..1], |h| h), &quantiles()), None);
    assert_eq!(fit_line(&levels(&[0.5, 0.5], |h| h), &quantiles()), None, "the steps do not differ");
    assert_eq!(fit_line(&levels(&HALVED, |h| h - 0.25), &quantiles()), None, "a zero and negative errors");
}

#[test]
fn candidates_are_those_of_multiple_regression() {
    for steps in [HALVED, UNEVEN] {
        for (m, case) in (3..=6).flat_map(|m| (0..9).map(move |case| (m, case))) {
            let data = data(&steps, m, case);
            let found = rate_interval(&data, &quantiles()).expect("regular");
            let (rate, pollution, interval) = by_the_rule(&data);
            let close = |found: f64, expected: f64| (found - expected).abs() <= 1e-8 * (1.0 + expected.abs());
            assert!(close(found.rate, rate), "{m} levels, case {case}: {found:?}, {rate}");
            assert_eq!(found.pollution, pollution, "{m} levels, case {case}");
            let ends = found.interval.iter().zip(interval).all(|(&found, expected)| close(found, expected));
            assert!(ends, "{m} levels, case {case}: {found:?}, {interval:?}");
        }
    }
}

/// e = h: every candidate says 1 and leaves nothing, so that the round-off of the logarithms is all there is.
#[test]
fn an_interval_is_never_narrower_than_the_round_off_of_the_logarithms() {
    for (m, unit) in [(3, 5.0), (3, 1e-9), (4, 5.0), (6, 1.0), (6, 1e-9)] {
        let data = levels(&UNEVEN[..m].iter().map(|h| unit * h).collect::<Vec<_>>(), |h| h);
        let scale = data.iter().fold(1.0_f64, |scale, level| scale.max(level.error.ln().abs()));
        let half_width = |columns: Vec<Vec<f64>>| {
            let inverse = regression(&columns, &vec![0.0; m]).inverse;
            quantiles().t(m - columns.len()) * 8.0 * f64::EPSILON * scale * inverse[(1, 1)].sqrt()
        };
        let mut widest = half_width(columns(&data, None));
        if m >= 4 {
            widest = POLLUTION_EXPONENTS.iter().map(|&r| half_width(columns(&data, Some(r)))).fold(widest, f64::max);
        }
        let found = rate_interval(&data, &quantiles()).expect("regular");
        for ratio in found.interval.map(|end| (end - 1.0).abs() / widest) {
            assert!((ratio - 1.0).abs() < 0.1, "{m} levels, unit {unit}: {found:?}, {widest:e}");
        }
    }
}

#[test]
fn no_interval_without_three_levels_whose_steps_differ() {
    assert_eq!(rate_interval(&levels(&HALVED[..2], |h| h), &quantiles()), None);
    assert!(rate_interval(&levels(&HALVED[..3], |h| h), &quantiles()).is_some());
    for steps in [[0.5, 0.25, 0.125, 0.125], [0.5, 0.5, 0.5, 0.5]] {
        let data: Vec<Level> =
            steps.iter().zip([0.5, 0.25, 0.12, 0.11]).map(|(&step, error)| Level { step, error }).collect();
        assert_eq!(rate_interval(&data, &quantiles()), None, "{steps:?}");
    }
}
