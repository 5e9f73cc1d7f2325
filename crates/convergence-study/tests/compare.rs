//! Two records, of which it is known what differs.

use std::path::Path;

use convergence_study::compare::{Change, Comparison, Settings, WITHIN, compare};
use convergence_study::judge::verdict::{Verdict, judge_pairs};
use convergence_study::store::record::{
    Errors, LevelRecord, Parameters, RateRecord, Record, SCHEMA, StudyRecord, json,
};

const COUNTS: [u32; 5] = [8, 16, 32, 64, 128];

/// A level with n cells: errors by name, and the work n².
fn level(n: u32, errors: &[(&str, f64)]) -> LevelRecord {
    LevelRecord {
        parameters: Parameters(vec![("n".to_owned(), f64::from(n))]),
        step: Some(1.0 / f64::from(n)),
        work: Some(f64::from(n).powi(2)),
        errors: Errors(errors.iter().map(|(name, error)| ((*name).to_owned(), *error)).collect()),
    }
}

/// A study of `L2`, claimed to be of order 2, and `H1`, of order 1.
fn study(id: &str, counts: &[u32], l2: impl Fn(f64) -> f64, h1: impl Fn(f64) -> f64) -> StudyRecord {
    let errors = |n: u32| [("L2", l2(1.0 / f64::from(n))), ("H1", h1(1.0 / f64::from(n)))];
    let rate = |norm: usize, order: f64| {
        let pairs = counts.iter().map(|&n| (1.0 / f64::from(n), errors(n)[norm].1));
        let judged = judge_pairs(pairs, order, 0.1);
        RateRecord {
            norm: ["L2", "H1"][norm].to_owned(),
            order,
            tolerance: 0.1,
            pairwise: judged.pairwise,
            fitted: judged.fitted,
            constant: judged.constant,
            interval: judged.interval,
            extrapolated: judged.extrapolated,
            verdict: judged.verdict,
            reason: judged.reason,
            code: String::new(),
            advice: String::new(),
        }
    };
    let rates = vec![rate(0, 2.0), rate(1, 1.0)];
    StudyRecord {
        id: id.to_owned(),
        claim: "c".to_owned(),
        tier: "quick".to_owned(),
        kind: "k".to_owned(),
        verdict: Verdict::worst(rates.iter().map(|rate| rate.verdict)),
        summary: "s".to_owned(),
        levels: counts.iter().map(|&n| level(n, &errors(n))).collect(),
        rates,
        checks: vec![],
        quantities: vec![],
        failed_cases: vec![],
        not_finite: vec![],
        untested: vec![],
    }
}

fn record(studies: Vec<StudyRecord>) -> Record {
    Record {
        schema: SCHEMA,
        crate_version: "0".to_owned(),
        scope: "files".to_owned(),
        verdict: Verdict::Pass,
        baseline_changes: vec![],
        studies,
    }
}

/// Smooth, with the next power.
fn smooth(constant: f64, order: f64) -> impl Fn(f64) -> f64 {
    move |h: f64| constant * h.powf(order) * (1.0 + 0.3 * h)
}

fn sound(id: &str) -> StudyRecord {
    study(id, &COUNTS, smooth(1.0, 2.0), smooth(3.0, 1.0))
}

fn compared(old: StudyRecord, new: StudyRecord) -> Comparison {
    compare(&record(vec![old]), &record(vec![new]), &Settings::new(None, WITHIN).unwrap())
}

/// The errors that differ, each with what became of it.
fn found(comparison: &Comparison) -> Vec<(&str, Change)> {
    let norms = comparison.studies.iter().flat_map(|study| &study.norms);
    norms.filter(|norm| norm.change != Change::Same).map(|norm| (norm.norm.as_str(), norm.change)).collect()
}

#[test]
fn a_larger_constant_and_a_lost_order_are_found_and_nothing_else() {
    let studies = |l2: &dyn Fn(f64) -> f64, h1: &dyn Fn(f64) -> f64| {
        record(vec![sound("a"), study("b", &COUNTS, l2, smooth(3.0, 1.0)), study("c", &COUNTS, smooth(1.0, 2.0), h1)])
    };
    let old = studies(&smooth(1.0, 2.0), &smooth(3.0, 1.0));
    let new = studies(&smooth(1.05, 2.0), &smooth(3.0, 0.5));
    let comparison = compare(&old, &new, &Settings::new(None, WITHIN).unwrap());
    assert_eq!(found(&comparison), [("L2", Change::Worse), ("H1", Change::Worse)]);
    assert!(comparison.notes.is_empty() && comparison.studies.iter().all(|study| study.notes.is_empty()));
    let [a, b, c] = [0, 1, 2].map(|k| &comparison.studies[k]);
    assert_eq!((a.change, b.change, c.change), (Change::Same, Change::Worse, Change::Worse));
    assert!(b.norms[0].reason.starts_with("errors larger at the same step: 1.0500 times"), "{}", b.norms[0].reason);
    let ratio = b.norms[0].error.unwrap();
    assert!(ratio.interval[0] > 1.0499 && ratio.interval[1] < 1.0501 && ratio.levels == 5, "{ratio:?}");
    assert!(c.norms[1].reason.starts_with("order 1.0") && c.norms[1].reason.contains("→ 0.5"), "{}", c.norms[1].reason);
    // The other way round both are better.
    let comparison = compare(&new, &old, &Settings::new(None, WITHIN).unwrap());
    assert_eq!(found(&comparison), [("L2", Change::Better), ("H1", Change::Better)]);
    assert_eq!(compare(&old, &old, &Settings::new(None, WITHIN).unwrap()).change, Change::Same);
}

#[test]
fn a_difference_below_the_limit_is_none() {
    let new = || study("a", &COUNTS, smooth(1.005, 2.0), smooth(3.0, 1.0));
    assert_eq!(compared(sound("a"), new()).change, Change::Same);
    let strict = Settings::new(None, 0.001).unwrap();
    assert_eq!(compare(&record(vec![sound("a")]), &record(vec![new()]), &strict).change, Change::Worse);
}

#[test]
fn unequal_levels_are_interpolated_and_named() {
    for (constant, change) in [(1.0, Change::Same), (1.05, Change::Worse), (0.95, Change::Better)] {
        let new = study("a", &[12, 24, 48, 96, 192], smooth(constant, 2.0), smooth(3.0, 1.0));
        let comparison = compared(sound("a"), new);
        assert_eq!(comparison.change, change, "{comparison:?}");
        let norm = &comparison.studies[0].norms[0];
        assert!(norm.error.is_some_and(|error| error.levels == 4 && (error.ratio - constant).abs() < 2e-3), "{norm:?}");
        assert!(comparison.studies[0].notes[0].contains("L2: in the old record only: n = 8; n = 16"), "{comparison:?}");
        assert!((norm.work.unwrap().ratio - constant).abs() < 0.03, "{norm:?}");
    }
    // No step in common, and none between two of the other.
    let apart = compared(sound("a"), study("a", &[256, 512, 1024, 2048], smooth(2.0, 2.0), smooth(3.0, 1.0)));
    assert_eq!((apart.change, apart.studies[0].norms[0].error), (Change::NotProven, None));
}

#[test]
fn a_norm_or_a_study_that_only_one_has_is_named_and_no_error() {
    let mut old = sound("a");
    old.levels.iter_mut().for_each(|level| level.errors.0.push(("max".to_owned(), 1.0)));
    let mut new = sound("a");
    new.levels.iter_mut().for_each(|level| level.errors.0.retain(|(name, _)| name != "H1"));
    new.rates.pop();
    let settings = Settings::new(None, WITHIN).unwrap();
    let comparison = compare(&record(vec![old, sound("b")]), &record(vec![new, sound("c")]), &settings);
    assert_eq!(comparison.change, Change::Same);
    assert_eq!(comparison.studies[0].notes, ["H1: in the old record only", "max: in the old record only"]);
    assert_eq!(comparison.notes, ["the study b is in the old record only", "the study c is in the new record only"]);
}

#[test]
fn the_same_error_for_more_work_is_worse() {
    let mut new = sound("a");
    new.levels.iter_mut().for_each(|level| level.work = level.work.map(|work| 1.2 * work));
    let comparison = compared(sound("a"), new);
    assert_eq!(found(&comparison), [("L2", Change::Worse), ("H1", Change::Worse)]);
    assert!(comparison.studies[0].norms[0].reason.contains("takes 1.200 times the work"), "{comparison:?}");
}

#[test]
fn an_error_that_is_a_number_no_more_is_worse() {
    let mut new = sound("a");
    new.levels[1].errors.0[0].1 = f64::NAN;
    let comparison = compared(sound("a"), new);
    assert_eq!(found(&comparison), [("L2", Change::Worse)]);
    assert_eq!(comparison.studies[0].norms[0].reason, "no longer a finite number >= 0 at n = 16");
}

#[test]
fn an_error_that_becomes_negative_is_worse() {
    let mut new = sound("a");
    new.levels[1].errors.0[0].1 *= -1.0;
    let comparison = compared(sound("a"), new.clone());
    assert_eq!(found(&comparison), [("L2", Change::Worse)]);
    assert_eq!(comparison.studies[0].norms[0].reason, "no longer a finite number >= 0 at n = 16");
    assert_eq!(found(&compared(new.clone(), new)), [], "it was no error before");
}

/// The levels scatter, so that the interval of their mean is wide.
#[test]
fn errors_that_are_larger_at_every_level_are_worse_however_they_scatter() {
    let without_rates = |scales: [f64; 3]| {
        let levels = [8, 16, 32].into_iter().zip(scales);
        let levels = levels.map(|(n, scale)| level(n, &[("L2", scale / f64::from(n).powi(2))])).collect();
        StudyRecord { levels, rates: vec![], verdict: Verdict::Pass, ..sound("a") }
    };
    for (scales, change, reason) in [
        ([30.0, 2.0, 200.0], Change::Worse, "errors larger"),
        ([1.0 / 30.0, 0.5, 0.005], Change::Better, "errors smaller"),
        ([30.0, 0.5, 200.0], Change::Worse, "errors larger at 2 of 3 levels that both have: n = 32: 200 times"),
        ([1.0 / 30.0, 1.0, 0.5], Change::NotProven, "no difference of errors is proven"),
        ([1.001, 1.0, 0.999], Change::Same, "errors the same"),
    ] {
        let comparison = compared(without_rates([1.0; 3]), without_rates(scales));
        let norm = &comparison.studies[0].norms[0];
        assert_eq!(norm.change, change, "{norm:?}");
        assert!(norm.reason.starts_with(reason), "{}", norm.reason);
    }
}

/// Round-off differs from machine to machine; so does what scatters.
#[test]
fn noise_and_errors_at_the_floor_differ_from_nothing() {
    let noisy = |seed: f64| move |h: f64| h * h * (1.0 + 0.03 * (seed / h).sin());
    let of = |seed: f64| {
        let study = study("a", &COUNTS, noisy(seed), |h| 1e-13 * (seed * h).cos().abs());
        StudyRecord { rates: vec![], verdict: Verdict::Pass, ..study }
    };
    let compared =
        |within: f64| compare(&record(vec![of(1.0)]), &record(vec![of(2.0)]), &Settings::new(None, within).unwrap());
    assert_eq!(compared(0.1).change, Change::Same, "{:?}", compared(0.1));
    // Errors at the same step are deterministic: what scatters by 3 % has changed by more than 1 %.
    assert_eq!(found(&compared(WITHIN)), [("L2", Change::Worse)]);
}

#[test]
fn a_study_without_errors_is_compared_by_its_verdict() {
    let plain = |verdict: Verdict| StudyRecord { levels: vec![], rates: vec![], verdict, ..sound("a") };
    let worse = compared(plain(Verdict::Pass), plain(Verdict::Fail));
    assert_eq!(worse.change, Change::Worse);
    assert_eq!(worse.studies[0].reason.as_deref(), Some("the verdict was pass, is fail: s"));
    assert_eq!(compared(plain(Verdict::Fail), plain(Verdict::Pass)).change, Change::Better);
    let unsure = compared(plain(Verdict::Pass), plain(Verdict::Inconclusive));
    assert_eq!(unsure.change, Change::Worse);
    assert_eq!(unsure.studies[0].reason.as_deref(), Some("the verdict was pass, is inconclusive: s"));
}

/// A record of six levels without claims, and the same with some errors larger.
fn unclaimed(factors: [f64; 6]) -> StudyRecord {
    let levels = [8, 16, 32, 64, 128, 256].into_iter().zip(factors);
    let levels = levels.map(|(n, factor)| level(n, &[("L2", factor / f64::from(n).powi(2))])).collect();
    StudyRecord { levels, rates: vec![], ..sound("a") }
}

#[test]
fn an_error_that_is_larger_at_one_common_step_is_worse_and_named() {
    let before = [1.0; 6];
    for (factors, reason) in [
        ([1.0, 1.0, 1.0, 1.0, 1.0, 100.0], "errors larger at 1 of 6 levels that both have: n = 256: 100 times"),
        ([1.0, 1.0, 1.0, 1.0, 1.5, 1.5], "errors larger at 2 of 6 levels that both have: n = 256: 1.5 times"),
        ([1.02, 1.0, 1.0, 1.0, 1.0, 1.0], "errors larger at 1 of 6 levels that both have: n = 8: 1.02 times"),
        ([1.0, 1.0, 1.0, 0.5, 0.25, 1.2], "errors larger at 1 of 6 levels that both have: n = 256: 1.2 times"),
    ] {
        let comparison = compared(unclaimed(before), unclaimed(factors));
        let norm = &comparison.studies[0].norms[0];
        assert_eq!((norm.change, norm.reason.as_str()), (Change::Worse, reason));
    }
    assert_eq!(compared(unclaimed(before), unclaimed([1.009; 6])).change, Change::Same);
    // A claim whose interval has become too wide: two finest errors 1.5 times, or the finest 3 times larger.
    for factor in [1.5, 3.0] {
        let larger = |h: f64| smooth(1.0, 2.0)(h) * if h < 0.01 { factor } else { 1.0 };
        let new = study("a", &COUNTS, larger, smooth(3.0, 1.0));
        assert_eq!(found(&compared(sound("a"), new))[0].1, Change::Worse, "{factor}");
    }
    // Both at round-off differ by nothing, however much.
    let tiny = |factor: f64| unclaimed([1e-13, 1e-13, 1e-13, 1e-13, 1e-13, factor * 1e-13]);
    assert_eq!(compared(tiny(1.0), tiny(100.0)).change, Change::Same);
}

/// Elements and steps in all pairs, and records of before, without steps.
#[test]
fn grids_and_records_without_steps_are_compared_by_their_parameters() {
    let grid = |scale: f64| {
        let pairs = [8, 16, 32].into_iter().flat_map(|n| [10, 20, 40].map(|steps| (n, steps)));
        let level = |(n, steps): (u32, u32)| LevelRecord {
            parameters: Parameters(vec![("n".into(), f64::from(n)), ("steps".into(), f64::from(steps))]),
            step: None,
            work: None,
            errors: Errors(vec![("L2".to_owned(), scale * (1.0 / f64::from(n) + 1.0 / f64::from(steps)))]),
        };
        StudyRecord { levels: pairs.map(level).collect(), rates: vec![], ..sound("a") }
    };
    let comparison = compared(grid(1.0), grid(1.05));
    assert_eq!(found(&comparison), [("L2", Change::Worse)]);
    assert_eq!(comparison.studies[0].norms[0].error.unwrap().levels, 9);
    assert_eq!(compared(grid(1.0), grid(1.0)).change, Change::Same);
    let mut old = sound("a");
    old.levels.iter_mut().for_each(|level| level.step = None);
    let new = study("a", &COUNTS, smooth(1.05, 2.0), smooth(3.0, 1.0));
    assert_eq!(found(&compared(old, new)), [("L2", Change::Worse)]);
}

#[test]
fn a_record_is_read_as_it_was_written() {
    let mut written = record(vec![sound("a")]);
    written.studies[0].levels[0].errors.0[0].1 = f64::NAN;
    written.studies[0].rates[0].interval = Some([f64::NAN, 1.0]);
    let text = json(&written).unwrap();
    let read = Record::parse(&text, Path::new("r.json")).unwrap();
    assert_eq!(json(&read).unwrap(), text);
    assert!(read.studies[0].levels[0].errors.0[0].1.is_nan());
    for (from, to, message) in [
        ("\"schema\": 1", "\"schema\": 7", "r.json: schema: found 7; expected 1"),
        ("\"pass\"", "\"good\"", "unknown variant `good`, expected one of `pass`, `inconclusive`, `fail`"),
        ("\"studies\"", "\"study\"", "r.json: missing field `studies`"),
        ("{", "", "expected a record as `verify` writes it"),
    ] {
        let error = Record::parse(&text.replacen(from, to, 1), Path::new("r.json")).unwrap_err().to_string();
        assert!(error.contains(message) && error.starts_with("r.json: "), "{error}");
    }
}
