//! Laws of planted faults: each counts, and so does the run without one.

use std::sync::LazyLock;
use thermobeam_study::kinds::orders::any_order::AnyOrder;
use thermobeam_study::studies::faults::{self, Fault, Faults, Plantable};

use super::*;

static CONTROLS: LazyLock<Sound<Faults<Convergence>>> =
    LazyLock::new(|| Sound::run(faults::study().kind));

const RHO: Fault = Fault::Coefficient("rho");

/// The outcome if the results under one fault in these cases are those under another.
fn replaced<S: Plantable>(
    sound: &Sound<Faults<S>>,
    [from, to]: [Fault; 2],
    is_meant: impl Fn(usize) -> bool,
) -> Outcome {
    sound.with(|index, results| {
        let mut known = results.iter().filter(|(fault, _)| *fault == from);
        let errors = known.next().map(|(_, errors)| errors.clone());
        let target = results.iter_mut().find(|(fault, _)| *fault == to);
        if let (true, Some(errors), Some((_, planted))) = (is_meant(index), errors, target) {
            *planted = errors;
        }
    })
}

#[test]
fn a_fault_that_no_study_detects_fails_and_so_does_a_study_that_fails_without_one() {
    let sound = CONTROLS.with(|_, _| ());
    assert_eq!(sound.verdict, Verdict::Pass, "{:?}", failed(&sound));
    let headline = |outcome: &Outcome| outcome.headline.to_string();
    assert_eq!(headline(&sound), "22 of 22 planted faults detected");
    let blind = replaced(&CONTROLS, [Fault::None, RHO], |_| true);
    assert_eq!(failed(&blind), ["rho: studies that notice it >= 1"]);
    assert_eq!(headline(&blind), "21 of 22 planted faults detected");
    // The studies that do not pass are named, since the fault is in them.
    let broken = failed(&replaced(&CONTROLS, [RHO, Fault::None], |_| true));
    let named = "theorem-3.4-space: does not pass = 0".to_owned();
    assert!(broken.contains(&named), "{broken:?}");
}

/// A study that decides nothing under a fault has not detected it, and none has a fault in a term
/// that it lacks.
#[test]
fn an_open_verdict_is_no_detection() {
    let sound = CONTROLS.with(|_, _| ());
    let rows = &sound.tables[1].rows;
    let row = rows.iter().find(|row| row[0] == "g1").expect("g1");
    assert_eq!(row[..4], ["g1", "fail", "inconclusive", "n/a"]);
    let all_but_the_second = |index: usize| CONTROLS.runs[index].case.data.study != 1;
    let pair = [Fault::None, Fault::Coefficient("g1")];
    let open = replaced(&CONTROLS, pair, all_but_the_second);
    assert_eq!(failed(&open), ["g1: studies that notice it >= 1"]);
}

#[test]
fn a_failed_level_and_an_honest_error_that_is_not_finite_fail() {
    for case in 0..CONTROLS.runs.len() {
        let mut failed = CONTROLS.runs.clone();
        failed[case].found = Err(CaseFailure::new("planted"));
        let failed = CONTROLS.study.judge(&failed);
        let broken = CONTROLS.at(case, |found| {
            for (fault, errors) in found {
                if let (Fault::None, Ok(errors)) = (*fault, errors) {
                    errors[Norm::Theorem34] = f64::NAN;
                }
            }
        });
        let verdicts = [failed, broken].map(|outcome| outcome.verdict);
        assert_eq!(verdicts, [Verdict::Fail; 2], "case {case}");
    }
}

#[test]
fn every_fault_of_the_solver_of_any_order_is_detected_and_one_that_is_not_fails() {
    let sound: Sound<Faults<AnyOrder>> = Sound::checked(faults::any_order().kind);
    let finest = sound.found(sound.runs.len() - 1);
    // None, eight coefficients and nine defects.
    assert_eq!(finest.len(), 18);
    for (fault, errors) in finest {
        let error = errors.as_ref().expect("errors").named[0].1;
        if *fault == Fault::None {
            assert!(error < 2e-12, "{error}");
            continue;
        }
        // A fault gives an error far above round-off.
        assert!(error > 1e-8, "{fault:?}: {error}");
        for pair in [[Fault::None, *fault], [*fault, Fault::None]] {
            let outcome = replaced(&sound, pair, |_| true);
            assert_eq!(outcome.verdict, Verdict::Fail, "{pair:?}");
        }
    }
    // A run that a fault breaks down is a detection, and a run that is missing is none.
    let broken = sound.with(|_, results| results[1].1 = Err(CaseFailure::new("it diverges")));
    let headline = broken.headline.to_string();
    assert!(headline.starts_with("17 of 17"), "{headline}");
    let missing = sound.with(|_, results| drop(results.remove(0)));
    assert_eq!(missing.verdict, Verdict::Fail);
}
