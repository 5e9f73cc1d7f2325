//! The whole way, on disk: what no command shows. The rest is in the transcript of `verify`.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::{Progress, TestRun, VerifyRequest, store::NEWEST};

use super::fake::{Does, PROJECT, finished, passing, request, says, study};

/// The files of a report that git holds, and those that it ignores, but for the page.
fn committed(reports: &Path) -> BTreeMap<String, Vec<u8>> {
    let folders = [reports.to_owned(), reports.join("figures")];
    let entries = folders
        .iter()
        .flat_map(|folder| fs::read_dir(folder).into_iter().flatten());
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .filter(|path| path.is_file() && !path.ends_with("index.html"))
        .map(|path| (path.display().to_string(), fs::read(&path).unwrap()))
        .collect()
}

fn is_ignored(path: &str) -> bool {
    NEWEST.iter().any(|name| path.ends_with(name))
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
    let studies = [passing("a")];
    PROJECT.verify(&studies, &bless, &|_| {}).unwrap();
    let before = committed(&reports);
    let shown = || NEWEST.iter().filter(|name| reports.join(name).exists());
    assert_eq!(shown().count(), NEWEST.len());
    let seen = AtomicUsize::new(0);
    let count = |_: Progress| {
        seen.fetch_max(1 + shown().count(), Ordering::Relaxed);
    };
    PROJECT.verify(&studies, &plain, &count).unwrap();
    assert_eq!(seen.into_inner(), 1);
    assert_eq!(committed(&reports), before);
    // A run that ends without a result leaves none, and what git holds as it was.
    let twice = [study("a", Does::DrawTwice)];
    let error = PROJECT.verify(&twice, &plain, &|_| {}).unwrap_err();
    says(&error, "cannot be written");
    assert_eq!(shown().count(), 0);
    let kept = before.into_iter().filter(|(path, _)| !is_ignored(path));
    assert_eq!(committed(&reports), kept.collect());
}

#[test]
fn a_report_that_cannot_be_made_leaves_the_baseline_alone() {
    let root = tempfile::tempdir().unwrap();
    let bless = VerifyRequest {
        bless: true,
        ..request(root.path(), &["a"])
    };
    let twice = [study("a", Does::DrawTwice)];
    let failed = PROJECT.verify(&twice, &bless, &|_| {}).unwrap_err();
    let failed = failed.to_string();
    let said = "reports: the reports cannot be written: ";
    says(&failed, said);
    assert!(!root.path().join("studies/baseline.json").exists());
}

#[test]
fn a_report_that_cannot_be_written_says_whether_the_baseline_is_blessed() {
    let folder = tempfile::tempdir().unwrap();
    let report = folder.path().join("paper");
    fs::create_dir(&report).unwrap();
    fs::write(report.join("README.md"), "My paper\n").unwrap();
    let studies = finished(vec![passing("a")]);
    for bless in [false, true] {
        let run = TestRun {
            baseline: folder.path().join("baseline.json"),
            bless,
            loosened: false,
            options: "",
            report: Some(report.clone()),
            gone: vec![],
        };
        let error = run.finish(&PROJECT, &studies, &studies).unwrap_err();
        says(&error, "found in the place of a report");
        assert_eq!(
            error.to_string().ends_with("is blessed all the same"),
            bless
        );
        assert_eq!(run.baseline.is_file(), bless);
    }
}
