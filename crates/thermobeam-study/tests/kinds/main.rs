//! Kinds of study, each against its own files and against planted defects: a check that cannot fail proves nothing.

mod bifurcation;
mod calibration;
mod controls;
mod energy;
mod equilibrium;
mod experiment;
mod frequencies;
mod planted;
mod refused;
mod rigid;
mod self_convergence;
mod solvers;
mod typed;
mod vibration;
mod work_precision;

use convergence_study::judge::verdict::Verdict;
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::Outcome;
use std::path::{Path, PathBuf};
use thermobeam_study::kinds::Study;
use thermobeam_study::kinds::untyped::Measured;

type Results = Vec<Result<Measured, CaseFailure>>;

/// A file of the repository's `studies/`.
fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies").join(name)
}

fn text(name: &str) -> String {
    std::fs::read_to_string(file(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn results(study: &dyn Study) -> Results {
    (0..study.cases().len()).map(|index| study.run(index)).collect()
}

/// A picture that is named after its study, figures without NaN, and numbers that the baseline can guard.
fn check_shape(study: &dyn Study, outcome: &Outcome) {
    let id = &study.header().id;
    assert!(!outcome.figures.is_empty() && !outcome.tables.is_empty() && !outcome.quantities.is_empty());
    for figure in &outcome.figures {
        assert!(figure.file.starts_with(&format!("{id}-")) && figure.file.ends_with(".svg"), "{}", figure.file);
        assert!(figure.svg.starts_with("<svg") && !figure.caption.is_empty());
    }
    for table in &outcome.tables {
        assert!(table.rows.iter().all(|row| row.len() == table.head.len()), "{}", table.title);
    }
    let mut names: Vec<&str> = outcome.quantities.iter().map(|quantity| quantity.name.as_str()).collect();
    assert!(outcome.quantities.iter().all(|quantity| quantity.value.is_finite() && quantity.tolerance > 0.0));
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), outcome.quantities.len());
}

/// The study passes as it is, and fails once a case has failed, is missing, or knows nothing.
#[track_caller]
fn passes_but_not_without_each_case(study: &dyn Study) {
    let sound = results(study);
    let outcome = study.conclude(&sound);
    assert_eq!(outcome.verdict, Verdict::Pass, "{}: {}", outcome.summary, report(&outcome));
    check_shape(study, &outcome);
    for index in 0..sound.len() {
        let mut failed = sound.clone();
        failed[index] = Err(CaseFailure { reason: "planted".into() });
        let outcome = study.conclude(&failed);
        assert_eq!(outcome.verdict, Verdict::Fail);
        assert!(report(&outcome).contains("planted"));
        let mut empty = sound.clone();
        empty[index] = Ok(Measured::default());
        assert_eq!(study.conclude(&empty).verdict, Verdict::Fail, "an empty result {index}");
    }
    assert_eq!(study.conclude(&sound[1..]).verdict, Verdict::Fail);
    assert_eq!(study.conclude(&[]).verdict, Verdict::Fail);
}

fn report(outcome: &Outcome) -> String {
    let rates = outcome.rates.iter().map(|(name, rate)| format!("{name}: {} {}", rate.verdict, rate.reason));
    let checks = outcome.checks.iter().map(|check| format!("{}: {} {}", check.claim, check.verdict, check.evidence));
    rates.chain(checks).collect::<Vec<_>>().join("\n")
}

/// The results with the number of that name changed in every case, told its index.
fn changed(results: &Results, name: &str, change: impl Fn(usize, f64) -> f64) -> Results {
    let mut results = results.clone();
    for (index, result) in results.iter_mut().enumerate() {
        let measured = result.as_mut().expect("a result");
        let value = measured.values.iter_mut().find(|(key, _)| key == name).unwrap_or_else(|| panic!("no {name}"));
        value.1 = change(index, value.1);
    }
    results
}
