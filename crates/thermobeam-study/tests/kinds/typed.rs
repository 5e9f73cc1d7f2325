//! What every kind with typed results must keep.

use convergence_study::judge::verdict::Verdict;
use convergence_study::study::outcome::Outcome;
use convergence_study::study::{CaseFailure, Kind, Ran};

/// The results of all cases, computed on this thread.
pub(crate) type Results<K> = Vec<Ran<<K as Kind>::Data, <K as Kind>::Found>>;

/// Runs all cases.
pub(crate) fn run<K: Kind>(study: &K) -> Results<K> {
    convergence_study::study::run_cases_here(study)
}

/// The verdict with one result changed.
pub(crate) fn verdict_with<K: Kind>(
    study: &K,
    sound: &Results<K>,
    index: usize,
    change: impl FnOnce(&mut K::Found),
) -> Verdict
where
    K::Data: Clone,
    K::Found: Clone,
{
    let mut planted = sound.clone();
    change(planted[index].found.as_mut().expect("a result"));
    study.judge(&planted).verdict
}

/// The study passes as it is, and fails once a case has failed or nothing was run.
#[track_caller]
pub(crate) fn passes_but_not_without_each_case<K: Kind>(study: &K) -> Results<K>
where
    K::Data: Clone,
    K::Found: Clone,
{
    let sound = run(study);
    let outcome = study.judge(&sound);
    assert_eq!(outcome.verdict, Verdict::Pass, "{}: {}", outcome.summary, report(&outcome));
    check_shape(&study.header().id, &outcome);
    for index in 0..sound.len() {
        let mut failed = sound.clone();
        failed[index].found = Err(CaseFailure { reason: "planted".into() });
        let outcome = study.judge(&failed);
        assert_eq!(outcome.verdict, Verdict::Fail, "case {index}: {}", sound[index].case.label);
        assert!(report(&outcome).contains("planted"));
    }
    assert_eq!(study.judge(&[]).verdict, Verdict::Fail);
    sound
}

/// Figures named after the study, tables without ragged rows, finite guarded numbers with names of their own.
fn check_shape(id: &str, outcome: &Outcome) {
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

/// Every verdict of an outcome with its reason, line by line.
pub(crate) fn report(outcome: &Outcome) -> String {
    let rates = outcome.rates.iter().map(|(name, rate)| format!("{name}: {} {}", rate.verdict, rate.reason));
    let checks = outcome.checks.iter().map(|check| format!("{}: {} {}", check.claim, check.verdict, check.evidence));
    rates.chain(checks).collect::<Vec<_>>().join("\n")
}
