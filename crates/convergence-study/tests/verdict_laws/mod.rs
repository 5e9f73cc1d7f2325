//! What the judge must never do, and what it must always do.

mod numbers;

use convergence_judge::verdict::{Aside, Judge, Rates, SetAside};
use convergence_study::{Band, Level, RateVerdict, Reason, Verdict, judge, judge_pairs};

/// Levels with step ratio 2 and exactly these pairwise rates.
pub(crate) fn with_rates(rates: &[f64]) -> Vec<Level> {
    let mut levels = vec![Level {
        step: 0.125,
        error: 0.1,
    }];
    for rate in rates {
        let last = levels[levels.len() - 1];
        levels.push(Level {
            step: last.step / 2.0,
            error: last.error * 2.0_f64.powf(-rate),
        });
    }
    levels
}

fn with_errors(errors: &[f64]) -> Vec<Level> {
    errors
        .iter()
        .zip(0..)
        .map(|(&error, k)| Level {
            step: 0.5_f64.powi(k),
            error,
        })
        .collect()
}

#[track_caller]
fn check(outcome: &RateVerdict, kind: Reason, verdict: Verdict) {
    assert_eq!(
        (outcome.code, outcome.verdict),
        (kind, verdict),
        "{outcome:?}"
    );
    assert!(!outcome.reason.is_empty());
}

#[track_caller]
fn check_rates(rates: &[f64], order: f64, kind: Reason, verdict: Verdict) {
    check(&judge(&with_rates(rates), order, 0.05), kind, verdict);
}

#[track_caller]
fn check_errors(errors: &[f64], order: f64, kind: Reason, verdict: Verdict) {
    check(&judge(&with_errors(errors), order, 0.05), kind, verdict);
}

#[test]
fn clean_rates_pass() {
    check_rates(&[2.0, 2.0, 2.0], 2.0, Reason::Agrees, Verdict::Pass);
    check_rates(&[1.0, 1.0], 1.0, Reason::Agrees, Verdict::Pass);
    check_rates(
        &[1.992, 1.998, 1.9995, 1.9999],
        2.0,
        Reason::Agrees,
        Verdict::Pass,
    );
    check_rates(&[0.983, 0.991, 0.996], 1.0, Reason::Agrees, Verdict::Pass);
}

#[test]
fn rates_that_close_in_on_the_order_pass_though_their_mean_is_off() {
    let outcome = judge(&with_rates(&[0.93, 0.96, 0.98, 0.99]), 1.0, 0.05);
    check(&outcome, Reason::Agrees, Verdict::Pass);
    assert!((outcome.extrapolated.expect("three rates") - 1.0).abs() < 1e-9);
    check_rates(&[0.93, 0.965, 0.9825], 1.0, Reason::Agrees, Verdict::Pass);
}

#[test]
fn interpolation_errors_of_a_superclose_scheme_pass_with_four_levels() {
    let error = |h: f64| (h * h + 9.0 * h.powi(4)).sqrt();
    let pairs = [8.0, 16.0, 32.0, 64.0].map(|n: f64| (1.0 / n, error(1.0 / n)));
    check(
        &judge_pairs(pairs, 1.0, 0.05),
        Reason::Agrees,
        Verdict::Pass,
    );
}

#[test]
fn any_refinement_ratio_will_do() {
    let pairs =
        [10.0, 15.0, 24.0, 50.0, 64.0].map(|n: f64| (1.0 / n, 0.3 * n.powi(-2) * (1.0 + 0.5 / n)));
    check(
        &judge_pairs(pairs, 2.0, 0.05),
        Reason::Agrees,
        Verdict::Pass,
    );
    check(
        &judge_pairs(pairs, 1.9, 0.05),
        Reason::TooHigh,
        Verdict::Fail,
    );
}

#[test]
fn order_one_where_two_is_claimed_fails() {
    check_rates(&[1.0, 1.0, 1.0], 2.0, Reason::TooLow, Verdict::Fail);
    check_rates(&[0.97, 0.985, 0.9925], 2.0, Reason::TooLow, Verdict::Fail);
}

#[test]
fn order_two_where_one_is_claimed_fails() {
    check_rates(&[2.0, 2.0, 2.0], 1.0, Reason::TooHigh, Verdict::Fail);
}

#[test]
fn an_order_one_tenth_off_fails_on_clean_data() {
    check_rates(&[0.9, 0.9, 0.9], 1.0, Reason::TooLow, Verdict::Fail);
    check_rates(&[1.1, 1.1, 1.1], 1.0, Reason::TooHigh, Verdict::Fail);
}

#[test]
fn a_rate_of_75_976_never_passes_and_a_coarse_level_like_that_is_set_aside() {
    for (rates, reason) in [
        ([1.0, 1.0, 75.976], Reason::NotAsymptotic),
        // Another table begins there, or the unit changes.
        ([1.0, 75.976, 1.0], Reason::Jump),
        ([1.0, -2.5, 1.0], Reason::Jump),
    ] {
        check_rates(&rates, 1.0, reason, Verdict::Inconclusive);
    }
    // However many levels follow.
    check_rates(
        &[1.0, 1.0, 17.0, 1.0, 1.0, 1.0],
        1.0,
        Reason::Jump,
        Verdict::Inconclusive,
    );
    check_rates(
        &[75.976, 75.976, 75.976],
        1.0,
        Reason::TooHigh,
        Verdict::Fail,
    );
    let coarse = judge(&with_rates(&[75.976, 1.0, 1.0]), 1.0, 0.05);
    assert_eq!(
        coarse.set_aside,
        [SetAside::new(0, Aside::PreAsymptotic)],
        "{coarse:?}"
    );
}

#[test]
fn two_levels_never_pass() {
    check_errors(&[], 1.0, Reason::TooFewLevels, Verdict::Inconclusive);
    check_errors(&[1.0], 1.0, Reason::TooFewLevels, Verdict::Inconclusive);
    check_errors(
        &[1.0, 0.5],
        1.0,
        Reason::TooFewLevels,
        Verdict::Inconclusive,
    );
}

#[test]
fn an_interval_so_wide_that_everything_fits_is_inconclusive() {
    check_rates(
        &[1.1, 0.92, 1.08, 0.93],
        1.0,
        Reason::IntervalTooWide,
        Verdict::Inconclusive,
    );
    let outcome = judge(&with_rates(&[1.1, 0.92, 1.08, 0.93]), 2.0, 0.45);
    assert_ne!(outcome.verdict, Verdict::Pass);
}

#[test]
fn rates_that_still_change_are_inconclusive() {
    check_rates(
        &[0.1, 0.5, 1.1],
        1.0,
        Reason::NotAsymptotic,
        Verdict::Inconclusive,
    );
}

#[test]
fn a_coarse_level_that_is_not_asymptotic_is_set_aside_and_said_so() {
    let outcome = judge(&with_rates(&[0.4, 0.99, 0.995, 0.9975]), 1.0, 0.05);
    check(&outcome, Reason::Agrees, Verdict::Pass);
    assert_eq!(outcome.used, 1..5);
    assert_eq!(
        outcome.pairwise.len(),
        4,
        "its rate is reported all the same"
    );
}

#[test]
fn levels_at_the_known_floor_are_set_aside() {
    let errors = [1e-4, 2.5e-5, 6.25e-6, 1.5625e-6, 2e-8, 1.9e-8, 2.1e-8];
    let judge = Judge::new(0.05)
        .and_then(|judge| judge.with_floor(2.1e-8))
        .expect("usable settings");
    let outcome = judge.judge(&with_errors(&errors), 2.0);
    // The fourth level is less than 100 times the floor, and counts.
    check(&outcome, Reason::Agrees, Verdict::Pass);
    assert_eq!(outcome.used, 0..4);
    assert_eq!(
        outcome.set_aside,
        [4, 5, 6].map(|level| SetAside::new(level, Aside::AtFloor))
    );
}

#[test]
fn nothing_but_floor_is_inconclusive() {
    let judge = Judge::new(0.05)
        .and_then(|judge| judge.with_floor(1e-10))
        .expect("usable settings");
    let outcome = judge.judge(
        &with_errors(&[0.7, 0.6, 1.0, 0.9].map(|error| error * 1e-10)),
        1.0,
    );
    check(&outcome, Reason::RoundOffFloor, Verdict::Inconclusive);
}

#[test]
fn errors_that_level_off_above_the_floor_fail() {
    // A consistency error of 1e-4 of the coarsest error: the first rates look perfect.
    let errors: Vec<f64> = (0..16).map(|k| 0.5_f64.powi(k) + 1e-4).collect();
    check_errors(&errors, 1.0, Reason::FallsAway, Verdict::Fail);
    let rough: Vec<f64> = (0..9)
        .map(|k| 0.25_f64.powi(k) + 1e-4 * if k % 2 == 0 { 1.0 } else { 0.8 })
        .collect();
    assert_ne!(
        judge(&with_errors(&rough), 2.0, 0.05).verdict,
        Verdict::Pass
    );
}

#[test]
fn a_lower_order_that_emerges_never_passes() {
    check_rates(
        &[2.0, 2.0, 1.98, 1.94],
        2.0,
        Reason::Departs,
        Verdict::Inconclusive,
    );
    check_rates(&[2.0, 1.9, 1.6, 1.3], 2.0, Reason::FallsAway, Verdict::Fail);
    assert_ne!(
        judge(&with_rates(&[2.0, 2.0, 1.99, 1.97]), 2.0, 0.05).verdict,
        Verdict::Pass
    );
}

#[test]
fn the_worst_verdict_wins_and_none_at_all_is_inconclusive() {
    use Verdict::{Fail, Inconclusive, Pass};
    assert_eq!(Verdict::worst([Pass, Pass]), Pass);
    assert_eq!(Verdict::worst([Pass, Inconclusive]), Inconclusive);
    assert_eq!(Verdict::worst([Inconclusive, Fail, Pass]), Fail);
    assert_eq!(Verdict::worst([]), Inconclusive);
}

#[test]
fn a_higher_floor_takes_fewer_levels() {
    let levels = with_rates(&[1.1, 0.95, 1.02, 0.99]);
    let floor = Judge::new(0.4)
        .expect("usable")
        .with_floor(levels[4].error)
        .expect("usable");
    assert_eq!(floor.judge(&levels, 1.0).used, 0..4);
}

#[test]
fn rates_fall_away_when_they_fall_twice_and_end_half_an_order_below() {
    for (rates, expected) in [
        (&[0.75, 0.625, 0.375][..], true),
        (&[2.0, 0.75, 0.625, 0.375], true),
        (&[0.75, 0.625, 0.5], false),
        (&[0.625, 0.625, 0.375], false),
        (&[0.75, 0.375, 0.375], false),
        (&[0.5, 0.625, 0.375], false),
        (&[0.75, 0.25, 0.375], false),
        (&[0.75, 0.375], false),
        (&[0.75, f64::NAN, 0.375], false),
    ] {
        assert_eq!(Rates::exact(rates).falls_away(1.0), expected, "{rates:?}");
    }
}

#[test]
fn too_few_levels_are_put_down_to_the_floor_if_it_leaves_too_few() {
    let judged = |rates: &[f64], at_floor: usize| {
        let levels = with_rates(rates);
        let floor = levels[levels.len() - at_floor].error;
        Judge::new(0.05)
            .and_then(|judge| judge.with_floor(floor))
            .expect("usable")
            .judge(&levels, 1.0)
    };
    check(
        &judged(&[0.25, 1.0, 1.0], 2),
        Reason::RoundOffFloor,
        Verdict::Inconclusive,
    );
    check(
        &judged(&[0.25, 1.0, 1.0], 1),
        Reason::NotAsymptotic,
        Verdict::Inconclusive,
    );
    check(
        &judged(&[0.25, 1.0, 1.0, 1.0], 1),
        Reason::Agrees,
        Verdict::Pass,
    );
}

#[test]
fn a_verdict_says_on_what_it_rests() {
    let outcome = judge(&with_rates(&[0.4, 1.0, 1.0, 1.0]), 1.0, 0.05);
    let expected = "the rate agrees with the order: 1.0000 ± 0.00005 from levels 2 to 5 of 5, claimed 1 ± 0.05";
    assert_eq!(outcome.reason.to_string(), expected);
    let band = Band {
        order: 1.0,
        tolerance: 0.05,
    };
    assert_eq!(outcome.claimed, Some(band));
    assert!(outcome.fitted.is_some_and(|rate| (rate - 1.0).abs() < 1e-9));
    let nothing = judge(&with_rates(&[1.0]), 1.0, 0.05);
    assert_eq!((nothing.code, nothing.used), (Reason::TooFewLevels, 0..0));
    assert_eq!(outcome.set_aside, [SetAside::new(0, Aside::PreAsymptotic)]);
    assert_eq!(
        format!(
            "{:>14}|{:<6}|{}",
            Verdict::Inconclusive,
            Verdict::Pass,
            Verdict::Fail
        ),
        "  inconclusive|pass  |fail"
    );
}

#[test]
fn each_reason_has_a_verdict_and_words_of_its_own() {
    use Reason::*;
    let failing = [
        NoResult,
        NonFiniteError,
        NegativeError,
        ErrorGrows,
        FallsAway,
        WrongLimit,
        TooLow,
        TooHigh,
        ConstantOff,
        Identical,
    ];
    for reason in Reason::all() {
        let expected = match reason {
            Agrees => Verdict::Pass,
            reason if failing.contains(&reason) => Verdict::Fail,
            _ => Verdict::Inconclusive,
        };
        assert_eq!(reason.verdict(), expected, "{reason:?}");
        assert!(
            reason.text().len() > 10 && reason.advice().len() > 30,
            "{reason:?}"
        );
        assert!(
            ["To try", "to try"]
                .iter()
                .any(|words| reason.mathematics().contains(words)),
            "{reason:?}"
        );
        // A finer level can decide only inconclusive verdicts.
        assert!(
            !reason.wants_a_level() || expected == Verdict::Inconclusive,
            "{reason:?}"
        );
    }
    let distinct = |words: fn(Reason) -> &'static str| {
        Reason::all()
            .map(words)
            .collect::<std::collections::BTreeSet<_>>()
            .len()
    };
    assert_eq!(
        [Reason::name, Reason::text, Reason::advice].map(distinct),
        [Reason::all().count(); 3]
    );
    let undecided = [
        TooFewLevels,
        NotAsymptotic,
        Departs,
        LeftOver,
        LevelsTooClose,
        IntervalTooWide,
        AtTheEdge,
    ];
    assert!(
        undecided.iter().all(|reason| reason.wants_a_level()) && !RoundOffFloor.wants_a_level()
    );
}

mod whatever_is_measured {
    use convergence_study::Interval;
    use proptest::prelude::*;

    use super::{Verdict, judge, judge_pairs, with_rates};

    proptest! {
        #[test]
        fn no_input_panics_and_a_pass_has_its_interval_in_the_band(
            pairs in prop::collection::vec((prop::num::f64::ANY, prop::num::f64::ANY), 0..9),
            order in 0.5..3.0_f64,
        ) {
            let outcome = judge_pairs(pairs, order, 0.05);
            if outcome.verdict == Verdict::Pass {
                let Interval { low, high } = outcome.interval.expect("a pass rests on an interval");
                prop_assert!(order - 0.05 <= low && low <= high && high <= order + 0.05);
            }
        }

        #[test]
        fn the_units_of_step_and_error_do_not_matter(
            rates in prop::collection::vec(0.9..1.1_f64, 2..7),
            step in -3..3_i32, error in -3..3_i32,
        ) {
            let levels = with_rates(&rates);
            let scaled = levels.iter().map(|l| (l.step * 10.0_f64.powi(step), l.error * 10.0_f64.powi(error)));
            let (a, b) = (judge(&levels, 1.0, 0.05), judge_pairs(scaled, 1.0, 0.05));
            let (a, b) = (a.interval.expect("regular"), b.interval.expect("regular"));
            prop_assert!((a.low - b.low).abs() < 1e-9 && (a.high - b.high).abs() < 1e-9, "{a:?} {b:?}");
        }
    }
}
