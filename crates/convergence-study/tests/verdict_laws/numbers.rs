//! Errors, steps and settings that are no usable numbers.

use convergence_judge::verdict::Judge;
use convergence_study::{JudgeError, Reason, Verdict, judge, judge_pairs};

use super::{check, check_errors, check_rates, with_errors, with_rates};

#[test]
fn a_nan_error_anywhere_fails() {
    for k in 0..4 {
        let mut levels = with_rates(&[1.0, 1.0, 1.0]);
        levels[k].error = f64::NAN;
        let outcome = judge(&levels, 1.0, 0.05);
        check(&outcome, Reason::NonFiniteError, Verdict::Fail);
        assert!(
            outcome.pairwise.iter().any(|rate| rate.is_nan()),
            "NaN rates are reported"
        );
    }
}

#[test]
fn all_nan_fails() {
    check_errors(&[f64::NAN; 5], 1.0, Reason::NonFiniteError, Verdict::Fail);
}

#[test]
fn an_infinite_error_fails() {
    check_errors(
        &[f64::INFINITY, 0.5, 0.25, 0.125],
        1.0,
        Reason::NonFiniteError,
        Verdict::Fail,
    );
}

#[test]
fn nan_fails_even_with_one_level() {
    check_errors(&[f64::NAN], 1.0, Reason::NonFiniteError, Verdict::Fail);
}

#[test]
fn a_negative_error_fails() {
    check_errors(
        &[1.0, -0.5, 0.25, 0.125],
        1.0,
        Reason::NegativeError,
        Verdict::Fail,
    );
    let all_negative = judge(&with_errors(&[-1.0, -0.5, -0.25, -0.125]), 1.0, 0.05);
    check(&all_negative, Reason::NegativeError, Verdict::Fail);
    assert!(
        all_negative.pairwise.iter().all(|rate| rate.is_nan()),
        "their quotients would look like rates of 1"
    );
}

#[test]
fn errors_all_zero_never_pass() {
    check_errors(&[0.0; 5], 1.0, Reason::ZeroError, Verdict::Inconclusive);
}

#[test]
fn one_zero_error_never_passes() {
    check_errors(
        &[1.0, 0.5, 0.25, 0.125, 0.0],
        1.0,
        Reason::ZeroError,
        Verdict::Inconclusive,
    );
}

#[test]
fn constant_errors_fail() {
    check_errors(&[0.3; 5], 1.0, Reason::ErrorGrows, Verdict::Fail);
}

#[test]
fn growing_errors_fail_even_when_the_sign_of_the_rate_is_lost() {
    check_rates(&[-1.0, -1.0, -1.0], 1.0, Reason::ErrorGrows, Verdict::Fail);
    check_rates(&[-2.0, -2.0, -2.0], 2.0, Reason::ErrorGrows, Verdict::Fail);
}

#[test]
fn a_tolerance_so_wide_that_everything_fits_is_refused() {
    assert_eq!(Judge::new(0.5), Err(JudgeError::ToleranceTooWide(0.5)));
    assert_eq!(
        Judge::new(f64::INFINITY),
        Err(JudgeError::ToleranceTooWide(f64::INFINITY))
    );
    assert!(Judge::new(0.0).is_err() && Judge::new(-0.1).is_err() && Judge::new(f64::NAN).is_err());
    let levels = with_rates(&[1.0, 1.0, 1.0]);
    check(
        &judge(&levels, 1.0, 1.0),
        Reason::ToleranceTooWide,
        Verdict::Inconclusive,
    );
    check(
        &judge(&levels, 1.0, f64::NAN),
        Reason::ClaimUnusable,
        Verdict::Inconclusive,
    );
}

#[test]
fn an_order_that_is_no_positive_number_is_inconclusive() {
    for order in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        check(
            &judge(&with_rates(&[1.0, 1.0, 1.0]), order, 0.05),
            Reason::ClaimUnusable,
            Verdict::Inconclusive,
        );
    }
}

#[test]
fn steps_that_do_not_decrease_are_inconclusive() {
    for steps in [
        [1.0, 0.5, 0.5, 0.25],
        [0.125, 0.25, 0.5, 1.0],
        [1.0, 0.5, f64::NAN, 0.1],
        [1.0, 0.5, 0.25, 0.0],
    ] {
        let pairs = steps.into_iter().zip([1.0, 0.5, 0.25, 0.125]);
        let levels: Vec<super::Level> = pairs
            .map(|(step, error)| super::Level { step, error })
            .collect();
        check(
            &judge(&levels, 1.0, 0.05),
            Reason::StepsNotDecreasing,
            Verdict::Inconclusive,
        );
    }
}

#[test]
fn settings_that_mean_nothing_are_refused() {
    let judge = || Judge::new(0.125).expect("usable");
    assert_eq!(judge().tolerance(), 0.125);
    for floor in [-1e-300, f64::INFINITY] {
        assert_eq!(judge().with_floor(floor), Err(JudgeError::Floor(floor)));
    }
    assert!(judge().with_floor(f64::NAN).is_err());
    assert!(judge().with_floor(0.0).is_ok());
}

#[test]
fn infinite_steps_are_none() {
    let pairs = [f64::INFINITY, 0.5, 0.25, 0.125]
        .into_iter()
        .zip([1.0, 0.5, 0.25, 0.125]);
    check(
        &judge_pairs(pairs, 1.0, 0.05),
        Reason::StepsNotDecreasing,
        Verdict::Inconclusive,
    );
}
