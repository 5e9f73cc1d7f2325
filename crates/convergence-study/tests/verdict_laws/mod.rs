//! What the judge must never do, and what it must always do.

mod numbers;

use convergence_judge::verdict::Judge;
use convergence_study::{Band, Interval, Level, RateVerdict, Reason, Verdict, judge, judge_pairs};

use crate::rows::rows;
use Reason::*;

/// Levels with step ratio 2 and exactly these pairwise rates.
pub(crate) fn with_rates(rates: &[f64]) -> Vec<Level> {
    let mut errors = vec![0.1];
    for rate in rates {
        errors.push(errors[errors.len() - 1] * 2.0_f64.powf(-rate));
    }
    with_errors(0.125, &errors)
}

/// Errors at halved steps.
pub(crate) fn with_errors(first: f64, errors: &[f64]) -> Vec<Level> {
    let levels = errors.iter().zip(0..);
    levels
        .map(|(&error, k)| Level {
            step: first * 0.5_f64.powi(k),
            error,
        })
        .collect()
}

/// Each reason has one verdict.
#[track_caller]
pub(crate) fn check(outcome: &RateVerdict, reason: Reason) {
    let found = (outcome.code, outcome.verdict);
    assert_eq!(found, (reason, reason.verdict()), "{outcome:?}");
    assert!(!outcome.reason.is_empty());
}

/// The numbers of a cell.
pub(crate) fn numbers_of(cell: &str) -> Vec<f64> {
    let words = cell.split_whitespace();
    words.map(|word| word.parse().expect("a number")).collect()
}

/// The same for the code of a reason.
#[track_caller]
fn check_code(outcome: &RateVerdict, code: &str) {
    check(outcome, code.to_owned().try_into().expect("a reason"));
}

#[test]
fn rates_have_their_reason_and_are_shown_whatever_it_is() {
    for [rates, order, reason, _] in rows(include_str!("rates.md")) {
        let rates = numbers_of(rates);
        let outcome = judge(&with_rates(&rates), numbers_of(order)[0], 0.05);
        check_code(&outcome, reason);
        assert_eq!(outcome.pairwise.len(), rates.len(), "{outcome:?}");
        if outcome.code != TooFewLevels {
            let rate = outcome.fitted.expect("a rate");
            let Interval { low, high } = outcome.interval.expect("an interval");
            let said = outcome.reason.to_string();
            let is_shown = low <= rate && rate <= high && said.contains("from levels");
            assert!(is_shown, "{outcome:?}");
        }
    }
}

#[test]
fn errors_that_are_no_usable_numbers_have_their_reason_and_no_rate() {
    for [errors, reason, _] in rows(include_str!("errors.md")) {
        let errors = numbers_of(errors);
        let outcome = judge(&with_errors(1.0, &errors), 1.0, 0.05);
        check_code(&outcome, reason);
        let is_usable = |error: &f64| error.is_finite() && *error > 0.0;
        for (pair, rate) in errors.windows(2).zip(&outcome.pairwise) {
            let is_rate = pair.iter().all(is_usable);
            assert!(is_rate || !rate.is_finite(), "{outcome:?}");
        }
    }
}

#[test]
fn interpolation_errors_of_a_superclose_scheme_pass_with_four_levels() {
    let error = |n: f64| (n.powi(-2) + 9.0 * n.powi(-4)).sqrt();
    let pairs = [8.0, 16.0, 32.0, 64.0].map(|n| (1.0 / n, error(n)));
    check(&judge_pairs(pairs, 1.0, 0.05), Agrees);
}

#[test]
fn any_refinement_ratio_will_do() {
    let pairs =
        [10.0, 15.0, 24.0, 50.0, 64.0].map(|n: f64| (1.0 / n, 0.3 * n.powi(-2) * (1.0 + 0.5 / n)));
    check(&judge_pairs(pairs, 2.0, 0.05), Agrees);
    check(&judge_pairs(pairs, 1.9, 0.05), TooHigh);
}

/// The judge with a floor and a tolerance.
pub(crate) fn above(floor: f64, tolerance: f64) -> Judge {
    let judge = Judge::new(tolerance).expect("a tolerance");
    judge.with_floor(floor).expect("a floor")
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
fn too_few_levels_are_put_down_to_the_floor_if_it_leaves_too_few() {
    let judged = |rates: &[f64], at_floor: usize| {
        let levels = with_rates(rates);
        let floor = levels[levels.len() - at_floor].error;
        above(floor, 0.05).judge(&levels, 1.0)
    };
    check(&judged(&[0.25, 1.0, 1.0], 2), RoundOffFloor);
    check(&judged(&[0.25, 1.0, 1.0], 1), NotAsymptotic);
    check(&judged(&[0.25, 1.0, 1.0, 1.0], 1), Agrees);
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
    assert_eq!((nothing.code, nothing.used), (TooFewLevels, 0..0));
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

    use super::{Verdict, judge_pairs};

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
    }
}
