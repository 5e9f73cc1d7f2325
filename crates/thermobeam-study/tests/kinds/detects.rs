//! Laws of the matrix of faults in studies of manufactured solutions.

use std::sync::LazyLock;

use convergence_study::{CaseFailure, FromFile, Kind, Verdict, internal::study::run_cases_here};
use thermobeam_study::kinds::detects::{Detects, Fault, ROW};
use thermobeam_study::kinds::orders::manufactured::Convergence;

use super::file;
use super::refused::refusal;
use super::typed::{Runs, changed, counted, each_case_counts, report};
use thermobeam_study::exact::norm::Norm;

type Controls = Detects<Convergence>;

fn controls() -> Controls {
    Controls::read(file("negative-controls.toml")).unwrap_or_else(|error| panic!("{error}"))
}

static SOUND: LazyLock<Runs<Controls>> = LazyLock::new(|| run_cases_here(&controls()));

/// The errors under one fault in these cases, replaced by those under another.
fn replaced_where(is_meant: impl Fn(usize) -> bool, from: Fault, to: Fault) -> Runs<Controls> {
    changed::<Controls>(&SOUND, |index, results| {
        let errors = results
            .iter()
            .find(|(fault, _)| *fault == from)
            .map(|(_, errors)| errors.clone());
        let target = results.iter_mut().find(|(fault, _)| *fault == to);
        if let (true, Some(errors), Some((_, planted))) = (is_meant(index), errors, target) {
            *planted = errors;
        }
    })
}

fn replaced(from: Fault, to: Fault) -> Runs<Controls> {
    replaced_where(|_| true, from, to)
}

/// A study that decides nothing under a fault has not detected it.
#[test]
fn an_open_verdict_is_no_detection() {
    let study = controls();
    let row = &study.judge(&SOUND).tables[0].rows[7];
    assert_eq!(row[..3], ["g1", "fail", "inconclusive"]);
    let all_but_the_second = |index: usize| SOUND[index].case.data.study != 1;
    let runs = replaced_where(all_but_the_second, Fault::None, Fault::Coefficient("g1"));
    let outcome = study.judge(&runs);
    let check = outcome
        .checks
        .iter()
        .find(|check| check.claim == "g1 is detected".into());
    let check = check.expect("a check of g1");
    assert_eq!(
        (check.verdict, check.evidence.to_string().as_str()),
        (Verdict::Fail, "0 of 4 studies notice it")
    );
}

#[test]
fn a_fault_that_no_study_detects_fails_and_so_does_a_study_that_fails_without_one() {
    let study = controls();
    assert_eq!(
        study.judge(&SOUND).verdict,
        Verdict::Pass,
        "{}",
        report(&study.judge(&SOUND))
    );
    // One of the two studies has no heating at the end; no fault can be planted in a term that is
    // absent.
    let pairs = counted(&study.judge(&SOUND), "pairs of a study and a fault").clone();
    assert!(0 < pairs.judged && pairs.judged < pairs.asked, "{pairs}");
    // The wrong rho gets the errors of the run without a fault.
    let rho = Fault::Coefficient("rho");
    let blind = study.judge(&replaced(Fault::None, rho));
    assert_eq!(blind.verdict, Verdict::Fail);
    let undetected: Vec<_> = blind
        .checks
        .iter()
        .filter(|check| check.verdict == Verdict::Fail)
        .collect();
    assert_eq!(undetected.len(), 1);
    assert!(undetected[0].claim.to_string().contains("rho"));
    let broken = study.judge(&replaced(rho, Fault::None));
    assert_eq!(broken.verdict, Verdict::Fail);
    // The studies that do not pass are named, since the fault is in them.
    let honest = broken
        .checks
        .iter()
        .find(|check| check.claim.to_string().starts_with("without a fault"))
        .unwrap();
    assert!(
        honest.evidence.to_string().contains(" pass; not ")
            && honest.evidence.to_string().contains("theorem-3.4-space"),
        "{honest:?}"
    );
}

#[test]
fn a_failed_level_and_an_honest_error_that_is_not_finite_fail() {
    let study = controls();
    for case in 0..SOUND.len() {
        let mut failed = SOUND.clone();
        failed[case].found = Err(CaseFailure::new("planted"));
        let outcome = study.judge(&failed);
        assert_eq!(outcome.verdict, Verdict::Fail, "case {case}");
        assert!(report(&outcome).contains("planted"));
        let broken = changed::<Controls>(&SOUND, |index, found| {
            for (fault, errors) in found.iter_mut().filter(|_| index == case) {
                if let (Fault::None, Ok(errors)) = (*fault, errors) {
                    errors[Norm::Theorem34] = f64::NAN;
                }
            }
        });
        assert_eq!(study.judge(&broken).verdict, Verdict::Fail, "case {case}");
    }
    assert_ne!(study.judge(&[]).verdict, Verdict::Pass);
    each_case_counts(&study, &SOUND);
}

#[test]
fn files_with_errors_are_refused() {
    for (name, from, to, message) in [
        (
            "negative-controls.toml",
            "relative = 1e-4",
            "relative = 1.0",
            "controls.relative",
        ),
        (
            "negative-controls.toml",
            "\"theorem-3.4-space.toml\"",
            "\"frequencies.toml\"",
            "kind",
        ),
        (
            "negative-controls.toml",
            "[controls]",
            "[control]",
            "control",
        ),
        (
            "negative-controls.toml",
            "[controls]",
            "[any-order]\n[controls]",
            "one of the tables",
        ),
    ] {
        let error = refusal(&ROW, name, from, to);
        assert!(error.contains(message), "{error}");
    }
}
