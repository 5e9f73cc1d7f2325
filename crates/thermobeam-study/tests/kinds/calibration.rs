use convergence_study::judge::calibration::Sheet;
use convergence_study::judge::verdict::Verdict;
use convergence_study::study::{CaseFailure, FromFile, Kind, run_cases_here};
use thermobeam_study::kinds::calibration::{Calibration, ROW};

use super::file;
use super::refused::refusal;
use super::typed::{changed, report};

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
            let runs = changed::<Calibration>(&sound, |_, found| plant(found));
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
                    .for_each(|row| row.values.fill(value));
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
        ("sheet = \"bars\"", "sheet = \"bar\""),
        ("column = \"refused\"", "column = \"refuse\""),
        ("row = \"all declared\"", "row = \"all\""),
    ] {
        let text = super::text("error-bars.toml")
            .replace(from, to)
            .replace("tables = 150", "tables = 1");
        let study = Calibration::parse(&text, &file("error-bars.toml"))
            .unwrap_or_else(|error| panic!("{error}"));
        let judged = study.judge(&run_cases_here(&study));
        let named = judged
            .checks
            .iter()
            .any(|check| check.verdict == Verdict::Fail && check.claim.contains(" has "));
        assert!(named, "{to}: {}", report(&judged));
    }
}

#[test]
fn files_with_errors_are_refused() {
    for (from, to, message) in [
        ("tables = 4", "tables = 0", "tables"),
        ("of = \"rule\"", "of = \"rules\"", "rule"),
        ("most = 0.0029", "most = -1", "most"),
        ("most = 0.0029", "", "one of the two"),
        ("column = ", "columns = ", "columns"),
    ] {
        let error = refusal(&ROW, "rule-calibration.toml", from, to);
        assert!(error.contains(message), "{error}");
    }
}
