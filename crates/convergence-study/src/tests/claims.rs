//! Claims and settings: the baseline keeps the claim of each number, and a hash of the settings of
//! each study.

use std::fs;
use std::path::Path;

use crate::{
    Blessing, Finished, Header, Must, Scope, Sheet, Study, Tier, Verdict, Verification,
    VerifyRequest, measured,
    report::{junit, sentence, words::blessing},
    run::listed,
    store::{Baseline, GuardedChange, diagnosis::diagnose},
    verify,
};

use super::fake::{Does, Fake, PROJECT, fake, finished, request};

const SETTINGS: [(&str, &str); 3] = [
    ("study.tier", "\"quick\""),
    ("expect[0].order", "1"),
    ("expect[0].tolerance", "0.002"),
];

/// The header of a study whose file has these values.
fn header(id: &str, settings: &[(&str, &str)]) -> Header {
    let settings = settings
        .iter()
        .map(|(path, value)| ((*path).to_owned(), (*value).to_owned()))
        .collect();
    Header {
        settings,
        ..fake(id, Does::Converge).header
    }
}

fn study(header: &Header) -> Box<dyn Study> {
    Fake {
        header: header.clone(),
        ..fake("", Does::Converge)
    }
    .erased()
}

/// The settings with another value at a path; `None`: without that path.
fn with(path: &str, value: Option<&'static str>) -> Header {
    let mut settings = SETTINGS.to_vec();
    settings.retain(|(of, _)| *of != path);
    settings.extend(value.map(|value| (path.to_owned().leak() as &str, value)));
    header("a", &settings)
}

fn ran(headers: &[Header]) -> Vec<Finished> {
    finished(headers.iter().map(study).collect())
}

/// The run of a study that claims this of its number.
fn claiming(claim: Option<Must>) -> Vec<Finished> {
    let fake = Fake {
        claim,
        ..fake("a", Does::Converge)
    };
    finished(vec![fake.erased()])
}

fn blessed(finished: &[Finished]) -> Baseline {
    let mut baseline = Baseline::default();
    baseline.bless(finished, None, false).unwrap();
    baseline
}

fn words(changes: &[GuardedChange]) -> Vec<String> {
    changes.iter().map(ToString::to_string).collect()
}

/// The one change, which is of settings.
#[track_caller]
fn one_of_settings(changes: &[GuardedChange], id: &str) -> String {
    let [change] = &words(changes)[..] else {
        panic!("{changes:?}");
    };
    let expected = format!("{id}: settings have changed: hash ");
    assert!(change.starts_with(&expected), "{change}");
    change.clone()
}

#[test]
fn a_study_with_another_value_in_its_file_or_another_case_is_named() {
    let baseline = blessed(&ran(&[header("a", &SETTINGS)]));
    let mut turned = SETTINGS;
    turned.reverse();
    for same in [header("a", &SETTINGS), header("a", &turned)] {
        assert_eq!(words(&baseline.compare(&ran(&[same]), None)), [""; 0]);
    }
    for (path, value) in [
        ("expect[0].tolerance", Some("0.02")),
        ("study.tier", Some("\"full\"")),
        ("expect[0].order", None),
        ("planted", Some("0.5")),
    ] {
        let changes = baseline.compare(&ran(&[with(path, value)]), None);
        one_of_settings(&changes, "a");
        assert!(changes[0].movement.is_loosened(), "{path}");
    }
    let mut fewer = listed(study(&header("a", &SETTINGS)).as_ref());
    assert_eq!(baseline.compare(&[], Some(&[fewer.clone()])), []);
    fewer.cases.pop();
    one_of_settings(&baseline.compare(&[], Some(&[fewer])), "a");
}

/// Such as a constant in code that somebody loosens a thousandfold.
#[test]
fn a_claim_of_a_number_that_is_not_guarded_stands_in_the_baseline_by_its_name() {
    let claiming = |bounds: [Option<f64>; 2]| {
        let mut ran = ran(&[header("a", &SETTINGS)]);
        let change = |(case, bound): (&str, Option<f64>)| {
            measured(case, "change", 1e-4).must_be(bound.map(Must::AtMost))
        };
        let numbers = ["t = 1", "t = 2"].into_iter().zip(bounds).map(change);
        ran[0].outcome.sheets = vec![Sheet::new("Changes", "time", numbers)];
        ran
    };
    let same = claiming([Some(1e-3); 2]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("baseline.json");
    blessed(&same).write(&path).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains("\"claims\": {\n        \"change\": \"<= 0.001\"\n      }"));
    let baseline = Baseline::read(&path).unwrap();
    assert_eq!(baseline.compare(&same, None), []);
    for (bounds, messages) in [
        (
            [Some(1.0); 2],
            &["change has a looser claim: was <= 0.001, is <= 1"][..],
        ),
        (
            [None; 2],
            &["change has a looser claim: was <= 0.001, is none"],
        ),
        (
            [Some(1e-3), Some(1.0)],
            &[
                "change has a looser claim: was <= 0.001, is none",
                "t = 1: change has a tighter claim: was none, is <= 0.001",
                "t = 2: change has a tighter claim: was none, is <= 1",
            ],
        ),
    ] {
        let ran = claiming(bounds);
        let found = words(&baseline.compare(&ran, None));
        let expected: Vec<String> = messages.iter().map(|text| format!("a: {text}")).collect();
        assert_eq!(found, expected);
        assert!(baseline.clone().bless(&ran, None, false).is_err());
        assert!(baseline.clone().bless(&ran, None, true).is_ok());
    }
}

#[test]
fn a_looser_claim_is_named_and_blessed_on_demand_and_a_tighter_one_without() {
    let near = |answer, within| Some(Must::Near { answer, within });
    let baseline = blessed(&claiming(Some(Must::AtMost(0.01))));
    for (to, message, is_loosened) in [
        (
            Some(Must::AtMost(0.1)),
            "a: finest error has a looser claim: was <= 0.01, is <= 0.1",
            true,
        ),
        (
            near(0.0, 0.02),
            "a: finest error has a looser claim: was <= 0.01, is 0 ± 0.02",
            true,
        ),
        (
            None,
            "a: finest error has a looser claim: was <= 0.01, is none",
            true,
        ),
        (
            Some(Must::AtMost(0.005)),
            "a: finest error has a tighter claim: was <= 0.01, is <= 0.005",
            false,
        ),
    ] {
        let ran = claiming(to);
        let changes = baseline.compare(&ran, None);
        assert_eq!(words(&changes), [message]);
        let mut plain = baseline.clone();
        if is_loosened {
            let refused = plain.bless(&ran, None, false).unwrap_err().to_string();
            assert!(
                refused.ends_with(&format!("--bless --loosened\n  {message}")),
                "{refused}"
            );
            assert_eq!(plain, baseline);
            assert_eq!(plain.bless(&ran, None, true), Ok(changes));
        } else {
            assert_eq!(plain.bless(&ran, None, false), Ok(vec![]));
        }
        assert_eq!(plain.compare(&ran, None), []);
        assert_eq!(plain.number("a", "finest error").unwrap().claim, to);
    }
}

#[test]
fn a_guard_counts_once_it_is_blessed_and_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("baseline.json");
    let guarded = |guard, scale| {
        let header = Header {
            guard,
            ..fake("a", Does::Converge).header
        };
        let fake = Fake {
            header,
            scale,
            tolerance: 1e-6,
            ..fake("", Does::Converge)
        };
        finished(vec![fake.erased()])
    };
    let scattered = guarded(Some(1e-4), 1.00005);
    let mut baseline = blessed(&guarded(None, 1.0));
    assert_eq!(
        words(&baseline.compare(&scattered, None)),
        [
            "a: guard was none, is 1e-4",
            "a: finest error moved from 0.00234375 to 0.00234387, by +0.005 %, tolerated 0.0001 %"
        ]
    );
    assert!(baseline.bless(&scattered, None, false).is_err());
    baseline
        .bless(&guarded(Some(1e-4), 1.0), None, true)
        .unwrap();
    baseline.write(&file).unwrap();
    let mut baseline = Baseline::read(&file).unwrap();
    assert_eq!(baseline.compare(&scattered, None), []);
    // A blessing of numbers keeps it, and their digits.
    baseline.bless(&scattered, None, false).unwrap();
    assert_eq!(baseline.compare(&scattered, None), []);
    assert_eq!(
        baseline.number("a", "finest error").unwrap().value,
        0.002_343_75
    );
    for wider in [Some(1e-3), Some(0.1)] {
        let ran = guarded(wider, 1.0);
        assert!(baseline.bless(&ran, None, false).is_err(), "{wider:?}");
    }
    // A narrower one needs no leave.
    for narrower in [Some(1e-5), None] {
        let ran = guarded(narrower, 1.0);
        assert_eq!(baseline.bless(&ran, None, false), Ok(vec![]));
    }
    let moved = baseline.compare(&guarded(None, 1.00005), None);
    assert_eq!(moved.len(), 1, "{moved:?}");
}

#[test]
fn settings_of_studies_that_are_not_run_are_compared_too() {
    let [a, b, gone] = ["a", "b", "gone"].map(|id| header(id, &SETTINGS));
    let baseline = blessed(&ran(&[a.clone(), b, gone]));
    let loose = header(
        "b",
        &[("expect[0].tolerance", "0.49"), SETTINGS[0], SETTINGS[1]],
    );
    let known = [a.clone(), loose, header("new", &SETTINGS)];
    let known = known.map(|header| listed(study(&header).as_ref()));
    let ran = ran(&[a]);
    let changes = baseline.compare(&ran, Some(&known));
    one_of_settings(&changes[..1], "b");
    assert_eq!(
        words(&changes[1..]),
        [
            "new: study is new",
            "gone: study was deleted: it had 1 guarded number"
        ]
    );
    assert!(
        baseline.compare(&ran, None).is_empty(),
        "a selection looks at itself alone"
    );
    assert!(sentence(&ran, Some(&changes)).ends_with(
        "; 1 study deleted, 1 study with changed settings, 1 study not yet in the baseline"
    ));
    // The tier that runs a study blesses it.
    assert_eq!(
        blessing(&PROJECT, "cargo xtask verify", &ran, &changes),
        "cargo xtask verify --tier full --bless --loosened"
    );
    assert_eq!(
        blessing(&PROJECT, "c", &ran, &changes[2..]),
        "c --bless --loosened"
    );
    assert_eq!(blessing(&PROJECT, "c", &ran, &[]), "c --bless");
}

#[test]
fn a_study_is_withdrawn_on_demand() {
    let [a, b] = ["a", "b"].map(|id| header(id, &SETTINGS));
    let mut baseline = blessed(&ran(&[a.clone(), b.clone()]));
    let known = [listed(study(&a).as_ref())];
    let ran_a = ran(&[a]);
    let refused = baseline.bless(&ran_a, Some(&known), false).unwrap_err();
    assert!(
        refused
            .to_string()
            .ends_with("\n  b: study was deleted: it had 1 guarded number"),
        "{refused}"
    );
    baseline.bless(&ran_a, Some(&known), true).unwrap();
    assert_eq!(baseline.compare(&ran_a, Some(&known)), []);
    assert_eq!(baseline.guards("b"), 0);
    // It comes back as a new one.
    let back = baseline.compare(&ran(&[b]), None);
    assert_eq!(words(&back)[0], "b: study is new");
}

/// What somebody may do to the file, by hand or in a merge.
#[test]
fn an_attack_on_the_file_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("baseline.json");
    let ran = claiming(Some(Must::AtMost(0.01)));
    let known = [ran[0].header.clone()];
    blessed(&ran).write(&file).unwrap();
    let text = fs::read_to_string(&file).unwrap();
    let line = "\n        \"finest error\": [0.00234375, 0.001, \"<= 0.01\"]\n      ";
    let settings = text.lines().find(|line| line.contains("settings")).unwrap();
    for (from, to, expected) in [
        (
            "0.00234375",
            "0.0024",
            "a: finest error moved from 0.0024 to 0.00234375",
        ),
        (
            "0.00234375",
            "null",
            "a: finest error moved from NaN to 0.00234375",
        ),
        (
            "0.001",
            "0.1",
            "a: finest error has another tolerance: was 1e-1, is 1e-3",
        ),
        (
            "0.001",
            "1e300",
            "a: finest error has another tolerance: was 1e300, is 1e-3",
        ),
        (
            "<= 0.01",
            "<= 0.1",
            "a: finest error has a tighter claim: was <= 0.1, is <= 0.01",
        ),
        (
            "<= 0.01",
            "<= 1e-4",
            "a: finest error has a looser claim: was <= 1e-4, is <= 0.01",
        ),
        (
            ", \"<= 0.01\"",
            "",
            "a: finest error was deleted from the baseline, which has it in its hash",
        ),
        (
            line,
            "",
            "a: finest error was deleted from the baseline, which has it in its hash",
        ),
        ("finest", "coarsest", "a: settings have changed"),
        ("\"a\"", "\"b\"", "a: study is new"),
        (
            settings,
            "",
            "a: settings have no hash in the baseline, which guards the study",
        ),
        (
            "\"settings\": \"",
            "\"settings\": \"0",
            "a: settings have changed: hash 0",
        ),
        (
            settings,
            "\"guard\": 0.1,",
            "a: settings have no hash in the baseline",
        ),
        (
            "\"numbers\"",
            "\"guard\": 0.1, \"numbers\"",
            "a: guard was 1e-1, is none",
        ),
    ] {
        let edited = text.replace(from, to);
        assert_ne!(edited, text, "{from}");
        fs::write(&file, edited).unwrap();
        let changes = words(&Baseline::read(&file).unwrap().compare(&ran, Some(&known)));
        assert!(changes[0].starts_with(expected), "{from}: {changes:?}");
    }
    // Emptied, it guards nothing, and everything is new.
    fs::write(&file, "{ \"schema\": 3, \"studies\": {} }").unwrap();
    let changes = Baseline::read(&file).unwrap().compare(&ran, Some(&known));
    assert_eq!(
        words(&changes),
        ["a: study is new", "a: finest error is new: 0.00234375"]
    );
}

/// A number that was guarded does not come back as a new one.
#[test]
fn a_line_that_was_deleted_is_blessed_on_demand_and_a_new_number_as_ever() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("baseline.json");
    let ran = claiming(Some(Must::AtMost(0.01)));
    blessed(&ran).write(&file).unwrap();
    let text = fs::read_to_string(&file).unwrap();
    let line = "\n        \"finest error\": [0.00234375, 0.001, \"<= 0.01\"]\n      ";
    for deleted in [line, ", \"<= 0.01\""] {
        fs::write(&file, text.replace(deleted, "")).unwrap();
        let mut baseline = Baseline::read(&file).unwrap();
        let refused = baseline.bless(&ran, None, false).unwrap_err().to_string();
        assert!(
            refused.contains("finest error was deleted from the baseline"),
            "{refused}"
        );
        assert_eq!(baseline.bless(&ran, None, true).unwrap().len(), 1);
        assert_eq!(baseline.compare(&ran, None), []);
    }
    let mut more = ran.clone();
    let mut quantity = ran[0].outcome.quantities[0].clone();
    quantity.name = "another".to_owned();
    more[0].outcome.quantities.push(quantity);
    let mut baseline = blessed(&ran);
    assert_eq!(
        words(&baseline.compare(&more, None)),
        ["a: another is new: 0.00234375"]
    );
    assert_eq!(baseline.bless(&more, None, false), Ok(vec![]));
}

#[test]
fn a_diagnosis_names_claims_that_changed() {
    let headers = ["a", "b"].map(|id| header(id, &SETTINGS));
    let baseline = blessed(&ran(&headers));
    let loose = with("expect[0].tolerance", Some("0.49"));
    let diagnosed = |headers: [&Header; 2], does: Does| {
        let studies = headers.map(|header| {
            let header = header.clone();
            Fake {
                header,
                ..fake("", does)
            }
            .erased()
        });
        let ran = finished(studies.into());
        diagnose(&ran, &baseline.compare(&ran, None))
    };
    let changed = one_of_settings(
        &baseline.compare(&ran(std::slice::from_ref(&loose)), None),
        "a",
    );
    let found = diagnosed([&loose, &headers[1]], Does::Stay).expect("a study fails");
    assert_eq!(found.claims, [changed.as_str()]);
    let lines = found.lines();
    assert_eq!(lines[0], ("claims", format!("changed: {changed}")));
    // Where nothing fails and no number moved, the list of changed claims says it all.
    assert_eq!(diagnosed([&loose, &headers[1]], Does::Converge), None);
    let found = diagnosed([&headers[0], &headers[1]], Does::Stay).expect("a study fails");
    assert!(found.claims.is_empty(), "{found:?}");
}

fn run(root: &Path, header: &Header, bless: bool, loosened: bool) -> Verification {
    let scope = Scope::Tier(Tier::Quick, vec![listed(study(header).as_ref())]);
    let request = VerifyRequest {
        scope,
        bless,
        loosened,
        ..request(root, &[])
    };
    verify(&PROJECT, &[study(header)], &request, &|_| {}).unwrap()
}

#[test]
fn changed_settings_fail_the_run_and_are_in_every_report() {
    let root = tempfile::tempdir().unwrap();
    let first = header("a", &SETTINGS);
    assert_eq!(
        run(root.path(), &first, true, false).record.verdict,
        Verdict::Pass
    );
    let baseline = root.path().join("studies/baseline.json");
    let before = fs::read(&baseline).unwrap();

    let loose = with("expect[0].tolerance", Some("0.49"));
    let changes = Baseline::read(&baseline)
        .unwrap()
        .compare(&ran(std::slice::from_ref(&loose)), None);
    let change = one_of_settings(&changes, "a");
    let why = change.strip_prefix("a: ").unwrap();
    for bless in [false, true] {
        let found = run(root.path(), &loose, bless, false);
        assert_eq!(
            (
                found.record.studies[0].outcome.verdict,
                found.record.verdict
            ),
            (Verdict::Pass, Verdict::Fail)
        );
        assert!(!matches!(found.blessing, Blessing::Taken(_)));
        assert_eq!(fs::read(&baseline).unwrap(), before);
        let report = |name: &str| {
            fs::read_to_string(root.path().join("reports/local/quick").join(name)).unwrap()
        };
        let readme = report("README.md");
        assert!(
            readme.contains(&format!("\n## Claims changed\n\n- a: {why}\n")),
            "{readme}"
        );
        assert!(readme.contains("`cargo xtask verify --bless --loosened`"));
        let page = report("index.html");
        assert!(page.contains(&format!("<li>a: {why}</li>")), "{page}");
        assert!(report("results.json").contains(&change));
        let xml = junit(PROJECT.name, &found.record).unwrap();
        assert_eq!(report("junit.xml"), xml);
        assert!(
            xml.contains("a: settings") && xml.contains("have changed: hash "),
            "{xml}"
        );
    }
    let taken = run(root.path(), &loose, true, true);
    assert_eq!(taken.record.verdict, Verdict::Pass);
    assert_eq!(taken.blessing, Blessing::Taken(changes));
    let again = run(root.path(), &loose, false, false);
    assert_eq!(again.record.verdict, Verdict::Pass);
}
