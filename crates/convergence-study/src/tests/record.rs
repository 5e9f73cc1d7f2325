use std::path::Path;

use crate::{
    NamedNumber, Verdict,
    report::Findings,
    store::{Baseline, Record, json},
};
use serde_json::Value;

use super::fake::{Does, Fake, PROJECT, fake, finished, study};

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
fn a_record_has_the_documented_fields() {
    let record = record(Does::Converge, false);
    assert_eq!(record["schema"], 1);
    let study = &record["studies"][0];
    assert_eq!(
        (&study["id"], &study["verdict"]),
        (&"a".into(), &"pass".into())
    );
    let level = &study["levels"][4];
    assert_eq!(
        (&level["elements"], &level["steps"]),
        (&128.into(), &20.into())
    );
    assert_eq!(level["step"], 1.0 / 128.0);
    assert_eq!(
        level["errors"]["velocity"],
        std::f64::consts::PI * 0.3 / 128.0
    );
    let rate = &study["rates"][0];
    assert_eq!(
        (&rate["norm"], &rate["order"]),
        (&"velocity".into(), &1.0.into())
    );
    assert_eq!(rate["pairwise"].as_array().unwrap().len(), 4);
    assert_eq!(rate["interval"].as_array().unwrap().len(), 2);
    let constant = rate["constant"].as_f64().unwrap();
    assert!(
        (constant - std::f64::consts::PI * 0.3).abs() < 1e-6,
        "{constant}"
    );
    assert!(rate["fitted"].is_f64() && rate["extrapolated"].is_f64());
    assert_eq!(rate["verdict"], "pass");
    assert!(rate["reason"].as_str().unwrap().contains("agrees"));
    assert_eq!(
        (&rate["code"], &rate["used"]["end"]),
        (&"agrees".into(), &5.into())
    );
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
    let mut finished = finished(vec![study("a", Does::Converge)]);
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
        let finished = finished(vec![study("a", does), study("b", Does::Converge)]);
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
