//! Lines and candidates compared with multiple linear regression over the same columns, by a
//! general library.

use convergence_judge::fit::{
    FACTOR, FACTOR_OF_THREE, Level, POLLUTION_EXPONENTS, fit_line, rate_interval, student_t,
};
use convergence_study::Interval;
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
    let columns: Vec<_> = columns
        .iter()
        .map(|column| DVector::from_column_slice(column))
        .collect();
    let (x, y) = (
        DMatrix::from_columns(&columns),
        DVector::from_column_slice(y),
    );
    let pseudo_inverse = x.clone().pseudo_inverse(0.0).expect("not negative");
    let coefficients = &pseudo_inverse * &y;
    let rss = (&y - &x * &coefficients).norm_squared();
    Regression {
        coefficients,
        rss,
        inverse: &pseudo_inverse * pseudo_inverse.transpose(),
    }
}

/// 1, log h, and (h / h_1)^r if there is an r.
fn columns(levels: &[Level], pollution: Option<f64>) -> Vec<Vec<f64>> {
    let column = |f: &dyn Fn(f64) -> f64| levels.iter().map(|level| f(level.step)).collect();
    let polluted = pollution.map(|r| column(&|h| (h / levels[0].step).powf(r)));
    [Some(column(&|_| 1.0)), Some(column(&f64::ln)), polluted]
        .into_iter()
        .flatten()
        .collect()
}

/// One model of the logarithms by least squares.
#[derive(Clone, Copy)]
struct Model {
    rate: f64,
    pollution: Option<f64>,
    rss: f64,
    half_width: f64,
}

fn model(levels: &[Level], pollution: Option<f64>) -> Model {
    let m = levels.len();
    let y: Vec<f64> = levels.iter().map(|level| level.error.ln()).collect();
    let columns = columns(levels, pollution);
    let fit = regression(&columns, &y);
    let dof = m - columns.len();
    let variance = fit.rss / dof as f64;
    let ratio = (levels[m - 2].step / levels[m - 1].step).ln();
    let finest = (y[m - 2] - y[m - 1]) / ratio;
    let rate = fit.coefficients[1];
    let correction = ((rate - finest).abs() - (2.0 * variance).sqrt() / ratio).max(0.0);
    let student = student_t(dof) * (variance * fit.inverse[(1, 1)]).sqrt();
    Model {
        rate,
        pollution,
        rss: fit.rss,
        half_width: FACTOR * (student + correction),
    }
}

/// Rate, pollution and interval by the rule as RULE.md states it.
fn by_the_rule(levels: &[Level]) -> (f64, Option<f64>, [f64; 2]) {
    if let [coarse, middle, fine] = levels {
        let rate = |a: &Level, b: &Level| (a.error / b.error).ln() / (a.step / b.step).ln();
        let (before, finest) = (rate(coarse, middle), rate(middle, fine));
        let half =
            1.5 * (finest - before).abs() / ((coarse.step / fine.step).powf(1.0 / 6.0) - 1.0);
        return (finest, None, [finest - half, finest + half]);
    }
    let line = model(levels, None);
    let polluted = POLLUTION_EXPONENTS.map(|r| model(levels, Some(r)));
    let best = polluted
        .iter()
        .min_by(|a, b| a.rss.total_cmp(&b.rss))
        .expect("five");
    let is_polluted = 20.0 * best.rss < line.rss;
    let Model {
        rate,
        pollution,
        half_width,
        ..
    } = if is_polluted { *best } else { line };
    let possible = polluted
        .iter()
        .filter(|other| is_polluted && other.rss < 4.0 * best.rss);
    let farthest = possible
        .map(|other| (other.rate - rate).abs())
        .fold(0.0, f64::max);
    let half_width = half_width.max(farthest);
    (rate, pollution, [rate - half_width, rate + half_width])
}

/// Errors of order 1.4 with pollution of either sign and scatter of some percent, on the first `m`
/// of the steps.
fn data(steps: &[f64], m: usize, case: usize) -> Vec<Level> {
    let pollution = [0.0, 0.5, -0.4][case % 3];
    let scatter = [1e-5, 1e-3, 0.03][case / 3];
    levels(&steps[..m], |h| {
        0.7 * h.powf(1.4) * (1.0 + pollution * h + scatter * (1.0 / h + case as f64).sin())
    })
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
            let expected = [
                slope,
                intercept,
                variance.sqrt(),
                slope - half,
                slope + half,
            ];
            let found = [
                line.slope,
                line.intercept,
                line.deviation,
                line.interval.low,
                line.interval.high,
            ];
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-9,
                    "{m} levels, case {case}: {line:?}, {expected}"
                );
            }
            assert_eq!(line.dof, m - 2);
        }
    }
}

#[test]
fn two_levels_make_a_line_that_says_nothing_and_one_makes_none() {
    let line = fit_line(&levels(&HALVED[..2], |h| h)).expect("a line");
    assert_eq!(
        (line.slope, line.dof, line.interval),
        (
            1.0,
            0,
            Interval {
                low: f64::NEG_INFINITY,
                high: f64::INFINITY
            }
        )
    );
    assert_eq!(fit_line(&levels(&HALVED[..1], |h| h)), None);
    assert_eq!(
        fit_line(&levels(&[0.5, 0.5], |h| h)),
        None,
        "the steps do not differ"
    );
    assert_eq!(
        fit_line(&levels(&HALVED, |h| h - 0.25)),
        None,
        "a zero and negative errors"
    );
}

#[test]
fn models_are_those_of_multiple_regression() {
    let mut chosen = [0; 2];
    for steps in [HALVED, UNEVEN] {
        for (m, case) in (3..=6).flat_map(|m| (0..9).map(move |case| (m, case))) {
            let data = data(&steps, m, case);
            let found = rate_interval(&data).expect("regular");
            let (rate, pollution, interval) = by_the_rule(&data);
            let close = |found: f64, expected: f64| {
                (found - expected).abs() <= 1e-8 * (1.0 + expected.abs())
            };
            assert!(
                close(found.rate, rate),
                "{m} levels, case {case}: {found:?}, {rate}"
            );
            assert_eq!(found.pollution, pollution, "{m} levels, case {case}");
            let ends =
                close(found.interval.low, interval[0]) && close(found.interval.high, interval[1]);
            assert!(ends, "{m} levels, case {case}: {found:?}, {interval:?}");
            chosen[usize::from(pollution.is_some())] += 1;
        }
    }
    assert!(
        chosen.iter().all(|count| *count > 15),
        "both kinds of model occur: {chosen:?}"
    );
}

/// e = h: every model gives 1 with no residual, so that only the round-off of the logarithms
/// remains.
#[test]
fn an_interval_is_never_narrower_than_the_round_off_of_the_logarithms() {
    for (m, unit) in [(3, 5.0), (3, 1e-9), (4, 5.0), (6, 1.0), (6, 1e-9)] {
        let steps: Vec<f64> = UNEVEN[..m].iter().map(|h| unit * h).collect();
        let data = levels(&steps, |h| h);
        // In units of the finest error.
        let scale = data.iter().fold(1.0_f64, |scale, level| {
            scale.max((level.error / data[m - 1].error).ln().abs())
        });
        let round_off = 8.0 * f64::EPSILON * scale;
        let half = if m == 3 {
            let apart = (steps[0] / steps[2]).powf(1.0 / 6.0) - 1.0;
            FACTOR_OF_THREE * round_off / (steps[1] / steps[2]).ln() / apart
        } else {
            let inverse = regression(&columns(&data, None), &vec![0.0; m]).inverse;
            FACTOR * student_t(m - 2) * round_off * inverse[(1, 1)].sqrt()
        };
        let found = rate_interval(&data).expect("regular");
        for ratio in <[f64; 2]>::from(found.interval).map(|end| (end - 1.0).abs() / half) {
            assert!(
                (0.7..10.0).contains(&ratio),
                "{m} levels, unit {unit}: {found:?}, {half:e}"
            );
        }
    }
}

#[test]
fn no_interval_without_three_levels_whose_steps_differ() {
    assert_eq!(rate_interval(&levels(&HALVED[..2], |h| h)), None);
    assert!(rate_interval(&levels(&HALVED[..3], |h| h)).is_some());
    for steps in [[0.5, 0.25, 0.125, 0.125], [0.5, 0.5, 0.5, 0.5]] {
        let data: Vec<Level> = steps
            .iter()
            .zip([0.5, 0.25, 0.12, 0.11])
            .map(|(&step, error)| Level { step, error })
            .collect();
        assert_eq!(rate_interval(&data), None, "{steps:?}");
    }
}
