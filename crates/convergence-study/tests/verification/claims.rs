//! Claims: the baseline keeps the content of a study file, value by value.

use std::fs;
use std::path::Path;

use convergence_study::{
    Blessing, Header, Project, Scope, SourcePlace, Study, Tier, Verdict, Verification,
    VerifyRequest,
    internal::{
        report::{blessing, sentence},
        store::{Baseline, BlessedClaim, GuardedChange, diagnosis::diagnose, junit},
    },
    verify,
};

use super::fake::{Does, Fake, PROJECT, fake, finished, request};

const CLAIMS: [(&str, &str); 3] = [
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

/// The claims with another value at a path; `None`: without that path.
fn with(path: &str, value: Option<&'static str>) -> Header {
    let mut settings = CLAIMS.to_vec();
    settings.retain(|(of, _)| *of != path);
    settings.extend(value.map(|value| (path.to_owned().leak() as &str, value)));
    header("a", &settings)
}

fn blessed(headers: &[Header]) -> Baseline {
    let mut baseline = Baseline::default();
    baseline
        .bless(&finished(headers.iter().map(study).collect()), None, None)
        .unwrap();
    baseline
}

fn words(changes: &[GuardedChange]) -> Vec<String> {
    changes.iter().map(ToString::to_string).collect()
}

#[test]
fn every_value_that_changed_is_named() {
    let baseline = blessed(&[header("a", &CLAIMS)]);
    for (path, value, expected) in [
        ("expect[0].tolerance", Some("0.002"), None),
        (
            "expect[0].tolerance",
            Some("0.49"),
            Some("a: claim expect[0].tolerance: was 0.002, is 0.49"),
        ),
        (
            "study.tier",
            Some("\"full\""),
            Some("a: claim study.tier: was \"quick\", is \"full\""),
        ),
        (
            "expect[0].order",
            None,
            Some("a: claim expect[0].order: was 1, is absent"),
        ),
        (
            "planted",
            Some("0.5"),
            Some("a: claim planted: was absent, is 0.5"),
        ),
    ] {
        let changes = baseline.compare(&finished(vec![study(&with(path, value))]), None);
        assert_eq!(
            words(&changes),
            expected.map(str::to_owned).into_iter().collect::<Vec<_>>()
        );
    }
}

#[test]
fn a_changed_claim_names_the_norm_that_it_is_about() {
    let norm = ("expect[0].norm", "\"L2\"");
    let former = header("a", &[CLAIMS[0], CLAIMS[1], CLAIMS[2], norm]);
    let baseline = blessed(&[former]);
    for (settings, message) in [
        (
            vec![CLAIMS[0], CLAIMS[1], ("expect[0].tolerance", "0.49"), norm],
            "a, L2: tolerance 0.002, now 0.49",
        ),
        (
            vec![CLAIMS[0], CLAIMS[1], norm],
            "a, L2: tolerance 0.002 removed",
        ),
        (
            vec![
                CLAIMS[0],
                CLAIMS[1],
                CLAIMS[2],
                norm,
                ("expect[0].floor", "1"),
            ],
            "a, L2: floor 1 added",
        ),
        (
            vec![("study.tier", "\"full\""), CLAIMS[1], CLAIMS[2], norm],
            "a: study.tier \"quick\", now \"full\"",
        ),
        (
            vec![
                CLAIMS[0],
                CLAIMS[1],
                CLAIMS[2],
                ("expect[0].norm", "\"H1\""),
            ],
            "a, H1: norm \"L2\", now \"H1\"",
        ),
    ] {
        let changes = baseline.compare(&finished(vec![study(&header("a", &settings))]), None);
        assert_eq!(
            changes.iter().map(GuardedChange::words).collect::<Vec<_>>(),
            [message]
        );
    }
}

#[test]
fn claims_of_studies_that_are_not_run_are_compared_too() {
    let [a, b, gone] = ["a", "b", "gone"].map(|id| header(id, &CLAIMS));
    let baseline = blessed(&[a.clone(), b, gone]);
    let loose = header(
        "b",
        &[("expect[0].tolerance", "0.49"), CLAIMS[0], CLAIMS[1]],
    );
    let known = [a.clone(), loose, header("new", &CLAIMS)];
    let ran = finished(vec![study(&a)]);
    let expected = [
        "b: claim expect[0].tolerance: was 0.002, is 0.49",
        "new: study file is new: 3 values",
        "gone: study file was deleted: it had 3 values",
    ];
    let changes = baseline.compare(&ran, Some(&known));
    assert_eq!(words(&changes), expected);
    assert!(
        baseline.compare(&ran, None).is_empty(),
        "a selection looks at itself alone"
    );
    assert!(
        sentence(&ran, Some(&changes))
            .ends_with("; 1 study deleted, 1 claim changed, 1 study not yet in the baseline")
    );
    // The tier that runs a study blesses it.
    assert_eq!(
        blessing(&PROJECT, "cargo xtask verify", &ran, &changes),
        "cargo xtask verify --tier full --bless"
    );
    assert_eq!(blessing(&PROJECT, "c", &ran, &changes[2..]), "c --bless");
}

#[test]
fn a_changed_claim_is_blessed_with_a_reason_which_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("baseline.json");
    let mut baseline = blessed(&[header("a", &CLAIMS)]);
    let before = baseline.clone();
    let loose = with("expect[0].tolerance", Some("0.49"));
    let ran = || finished(vec![study(&loose)]);
    let refused = baseline.bless(&ran(), None, None).unwrap_err();
    let said = refused.to_string();
    assert!(
        said.ends_with("--bless --reason TEXT\n  a: claim expect[0].tolerance: was 0.002, is 0.49"),
        "{said}"
    );
    assert_eq!(baseline, before);

    baseline
        .bless(&ran(), None, Some("three levels only"))
        .unwrap();
    // Another blessing does not change value and reason.
    baseline.bless(&ran(), None, Some("another")).unwrap();
    baseline.bless(&ran(), None, None).unwrap();
    baseline.write(&file).unwrap();
    let baseline = Baseline::read(&file).unwrap();
    let kept = BlessedClaim {
        value: Some("0.49".to_owned()),
        reason: Some("three levels only".to_owned()),
    };
    assert_eq!(baseline.claim("a", "expect[0].tolerance"), Some(&kept));
    assert_eq!(
        baseline.claim("a", "expect[0].order"),
        Some(&BlessedClaim {
            value: Some("1".to_owned()),
            reason: None
        })
    );
    assert!(baseline.compare(&ran(), None).is_empty());
}

#[test]
fn a_claim_or_a_study_is_withdrawn_with_a_reason_which_stays() {
    let [a, b] = ["a", "b"].map(|id| header(id, &CLAIMS));
    let mut baseline = blessed(&[a.clone(), b]);
    let ran = || finished(vec![study(&a)]);
    let refused = baseline
        .bless(&ran(), Some(std::slice::from_ref(&a)), None)
        .unwrap_err();
    assert!(
        refused
            .to_string()
            .ends_with("\n  b: study file was deleted: it had 3 values"),
        "{refused}"
    );
    baseline
        .bless(
            &ran(),
            Some(std::slice::from_ref(&a)),
            Some("b is a special case of a"),
        )
        .unwrap();
    assert!(
        baseline
            .compare(&ran(), Some(std::slice::from_ref(&a)))
            .is_empty()
    );
    let withdrawn = |reason: &str| BlessedClaim {
        value: None,
        reason: Some(reason.to_owned()),
    };
    assert_eq!(
        baseline.claim("b", "study.id"),
        Some(&withdrawn("b is a special case of a"))
    );
    assert_eq!(baseline.guards("b"), 0);

    let less = with("expect[0].order", None);
    baseline
        .bless(&finished(vec![study(&less)]), None, Some("no theory"))
        .unwrap();
    assert_eq!(
        baseline.claim("a", "expect[0].order"),
        Some(&withdrawn("no theory"))
    );
    let back = baseline.compare(&ran(), None);
    assert_eq!(words(&back), ["a: claim expect[0].order: was absent, is 1"]);
}

#[test]
fn claims_that_were_taken_out_of_the_baseline_need_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("baseline.json");
    let a = header("a", &CLAIMS);
    blessed(std::slice::from_ref(&a)).write(&file).unwrap();
    let mut object: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
    for claims in [serde_json::json!({}), serde_json::json!({ "a": {} })] {
        object["claims"] = claims;
        fs::write(&file, object.to_string()).unwrap();
        let mut baseline = Baseline::read(&file).unwrap();
        let ran = || finished(vec![study(&a)]);
        let message =
            "a: study file has no claims in the baseline, which guards 1 of its numbers: 3 values";
        assert_eq!(words(&baseline.compare(&ran(), None)), [message]);
        let changes = baseline.compare(&ran(), None);
        assert_eq!(blessing(&PROJECT, "c", &ran(), &changes), "c --bless");
        let refused = baseline.bless(&ran(), None, None).unwrap_err().to_string();
        assert!(refused.ends_with(&format!(
            " needs a reason; repeat it with --bless --reason TEXT\n  {message}"
        )));
        let mut accepted = baseline.clone();
        baseline
            .bless(&ran(), None, Some("merged by hand"))
            .unwrap();
        accepted
            .accept(&ran(), &changes[0], "merged by hand")
            .unwrap();
        for baseline in [baseline, accepted] {
            let kept = BlessedClaim {
                value: Some("1".to_owned()),
                reason: Some("merged by hand".to_owned()),
            };
            assert_eq!(baseline.claim("a", "expect[0].order"), Some(&kept));
            assert!(baseline.compare(&ran(), None).is_empty());
        }
    }
}

#[test]
fn a_diagnosis_names_claims_that_changed_and_no_solver() {
    let baseline = blessed(&[header("a", &CLAIMS), header("b", &CLAIMS)]);
    let loose = with("expect[0].tolerance", Some("0.49"));
    let failing = Fake {
        header: loose.clone(),
        ..fake("", Does::Stay)
    }
    .erased();
    let project = Project {
        places: &[SourcePlace {
            word: "finest error",
            place: "force.rs",
        }],
        ..PROJECT
    };
    let diagnosed = |study: Box<dyn Study>| {
        let ran = finished(vec![study]);
        diagnose(&project, &[], &ran, &baseline.compare(&ran, None))
    };
    let found = diagnosed(failing).expect("a study fails");
    assert_eq!(found.claims, ["a: expect[0].tolerance 0.002, now 0.49"]);
    let lines = found.lines();
    assert!(
        lines[0]
            == (
                "claims",
                "changed: a: expect[0].tolerance 0.002, now 0.49".to_owned()
            ),
        "{lines:?}"
    );
    assert!(!format!("{lines:?}").contains("force"), "{lines:?}");
    // Where nothing fails and no number moved, the list of changed claims says it all.
    assert_eq!(diagnosed(study(&loose)), None);
    // Without a changed claim a place is named.
    let same = Fake {
        header: header("b", &CLAIMS),
        ..fake("", Does::Stay)
    }
    .erased();
    let found = diagnosed(same).expect("a study fails");
    assert!(
        found.claims.is_empty() && found.look_at == ["force.rs"],
        "{found:?}"
    );
}

fn run(root: &Path, header: &Header, bless: bool) -> Verification {
    let scope = Scope::Tier(Tier::Quick, vec![header.clone()]);
    let request = VerifyRequest {
        scope,
        bless,
        ..request(root, &[])
    };
    verify(&PROJECT, &[study(header)], &request, &|_| {}).unwrap()
}

#[test]
fn a_changed_claim_fails_the_run_and_is_in_every_report() {
    let root = tempfile::tempdir().unwrap();
    let first = header("a", &CLAIMS);
    assert_eq!(run(root.path(), &first, true).record.verdict, Verdict::Pass);
    let baseline = root.path().join("studies/baseline.json");
    let before = fs::read(&baseline).unwrap();

    let loose = with("expect[0].tolerance", Some("0.49"));
    let found = run(root.path(), &loose, false);
    assert_eq!(
        (
            found.record.studies[0].outcome.verdict,
            found.record.verdict
        ),
        (Verdict::Pass, Verdict::Fail)
    );
    assert_ne!(found.blessing, Blessing::Taken);
    assert_eq!(fs::read(&baseline).unwrap(), before);
    let report = |name: &str| {
        fs::read_to_string(root.path().join("reports/local/quick").join(name)).unwrap()
    };
    assert!(
        report("README.md").contains(
            "\n## Claims changed\n\n- [a](#a): expect\\[0\\].tolerance 0.002, now 0.49\n"
        )
    );
    assert!(report("README.md").contains("`cargo xtask verify --bless`"));
    assert!(
        report("index.html")
            .contains("<li><a href=\"#a\">a</a>: expect[0].tolerance 0.002, now 0.49</li>"),
        "{}",
        report("index.html")
    );
    assert!(report("results.json").contains("a: claim expect[0].tolerance: was 0.002, is 0.49"));
    let xml = junit(PROJECT.name, &found.record);
    assert_eq!(report("junit.xml"), xml);
    assert!(
        xml.contains("a: claim expect[0].tolerance") && xml.contains("was 0.002, is 0.49"),
        "{xml}"
    );
    assert_eq!(run(root.path(), &loose, true).record.verdict, Verdict::Pass);
    assert_eq!(
        run(root.path(), &loose, false).record.verdict,
        Verdict::Pass
    );
}
