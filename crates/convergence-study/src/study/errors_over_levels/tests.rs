use super::*;
use convergence_judge::random::SplitMix;
use convergence_judge::verdict::Reason;

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

#[test]
fn a_level_may_say_its_own_step_and_a_higher_rate_may_do() {
    let solve = |n: usize| [("dt", 2.0 / n as f64), ("e", (n as f64).powi(-3))];
    assert_eq!(
        judged(&levels(COUNTS, solve).claim("e", 2.0)).verdict,
        Verdict::Fail
    );
    let found = judged(&levels(COUNTS, solve).claiming(
        "e",
        Claim {
            bound: Bound::AtLeast,
            ..Claim::new(2.0, 0.1)
        },
    ));
    assert_eq!(
        (found.verdict, found.levels[0].step),
        (Verdict::Pass, Some(0.5))
    );
    assert_eq!(found.levels[0].errors, [NamedNumber::new("e", 1.0 / 64.0)]);
    let some = |n: usize| {
        if n == 8 {
            vec![("e", 1.0)]
        } else {
            vec![("h", 1.0 / n as f64), ("e", (n as f64).powi(-2))]
        }
    };
    assert_eq!(
        judged(&levels(COUNTS, some).claim("e", 2.0)).rates[0]
            .rate
            .code,
        Reason::StepsNotDecreasing
    );
    assert_eq!(
        judged(&levels(COUNTS, |n| (n as f64).powi(-2)).claim("error", 2.0)).verdict,
        Verdict::Pass
    );
}

#[test]
fn a_claim_about_an_error_that_no_level_has_names_those_there_are() {
    let found = judged(&levels(COUNTS, |n| [("L2", 1.0 / n as f64), ("up", 1.0)]).claim("L3", 2.0));
    assert_eq!(
        (found.verdict, found.rates[0].rate.code),
        (Verdict::Fail, Reason::NoResult)
    );
    assert_eq!(
        found.rates[0].rate.reason.to_string(),
        "no level has an error `L3`; there are L2, up"
    );
}

#[test]
fn a_right_claim_passes_and_a_wrong_one_fails() {
    let of = |order| outcome(order, |_, error| [("e", error), ("f", 1.0)]);
    assert_eq!(
        (of(2.0).verdict, of(1.0).verdict),
        (Verdict::Pass, Verdict::Fail)
    );
    let right = of(2.0);
    assert_eq!(right.levels.len(), COUNTS.len());
    assert_eq!(
        right.levels[2].parameters,
        [NamedNumber::new("cells", 16.0)]
    );
    assert_eq!(
        right.levels[2].errors,
        [
            NamedNumber::new("e", 1.0 / 256.0),
            NamedNumber::new("f", 1.0)
        ]
    );
    // A rate, and two errors on five levels.
    assert_eq!(right.quantities.len(), 1 + 2 * 5);
    assert_eq!(right.quantities[1].name, "error e, cells = 4");
    let drawn: Vec<&str> = right
        .figures
        .iter()
        .map(|figure| figure.file.as_str())
        .collect();
    assert_eq!(
        drawn,
        ["errors.svg"][..usize::from(cfg!(feature = "reports"))]
    );
}

#[test]
fn a_level_that_fails_or_lacks_an_error_fails_the_study() {
    let failure = || Err(CaseFailure::new("diverged"));
    let failed = outcome(2.0, |n, error| {
        if n == 8 {
            failure()
        } else {
            Ok([("e", error)])
        }
    });
    assert_eq!(failed.verdict, Verdict::Fail);
    assert!(
        failed.checks[0]
            .evidence
            .to_string()
            .contains("cells = 8: diverged"),
        "{:?}",
        failed.checks
    );
    let expected = "e 2.0000 (order 2): 1 of 5 levels has no result: cells = 8; 2.0000 ± 0.00005 from levels 1 to 5 of 5";
    assert!(
        failed.summary.to_string().starts_with(expected),
        "{}",
        failed.summary
    );
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
    assert_eq!(
        (nan.verdict, nan.rates[0].rate.code),
        (Verdict::Fail, Reason::NonFiniteError)
    );
    let lacks = |n, error| {
        if n == 8 {
            vec![("e", error)]
        } else {
            vec![("e", error), ("f", 1.0)]
        }
    };
    let lacking = outcome(2.0, lacks);
    assert_eq!(lacking.verdict, Verdict::Fail);
    assert!(
        lacking.checks[0]
            .evidence
            .to_string()
            .contains("cells = 8: the error `f`"),
        "{:?}",
        lacking.checks
    );
    assert_eq!(
        outcome(2.0, |_, error| [("another", error)]).verdict,
        Verdict::Fail
    );
}

#[test]
fn a_name_that_is_given_twice_does_not_pass() {
    let twice = |n: usize| [("e", (n as f64).powi(-2)), ("e", 1.0 / n as f64)];
    let found = judged(&levels(COUNTS, twice).claim("e", 2.0));
    assert_eq!(found.verdict, Verdict::Fail);
    let evidence = found.checks[0].evidence.to_string();
    assert!(evidence.contains("found `e` twice"), "{evidence}");
    let solve = |n: usize| [("e", (n as f64).powi(-2))];
    let found = judged(&levels(COUNTS, solve).claim("e", 2.0).claim("e", 1.0));
    assert_eq!(found.verdict, Verdict::Fail);
}

#[test]
fn levels_come_in_any_order_and_each_once() {
    let solve = |n: usize| [("e", (n as f64).powi(-2))];
    let found = judged(&levels([16, 4, 64, 8, 32], solve).claim("e", 2.0));
    assert_eq!(found.verdict, Verdict::Pass);
    assert_eq!(found.levels[0].parameters, [NamedNumber::new("n", 4.0)]);
    let found = judged(&levels([16, 4, 16, 64, 8], solve).claim("e", 2.0));
    assert_eq!(found.rates[0].rate.code, Reason::StepsNotDecreasing);
    assert_ne!(found.verdict, Verdict::Pass);
}

#[test]
fn a_study_that_claims_nothing_does_not_pass() {
    assert_eq!(
        judged(&levels(COUNTS, |_| [("e", 1.0)])).verdict,
        Verdict::Inconclusive
    );
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

const SHUFFLED: [usize; 5] = [64, 4, 16, 8, 32];

#[test]
fn levels_are_judged_by_the_scatter_of_their_samples() {
    let study = |strong: f64, weak: f64| {
        let study = levels_of_samples(SHUFFLED, 40, errors);
        let study = study.claim("strong", strong);
        study
            .claim("weak", weak)
            .made_of("weak", Of::Weak)
            .run()
            .outcome
    };
    let right = study(0.5, 1.0);
    assert!(right.verdict.is_pass(), "{}", right.summary);
    assert!(right.summary.to_string().contains("made of 40 samples"));
    assert_eq!(right.levels.len(), 5);
    assert_eq!(study(1.0, 1.0).verdict, Verdict::Fail);
    assert_eq!(study(0.5, 2.0).verdict, Verdict::Fail);
}

#[test]
fn few_samples_a_failed_one_and_no_claim_do_not_pass() {
    let few = levels_of_samples(SHUFFLED, 9, errors).claim("weak", 1.0);
    assert_eq!(few.run().outcome.verdict, Verdict::Fail);
    let failing = |n: usize, seed: usize| {
        if (n, seed) == (16, 7) {
            Err(CaseFailure::new("diverged"))
        } else {
            Ok(errors(n, seed))
        }
    };
    let failed = levels_of_samples(SHUFFLED, 20, failing).claim("weak", 1.0);
    let failed = failed.run().outcome;
    assert_eq!(failed.verdict, Verdict::Fail);
    let evidence = failed.checks[0].evidence.to_string();
    assert!(
        evidence.contains("n = 16, seed = 7: diverged"),
        "{evidence}"
    );
    let nothing = levels_of_samples(SHUFFLED, 20, errors).run().outcome;
    assert_eq!(nothing.verdict, Verdict::Inconclusive);
}

/// All levels report their step or none does, and all samples of one level report the same.
#[test]
fn levels_whose_samples_do_not_agree_on_their_steps_do_not_pass() {
    let with_steps = |step: fn(usize, usize) -> Option<f64>| {
        let solve = move |n: usize, seed: usize| {
            let [(name, error), _] = errors(n, seed);
            let step = step(n, seed).map(|step| ("h", step));
            step.into_iter().chain([(name, error)]).collect::<Vec<_>>()
        };
        let study = levels_of_samples(SHUFFLED, 40, solve);
        study.claim("strong", 0.5).run().outcome
    };
    let right = with_steps(|n, _| Some(2.0 / n as f64));
    assert!(right.verdict.is_pass(), "{}", right.summary);
    assert_eq!(right.levels[0].step, Some(0.5));
    let mixed = with_steps(|n, seed| {
        Some(if (n, seed) == (8, 3) {
            0.3
        } else {
            1.0 / n as f64
        })
    });
    assert_eq!(mixed.verdict, Verdict::Fail);
    let evidence: Vec<String> = mixed
        .checks
        .iter()
        .map(|check| check.evidence.to_string())
        .collect();
    assert!(
        evidence
            .iter()
            .any(|one| one.contains("n = 8: expected one step")),
        "{evidence:?}"
    );
    let some = with_steps(|n, _| (n != 8).then_some(1.0 / n as f64));
    assert!(!some.verdict.is_pass(), "{}", some.summary);
    // 1/n as the order of levels would be wrong.
    let reversed = with_steps(|n, _| Some(n as f64 / 64.0));
    assert_eq!(reversed.verdict, Verdict::Fail, "{}", reversed.summary);
}

#[test]
fn a_nan_of_one_sample_fails() {
    let broken = |n: usize, seed: usize| if seed == 3 { f64::NAN } else { 1.0 / n as f64 };
    let study = levels_of_samples(SHUFFLED, 20, broken).claim("error", 1.0);
    assert_eq!(study.run().outcome.verdict, Verdict::Fail);
}
