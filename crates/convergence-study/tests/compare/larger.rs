//! Errors that have become larger, at the same levels.

use convergence_study::{
    Claim, Finished, Floor, Level,
    internal::compare::{Shift, WITHIN, compare},
};

use super::{COUNTS, compared, found, level, record, smooth, sound, study, unjudged};

/// The levels scatter, so that the interval of their mean is wide.
#[test]
fn errors_that_are_larger_at_every_level_are_worse_however_they_scatter() {
    let without_rates = |scales: [f64; 3]| {
        let levels = [8, 16, 32].into_iter().zip(scales);
        let levels = levels
            .map(|(n, scale)| level(n, &[("L2", scale / f64::from(n).powi(2))]))
            .collect();
        unjudged(levels)
    };
    for (scales, change, reason) in [
        ([30.0, 2.0, 200.0], Shift::Worse, "errors larger"),
        ([1.0 / 30.0, 0.5, 0.005], Shift::Better, "errors smaller"),
        (
            [30.0, 0.5, 200.0],
            Shift::Worse,
            "errors larger at 2 of 3 levels that both have: n = 32: 200 times",
        ),
        (
            [1.0 / 30.0, 1.0, 0.5],
            Shift::NotProven,
            "no difference of errors is proven",
        ),
        ([1.001, 1.0, 0.999], Shift::Same, "errors the same"),
    ] {
        let comparison = compared(without_rates([1.0; 3]), without_rates(scales));
        assert_eq!(comparison.change, change, "{comparison:?}");
        assert!(
            comparison.findings[0].reason.starts_with(reason),
            "{comparison:?}"
        );
    }
}

/// Round-off differs between machines; so do scattered errors.
#[test]
fn noise_and_errors_at_the_floor_differ_from_nothing() {
    let noisy = |seed: f64| move |h: f64| h * h * (1.0 + 0.03 * (seed / h).sin());
    let of = |seed: f64| {
        unjudged(
            study("a", &COUNTS, noisy(seed), |h| {
                1e-13 * (seed * h).cos().abs()
            })
            .outcome
            .levels,
        )
    };
    let compared = |within: f64| {
        compare(
            &record(vec![of(1.0)]),
            &record(vec![of(2.0)]),
            Floor::new(1e-10).unwrap(),
            within,
        )
    };
    assert_eq!(compared(0.1).change, Shift::Same, "{:?}", compared(0.1));
    // Errors at the same step are deterministic: with 3 % of scatter some have changed by more than
    // 1 %.
    assert_eq!(found(&compared(WITHIN)), [("L2", Shift::Worse)]);
}

/// A record of six levels without claims, and the same with some errors larger.
fn unclaimed(factors: [f64; 6]) -> Finished {
    let levels = [8, 16, 32, 64, 128, 256].into_iter().zip(factors);
    unjudged(
        levels
            .map(|(n, factor)| level(n, &[("L2", factor / f64::from(n).powi(2))]))
            .collect(),
    )
}

#[test]
fn an_error_that_is_larger_at_one_common_step_is_worse_and_named() {
    let before = [1.0; 6];
    for (factors, reason) in [
        (
            [1.0, 1.0, 1.0, 1.0, 1.0, 100.0],
            "errors larger at 1 of 6 levels that both have: n = 256: 100 times",
        ),
        (
            [1.0, 1.0, 1.0, 1.0, 1.5, 1.5],
            "errors larger at 2 of 6 levels that both have: n = 256: 1.5 times",
        ),
        (
            [1.02, 1.0, 1.0, 1.0, 1.0, 1.0],
            "errors larger at 1 of 6 levels that both have: n = 8: 1.02 times",
        ),
        (
            [1.0, 1.0, 1.0, 0.5, 0.25, 1.2],
            "errors larger at 1 of 6 levels that both have: n = 256: 1.2 times",
        ),
    ] {
        let comparison = compared(unclaimed(before), unclaimed(factors));
        assert_eq!(
            (comparison.change, &*comparison.findings[0].reason),
            (Shift::Worse, reason)
        );
    }
    assert_eq!(
        compared(unclaimed(before), unclaimed([1.009; 6])).change,
        Shift::Same
    );
    // A claim whose interval has become too wide: two finest errors 1.5 times, or the finest 3
    // times larger.
    for factor in [1.5, 3.0] {
        let larger = |h: f64| smooth(1.0, 2.0)(h) * if h < 0.01 { factor } else { 1.0 };
        let new = study("a", &COUNTS, larger, smooth(3.0, 1.0));
        assert_eq!(
            found(&compared(sound("a"), new))[0].1,
            Shift::Worse,
            "{factor}"
        );
    }
    // At a floor no difference counts, however large.
    let tiny = |factor: f64| {
        record(vec![unclaimed([
            1e-13,
            1e-13,
            1e-13,
            1e-13,
            1e-13,
            factor * 1e-13,
        ])])
    };
    let by =
        |floor: f64| compare(&tiny(1.0), &tiny(100.0), Floor::new(floor).unwrap(), WITHIN).change;
    assert_eq!((by(1e-10), by(0.0)), (Shift::Same, Shift::Worse));
}

/// Records of the orders of magnitude of SI units are compared like any others.
#[test]
fn no_error_is_too_small_to_be_compared() {
    let of = |scale: f64| study("a", &COUNTS, smooth(scale, 2.0), smooth(scale, 1.0));
    for unit in [1e-20, 1e-11, 1e-9, 1.0, 1e15] {
        assert_eq!(
            compared(of(unit), of(20.0 * unit)).change,
            Shift::Worse,
            "{unit}"
        );
        assert_eq!(
            compared(of(unit), of(unit / 20.0)).change,
            Shift::Better,
            "{unit}"
        );
        assert_eq!(
            compared(of(unit), of(1.001 * unit)).change,
            Shift::Same,
            "{unit}"
        );
    }
}

/// Round-off is another on another machine: a study that states its floor has set those levels
/// aside.
#[test]
fn levels_at_the_floor_of_the_study_are_not_compared() {
    let with_floor = |floor: f64, round_off: f64| {
        let error = move |h: f64| if h < 0.01 { round_off } else { h * h };
        let mut study = study("a", &COUNTS, error, smooth(3.0, 1.0));
        let pairs: Vec<Level> = COUNTS
            .iter()
            .map(|&n| 1.0 / f64::from(n))
            .map(|step| Level {
                step,
                error: error(step),
            })
            .collect();
        let floor = Floor::new(floor).unwrap();
        study.outcome.rates[0].rate = Claim::new(2.0, 0.1).judge(&pairs, floor);
        study
    };
    assert_eq!(
        compared(with_floor(1e-9, 1e-13), with_floor(1e-9, 1e-11)).change,
        Shift::Same
    );
    assert_eq!(
        compared(with_floor(0.0, 1e-13), with_floor(0.0, 1e-11)).change,
        Shift::Worse
    );
}
