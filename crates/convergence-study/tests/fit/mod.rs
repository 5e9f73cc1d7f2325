//! Readings of a rate, compared with answers known by other means.

mod regression;

use crate::verdict_laws::with_errors;
use convergence_judge::fit::{
    Level, asymptotic_range, extrapolated_rate, fit_line, pairwise_rates, rate_interval, student_t,
};

fn levels(steps: &[f64], error: impl Fn(f64) -> f64) -> Vec<Level> {
    let level = |&step: &f64| Level {
        step,
        error: error(step),
    };
    steps.iter().map(level).collect()
}

/// Errors with these logarithms to base 2.
fn with_log2(errors: &[f64]) -> Vec<Level> {
    let errors: Vec<f64> = errors.iter().map(|error| error.exp2()).collect();
    with_errors(0.5, &errors)
}

const HALVED: [f64; 6] = [0.5, 0.25, 0.125, 0.0625, 0.03125, 0.015625];
const UNEVEN: [f64; 6] = [0.5, 0.3, 0.14, 0.1, 0.04, 0.03];

/// Two-sided 95 % quantiles of Student's t for 1, 2, ... degrees of freedom: as printed tables have
/// them, with more digits.
const STUDENT: &str = include_str!("student.txt");

#[test]
fn student_quantiles_are_those_of_the_tables() {
    for (dof, expected) in (1..=30).zip(STUDENT.lines()) {
        assert_eq!(Ok(student_t(dof)), expected.parse(), "{dof}");
    }
    assert_eq!(student_t(0), f64::INFINITY);
    assert_eq!(student_t(1000), student_t(30));
}

#[test]
fn every_reading_of_a_pure_power_is_its_order() {
    for steps in [HALVED, UNEVEN] {
        let data = levels(&steps, |h| 3.0 * h.powf(1.7));
        assert!(
            pairwise_rates(&data)
                .iter()
                .all(|rate| (rate - 1.7).abs() < 1e-12)
        );
        let line = fit_line(&data).expect("regular");
        assert!((line.slope - 1.7).abs() < 1e-12 && (line.intercept - 3.0_f64.ln()).abs() < 1e-12);
        let fit = rate_interval(&data).expect("regular");
        assert!((fit.rate - 1.7).abs() < 1e-10 && fit.interval.holds(1.7));
        assert!((extrapolated_rate(&data).expect("regular") - 1.7).abs() < 1e-9);
    }
}

#[test]
fn extrapolation_gains_digits_on_smooth_data_with_uneven_steps() {
    let data = levels(&UNEVEN.map(|h| h / 8.0), |h| h * (1.0 + h));
    let finest = pairwise_rates(&data)[4];
    let limit = extrapolated_rate(&data).expect("closing in");
    assert!(
        (limit - 1.0).abs() < 0.1 * (finest - 1.0).abs(),
        "{limit} against {finest}"
    );
}

#[test]
fn extrapolation_declines_scatter_and_too_few_levels() {
    let noisy = levels(&HALVED, |h| {
        h * if h.log2() as i64 % 2 == 0 { 1.02 } else { 0.98 }
    });
    let first_negative = |h: f64| if h > 0.4 { -h } else { h };
    let last_negative = |h: f64| if h < 0.1 { -h } else { h };
    for declined in [
        noisy,
        levels(&HALVED[..3], |h| h),
        vec![],
        levels(&HALVED, |_| f64::NAN),
        levels(&HALVED[..4], last_negative),
        levels(&HALVED[..4], first_negative),
    ] {
        assert_eq!(extrapolated_rate(&declined), None, "{declined:?}");
    }
}

/// The quotient of two negative errors is positive, and would look like a rate.
#[test]
fn pairwise_rates_keep_what_is_not_finite_and_negative_errors_have_none() {
    let rates = pairwise_rates(&with_errors(0.5, &[1.0, f64::NAN, 0.25, 0.0, 0.1, -0.1]));
    assert!(rates[0].is_nan() && rates[1].is_nan() && rates[4].is_nan());
    assert_eq!((rates[2], rates[3]), (f64::INFINITY, f64::NEG_INFINITY));
    let negative = pairwise_rates(&with_errors(0.5, &[-0.16, -0.04, 0.01]));
    assert!(negative.iter().all(|rate| rate.is_nan()), "{negative:?}");
}

#[test]
fn the_range_is_what_its_three_rules_leave() {
    // Rates 1.75, 1.5, 1.0, 1.0, all exact: the first differs by 0.75 from the finest, the second
    // by 0.5.
    let data = with_log2(&[0.0, -1.75, -3.25, -4.25, -5.25]);
    assert_eq!(asymptotic_range(&data, 0.0), 1..5);
    // A level counts while its error is above, not at, the floor.
    assert_eq!(asymptotic_range(&data, data[4].error * (1.0 - 1e-12)), 1..5);
    assert_eq!(asymptotic_range(&data, data[4].error), 1..4);
    // Only the finest levels are dropped for the floor: one that dips down to it and recovers
    // counts.
    let dip = with_log2(&[0.0, -1.0, -30.0, -3.0]);
    assert_eq!(asymptotic_range(&dip, 1e-10).end, 4);
    // The five finest of those above the floor.
    let eight = levels(&[1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3], |h| h);
    assert_eq!(asymptotic_range(&eight, 0.0), 3..8);
    assert_eq!(asymptotic_range(&eight, 0.35), 2..7);
    // A rate that is far from the finest drops every level before it, near or not.
    for (rates, dropped) in [
        (&[1.5, 1.0, 1.25, 1.0][..], 0),
        (&[1.5625, 1.0, 1.25, 1.0], 1),
        (&[1.0, 1.5625, 1.0, 1.0], 2),
        (&[0.4375, 1.0], 1),
        (&[1.5625, 1.0], 1),
        (&[2.0, 1.0], 1),
    ] {
        let mut errors = vec![0.0];
        rates
            .iter()
            .for_each(|rate| errors.push(errors[errors.len() - 1] - rate));
        assert_eq!(
            asymptotic_range(&with_log2(&errors), 0.0).start,
            dropped,
            "{rates:?}"
        );
    }
    assert_eq!(
        asymptotic_range(&with_log2(&[f64::NAN, -1.0, -2.0, -3.0]), 0.0).start,
        1
    );
}

#[test]
fn a_limit_is_found_wherever_the_pollution_is_one_that_is_looked_for() {
    // Rates 1 + c w_k(r) to first order in c, w for halved steps proportional to 2^-rk.
    for (contraction, found) in [
        (0.9, false),
        (0.8, true),
        (0.5, true),
        (0.01, true),
        (0.003, false),
        (-0.5, false),
    ] {
        let rates =
            [0.1, 0.1 * contraction, 0.1 * contraction * contraction].map(|shift| 1.0 + shift);
        let sums = [0.0, rates[0], rates[0] + rates[1], rates.iter().sum()];
        let limit = extrapolated_rate(&with_log2(&sums.map(|sum| -sum)));
        assert_eq!(limit.is_some(), found, "{contraction}: {limit:?}");
        assert!(
            limit.is_none_or(|limit| (limit - 1.0).abs() < 1e-9),
            "{contraction}: {limit:?}"
        );
    }
}

#[test]
fn the_range_never_drops_a_plateau_above_the_floor() {
    let data = levels(&HALVED, |h| h * h + 1e-3);
    assert_eq!(asymptotic_range(&data, 1e-13).end, 6);
    assert_eq!(asymptotic_range(&data, 1.0).end, 0);
    assert_eq!(asymptotic_range(&[], 0.0), 0..0);
}
