//! The studies: each bound can fail, and so does a share that is not there.

use convergence_calibration::sheet::Sheet;
use convergence_calibration::studies::{ExpectedShare, error_bars, quick};
use convergence_study::{CaseFailure, Kind, Outcome, Verdict};

/// All checks, with their evidence.
fn report(outcome: &Outcome) -> String {
    let checks = outcome
        .checks
        .iter()
        .map(|check| format!("{}: {} {}", check.claim, check.verdict, check.evidence));
    checks.collect::<Vec<_>>().join("\n")
}

/// Where the study has a bound, a check bounds the value of a sheet from the stated side.
#[test]
fn each_share_can_be_too_large_or_too_small() {
    for (name, study) in [("quick", quick()), ("error bars", error_bars())] {
        let study = study.kind;
        let sound = study.run_here();
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
    let sound = error_bars().kind;
    let ran = sound.run_here();
    let changes: [fn(&mut ExpectedShare); 3] = [
        |share| share.sheet = "noises",
        |share| share.column = "interval holds",
        |share| share.row = "9 values",
    ];
    for change in changes {
        let mut study = sound.clone();
        study.expected.iter_mut().for_each(change);
        let judged = study.judge(&ran);
        assert_eq!(judged.verdict, Verdict::Fail, "{}", report(&judged));
    }
}
