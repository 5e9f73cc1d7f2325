//! Laws of the matrix of faults in the solver of any order: wrong coefficients, and mistakes in the
//! loads.

use convergence_study::judge::verdict::Verdict;
use convergence_study::study::{CaseFailure, FromFile, Kind, run_cases_here};
use thermobeam_study::kinds::controls::any_order::AnyOrderControls;
use thermobeam_study::kinds::controls::{Fault, ROW};

use super::file;
use super::planted::verdict_with;
use super::refused::refusal;
use super::typed::report;

#[test]
fn every_fault_is_detected_and_one_that_is_not_fails() {
    let study = AnyOrderControls::read(file("any-order-controls.toml"))
        .unwrap_or_else(|error| panic!("{error}"));
    let sound = run_cases_here(&study);
    let outcome = study.judge(&sound);
    assert_eq!(outcome.verdict, Verdict::Pass, "{}", report(&outcome));
    assert_eq!(
        sound.len(),
        18,
        "the honest solver, eight coefficients and nine defects"
    );
    assert_eq!(sound[0].case.data.1, Fault::None);
    for (index, ran) in sound.iter().enumerate() {
        let judged = ran.ok().expect("a verdict");
        // A fault gives an error far above round-off; without one the error is round-off.
        assert!(
            if index == 0 {
                judged.error < 2e-12
            } else {
                judged.error > 1e-8
            },
            "{}: {judged:?}",
            ran.case.label
        );
        let other = if index == 0 {
            Verdict::Fail
        } else {
            Verdict::Pass
        };
        for wrong in [other, Verdict::Inconclusive] {
            assert_eq!(
                verdict_with(&study, &sound, index, |found| found.verdict = wrong),
                Verdict::Fail,
                "{index}"
            );
        }
        let mut failed = sound.clone();
        failed[index].found = Err(CaseFailure::new("planted"));
        let outcome = study.judge(&failed);
        assert_eq!(outcome.verdict, Verdict::Fail);
        assert!(report(&outcome).contains("planted"));
    }
    // The study that does not pass is named, since the fault is in it.
    let mut broken = sound.clone();
    if let Ok(judged) = &mut broken[0].found {
        judged.verdict = Verdict::Fail;
    }
    assert!(report(&study.judge(&broken)).contains("0 of 1 pass; not any-order-coefficients"));
    assert_ne!(study.judge(&sound[1..]).verdict, Verdict::Pass);
    assert_ne!(study.judge(&[]).verdict, Verdict::Pass);
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
