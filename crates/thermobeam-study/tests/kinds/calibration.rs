use convergence_study::judge::calibration::Calibration;
use convergence_study::judge::verdict::Verdict;
use convergence_study::study::{CaseFailure, FromFile, Kind, run_cases_here};
use thermobeam_study::kinds::calibration::{Counted, ROW, RuleCalibration};

use crate::file;
use crate::refused::refusal;
use crate::typed::{changed, report};

/// A change of what a case found, with its name.
type Defect<F> = (&'static str, fn(&mut F));

#[test]
fn each_share_can_be_too_large_or_too_small() {
    let study = RuleCalibration::read(file("rule-calibration.toml")).unwrap_or_else(|error| panic!("{error}"));
    let sound = run_cases_here(&study);
    assert_eq!(study.judge(&sound).verdict, Verdict::Pass, "{}", report(&study.judge(&sound)));
    let planted: [Defect<Calibration>; 6] = [
        ("wrong claims that pass", |found| found.families[0].false_pass = found.families[0].wrong),
        ("wrong claims that pass, over all", |found| found.declared.false_pass = found.declared.wrong),
        ("wrong claims that pass, by levels", |found| found.by_levels[0].false_pass = found.by_levels[0].wrong),
        ("right claims that fail", |found| found.families[0].false_fail = found.families[0].right),
        ("intervals that miss", |found| found.families[0].covered = 0),
        ("no wrong claim", |found| found.families[0].wrong = 0),
    ];
    for (what, plant) in planted {
        let runs = changed::<RuleCalibration>(&sound, |_, found| {
            let Counted::Families(found) = found else { return };
            plant(found);
            // Of no samples a share is NaN.
            if found.families[0].wrong == 0 {
                found.families[0].false_pass = 0;
            }
        });
        assert_eq!(study.judge(&runs).verdict, Verdict::Fail, "{what}");
    }
    for case in 0..sound.len() {
        let mut failed = sound.clone();
        failed[case].found = Err(CaseFailure { reason: "planted".into() });
        assert_ne!(study.judge(&failed).verdict, Verdict::Pass, "case {case}");
    }
    let hidden = changed::<RuleCalibration>(&sound, |_, found| {
        if let Counted::Laws(found) = found {
            found.hidden[0][1][2] = 0.9;
        }
    });
    assert_eq!(study.judge(&hidden).verdict, Verdict::Fail, "hidden terms that pass");
    assert_ne!(study.judge(&[]).verdict, Verdict::Pass);
}

#[test]
fn files_with_errors_are_refused() {
    for (from, to, message) in [
        ("samples = 20000", "samples = 10", "calibration.samples"),
        ("false_pass = 0.01", "false_pass = 1.0", "calibration.false_pass"),
        ("coverage = 0.93", "covered = 0.93", "covered"),
        ("hidden = ", "hidden = 2", "laws.hidden"),
    ] {
        let error = refusal(&ROW, "rule-calibration.toml", from, to);
        assert!(error.contains(message), "{error}");
    }
}
