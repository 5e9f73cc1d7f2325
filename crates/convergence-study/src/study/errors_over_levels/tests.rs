use super::*;
use convergence_judge::random::SplitMix;
use convergence_judge::verdict::Reason;
use convergence_judge::verdict::Verdict::{Fail, Inconclusive, Pass};

const COUNTS: [usize; 5] = [4, 8, 16, 32, 64];

fn judged<R: IntoErrors, F: Fn(usize, usize) -> R + Send + Sync>(
    study: &ErrorsOverLevels<F>,
) -> Outcome {
    study.judge(&study.run_here())
}

/// The outcome for an error of second order, claimed to be of this order, changed by `change`.
fn outcome<R: IntoErrors>(order: f64, change: impl Fn(usize, f64) -> R + Send + Sync) -> Outcome {
    let study =
        levels(COUNTS, |n| change(n, (n as f64).powi(-2))).counting("cells", RefinedIn::Space);
    judged(&study.claiming("e", Claim::new(order, 0.05)))
}

/// An error of second order.
fn second(n: usize) -> [(&'static str, f64); 1] {
    [("e", (n as f64).powi(-2))]
}

/// An outcome of this verdict has these words in its summary, a check or a rate.
#[track_caller]
fn says(outcome: &Outcome, verdict: Verdict, words: &str) {
    let evidence = outcome.checks.iter().map(|check| &check.evidence);
    let reasons = outcome.rates.iter().map(|named| &named.rate.reason);
    let mut all = evidence.chain(reasons).chain([&outcome.summary]);
    let is_said = all.any(|text| text.to_string().contains(words));
    assert!(
        outcome.verdict == verdict && is_said,
        "{words}: {outcome:?}"
    );
}

/// The reason of the first rate.
fn code(outcome: &Outcome) -> Reason {
    outcome.rates[0].rate.code
}

#[test]
fn a_level_may_say_its_own_step_and_a_higher_rate_may_do() {
    let solve = |n: usize| [("dt", 2.0 / n as f64), ("e", (n as f64).powi(-3))];
    says(&judged(&levels(COUNTS, solve).claim("e", 2.0)), Fail, "");
    let claim = Claim {
        bound: Bound::AtLeast,
        ..Claim::new(2.0, 0.1)
    };
    let found = judged(&levels(COUNTS, solve).claiming("e", claim));
    says(&found, Pass, "");
    assert_eq!(found.levels[0].step, Some(0.5));
    assert_eq!(found.levels[0].errors, [NamedNumber::new("e", 1.0 / 64.0)]);
    let some = |n: usize| {
        let step = (n != 8).then_some(("h", 1.0 / n as f64));
        step.into_iter().chain(second(n)).collect::<Vec<_>>()
    };
    let found = judged(&levels(COUNTS, some).claim("e", 2.0));
    assert_eq!(code(&found), Reason::StepsNotDecreasing);
    let number = levels(COUNTS, |n| (n as f64).powi(-2)).claim("error", 2.0);
    says(&judged(&number), Pass, "");
}

#[test]
fn a_right_claim_passes_and_a_wrong_one_fails() {
    let of = |order| outcome(order, |_, error| [("e", error), ("f", 1.0)]);
    says(&of(1.0), Fail, "");
    let right = of(2.0);
    says(&right, Pass, "");
    assert_eq!(right.levels.len(), COUNTS.len());
    let crate::study::outcome::LevelErrors {
        parameters, errors, ..
    } = &right.levels[2];
    assert_eq!(*parameters, [NamedNumber::new("cells", 16.0)]);
    let expected = [("e", 1.0 / 256.0), ("f", 1.0)];
    assert_eq!(
        *errors,
        expected.map(|(name, error)| NamedNumber::new(name, error))
    );
    // A rate, and two errors on five levels.
    assert_eq!(right.quantities.len(), 1 + 2 * 5);
    assert_eq!(right.quantities[1].name, "error e, cells = 4");
    let drawn: Vec<&str> = right.figures.iter().map(|figure| &*figure.file).collect();
    let expected = usize::from(cfg!(feature = "reports"));
    assert_eq!(drawn, ["errors.svg"][..expected]);
}

#[test]
fn a_level_that_fails_or_lacks_an_error_fails_the_study() {
    let failed = outcome(2.0, |n, error| match n {
        8 => Err(CaseFailure::new("diverged")),
        _ => Ok([("e", error)]),
    });
    says(&failed, Fail, "cells = 8: diverged");
    let expected = "e 2.0000 (order 2): 1 of 5 levels has no result: cells = 8; 2.0000 ± 0.00005 from levels 1 to 5 of 5";
    says(&failed, Fail, expected);
    let rate = &failed.rates[0].rate;
    assert_eq!(
        (rate.code, rate.set_aside.len(), rate.set_aside[0].level),
        (Reason::NoResult, 1, 1)
    );
    assert!(
        rate.pairwise[..2].iter().all(|rate| rate.is_nan())
            && rate.pairwise[2..].iter().all(|r| (r - 2.0).abs() < 1e-9)
    );
    // An error that was computed and is NaN is a different case.
    let nan = outcome(2.0, |n, error| {
        [("e", if n == 8 { f64::NAN } else { error })]
    });
    says(&nan, Fail, "");
    assert_eq!(code(&nan), Reason::NonFiniteError);
    let lacking = outcome(2.0, |n, error| {
        let other = (n != 8).then_some(("f", 1.0));
        [("e", error)].into_iter().chain(other).collect::<Vec<_>>()
    });
    says(&lacking, Fail, "cells = 8: the error `f`");
    says(&outcome(2.0, |_, error| [("another", error)]), Fail, "");
}

#[test]
fn a_name_that_is_given_twice_does_not_pass() {
    let twice = outcome(2.0, |n, error| [("e", error), ("e", 1.0 / n as f64)]);
    says(&twice, Fail, "found `e` twice");
    let claims = levels(COUNTS, second).claim("e", 2.0).claim("e", 1.0);
    says(&judged(&claims), Fail, "`e` is claimed twice");
}

#[test]
fn levels_come_in_any_order_and_each_once() {
    let found = judged(&levels([16, 4, 64, 8, 32], second).claim("e", 2.0));
    says(&found, Pass, "");
    assert_eq!(found.levels[0].parameters, [NamedNumber::new("n", 4.0)]);
    let found = judged(&levels([16, 4, 16, 64, 8], second).claim("e", 2.0));
    says(&found, Inconclusive, "");
    assert_eq!(code(&found), Reason::StepsNotDecreasing);
}

/// A strong error of order one half, and a signed weak one of order one.
fn errors(n: usize, seed: usize) -> [(&'static str, f64); 2] {
    let mut random = SplitMix::new((seed * 4096 + n) as u64);
    let h = 1.0 / n as f64;
    let strong = h.sqrt() * (1.0 + 0.3 * random.normal()).abs();
    [
        ("strong", strong),
        ("weak", h * (1.0 + 0.3 * random.normal())),
    ]
}

/// The outcome of so many samples of each level, with a claim of one error.
fn sampled<R: IntoErrors>(
    count: usize,
    (name, order): (&str, f64),
    solve: impl Fn(usize, usize) -> R + Send + Sync,
) -> Outcome {
    let study = levels_of_samples([64, 4, 16, 8, 32], count, solve);
    study.claim(name, order).run().outcome
}

#[test]
fn levels_are_judged_by_the_scatter_of_their_samples() {
    let study = |strong: f64, weak: f64| {
        let study = levels_of_samples([64, 4, 16, 8, 32], 40, errors);
        let study = study.claim("strong", strong).claim("weak", weak);
        study.made_of("weak", Of::Weak).run().outcome
    };
    let right = study(0.5, 1.0);
    says(&right, Pass, "made of 40 samples");
    assert_eq!(right.levels.len(), 5);
    says(&study(1.0, 1.0), Fail, "");
    says(&study(0.5, 2.0), Fail, "");
}

#[test]
fn few_samples_a_failed_or_broken_one_and_no_claim_do_not_pass() {
    let weak = ("weak", 1.0);
    says(&sampled(9, weak, errors), Fail, "");
    let failing = |n: usize, seed: usize| match (n, seed) {
        (16, 7) => Err(CaseFailure::new("diverged")),
        _ => Ok(errors(n, seed)),
    };
    says(
        &sampled(20, weak, failing),
        Fail,
        "n = 16, seed = 7: diverged",
    );
    let broken = |n: usize, seed: usize| if seed == 3 { f64::NAN } else { 1.0 / n as f64 };
    says(&sampled(20, ("error", 1.0), broken), Fail, "");
    says(
        &levels_of_samples(COUNTS, 20, errors).run().outcome,
        Inconclusive,
        "",
    );
    says(&judged(&levels(COUNTS, second)), Inconclusive, "");
}

/// All levels report their step or none does, and all samples of one level report the same.
#[test]
fn levels_whose_samples_do_not_agree_on_their_steps_do_not_pass() {
    let with_steps = |step: fn(usize, usize) -> Option<f64>| {
        sampled(40, ("strong", 0.5), move |n: usize, seed: usize| {
            let step = step(n, seed).map(|step| ("h", step));
            let [strong, _] = errors(n, seed);
            step.into_iter().chain([strong]).collect::<Vec<_>>()
        })
    };
    let right = with_steps(|n, _| Some(2.0 / n as f64));
    says(&right, Pass, "");
    assert_eq!(right.levels[0].step, Some(0.5));
    let mixed = with_steps(|n, seed| match (n, seed) {
        (8, 3) => Some(0.3),
        _ => Some(1.0 / n as f64),
    });
    says(&mixed, Fail, "n = 8: expected one step");
    let some = with_steps(|n, _| (n != 8).then_some(1.0 / n as f64));
    assert_ne!(some.verdict, Pass, "{}", some.summary);
    // 1/n as the order of levels would be wrong.
    says(&with_steps(|n, _| Some(n as f64 / 64.0)), Fail, "");
}
