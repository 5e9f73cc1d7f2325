use std::path::Path;

use crate::{
    NamedNumber, Verdict,
    report::Findings,
    store::{Baseline, Record, json},
};
use convergence_judge::verdict::Reason;
use serde_json::Value;

use super::fake::{Does, Fake, PROJECT, fake, finished, passing, study};

fn record(does: Does, is_committed: bool) -> Value {
    let exact = Fake {
        scale: std::f64::consts::PI,
        ..fake("a", does)
    };
    let finished = finished(vec![exact.erased()]);
    let record = Record::new("quick", "verify", Verdict::Pass, Some(&[]), finished);
    let record = if is_committed {
        record.committed()
    } else {
        record
    };
    serde_json::from_str(&json(&record).unwrap()).unwrap()
}

#[test]
fn a_committed_record_keeps_six_digits() {
    let record = record(Does::Converge, true);
    assert_eq!(
        record["studies"][0]["levels"][4]["errors"]["velocity"],
        0.00736311
    );
    assert_eq!(record["studies"][0]["quantities"][0]["value"], 0.00736311);
    assert_eq!(record["studies"][0]["rates"][0]["fitted"], 1.0);
}

#[test]
fn numbers_that_are_not_finite_are_null_and_named() {
    for does in [Does::NotANumber, Does::Fail, Does::Panic] {
        let record = record(does, false);
        let study = &record["studies"][0];
        assert_eq!(study["verdict"], "fail");
        assert!(study["levels"][1]["errors"]["velocity"].is_null());
        assert!(study["rates"][0]["fitted"].is_null());
        let named: Vec<&str> = study["not_finite"]
            .as_array()
            .unwrap()
            .iter()
            .map(|entry| entry["at"].as_str().unwrap())
            .collect();
        assert_eq!(
            named,
            [
                "levels[1].errors.velocity",
                "rates[0].pairwise[0]",
                "rates[0].pairwise[1]"
            ]
        );
        assert_eq!(
            study["failed_cases"].as_array().unwrap().len(),
            usize::from(does != Does::NotANumber)
        );
    }
}

#[test]
fn norms_keep_their_order() {
    let mut finished = finished(vec![passing("a")]);
    finished[0].outcome.levels[0].errors = ["z", "a", "m"]
        .map(|norm| NamedNumber::new(norm, 1.0))
        .to_vec();
    let text = json(&Record::new(
        "quick",
        "verify",
        Verdict::Pass,
        None,
        finished,
    ))
    .unwrap();
    let at = |norm: &str| text.find(&format!("\"{norm}\": 1.0")).unwrap();
    assert!(at("z") < at("a") && at("a") < at("m"));
}

/// A report needs only a record and the pictures: made from a written record it is the same in
/// every byte.
#[test]
fn a_record_that_is_read_makes_the_same_report() {
    for does in [
        Does::Converge,
        Does::NotANumber,
        Does::Fail,
        Does::Panic,
        Does::TooShort,
        Does::Nothing,
    ] {
        let finished = finished(vec![study("a", does), passing("b")]);
        let changes = Baseline::default().compare(&finished, None);
        let record =
            Record::new("quick", "verify", Verdict::Fail, Some(&changes), finished).committed();
        let text = json(&record).unwrap();
        let read = Record::parse(&text, Path::new("r.json")).unwrap();
        // Pictures are separate files.
        let mut read = read.committed();
        let pictured = read.studies.iter_mut().zip(&record.studies);
        pictured
            .for_each(|(read, written)| read.outcome.figures.clone_from(&written.outcome.figures));
        let files = |record: &Record| {
            let findings = Findings::of(&PROJECT, record);
            findings.files().unwrap()
        };
        let [anew, written] = [files(&read), files(&record)];
        assert!(written.0.len() >= 7);
        for (file, written) in anew.0.iter().zip(&written.0) {
            assert_eq!(file.0, written.0);
            assert!(file.1 == written.1, "{does:?}: {}", file.0);
        }
        assert_eq!(anew.0.len(), written.0.len());
    }
}

type Edit = fn(&mut Record);

/// Each is an edit of a run where `b` is inconclusive and no study is in the baseline, and what is
/// said of it.
#[test]
fn a_record_that_contradicts_itself_is_refused() {
    let parts = "rates and checks that make it inconclusive";
    let no_more = "studies and changes that make it inconclusive";
    let edits: [(Edit, String); 8] = [
        (
            |record| record.studies[0].outcome.rates[0].rate.code = Reason::TooLow,
            "a: rates: found pass, and the code `too-low`, which makes it fail".to_owned(),
        ),
        (
            |record| record.verdict = Verdict::Pass,
            "verdict: found pass, and studies and changes that make it fail".to_owned(),
        ),
        (
            |record| record.verdict = Verdict::Inconclusive,
            "verdict: found inconclusive, and studies and changes that make it fail".to_owned(),
        ),
        (
            |record| record.changes = Some(vec![]),
            "baseline_changes: found 4, and 0 in changes".to_owned(),
        ),
        (
            |record| {
                record.baseline_changes.clear();
                record.changes = None;
            },
            format!("verdict: found fail, and {no_more}"),
        ),
        (
            |record| {
                record.baseline_changes.clear();
                record.changes = None;
                record.verdict = Verdict::Pass;
            },
            format!("verdict: found pass, and {no_more}"),
        ),
        (
            |record| record.studies[1].outcome.verdict = Verdict::Pass,
            format!("b: verdict: found pass, and {parts}"),
        ),
        (
            |record| record.studies.clear(),
            "studies: found none".to_owned(),
        ),
    ];
    let finished = finished(vec![passing("a"), study("b", Does::TooShort)]);
    let changes = Baseline::default().compare(&finished, None);
    let record = Record::new("quick", "verify", Verdict::Fail, Some(&changes), finished);
    let read = |record: &Record| Record::parse(&json(record).unwrap(), Path::new("r.json"));
    assert!(read(&record).is_ok());
    for (edit, found) in edits {
        let mut edited = record.clone();
        edit(&mut edited);
        let refused = read(&edited).unwrap_err().to_string();
        let expected = format!("r.json: {found}; expected a record");
        assert!(refused.starts_with(&expected), "{refused}");
    }
}
