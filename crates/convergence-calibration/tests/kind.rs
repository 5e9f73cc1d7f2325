//! The kind of study: each expectation can fail, and what a file has wrong is refused.

use std::path::{Path, PathBuf};

use convergence_calibration::kind::{Calibration, ROW};
use convergence_calibration::sheet::Sheet;
use convergence_study::{
    CaseFailure, FromFile, Header, Kind, Outcome, Verdict,
    internal::{input, study::kind::run_cases_here},
};

/// A file of the repository's `studies/`.
fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../studies")
        .join(name)
}

fn text(name: &str) -> String {
    std::fs::read_to_string(file(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// All checks, with their evidence.
fn report(outcome: &Outcome) -> String {
    let checks = outcome
        .checks
        .iter()
        .map(|check| format!("{}: {} {}", check.claim, check.verdict, check.evidence));
    checks.collect::<Vec<_>>().join("\n")
}

/// Where the file has an expectation, a check bounds the value of a sheet from the stated side.
#[test]
fn each_share_can_be_too_large_or_too_small() {
    for name in ["rule-calibration.toml", "error-bars.toml"] {
        let study = Calibration::read(file(name)).unwrap_or_else(|error| panic!("{error}"));
        let sound = run_cases_here(&study);
        assert_eq!(
            study.judge(&sound).verdict,
            Verdict::Pass,
            "{}",
            report(&study.judge(&sound))
        );
        let failing = |plant: &dyn Fn(&mut Vec<Sheet>)| {
            let mut runs = sound.clone();
            for ran in &mut runs {
                plant(ran.found.as_mut().expect("a case that has run"));
            }
            let judged = study.judge(&runs);
            judged
                .checks
                .iter()
                .filter(|check| check.verdict == Verdict::Fail)
                .count()
        };
        let all = |value: f64| {
            move |found: &mut Vec<Sheet>| {
                found
                    .iter_mut()
                    .flat_map(|sheet| &mut sheet.rows)
                    .flat_map(|row| &mut row.cells)
                    .for_each(|cell| cell.set(value));
            }
        };
        let bounded = study.judge(&sound).checks.len() - 1;
        assert_eq!(
            failing(&all(2.0)) + failing(&all(0.0)),
            bounded,
            "{name}: each is bounded on one side"
        );
        assert_eq!(
            failing(&all(f64::NAN)),
            bounded,
            "{name}: a share of nothing is none"
        );
        assert!(failing(&|found: &mut Vec<Sheet>| found.clear()) > 0);
        for case in 0..sound.len() {
            let mut failed = sound.clone();
            failed[case].found = Err(CaseFailure::new("planted"));
            assert_eq!(
                study.judge(&failed).verdict,
                Verdict::Fail,
                "{name}: case {case}"
            );
        }
        assert_ne!(study.judge(&[]).verdict, Verdict::Pass);
    }
}

#[test]
fn a_sheet_column_or_row_that_is_not_there_fails() {
    for (from, to) in [
        ("sheet = \"noise\"", "sheet = \"noises\""),
        (
            "column = \"interval holds the limit\"",
            "column = \"interval holds\"",
        ),
        ("least = 0.87", "row = \"9 values\"\nleast = 0.87"),
    ] {
        let changed = text("error-bars.toml").replace(from, to);
        assert_ne!(changed, text("error-bars.toml"), "{from}");
        let text = changed.replace("tables = 1500", "tables = 1");
        let study = Calibration::parse(&text, &file("error-bars.toml"))
            .unwrap_or_else(|error| panic!("{error}"));
        let judged = study.judge(&run_cases_here(&study));
        let named = judged.checks.iter().any(|check| {
            check.verdict == Verdict::Fail && check.claim.to_string().contains(" has ")
        });
        assert!(named, "{to}: {}", report(&judged));
    }
}

/// The message about a study file with `from` replaced by `to`.
#[track_caller]
fn refusal(name: &str, from: &str, to: &str) -> String {
    let changed = text(name).replacen(from, to, 1);
    assert_ne!(changed, text(name), "{name} has no {from}");
    let read = input::parse_beside(
        &changed,
        &file(&format!("changed-{name}")),
        |root, folder| (ROW.read)(Header::from_document(root)?, root, folder),
    );
    read.err()
        .unwrap_or_else(|| panic!("{name} with {to} is read"))
        .to_string()
}

#[test]
fn files_with_errors_are_refused() {
    for (from, to, message) in [
        ("tables = 4", "tables = 0", "tables"),
        (
            "tables = 4",
            "tables = 1000000000000",
            "tables: found 1000000000000",
        ),
        ("of = \"rule\"", "of = \"rules\"", "rule"),
        ("most = 0.0029", "most = -1", "most"),
        ("most = 0.0029", "", "one of the two"),
        ("column = ", "columns = ", "columns"),
    ] {
        let error = refusal("rule-calibration.toml", from, to);
        assert!(error.contains(message), "{error}");
    }
}
