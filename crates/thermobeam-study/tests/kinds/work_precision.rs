//! Laws of work-precision studies: they pass, they are reproducible, and planted defects make them
//! fail.

use super::file;
use super::typed::passes_but_not_without_each_case;
use convergence_study::{CaseFailure, FromFile, Kind, Outcome, Ran, Verdict, run_one};
use thermobeam_study::kinds::work_precision::WorkPrecision;
use thermobeam_study::kinds::work_precision::compared::{Costed, cheapest, front};
use thermobeam_study::kinds::work_precision::method::{METHODS, Measurement, Trial};

fn read(text: &str) -> Result<WorkPrecision, String> {
    WorkPrecision::parse(text, &file("study.toml")).map_err(|error| error.to_string())
}

fn quick() -> WorkPrecision {
    WorkPrecision::read(file("work-precision-manufactured.toml")).unwrap()
}

fn failed(outcome: &Outcome) -> Vec<String> {
    outcome
        .checks
        .iter()
        .filter(|c| c.verdict == Verdict::Fail)
        .map(|c| c.claim.to_string())
        .collect()
}

/// The checks that fail if the runs whose label starts with `only` have a defect.
fn planted(
    study: &WorkPrecision,
    honest: &[Ran<Trial, Measurement>],
    only: &str,
    defect: impl Fn(&mut Measurement),
) -> Vec<String> {
    let mut ran = honest.to_vec();
    let mut touched = 0;
    for ran in ran.iter_mut().filter(|r| r.case.label.starts_with(only)) {
        defect(ran.found.as_mut().unwrap());
        touched += 1;
    }
    assert!(touched > 0, "no run is called {only}");
    let outcome = study.judge(&ran);
    failed(&outcome)
}

#[test]
fn the_study_passes_and_repeats_and_no_case_may_be_missing() {
    let study = quick();
    let outcome = study.outcome_of(&passes_but_not_without_each_case(&study));
    let target = "times dearer, theorem-3.4 1e-2, midpoint over dg >= 4.7";
    let check = outcome
        .checks
        .iter()
        .find(|check| check.claim == target.into());
    assert!(check.is_some_and(|check| check.evidence.to_string().contains("(98 x 32) against")));
    assert_eq!(outcome, run_one(&quick()));
}

#[test]
fn planted_defects_fail() {
    let study = quick();
    let honest = study.run_here();
    let plant = |only: &str, defect: &dyn Fn(&mut Measurement)| {
        planted(&study, &honest, only, |run| defect(run))
    };
    assert_eq!(plant("midpoint", &|_| ()), Vec::<String>::new());
    for wrong in [f64::NAN, f64::INFINITY] {
        let of_error = plant("midpoint, 16 x 32", &|run| run.errors.norm = wrong);
        assert!(of_error.iter().any(|claim| claim.contains("finite")));
        let of_work = plant("dg", &|run| run.spent.node_solves = wrong);
        assert!(of_work.iter().any(|claim| claim.contains("finite")));
    }
    // A method that lost its order does not reach its targets any more.
    let lost = plant("midpoint", &|run| {
        run.errors.tip = run.errors.tip.max(2e-3);
    });
    for error in ["1e-3", "1e-4", "1e-5"] {
        let of_target = lost
            .iter()
            .filter(|claim| claim.contains(&format!("tip {error}")));
        assert!(of_target.count() > 0, "{error}: {lost:?}");
    }
    let dear = plant("dg", &|run| run.spent.node_solves *= 3.0);
    assert!(
        dear.iter().any(|claim| claim.contains("over dg >=")),
        "{dear:?}"
    );
    let cheap = plant("fixed-point,", &|run| run.spent.node_solves /= 4.0);
    assert!(!cheap.is_empty());
}

/// A method that reaches a target must be compared, or its ratio would not be claimed.
#[test]
fn a_method_that_is_left_out_of_a_target_fails() {
    let text = super::text("work-precision-manufactured.toml").replace(
        "methods = [\"midpoint\", \"dg\"]\ntimes = [20]",
        "methods = [\"richardson\", \"dg\"]\ntimes = [20]",
    );
    let outcome = run_one(&read(&text).unwrap());
    assert_eq!(
        failed(&outcome),
        [
            "times dearer, tip 1e-5, richardson over dg >= 20",
            "methods that reach it and are not compared, tip 1e-5 = 0",
            "methods compared, tip 1e-5 >= 2"
        ]
    );
    let evidence = |k: &str| {
        let check = outcome
            .checks
            .iter()
            .find(|check| check.claim.to_string().contains(k));
        check.unwrap().evidence.to_string()
    };
    assert_eq!(evidence("are not compared, tip 1e-5"), "1: midpoint");
    assert!(evidence("tip 1e-5, richardson over").contains("not reached"));
}

/// A ratio is one of optimal runs: 23.7 came of a midpoint run that a coarser one beats.
#[test]
fn a_run_that_a_neighbour_beats_fails() {
    let text = super::text("work-precision-manufactured.toml").replace("[150, 336]", "[192, 384]");
    let outcome = run_one(&read(&text).unwrap());
    let claim = "runs next to a listed one that reach it for less, tip 1e-5 = 0";
    assert_eq!(failed(&outcome), [claim]);
    let check = outcome
        .checks
        .iter()
        .find(|check| check.claim == claim.into());
    let evidence = &check.unwrap().evidence;
    assert!(
        evidence
            .to_string()
            .starts_with("1: midpoint by 168 x 384 for 1.88e5 in place of 2.15e5"),
        "{evidence}"
    );
}

#[test]
fn a_claim_that_is_too_bold_fails() {
    let text = super::text("work-precision-manufactured.toml");
    let study = read(&text.replace("times = [20]", "times = [40]")).unwrap();
    let outcome = run_one(&study);
    assert_eq!(
        failed(&outcome),
        ["times dearer, tip 1e-5, midpoint over dg >= 40"]
    );
}

#[test]
fn every_ratio_and_the_smallest_error_of_each_method_are_guarded() {
    let study = quick();
    let outcome = run_one(&study);
    let claimed: usize = study
        .targets()
        .iter()
        .map(|target| target.times.len())
        .sum();
    let names: Vec<&str> = outcome.quantities.iter().map(|q| q.name.as_str()).collect();
    let ratios = names.iter().filter(|name| name.starts_with("times dearer"));
    assert_eq!(ratios.count(), claimed);
    assert_eq!(names.len(), claimed + 2 * METHODS.len());
    assert!(names.contains(&"times dearer, tip 1e-5, midpoint over dg"));
    assert!(names.contains(&"smallest error, theorem-3.4, fixed-point-once"));
}

#[test]
fn the_cheapest_run_that_is_good_enough_counts() {
    let run = |method: &str, cost: f64, error: f64| Costed {
        method: method.to_owned(),
        resolution: String::new(),
        error,
        cost,
    };
    let runs = [
        run("dg", 1.0, 1e-7),
        run("dg", 0.5, 2e-7),
        run("midpoint", 0.1, 1e-9),
        run("dg", 3.0, f64::NAN),
    ];
    let cost = |error: f64| cheapest(&runs, "dg", error).map(|run| run.cost);
    assert_eq!(
        [cost(1e-6), cost(1e-7), cost(1e-8)],
        [Some(0.5), Some(1.0), None]
    );
    assert_eq!(
        front([(3.0, 1.0), (1.0, 5.0), (2.0, 6.0), (2.0, 4.0)]),
        [(1.0, 5.0), (2.0, 4.0), (3.0, 1.0)]
    );
}

/// The paper's experiment with few runs.
fn short() -> String {
    let text = super::text("work-precision-paper.toml");
    let head = text.split("[[runs]]").next().unwrap().to_owned();
    head + "[[runs]]\nmethod = \"midpoint\"\nruns = [[8, 128]]\n[[runs]]\nmethod = \"dg\"\nnodes = [0.0, 1.0]\nruns = [[6, 1, \
            0.1]]\n[[target]]\nnorm = \"tip\"\nerror = 1e-2\nmethods = [\"dg\", \"midpoint\"]\ntimes = [1]\n"
}

#[test]
fn references_that_do_not_agree_fail() {
    let reasons = |text: &str| -> Vec<String> {
        let ran = read(text).unwrap().run_here();
        let reason = |failure: CaseFailure| failure.reason;
        ran.into_iter()
            .filter_map(|ran| ran.found.err().map(reason))
            .collect()
    };
    let fine = short()
        .replace("[34, 5, 0.002]", "[16, 2, 0.02]")
        .replace("[30, 5, 0.0023]", "[14, 2, 0.02]");
    assert_eq!(reasons(&fine), Vec::<String>::new());
    let coarse = reasons(&fine.replace("[14, 2, 0.02]", "[2, 1, 0.1]"));
    assert_eq!(coarse.len(), 10, "two runs and eight neighbours");
    let apart = "the two references are ";
    assert!(
        coarse.iter().all(|reason| reason.starts_with(apart)),
        "{coarse:?}"
    );
    assert!(coarse[0].ends_with("in tip, allowed 1.0e-3"), "{coarse:?}");
}

#[test]
fn seconds_are_those_of_the_clock_that_is_given() {
    use std::sync::atomic::{AtomicUsize, Ordering};
    static READINGS: AtomicUsize = AtomicUsize::new(0);
    fn clock() -> f64 {
        READINGS.fetch_add(1, Ordering::Relaxed) as f64
    }
    let study = quick();
    for ran in study.run_here() {
        let run = ran.found.unwrap();
        assert_eq!(run.seconds, 0.0, "a study has no clock");
        if ran.case.label.starts_with("midpoint, 10 x 16") {
            let timed = study.measure(&ran.case.data, clock).unwrap();
            // A reading before and after the steps to each of the file's 16 observations.
            assert_eq!(timed.seconds, 16.0);
            assert_eq!((timed.errors, timed.spent), (run.errors, run.spent));
            assert_eq!(study.seconds(&ran.case.data, clock).unwrap(), 1.0);
        }
    }
    assert!(READINGS.load(Ordering::Relaxed) > 0);
}
