//! Errors that are those of another level, of another column, or of no discretization: studies say
//! so, and do not pass. (Tables: the transcript of how `rates` reads them.)

use convergence_study::{Claim, Kind, Outcome, Reason, Verdict, levels};

fn outcome(
    errors: impl Fn(usize) -> Vec<(&'static str, f64)> + Send + Sync,
    names: &[&str],
) -> Outcome {
    let study = levels([4, 8, 16, 32, 64], errors);
    let study = names.iter().fold(study, |study, name| {
        study.claiming(*name, Claim::new(2.0, 0.25))
    });
    study.judge(&study.run_here())
}

/// The verdict, and the reason of the first rate.
fn said(outcome: &Outcome) -> (Verdict, Reason) {
    (outcome.verdict, outcome.rates[0].rate.code)
}

#[test]
fn a_program_with_a_repeated_level_or_column_does_not_pass() {
    let error = |n: usize| 0.347_1 * (n as f64).powi(-2);
    let right = outcome(
        |n| vec![("L2", error(n)), ("max", 2.1 * error(n))],
        &["L2", "max"],
    );
    assert_eq!(right.verdict, Verdict::Pass);

    let stale = |n: usize| vec![("L2", error(if n == 16 { 8 } else { n }))];
    let expected = (Verdict::Inconclusive, Reason::Repeats);
    assert_eq!(said(&outcome(stale, &["L2"])), expected);

    let unused = outcome(|_| vec![("L2", error(8))], &["L2"]);
    assert_eq!(said(&unused), (Verdict::Fail, Reason::Identical));
    let words = unused.rates[0].rate.because.to_string();
    assert!(words.contains("does the program use {n}?"), "{words}");

    let equal = |n: usize| vec![("L2", error(n)), ("max", error(n))];
    let both = outcome(equal, &["L2", "max"]);
    assert_eq!(both.verdict, Verdict::Inconclusive);
    let mut rates = both.rates.iter();
    assert!(rates.all(|rate| rate.rate.code == Reason::EqualColumns));
    let one = outcome(equal, &["L2"]);
    assert_eq!(one.verdict, Verdict::Pass);
    let mut claims = one.checks.iter().map(|check| check.claim.to_string());
    assert!(claims.any(|claim| claim.contains("equal in all digits")));
}
