//! Errors, steps and settings that are no usable numbers.

use convergence_judge::verdict::Judge;
use convergence_study::{JudgeError, Reason, judge};

use super::{check, with_rates};

#[test]
fn a_tolerance_so_wide_that_everything_fits_is_refused() {
    assert_eq!(Judge::new(0.5), Err(JudgeError::ToleranceTooWide(0.5)));
    assert_eq!(
        Judge::new(f64::INFINITY),
        Err(JudgeError::ToleranceTooWide(f64::INFINITY))
    );
    assert!(Judge::new(0.0).is_err() && Judge::new(-0.1).is_err() && Judge::new(f64::NAN).is_err());
    let levels = with_rates(&[1.0, 1.0, 1.0]);
    check(&judge(&levels, 1.0, 1.0), Reason::ToleranceTooWide);
    check(&judge(&levels, 1.0, f64::NAN), Reason::ClaimUnusable);
}

#[test]
fn steps_that_do_not_decrease_are_inconclusive() {
    for steps in [
        [1.0, 0.5, 0.5, 0.25],
        [0.125, 0.25, 0.5, 1.0],
        [1.0, 0.5, f64::NAN, 0.1],
        [1.0, 0.5, 0.25, 0.0],
        [f64::INFINITY, 0.5, 0.25, 0.125],
    ] {
        let mut levels = with_rates(&[1.0, 1.0, 1.0]);
        let pairs = levels.iter_mut().zip(steps);
        pairs.for_each(|(level, step)| level.step = step);
        check(&judge(&levels, 1.0, 0.05), Reason::StepsNotDecreasing);
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
