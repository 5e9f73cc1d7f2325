//! The whole way, on disk.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::{
    Blessing, Header, Progress, Scope, Study, Tier, Verdict, Verification, VerifyRequest,
    store::NEWEST, verify,
};

use super::fake::{Does, Fake, PROJECT, fake, ids, jobs, request, study};

fn run(studies: Vec<Box<dyn Study>>, request: &VerifyRequest) -> Verification {
    verify(&PROJECT, &studies, request, &|_| {}).unwrap()
}

/// The files directly in a folder and in its figures, except the page, which belongs to one run.
fn committed(reports: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = |folder: &Path| {
        let entries = fs::read_dir(folder)
            .into_iter()
            .flatten()
            .map(|entry| entry.unwrap().path());
        entries
            .filter(|path| {
                path.is_file() && path.file_name().is_some_and(|name| name != "index.html")
            })
            .map(|path| (path.display().to_string(), fs::read(&path).unwrap()))
            .collect::<Vec<_>>()
    };
    files(reports)
        .into_iter()
        .chain(files(&reports.join("figures")))
        .collect()
}

#[test]
fn a_run_that_is_new_fails_until_it_is_blessed() {
    let root = tempfile::tempdir().unwrap();
    let plain = request(root.path(), &["a"]);
    let unknown = run(vec![study("a", Does::Converge)], &plain);
    assert_eq!(
        (unknown.record.verdict, unknown.record.moves().len()),
        (Verdict::Fail, 2)
    );
    let blessed = run(
        vec![study("a", Does::Converge)],
        &VerifyRequest {
            bless: true,
            ..plain.clone()
        },
    );
    assert_eq!(
        (blessed.record.verdict, blessed.blessing),
        (Verdict::Pass, Blessing::Taken(vec![]))
    );
    assert_eq!(
        run(vec![study("a", Does::Converge)], &plain).record.verdict,
        Verdict::Pass
    );
    let moved = Fake {
        scale: 1.5,
        ..fake("a", Does::Converge)
    };
    let moved = run(vec![moved.erased()], &plain);
    assert_eq!(
        (
            moved.record.studies[0].outcome.verdict,
            moved.record.verdict
        ),
        (Verdict::Pass, Verdict::Fail)
    );
    assert!(
        fs::read_to_string(root.path().join("reports/local/quick/README.md"))
            .unwrap()
            .contains("by +50 %")
    );
}

/// The files of a report that git ignores.
fn is_ignored(path: &str) -> bool {
    NEWEST.iter().any(|name| path.ends_with(name))
}

#[test]
fn a_run_that_does_not_pass_leaves_what_git_holds_and_shows_itself_to_programs() {
    let root = tempfile::tempdir().unwrap();
    let reports = root.path().join("reports");
    let local = reports.join("local/quick");
    let plain = request(root.path(), &["a"]);
    let bless = VerifyRequest {
        bless: true,
        ..plain.clone()
    };
    let passing = run(vec![study("a", Does::Converge)], &bless);
    assert_eq!(passing.reports, reports);
    let before = committed(&reports);
    let failing = run(vec![study("a", Does::Stay)], &plain);
    assert_eq!(
        (failing.record.verdict, failing.reports.as_path()),
        (Verdict::Fail, local.as_path())
    );
    let after = committed(&reports);
    let changed = |path: &&String| before.get(*path) != after.get(*path);
    let changed: Vec<&String> = before.keys().filter(changed).collect();
    assert!(
        before.keys().eq(after.keys())
            && !changed.is_empty()
            && changed.iter().all(|path| is_ignored(path)),
        "{changed:?}"
    );
    // Programs and browsers see the newest run; its whole report is in the local folder.
    for name in NEWEST {
        let own = fs::read(reports.join(name)).unwrap();
        assert_eq!(own, fs::read(local.join(name)).unwrap(), "{name}");
    }
    for name in ["README.md", "junit.xml", "index.html"] {
        let text = fs::read_to_string(local.join(name)).unwrap();
        assert!(text.contains("fail"), "{name}: {text}");
    }
    // The next run that passes removes it.
    let again = run(vec![study("a", Does::Converge)], &plain);
    assert_eq!(again.record.verdict, Verdict::Pass);
    assert!(!local.join("README.md").exists());
    assert_eq!(committed(&reports), before);
}

/// What a run finds in the folder while it is under way is what it leaves if it is killed then.
#[test]
fn no_program_reads_an_older_result_while_a_run_is_under_way() {
    let root = tempfile::tempdir().unwrap();
    let reports = root.path().join("reports");
    let plain = request(root.path(), &["a"]);
    let bless = VerifyRequest {
        bless: true,
        ..plain.clone()
    };
    run(vec![study("a", Does::Converge)], &bless);
    let before = committed(&reports);
    let shown = || NEWEST.iter().filter(|name| reports.join(name).exists());
    assert_eq!(shown().count(), NEWEST.len());
    let seen = AtomicUsize::new(0);
    let count = |_: Progress| {
        seen.fetch_max(1 + shown().count(), Ordering::Relaxed);
    };
    let studies = [study("a", Does::Converge)];
    verify(&PROJECT, &studies, &plain, &count).unwrap();
    assert_eq!(seen.into_inner(), 1);
    assert_eq!(committed(&reports), before);
    // A run that ends without a result leaves none, and what git holds as it was.
    let twice = [study("a", Does::DrawTwice)];
    let error = verify(&PROJECT, &twice, &plain, &|_| {}).unwrap_err();
    assert!(error.to_string().contains("cannot be written"), "{error}");
    assert_eq!(shown().count(), 0);
    let kept = before.into_iter().filter(|(path, _)| !is_ignored(path));
    assert_eq!(committed(&reports), kept.collect());
}

#[test]
fn a_blessing_that_leaves_changes_does_not_write_what_git_holds() {
    let root = tempfile::tempdir().unwrap();
    let reports = root.path().join("reports");
    let bless = VerifyRequest {
        bless: true,
        ..request(root.path(), &["a"])
    };
    let scaled = |scale: f64| {
        let a = fake("a", Does::Converge);
        vec![Fake { scale, ..a }.erased()]
    };
    run(scaled(1.0), &bless);
    let readme = || fs::read_to_string(reports.join("README.md")).unwrap();
    let before = readme();
    // Another tier has a study that is not in the baseline.
    let new = Header {
        settings: vec![("exponent".to_owned(), "1".to_owned())],
        ..fake("b", Does::Converge).header
    };
    let known = [ids(&["a"]), vec![new]].concat();
    let some = VerifyRequest {
        scope: Scope::Tier(Tier::Quick, known),
        ..bless
    };
    let left = run(scaled(1.5), &some);
    assert_eq!(
        (left.blessing, left.record.verdict),
        (Blessing::Taken(vec![]), Verdict::Fail)
    );
    assert_eq!(left.reports, reports.join("local/quick"));
    assert_eq!(readme(), before);
}

#[test]
fn a_failing_run_of_the_full_tier_leaves_both_reports() {
    let root = tempfile::tempdir().unwrap();
    let reports = root.path().join("reports");
    let full = |does: Does, bless: bool| {
        let studies = vec![study("a", does)];
        let headers = studies.iter().map(|study| study.header().clone()).collect();
        let request = VerifyRequest {
            scope: Scope::Tier(Tier::Full, headers),
            bless,
            ..request(root.path(), &["a"])
        };
        run(studies, &request)
    };
    run(
        vec![study("a", Does::Converge)],
        &VerifyRequest {
            bless: true,
            ..request(root.path(), &["a"])
        },
    );
    full(Does::Converge, true);
    let kept = |folder: &Path| {
        let mut files = committed(folder);
        files.retain(|path, _| !is_ignored(path));
        files
    };
    let before = [kept(&reports), kept(&reports.join("full"))];
    let failing = full(Does::Stay, false);
    assert_eq!(failing.reports, reports.join("local/full"));
    assert_eq!([kept(&reports), kept(&reports.join("full"))], before);
}

#[test]
fn a_report_that_cannot_be_made_leaves_the_baseline_alone() {
    let root = tempfile::tempdir().unwrap();
    let bless = VerifyRequest {
        bless: true,
        ..request(root.path(), &["a"])
    };
    let failed = verify(&PROJECT, &[study("a", Does::DrawTwice)], &bless, &|_| {})
        .unwrap_err()
        .to_string();
    assert!(
        failed.contains("reports: the reports cannot be written: "),
        "{failed}"
    );
    assert!(!root.path().join("studies/baseline.json").exists());
}

#[test]
fn a_blessing_does_not_turn_a_failing_study_green() {
    let root = tempfile::tempdir().unwrap();
    let bless = VerifyRequest {
        bless: true,
        ..request(root.path(), &["a"])
    };
    run(vec![study("a", Does::Converge)], &bless);
    let file = root.path().join("studies/baseline.json");
    let before = fs::read(&file).unwrap();
    let failing = run(vec![study("a", Does::Stay)], &bless);
    assert_eq!(failing.record.verdict, Verdict::Fail);
    assert!(matches!(failing.blessing, Blessing::Refused(_)));
    assert_eq!(fs::read(&file).unwrap(), before);
    // Nor does a baseline that agrees with what the failing study finds.
    let text = String::from_utf8(before).unwrap();
    let agreeing = text.replace("[0.00234375, 0.001]", "[1.0, 0.001]");
    assert_ne!(agreeing, text);
    fs::write(&file, agreeing).unwrap();
    let agreed = run(vec![study("a", Does::Stay)], &request(root.path(), &["a"]));
    assert_eq!(
        (agreed.record.moves().len(), agreed.record.verdict),
        (0, Verdict::Fail)
    );
}

#[test]
fn two_runs_leave_the_same_bytes_for_any_number_of_threads() {
    let root = tempfile::tempdir().unwrap();
    let reports = root.path().join("reports/local/quick");
    let studies = || {
        vec![
            study("a", Does::Converge),
            study("b", Does::Panic),
            study("c", Does::NotANumber),
        ]
    };
    let mut request = request(root.path(), &["a", "b", "c"]);
    run(studies(), &request);
    let first = committed(&reports);
    // Four files of the report, the picture of all rates, one figure for each study.
    assert_eq!(first.len(), 4 + 1 + 3);
    let page = || fs::read_to_string(reports.join("index.html")).unwrap();
    // A project without Rust was not compiled by what is installed here.
    assert!(!page().contains("rustc "));
    fs::write(root.path().join("Cargo.toml"), "").unwrap();
    for count in [1, 4] {
        request.effort = jobs(count).into();
        run(studies(), &request);
        assert_eq!(committed(&reports), first, "{count} threads");
    }
    let provenance = root.path().join("reports/local/provenance.json");
    let provenance = fs::read_to_string(provenance).unwrap();
    let provenance: serde_json::Value = serde_json::from_str(&provenance).unwrap();
    assert_eq!(
        (&provenance["jobs"], &provenance["command"]),
        (&4.into(), &"cargo xtask verify".into())
    );
    assert_eq!(provenance["studies"].as_array().unwrap().len(), 3);
    let page = page();
    for known in [
        format!("4 of {} threads.", provenance["threads_available"]),
        "UTC.".to_owned(),
        "rustc ".to_owned(),
    ] {
        assert!(page.contains(&known), "{known}");
    }
}

#[test]
fn a_part_does_not_replace_the_report_on_the_whole() {
    let root = tempfile::tempdir().unwrap();
    let reports = root.path().join("reports");
    let quick = request(root.path(), &["a", "b"]);
    let bless = VerifyRequest {
        bless: true,
        ..quick.clone()
    };
    let both = || vec![study("a", Does::Converge), study("b", Does::Converge)];
    run(both(), &bless);
    let whole = committed(&reports);
    let words = vec!["a".to_owned(), "b*".to_owned()];
    let part = run(
        vec![study("a", Does::Stay)],
        &VerifyRequest {
            scope: Scope::Selection(words),
            ..quick.clone()
        },
    );
    assert_eq!(part.reports, reports.join("local/partial"));
    assert_eq!(committed(&reports), whole);
    let page = fs::read_to_string(part.reports.join("README.md")).unwrap();
    assert!(
        page.contains("Written by `cargo xtask verify a 'b*'`"),
        "{page}"
    );

    let full = VerifyRequest {
        scope: Scope::Tier(Tier::Full, ids(&["a", "b"])),
        ..bless
    };
    run(both(), &full);
    assert_eq!(committed(&reports), whole);
    assert!(reports.join("full/README.md").is_file());
    // From now on the quick report links to the full one, and does not change again.
    run(both(), &quick);
    let page = fs::read_to_string(reports.join("README.md")).unwrap();
    assert!(
        page.contains("[the report on the full tier](full/README.md)"),
        "{page}"
    );
}

#[test]
fn a_selection_blesses_itself_alone() {
    let root = tempfile::tempdir().unwrap();
    let quick = request(root.path(), &["a", "b"]);
    let both = || vec![study("a", Does::Converge), study("b", Does::Converge)];
    run(
        both(),
        &VerifyRequest {
            bless: true,
            ..quick.clone()
        },
    );
    let scope = Scope::Selection(vec!["a".to_owned()]);
    let moved: Vec<Box<dyn Study>> = vec![
        Fake {
            scale: 2.0,
            ..fake("a", Does::Converge)
        }
        .erased(),
    ];
    assert_eq!(
        run(
            moved,
            &VerifyRequest {
                bless: true,
                scope,
                ..quick.clone()
            }
        )
        .record
        .verdict,
        Verdict::Pass
    );
    let after = run(both(), &quick);
    assert_eq!(
        after
            .record
            .moves()
            .iter()
            .map(|change| change.study.as_str())
            .collect::<Vec<_>>(),
        ["a"]
    );
}

#[test]
fn an_unusable_baseline_stops_everything_before_it_starts() {
    let root = tempfile::tempdir().unwrap();
    fs::create_dir_all(root.path().join("studies")).unwrap();
    fs::write(root.path().join("studies/baseline.json"), "{").unwrap();
    let studies = [study("a", Does::Converge)];
    let stopped = verify(&PROJECT, &studies, &request(root.path(), &["a"]), &|_| {
        panic!("nothing may run")
    })
    .unwrap_err();
    assert!(stopped.to_string().contains("baseline.json: "), "{stopped}");
    assert!(!root.path().join("reports").exists());
}
