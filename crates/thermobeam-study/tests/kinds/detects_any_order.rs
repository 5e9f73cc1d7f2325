//! Laws of the matrix of faults in the solver of any order: wrong coefficients, and mistakes in the
//! loads.

use convergence_study::{CaseFailure, FromFile, Kind, Verdict};
use thermobeam_study::kinds::detects::{Detects, Fault, ROW};
use thermobeam_study::kinds::orders::any_order::AnyOrder;

use super::file;
use super::refused::refusal;
use super::typed::{Runs, changed, passes_but_not_without_each_case, report};

type Controls = Detects<AnyOrder>;

/// The results under one fault in all runs, replaced by those under another.
fn replaced(sound: &Runs<Controls>, from: usize, to: usize) -> Runs<Controls> {
    changed::<Controls>(sound, |_, results| results[to].1 = results[from].1.clone())
}

#[test]
fn every_fault_is_detected_and_one_that_is_not_fails() {
    let study =
        Controls::read(file("any-order-controls.toml")).unwrap_or_else(|error| panic!("{error}"));
    let sound = passes_but_not_without_each_case(&study);
    let faults: Vec<Fault> = sound[0].ok().expect("results")[..]
        .iter()
        .map(|(fault, _)| *fault)
        .collect();
    assert_eq!(
        faults.len(),
        18,
        "the honest solver, eight coefficients and nine defects"
    );
    assert_eq!(faults[0], Fault::None);
    let finest = sound[sound.len() - 1].ok().expect("results");
    for (index, (fault, errors)) in finest.iter().enumerate() {
        let error = errors.as_ref().expect("errors").named[0].1;
        // A fault gives an error far above round-off; without one the error is round-off.
        assert!(
            if index == 0 {
                error < 2e-12
            } else {
                error > 1e-8
            },
            "{fault:?}: {error}"
        );
        if index > 0 {
            // The study passes under this fault, or it fails without one.
            for [from, to] in [[0, index], [index, 0]] {
                let outcome = study.judge(&replaced(&sound, from, to));
                assert_eq!(outcome.verdict, Verdict::Fail, "{fault:?}, {from} for {to}");
            }
        }
    }
    // The study that does not pass is named, since the fault is in it.
    let broken = report(&study.judge(&replaced(&sound, 1, 0)));
    assert!(
        broken.contains("0 of 1 pass; not any-order-coefficients"),
        "{broken}"
    );
}

#[test]
fn a_run_that_a_fault_breaks_down_is_a_detection_and_a_run_that_is_missing_is_none() {
    let study =
        Controls::read(file("any-order-controls.toml")).unwrap_or_else(|error| panic!("{error}"));
    let sound = convergence_study::internal::study::run_cases_here(&study);
    let broken = changed::<Controls>(&sound, |_, results| {
        results[1].1 = Err(CaseFailure::new("it diverges"));
    });
    assert_eq!(study.judge(&broken).verdict, Verdict::Pass);
    let missing = changed::<Controls>(&sound, |_, results| drop(results.remove(0)));
    assert_eq!(study.judge(&missing).verdict, Verdict::Fail);
    let mut failed = sound;
    failed[0].found = Err(CaseFailure::new("planted"));
    let outcome = study.judge(&failed);
    let detected = outcome.checks.iter().filter(|check| {
        check
            .claim
            .to_string()
            .ends_with(" is detected by every study")
            && check.verdict == Verdict::Pass
    });
    assert_eq!(detected.count(), 0, "{}", report(&outcome));
}

#[test]
fn files_with_errors_are_refused_with_the_field() {
    for (from, to, message) in [
        ("relative = 1e-4", "relative = 0", "any-order.relative"),
        (
            "\"any-order-coefficients.toml\"",
            "\"theorem-3.4-space.toml\"",
            "study.kind: found \"orders/manufactured\"; expected \"orders/any-order\"",
        ),
        (
            "[\"any-order-coefficients.toml\"]",
            "[]",
            "any-order.studies",
        ),
        // There, theta_a is zero.
        (
            "\"any-order-coefficients.toml\"",
            "\"any-order-space.toml\"",
            "theta_a, which any-order-space",
        ),
        ("\"zeta\", ", "\"zetta\", ", "any-order.coefficients"),
        (
            "\"half of rho in N\"",
            "\"half of rho\"",
            "any-order.defects",
        ),
        // It is about the levels of one-step schemes.
        (
            "half of rho in N",
            "N of the mean state instead of the mean of N",
            "any-order.defects",
        ),
        (
            "[any-order]",
            "[controls]\n[any-order]",
            "one of the tables",
        ),
    ] {
        let error = refusal(&ROW, "any-order-controls.toml", from, to);
        assert!(error.contains(message), "{to}: {error}");
    }
}
