//! What the judge must never do, and what it must always do.

mod numbers;

use convergence_judge::verdict::Judge;
use convergence_study::{Band, Interval, Level, RateVerdict, Reason, Verdict, judge, judge_pairs};

use Reason::*;

/// Levels with step ratio 2 and exactly these pairwise rates.
pub(crate) fn with_rates(rates: &[f64]) -> Vec<Level> {
    let first = Level {
        step: 0.125,
        error: 0.1,
    };
    let below = rates.iter().scan(first, |level, rate| {
        level.step /= 2.0;
        level.error *= 2.0_f64.powf(-rate);
        Some(*level)
    });
    [first].into_iter().chain(below).collect()
}

fn with_errors(errors: &[f64]) -> Vec<Level> {
    let levels = errors.iter().zip(0..);
    levels
        .map(|(&error, k)| Level {
            step: 0.5_f64.powi(k),
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

/// Pairwise rates, an order that is claimed of them within 0.05, and what is said.
const OF_RATES: [(&[f64], f64, Reason); 34] = [
    (&[2.0, 2.0, 2.0], 2.0, Agrees),
    (&[1.0, 1.0], 1.0, Agrees),
    (&[1.992, 1.998, 1.9995, 1.9999], 2.0, Agrees),
    (&[0.983, 0.991, 0.996], 1.0, Agrees),
    // They close in on the order, though their mean is off.
    (&[0.93, 0.96, 0.98, 0.99], 1.0, Agrees),
    (&[0.93, 0.965, 0.9825], 1.0, Agrees),
    (&[0.4, 0.99, 0.995, 0.9975], 1.0, Agrees),
    (&[1.0, 1.0, 1.0], 2.0, TooLow),
    (&[0.97, 0.985, 0.9925], 2.0, TooLow),
    (&[0.9, 0.9, 0.9], 1.0, TooLow),
    (&[1.1, 1.1, 1.1], 1.0, TooHigh),
    (&[2.0, 2.0, 2.0], 1.0, TooHigh),
    (&[75.976, 75.976, 75.976], 1.0, TooHigh),
    (&[1.0, 1.0, 75.976], 1.0, NotAsymptotic),
    (&[1.0, 1.0, -0.5], 1.0, NotAsymptotic),
    (&[0.1, 0.6, 1.2], 1.0, NotAsymptotic),
    (&[0.1, 0.5, 1.1], 1.0, NotAsymptotic),
    // Another table begins there, or the unit changes, however many levels follow.
    (&[1.0, 75.976, 1.0], 1.0, Jump),
    (&[1.0, -2.5, 1.0], 1.0, Jump),
    (&[1.0, 1.0, 17.0, 1.0, 1.0, 1.0], 1.0, Jump),
    // An interval so wide that everything fits.
    (&[1.1, 0.92, 1.08, 0.93], 1.0, IntervalTooWide),
    (&[1.3, 0.2, 1.9, -0.1], 1.0, NotAsymptotic),
    // A lower order emerges, or a limit that is wrong.
    (&[2.0, 2.0, 1.98, 1.94], 2.0, Departs),
    (&[2.0, 1.9, 1.6, 1.3], 2.0, FallsAway),
    (&[1.0, 1.0, 1.0], f64::NAN, ClaimUnusable),
    (&[1.0, 1.0, 1.0], f64::INFINITY, ClaimUnusable),
    (&[1.0, 1.0, 1.0], 0.0, ClaimUnusable),
    (&[1.0, 1.0, 1.0], -1.0, ClaimUnusable),
    (&[-1.0, -1.0, -1.0], 1.0, ErrorGrows),
    (&[-2.0, -2.0, -2.0], 2.0, ErrorGrows),
    // A rate of zero that wavers; one that ends upwards.
    (&[-0.002, 0.001, -0.0005], 1.0, ErrorGrows),
    (&[-0.002, -0.001, 0.0005], 1.0, TooLow),
    (&[1.0], 1.0, TooFewLevels),
    (&[], 1.0, TooFewLevels),
];

#[test]
fn rates_have_their_reason_and_are_shown_whatever_it_is() {
    for (rates, order, reason) in OF_RATES {
        let outcome = judge(&with_rates(rates), order, 0.05);
        check(&outcome, reason);
        assert_eq!(outcome.pairwise.len(), rates.len(), "{outcome:?}");
        if reason != TooFewLevels {
            let rate = outcome.fitted.expect("a rate");
            let Interval { low, high } = outcome.interval.expect("an interval");
            let said = outcome.reason.to_string();
            let is_shown = low <= rate && rate <= high && said.contains("from levels");
            assert!(is_shown, "{outcome:?}");
        }
    }
}

/// Errors at halved steps of which order 1 is claimed within 0.05, and what is said.
const OF_ERRORS: [(&[f64], Reason); 12] = [
    (&[], TooFewLevels),
    (&[1.0], TooFewLevels),
    (&[1.0, 0.5], TooFewLevels),
    (&[f64::NAN], NonFiniteError),
    (&[f64::NAN; 5], NonFiniteError),
    (&[1.0, 0.5, f64::NAN, 0.125], NonFiniteError),
    (&[f64::INFINITY, 0.5, 0.25, 0.125], NonFiniteError),
    (&[1.0, -0.5, 0.25, 0.125], NegativeError),
    // Their quotients would look like rates of 1.
    (&[-1.0, -0.5, -0.25, -0.125], NegativeError),
    (&[0.0; 5], ZeroError),
    (&[1.0, 0.5, 0.25, 0.125, 0.0], ZeroError),
    (&[0.3; 5], ErrorGrows),
];

#[test]
fn errors_that_are_no_usable_numbers_have_their_reason_and_no_rate() {
    for (errors, reason) in OF_ERRORS {
        let outcome = judge(&with_errors(errors), 1.0, 0.05);
        check(&outcome, reason);
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
