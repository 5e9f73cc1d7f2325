//! Two records with known differences.

use std::path::Path;

use convergence_study::compare::{Comparison, Shift, WITHIN, compare, rule};
use convergence_study::judge::verdict::{Judge, Level, Verdict, judge_pairs};
use convergence_study::run::{Finished, Spent};
use convergence_study::store::{Record, json};
use convergence_study::study::{Header, LevelErrors, Outcome};

const COUNTS: [u32; 5] = [8, 16, 32, 64, 128];

/// A level with n cells: errors by name, and the work n².
fn level(n: u32, errors: &[(&str, f64)]) -> LevelErrors {
    LevelErrors {
        parameters: vec![("n".to_owned(), f64::from(n))],
        step: Some(1.0 / f64::from(n)),
        work: Some(f64::from(n).powi(2)),
        errors: errors
            .iter()
            .map(|(name, error)| ((*name).to_owned(), *error))
            .collect(),
        without: vec![],
    }
}

/// A study of `L2`, claimed to be of order 2, and `H1`, of order 1.
fn study(id: &str, counts: &[u32], l2: impl Fn(f64) -> f64, h1: impl Fn(f64) -> f64) -> Finished {
    let errors = |n: u32| {
        [
            ("L2", l2(1.0 / f64::from(n))),
            ("H1", h1(1.0 / f64::from(n))),
        ]
    };
    let rate = |norm: usize, order: f64| {
        let pairs = counts
            .iter()
            .map(|&n| (1.0 / f64::from(n), errors(n)[norm].1));
        (
            ["L2", "H1"][norm].to_owned(),
            judge_pairs(pairs, order, 0.1),
        )
    };
    let levels = counts.iter().map(|&n| level(n, &errors(n))).collect();
    Finished {
        header: Header::new(id, "c"),
        outcome: Outcome {
            levels,
            ..Outcome::new("s", vec![rate(0, 2.0), rate(1, 1.0)], vec![])
        },
        failed_cases: vec![],
        not_finite: vec![],
        untested: vec![],
        spent: Spent::default(),
        work: vec![],
    }
}

fn record(studies: Vec<Finished>) -> Record {
    Record::new("files", "test", Verdict::Pass, None, studies)
}

/// Smooth, with the next power of the step.
fn smooth(constant: f64, order: f64) -> impl Fn(f64) -> f64 {
    move |h: f64| constant * h.powf(order) * (1.0 + 0.3 * h)
}

fn sound(id: &str) -> Finished {
    study(id, &COUNTS, smooth(1.0, 2.0), smooth(3.0, 1.0))
}

fn compared(old: Finished, new: Finished) -> Comparison {
    compare(
        &record(vec![old]),
        &record(vec![new]),
        &rule(0.0).unwrap(),
        WITHIN,
    )
}

/// The errors that differ, each with its change.
fn found(comparison: &Comparison) -> Vec<(&str, Shift)> {
    let norms = comparison
        .findings
        .iter()
        .filter_map(|finding| Some((finding.norm.as_deref()?, finding.change)));
    norms.filter(|(_, change)| *change != Shift::Same).collect()
}

/// The reason given for the first error.
fn reason(comparison: &Comparison) -> &str {
    &comparison.findings[0].reason
}

#[test]
fn a_larger_constant_and_a_lost_order_are_found_and_nothing_else() {
    let studies = |l2: &dyn Fn(f64) -> f64, h1: &dyn Fn(f64) -> f64| {
        record(vec![
            sound("a"),
            study("b", &COUNTS, l2, smooth(3.0, 1.0)),
            study("c", &COUNTS, smooth(1.0, 2.0), h1),
        ])
    };
    let old = studies(&smooth(1.0, 2.0), &smooth(3.0, 1.0));
    let new = studies(&smooth(1.05, 2.0), &smooth(3.0, 0.5));
    let comparison = compare(&old, &new, &rule(0.0).unwrap(), WITHIN);
    assert_eq!(
        found(&comparison),
        [("L2", Shift::Worse), ("H1", Shift::Worse)]
    );
    assert_eq!(
        (
            comparison.studies,
            comparison.gained.len(),
            comparison.findings.len()
        ),
        (3, 0, 6)
    );
    let [larger, lower] = [2, 5].map(|k| &comparison.findings[k]);
    assert_eq!((larger.study.as_str(), lower.study.as_str()), ("b", "c"));
    let words = "errors larger at 5 of 5 levels that both have: n = ";
    assert!(
        larger.reason.starts_with(words) && larger.reason.ends_with(": 1.05 times"),
        "{}",
        larger.reason
    );
    assert!(
        lower.reason.starts_with("order 1.0") && lower.reason.contains("→ 0.5"),
        "{}",
        lower.reason
    );
    // The other way round both are better.
    let comparison = compare(&new, &old, &rule(0.0).unwrap(), WITHIN);
    assert_eq!(
        found(&comparison),
        [("L2", Shift::Better), ("H1", Shift::Better)]
    );
    assert_eq!(
        compare(&old, &old, &rule(0.0).unwrap(), WITHIN).change,
        Shift::Same
    );
}

#[test]
fn a_difference_below_the_limit_is_none() {
    let new = || study("a", &COUNTS, smooth(1.005, 2.0), smooth(3.0, 1.0));
    assert_eq!(compared(sound("a"), new()).change, Shift::Same);
    assert_eq!(
        compare(
            &record(vec![sound("a")]),
            &record(vec![new()]),
            &rule(0.0).unwrap(),
            0.001
        )
        .change,
        Shift::Worse
    );
}

#[test]
fn the_errors_of_other_levels_are_interpolated() {
    for (constant, change) in [
        (1.0, Shift::Same),
        (1.05, Shift::Worse),
        (0.95, Shift::Better),
    ] {
        let new = || {
            study(
                "a",
                &[12, 24, 48, 96, 192],
                smooth(constant, 2.0),
                smooth(constant, 1.0),
            )
        };
        let old = || study("a", &COUNTS, smooth(1.0, 2.0), smooth(1.0, 1.0));
        let comparison = compared(old(), new());
        assert_eq!(comparison.change, change, "{comparison:?}");
        assert!(
            reason(&comparison).contains("4 of 4 levels")
                || reason(&comparison).ends_with("4 levels"),
            "{comparison:?}"
        );
    }
    // No step in common, and none that lies between two of the other.
    let apart = compared(
        sound("a"),
        study(
            "a",
            &[256, 512, 1024, 2048],
            smooth(2.0, 2.0),
            smooth(3.0, 1.0),
        ),
    );
    assert_eq!(apart.change, Shift::NotProven);
}

#[test]
fn what_is_lost_is_lost_and_what_is_gained_is_named() {
    let without = |norm: &str, rates: bool| {
        let mut new = sound("a");
        if !rates {
            new.outcome
                .levels
                .iter_mut()
                .for_each(|level| level.errors.retain(|(name, _)| name != norm));
        }
        new.outcome.rates.retain(|(name, _)| name != norm);
        new
    };
    let coarser = || study("a", &COUNTS[..4], smooth(1.0, 2.0), smooth(3.0, 1.0));
    for (new, lost, why) in [
        (
            without("H1", false),
            vec!["H1"],
            "the new record does not have the error",
        ),
        (
            without("H1", true),
            vec!["H1"],
            "the new record does not judge its rate",
        ),
        (
            coarser(),
            vec!["L2", "H1"],
            "the new record does not have the finest level, n = 128",
        ),
    ] {
        let comparison = compared(sound("a"), new.clone());
        assert_eq!(
            found(&comparison),
            lost.iter()
                .map(|norm| (*norm, Shift::Lost))
                .collect::<Vec<_>>(),
            "{why}"
        );
        assert!(
            comparison
                .findings
                .iter()
                .any(|finding| finding.reason == why),
            "{comparison:?}"
        );
        // In the other direction something is gained.
        let gained = compared(new, sound("a"));
        assert_eq!(gained.change, Shift::Same, "{gained:?}");
        assert_eq!(
            gained.gained.iter().any(|name| name == "a: H1"),
            why.ends_with("the error"),
            "{gained:?}"
        );
    }
    let [old, new] = [
        record(vec![sound("a"), sound("b")]),
        record(vec![sound("a"), sound("c")]),
    ];
    let comparison = compare(&old, &new, &rule(0.0).unwrap(), WITHIN);
    assert_eq!(
        (comparison.change, comparison.gained),
        (Shift::Lost, vec!["the study c".to_owned()])
    );
    assert_eq!(
        comparison
            .findings
            .last()
            .map(|finding| (&*finding.study, finding.change)),
        Some(("b", Shift::Lost))
    );
}

#[test]
fn the_same_error_for_more_work_is_worse() {
    let mut new = sound("a");
    new.outcome
        .levels
        .iter_mut()
        .for_each(|level| level.work = level.work.map(|work| 1.2 * work));
    let comparison = compared(sound("a"), new);
    assert_eq!(
        found(&comparison),
        [("L2", Shift::Worse), ("H1", Shift::Worse)]
    );
    assert!(
        reason(&comparison).contains("takes 1.200 times the work"),
        "{comparison:?}"
    );
}

#[test]
fn an_error_that_is_a_number_no_more_is_worse() {
    let mut new = sound("a");
    new.outcome.levels[1].errors[0].1 = f64::NAN;
    let comparison = compared(sound("a"), new);
    assert_eq!(found(&comparison), [("L2", Shift::Worse)]);
    assert_eq!(
        reason(&comparison),
        "no longer a finite number >= 0 at n = 16"
    );
}

#[test]
fn an_error_that_becomes_negative_is_worse() {
    let mut new = sound("a");
    new.outcome.levels[1].errors[0].1 *= -1.0;
    let comparison = compared(sound("a"), new.clone());
    assert_eq!(found(&comparison), [("L2", Shift::Worse)]);
    assert_eq!(
        reason(&comparison),
        "no longer a finite number >= 0 at n = 16"
    );
    assert_eq!(
        found(&compared(new.clone(), new)),
        [],
        "it was no error before"
    );
}

/// Errors without a claimed order.
fn unjudged(levels: Vec<LevelErrors>) -> Finished {
    let outcome = Outcome {
        levels,
        verdict: Verdict::Pass,
        ..Outcome::new("s", vec![], vec![])
    };
    Finished {
        outcome,
        ..sound("a")
    }
}

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
            &rule(1e-10).unwrap(),
            within,
        )
    };
    assert_eq!(compared(0.1).change, Shift::Same, "{:?}", compared(0.1));
    // Errors at the same step are deterministic: with 3 % of scatter some have changed by more than 1 %.
    assert_eq!(found(&compared(WITHIN)), [("L2", Shift::Worse)]);
}

#[test]
fn a_study_without_errors_is_compared_by_its_verdict() {
    let plain = |verdict: Verdict| {
        let plain = unjudged(vec![]);
        Finished {
            outcome: Outcome {
                verdict,
                ..plain.outcome
            },
            ..plain
        }
    };
    let worse = compared(plain(Verdict::Pass), plain(Verdict::Fail));
    assert_eq!(
        (worse.change, reason(&worse)),
        (Shift::Worse, "the verdict was pass, is fail: s")
    );
    assert_eq!(
        compared(plain(Verdict::Fail), plain(Verdict::Pass)).change,
        Shift::Better
    );
    let unsure = compared(plain(Verdict::Pass), plain(Verdict::Inconclusive));
    assert_eq!(
        (unsure.change, reason(&unsure)),
        (Shift::Worse, "the verdict was pass, is inconclusive: s")
    );
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
    // A claim whose interval has become too wide: two finest errors 1.5 times, or the finest 3 times larger.
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
    let by = |floor: f64| compare(&tiny(1.0), &tiny(100.0), &rule(floor).unwrap(), WITHIN).change;
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

/// Round-off is another on another machine: a study that states its floor has set those levels aside.
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
        let judge = Judge::new(0.1)
            .and_then(|judge| judge.with_floor(floor))
            .unwrap();
        study.outcome.rates[0].1 = judge.judge(&pairs, 2.0);
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

/// Elements and steps in all pairs, and older records, without steps.
#[test]
fn grids_and_records_without_steps_are_compared_by_their_parameters() {
    let grid = |scale: f64| {
        let pairs = [8, 16, 32]
            .into_iter()
            .flat_map(|n| [10, 20, 40].map(|steps| (n, steps)));
        let at = |(n, steps): (u32, u32)| LevelErrors {
            parameters: vec![
                ("n".into(), f64::from(n)),
                ("steps".into(), f64::from(steps)),
            ],
            step: None,
            work: None,
            ..level(
                n,
                &[("L2", scale * (1.0 / f64::from(n) + 1.0 / f64::from(steps)))],
            )
        };
        unjudged(pairs.map(at).collect())
    };
    let comparison = compared(grid(1.0), grid(1.05));
    assert_eq!(found(&comparison), [("L2", Shift::Worse)]);
    assert!(
        reason(&comparison).starts_with("errors larger at 9 of 9 levels"),
        "{comparison:?}"
    );
    let mut coarser = grid(1.0);
    coarser.outcome.levels.pop();
    assert_eq!(compared(grid(1.0), coarser).change, Shift::Lost);
    assert_eq!(compared(grid(1.0), grid(1.0)).change, Shift::Same);
    let mut old = sound("a");
    old.outcome
        .levels
        .iter_mut()
        .for_each(|level| level.step = None);
    let new = study("a", &COUNTS, smooth(1.05, 2.0), smooth(3.0, 1.0));
    assert_eq!(found(&compared(old, new)), [("L2", Shift::Worse)]);
}

#[test]
fn a_record_is_read_as_it_was_written() {
    let mut written = record(vec![sound("a")]);
    written.studies[0].outcome.levels[0].errors[0].1 = f64::NAN;
    written.studies[0].outcome.rates[0].1.interval = Some([f64::NAN, 1.0]);
    let text = json(&written).unwrap();
    let read = Record::parse(&text, Path::new("r.json")).unwrap();
    assert_eq!(json(&read).unwrap(), text);
    assert!(read.studies[0].outcome.levels[0].errors[0].1.is_nan());
    for (from, to, message) in [
        (
            "\"schema\": 1",
            "\"schema\": 7",
            "r.json: schema: found 7; expected 1",
        ),
        (
            "\"pass\"",
            "\"good\"",
            "unknown variant `good`, expected one of `pass`, `inconclusive`, `fail`",
        ),
        (
            "\"studies\"",
            "\"study\"",
            "r.json: missing field `studies`",
        ),
        ("{", "", "expected a record as `verify` writes it"),
    ] {
        let error = Record::parse(&text.replacen(from, to, 1), Path::new("r.json"))
            .unwrap_err()
            .to_string();
        assert!(
            error.contains(message) && error.starts_with("r.json: "),
            "{error}"
        );
    }
}
