//! Laws of work-precision studies: they pass, they repeat, and planted defects make them fail.

use convergence_study::judge::verdict::Verdict;
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::Outcome;
use std::path::{Path, PathBuf};
use thermobeam_study::kinds::untyped::Measured;
use thermobeam_study::kinds::work_precision::WorkPrecision;
use thermobeam_study::kinds::{FromFile, Study};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies")
}

fn read(text: &str) -> Result<WorkPrecision, String> {
    WorkPrecision::parse(text, &folder().join("study.toml")).map_err(|error| error.to_string())
}

fn quick() -> WorkPrecision {
    WorkPrecision::read(folder().join("work-precision-manufactured.toml")).unwrap()
}

fn results(study: &WorkPrecision) -> Vec<Result<Measured, CaseFailure>> {
    (0..study.cases().len()).map(|index| study.run(index)).collect()
}

fn failed(outcome: &Outcome) -> Vec<&str> {
    outcome.checks.iter().filter(|c| c.verdict == Verdict::Fail).map(|c| c.claim.as_str()).collect()
}

#[test]
fn midpoint_is_a_hundred_times_cheaper_and_the_outcome_repeats() {
    let (first, again) = (quick(), quick());
    let outcome = first.conclude(&results(&first));
    assert_eq!((outcome.verdict, failed(&outcome)), (Verdict::Pass, vec![]));
    assert!(outcome.checks.iter().any(|check| check.claim.contains("100 times cheaper")));
    assert!(outcome.quantities.iter().all(|quantity| quantity.value.is_finite()));
    assert_eq!(outcome, again.conclude(&results(&again)));
}

#[test]
fn planted_defects_fail() {
    let study = quick();
    let honest = results(&study);
    let plant = |defect: &dyn Fn(&str, &mut f64), only: &str| {
        let mut planted = honest.clone();
        for (case, result) in study.cases().iter().zip(&mut planted) {
            if case.label.starts_with(only) {
                result.as_mut().unwrap().values.iter_mut().for_each(|(name, value)| defect(name, value));
            }
        }
        study.conclude(&planted)
    };
    let one_nan = |name: &str, value: &mut f64| *value = if name == "superclose 64" { f64::NAN } else { *value };
    assert_eq!(plant(&one_nan, "midpoint, n = 16").verdict, Verdict::Fail);
    let floor = |name: &str, value: &mut f64| *value = if name.starts_with("tip") { value.max(1e-3) } else { *value };
    assert_eq!(plant(&floor, "midpoint").verdict, Verdict::Fail);
    // An order lost: 256 and 1024 steps are no better than 64.
    let first_order = |name: &str, value: &mut f64| {
        if name == "superclose 256" {
            *value *= 8.0;
        } else if name == "superclose 1024" {
            *value *= 64.0;
        }
    };
    assert_eq!(plant(&first_order, "midpoint").verdict, Verdict::Fail);
    let mut missing = honest.clone();
    missing[2] = Err(CaseFailure { reason: "planted".to_owned() });
    let outcome = study.conclude(&missing);
    assert_eq!(outcome.verdict, Verdict::Fail);
    assert!(outcome.checks.iter().any(|check| check.evidence == "planted"));
}

#[test]
fn a_claim_that_is_too_bold_fails() {
    let text = std::fs::read_to_string(folder().join("work-precision-manufactured.toml")).unwrap();
    let study = read(&text.replace("times = 100", "times = 100000")).unwrap();
    let outcome = study.conclude(&results(&study));
    assert_eq!(outcome.verdict, Verdict::Fail);
    assert_eq!(failed(&outcome).len(), 1);
}

#[test]
fn seconds_are_there_for_benchmarks_only() {
    let study = quick();
    let timed = study.timed().unwrap();
    assert!(timed.iter().all(|run| run.measurement.spent.seconds > 0.0));
    for measured in results(&study).into_iter().flatten() {
        assert!(measured.values.iter().all(|(name, _)| !name.contains("second")));
    }
}

#[test]
fn mistakes_are_named() {
    let head = "[study]\nid = \"w\"\nclaim = \"c\"\ntier = \"quick\"\nkind = \"work-precision\"\n[work-precision]\n";
    let grid = "elements = [4, 8]\nsteps = [8, 16]\n";
    for (body, piece) in [
        ("elements = [4, 8]\nsteps = [8, 12]\nsolution = \"midpoint-coupled.toml\"", "work-precision.steps"),
        ("elements = [8, 4]\nsteps = [8, 16]\nsolution = \"midpoint-coupled.toml\"", "work-precision.elements"),
        (grid, "exactly one of"),
        (&format!("{grid}vibration = [40]\nzeta = 0.1\nt_end = 1"), "modes that ring"),
        (&format!("{grid}vibration = [0]\nzeta = 0.1\nt_end = 1\nreference = [8, 8]"), "reference without scene"),
        (&format!("{grid}scene = \"scenes/paper-1-beta-0.toml\"\nt_end = 1\nreference = [9, 8]"), "a multiple"),
        (&format!("{grid}solution = \"midpoint-coupled.toml\"\n[[advantage]]\nnorm = \"tipp\""), "did you mean"),
    ] {
        let error = read(&format!("{head}{body}")).err().unwrap_or_else(|| panic!("{body} was accepted"));
        assert!(error.contains("study.toml:") && error.contains(piece), "{piece}: {error}");
    }
}
