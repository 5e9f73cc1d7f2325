use convergence_study::judge::calibration::Calibration;
use convergence_study::judge::calibration::bars::Bars;
use convergence_study::judge::verdict::Verdict;
use convergence_study::study::{CaseFailure, FromFile, Header, Kind, run_cases_here};
use thermobeam_study::kinds::calibration::bars::{self, BarCalibration};
use thermobeam_study::kinds::calibration::{Counted, ROW, RuleCalibration};

use crate::refused::refusal;
use crate::typed::{changed, report};
use crate::{file, text};

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

#[test]
fn bars_can_hold_too_little_be_refused_too_often_or_be_too_long() {
    let read = |from: &str, to: &str| {
        let changed = text("error-bars.toml").replacen(from, to, 1);
        convergence_study::input::parse_beside(&changed, &file("error-bars.toml"), |root, folder| {
            BarCalibration::from_document(Header::from_document(root)?, root, folder)
        })
        .unwrap_or_else(|error| panic!("{error}"))
    };
    let study = read("", "");
    let sound = run_cases_here(&study);
    assert_eq!(study.judge(&sound).verdict, Verdict::Pass, "{}", report(&study.judge(&sound)));
    let planted: [Defect<Bars>; 4] = [
        ("all bars miss", |found| found.declared.bars[1] = 0),
        ("those of a law miss", |found| found.laws[3].bars[1] /= 2),
        ("those of six values miss", |found| found.by_values[3].bars[1] /= 2),
        ("none is given", |found| found.declared.bars = [0, 0]),
    ];
    for (what, plant) in planted {
        let runs = changed::<BarCalibration>(&sound, |_, found| plant(found));
        assert_eq!(study.judge(&runs).verdict, Verdict::Fail, "{what}");
    }
    for (from, to) in [("width = 0.2", "width = 0.1"), ("refused = 0.27", "refused = 0.2")] {
        assert_eq!(read(from, to).judge(&sound).verdict, Verdict::Fail, "{to}");
    }
    assert_ne!(study.judge(&[]).verdict, Verdict::Pass);
    for (from, to, message) in [
        ("samples = 150", "samples = 1", "bars.samples"),
        ("coverage = 0.95", "coverage = 1.5", "bars.coverage"),
        ("width = ", "length = ", "length"),
    ] {
        let error = refusal(&bars::ROW, "error-bars.toml", from, to);
        assert!(error.contains(message), "{error}");
    }
}
