//! Two records with known differences.

mod larger;

use convergence_study::{
    Finished, Floor, Header, Interval, LevelErrors, NamedNumber, NamedRate, Outcome, Verdict,
    internal::{
        compare::{RecordComparison, Shift, WITHIN, compare},
        run::Spent,
        store::{Record, json},
    },
    judge_pairs,
};
use std::path::Path;

const COUNTS: [u32; 5] = [8, 16, 32, 64, 128];

/// A level with n cells: errors by name, and the work n².
fn level(n: u32, errors: &[(&str, f64)]) -> LevelErrors {
    LevelErrors {
        parameters: vec![NamedNumber::new("n", f64::from(n))],
        step: Some(1.0 / f64::from(n)),
        work: Some(f64::from(n).powi(2)),
        errors: errors
            .iter()
            .map(|(name, error)| NamedNumber::new(*name, *error))
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
        NamedRate::new(["L2", "H1"][norm], judge_pairs(pairs, order, 0.1))
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
        located: None,
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

fn compared(old: Finished, new: Finished) -> RecordComparison {
    compare(&record(vec![old]), &record(vec![new]), Floor::NONE, WITHIN)
}

/// The errors that differ, each with its change.
fn found(comparison: &RecordComparison) -> Vec<(&str, Shift)> {
    let norms = comparison
        .findings
        .iter()
        .filter_map(|finding| Some((finding.norm.as_deref()?, finding.change)));
    norms.filter(|(_, change)| *change != Shift::Same).collect()
}

/// The reason given for the first error.
fn reason(comparison: &RecordComparison) -> &str {
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
    let comparison = compare(&old, &new, Floor::NONE, WITHIN);
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
    let comparison = compare(&new, &old, Floor::NONE, WITHIN);
    assert_eq!(
        found(&comparison),
        [("L2", Shift::Better), ("H1", Shift::Better)]
    );
    assert_eq!(compare(&old, &old, Floor::NONE, WITHIN).change, Shift::Same);
}

#[test]
fn a_difference_below_the_limit_is_none() {
    let new = || study("a", &COUNTS, smooth(1.005, 2.0), smooth(3.0, 1.0));
    assert_eq!(compared(sound("a"), new()).change, Shift::Same);
    assert_eq!(
        compare(
            &record(vec![sound("a")]),
            &record(vec![new()]),
            Floor::NONE,
            0.001
        )
        .change,
        Shift::Worse
    );
}

#[test]
fn only_levels_of_both_records_are_compared() {
    // n = 32, 64 and 128 stand in both.
    for (constant, change) in [
        (1.0, Shift::Same),
        (1.05, Shift::Worse),
        (0.95, Shift::Better),
    ] {
        let new = study(
            "a",
            &[32, 64, 128, 256],
            smooth(constant, 2.0),
            smooth(constant, 1.0),
        );
        let old = study("a", &COUNTS, smooth(1.0, 2.0), smooth(1.0, 1.0));
        let comparison = compared(old, new);
        assert_eq!(comparison.change, change, "{comparison:?}");
        assert!(reason(&comparison).contains("3 "), "{comparison:?}");
    }
    for counts in [[12, 24, 48, 96, 192], [256, 512, 1024, 2048, 4096]] {
        let apart = study("a", &counts, smooth(2.0, 2.0), smooth(3.0, 1.0));
        let apart = compared(sound("a"), apart);
        assert_eq!(apart.change, Shift::NotProven);
        assert!(reason(&apart).ends_with("no level is at a step that both have"));
    }
}

#[test]
fn what_is_lost_is_lost_and_what_is_gained_is_named() {
    let without = |norm: &str, rates: bool| {
        let mut new = sound("a");
        if !rates {
            new.outcome
                .levels
                .iter_mut()
                .for_each(|level| level.errors.retain(|error| error.name != *norm));
        }
        new.outcome.rates.retain(|rate| rate.name != *norm);
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
    let comparison = compare(&old, &new, Floor::NONE, WITHIN);
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
    new.outcome.levels[1].errors[0].value = f64::NAN;
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
    new.outcome.levels[1].errors[0].value *= -1.0;
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

/// Elements and steps in all pairs, and older records, without steps.
#[test]
fn grids_and_records_without_steps_are_compared_by_their_parameters() {
    let grid = |scale: f64| {
        let pairs = [8, 16, 32]
            .into_iter()
            .flat_map(|n| [10, 20, 40].map(|steps| (n, steps)));
        let at = |(n, steps): (u32, u32)| LevelErrors {
            parameters: vec![
                NamedNumber::new("n", f64::from(n)),
                NamedNumber::new("steps", f64::from(steps)),
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
    written.studies[0].outcome.levels[0].errors[0].value = f64::NAN;
    written.studies[0].outcome.rates[0].rate.interval = Some(Interval {
        low: f64::NAN,
        high: 1.0,
    });
    let text = json(&written).unwrap();
    let read = Record::parse(&text, Path::new("r.json")).unwrap();
    assert_eq!(json(&read).unwrap(), text);
    assert!(read.studies[0].outcome.levels[0].errors[0].value.is_nan());
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
