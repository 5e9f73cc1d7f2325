//! Laws of planted faults: each counts, and so does the run without one.

use std::sync::LazyLock;

use convergence_study::{CaseFailure, Kind, Outcome, Verdict};
use thermobeam_study::exact::norm::Norm;
use thermobeam_study::kinds::orders::{any_order::AnyOrder, manufactured::Convergence};
use thermobeam_study::studies::faults::{self, Fault, Faults, Plantable};

use super::typed::{Runs, changed, passes_but_not_without_each_case};

type Controls = Faults<Convergence>;
type OfAnyOrder = Faults<AnyOrder>;

static CONTROLS: LazyLock<Runs<Controls>> = LazyLock::new(|| faults::study().kind.run_here());

/// The results under one fault in these cases, replaced by those under another.
fn replaced<S: Plantable>(
    sound: &Runs<Faults<S>>,
    [from, to]: [Fault; 2],
    is_meant: impl Fn(usize) -> bool,
) -> Runs<Faults<S>>
where
    S::Data: Clone,
{
    changed::<Faults<S>>(sound, |index, results| {
        let mut known = results.iter().filter(|(fault, _)| *fault == from);
        let errors = known.next().map(|(_, errors)| errors.clone());
        let target = results.iter_mut().find(|(fault, _)| *fault == to);
        if let (true, Some(errors), Some((_, planted))) = (is_meant(index), errors, target) {
            *planted = errors;
        }
    })
}

/// The statements that do not hold.
fn failed(outcome: &Outcome) -> Vec<String> {
    let checks = outcome.checks.iter();
    let failed = checks.filter(|check| check.verdict == Verdict::Fail);
    failed.map(|check| check.statement()).collect()
}

#[test]
fn a_fault_that_no_study_detects_fails_and_so_does_a_study_that_fails_without_one() {
    let study = faults::study().kind;
    let sound = study.judge(&CONTROLS);
    assert_eq!(sound.verdict, Verdict::Pass, "{:?}", failed(&sound));
    assert_eq!(
        sound.headline.to_string(),
        "22 of 22 planted faults detected"
    );
    let rho = Fault::Coefficient("rho");
    let blind = study.judge(&replaced::<Convergence>(
        &CONTROLS,
        [Fault::None, rho],
        |_| true,
    ));
    assert_eq!(failed(&blind), ["rho: studies that notice it >= 1"]);
    assert_eq!(
        blind.headline.to_string(),
        "21 of 22 planted faults detected"
    );
    // The studies that do not pass are named, since the fault is in them.
    let broken = failed(&study.judge(&replaced::<Convergence>(
        &CONTROLS,
        [rho, Fault::None],
        |_| true,
    )));
    assert!(
        broken.contains(&"theorem-3.4-space: does not pass = 0".to_owned()),
        "{broken:?}"
    );
}

/// A study that decides nothing under a fault has not detected it, and none has a fault in a term
/// that it lacks.
#[test]
fn an_open_verdict_is_no_detection() {
    let study = faults::study().kind;
    let sound = study.judge(&CONTROLS);
    let rows = &sound.tables[1].rows;
    let row = rows.iter().find(|row| row[0] == "g1").expect("g1");
    assert_eq!(row[..4], ["g1", "fail", "inconclusive", "n/a"]);
    let all_but_the_second = |index: usize| CONTROLS[index].case.data.study != 1;
    let g1 = Fault::Coefficient("g1");
    let runs = replaced::<Convergence>(&CONTROLS, [Fault::None, g1], all_but_the_second);
    assert_eq!(
        failed(&study.judge(&runs)),
        ["g1: studies that notice it >= 1"]
    );
}

#[test]
fn a_failed_level_and_an_honest_error_that_is_not_finite_fail() {
    let study = faults::study().kind;
    for case in 0..CONTROLS.len() {
        let mut failed = CONTROLS.clone();
        failed[case].found = Err(CaseFailure::new("planted"));
        assert_eq!(study.judge(&failed).verdict, Verdict::Fail, "case {case}");
        let broken = changed::<Controls>(&CONTROLS, |index, found| {
            for (fault, errors) in found.iter_mut().filter(|_| index == case) {
                if let (Fault::None, Ok(errors)) = (*fault, errors) {
                    errors[Norm::Theorem34] = f64::NAN;
                }
            }
        });
        assert_eq!(study.judge(&broken).verdict, Verdict::Fail, "case {case}");
    }
}

#[test]
fn every_fault_of_the_solver_of_any_order_is_detected_and_one_that_is_not_fails() {
    let study = faults::any_order().kind;
    let sound = passes_but_not_without_each_case(&study);
    let finest = sound[sound.len() - 1].ok().expect("results");
    assert_eq!(
        finest.len(),
        18,
        "none, eight coefficients and nine defects"
    );
    for (fault, errors) in finest {
        let error = errors.as_ref().expect("errors").named[0].1;
        if *fault == Fault::None {
            assert!(error < 2e-12, "{error}");
            continue;
        }
        // A fault gives an error far above round-off.
        assert!(error > 1e-8, "{fault:?}: {error}");
        for pair in [[Fault::None, *fault], [*fault, Fault::None]] {
            let outcome = study.judge(&replaced::<AnyOrder>(&sound, pair, |_| true));
            assert_eq!(outcome.verdict, Verdict::Fail, "{pair:?}");
        }
    }
    // A run that a fault breaks down is a detection, and a run that is missing is none.
    let broken = changed::<OfAnyOrder>(&sound, |_, results| {
        results[1].1 = Err(CaseFailure::new("it diverges"));
    });
    let broken = study.judge(&broken);
    assert!(
        broken.headline.to_string().starts_with("17 of 17"),
        "{}",
        broken.headline
    );
    let missing = changed::<OfAnyOrder>(&sound, |_, results| drop(results.remove(0)));
    assert_eq!(study.judge(&missing).verdict, Verdict::Fail);
}
