//! Requirements on every typed kind of study, and defects planted in its results.

use convergence_study::{CaseFailure, Coverage, Kind, NamedRate, Outcome, Ran, Verdict};

/// The results of a study: every case, run on this thread.
pub(crate) type Runs<K> = Vec<Ran<<K as Kind>::Data, <K as Kind>::Found>>;

/// The results after `change` was applied to each; it also receives the number of the case.
pub(crate) fn changed<K: Kind>(sound: &Runs<K>, change: impl Fn(usize, &mut K::Found)) -> Runs<K>
where
    K::Data: Clone,
    K::Found: Clone,
{
    let mut runs = sound.clone();
    for (index, ran) in runs.iter_mut().enumerate() {
        change(index, ran.found.as_mut().expect("a result"));
    }
    runs
}

/// The study passes unchanged, and fails if a case has failed or is missing: the summary then says
/// that one case less was judged.
///
/// * Returns the results for further tests.
#[track_caller]
pub(crate) fn passes_but_not_without_each_case<K: Kind>(study: &K) -> Runs<K>
where
    K::Data: Clone,
    K::Found: Clone,
{
    let sound = study.run_here();
    let outcome = study.outcome_of(&sound);
    let (summary, all) = (&outcome.summary, sound.len());
    assert_eq!(
        outcome.verdict,
        Verdict::Pass,
        "{summary}: {}",
        report(&outcome)
    );
    check_shape(&outcome);
    assert!(!outcome.coverage.is_empty());
    for index in 0..all {
        let mut failed = sound.clone();
        failed[index].found = Err(CaseFailure::new("planted"));
        let outcome = study.outcome_of(&failed);
        assert_eq!(outcome.verdict, Verdict::Fail, "case {index} failed");
        let report = report(&outcome);
        assert!(report.contains("planted"), "{report}");
        assert!(
            !report.contains("the outcome of the study is sound"),
            "{report}"
        );
        let words = format!("{} of {all} cases judged; 1 not: without a result", all - 1);
        let summary = outcome.summary.to_string();
        assert!(summary.contains(&words), "{summary}");
    }
    assert_ne!(study.judge(&[]).verdict, Verdict::Pass);
    sound
}

/// A changed result leaves out one item, for that reason, and the summary says so.
///
/// * `items`: what is counted.
#[track_caller]
pub(crate) fn leaves_one_out<K: Kind>(
    study: &K,
    sound: &Runs<K>,
    index: usize,
    [items, reason]: [&str; 2],
    change: impl FnOnce(&mut K::Found),
) where
    K::Data: Clone,
    K::Found: Clone,
{
    let mut planted = sound.clone();
    change(planted[index].found.as_mut().expect("a result"));
    let (before, after) = (study.judge(sound), study.outcome_of(&planted));
    let [before, less] = [&before, &after].map(|outcome| counted(outcome, items));
    assert_eq!(
        (less.asked, less.judged + 1),
        (before.asked, before.judged),
        "{less}"
    );
    let of_reason = |coverage: &Coverage| {
        let left = coverage.left_out.iter().find(|left| left.reason == reason);
        left.map_or(0, |left| left.count)
    };
    assert_eq!(of_reason(less), of_reason(before) + 1, "{less}");
    assert!(
        after.summary.to_string().contains(&less.to_string()),
        "{}",
        after.summary
    );
}

/// The count of these items.
#[track_caller]
pub(crate) fn counted<'o>(outcome: &'o Outcome, items: &str) -> &'o Coverage {
    let coverage = outcome
        .coverage
        .iter()
        .find(|coverage| coverage.items == items);
    coverage.unwrap_or_else(|| panic!("no count of {items}: {:?}", outcome.coverage))
}

/// The outcome has numbers, and all that it has can be shown.
#[track_caller]
fn check_shape(outcome: &Outcome) {
    assert!(!outcome.tables.is_empty() || !outcome.levels.is_empty() || !outcome.rates.is_empty());
    assert!(!outcome.quantities.is_empty());
    for check in &outcome.checks {
        assert!(!check.subject.quantity.is_empty(), "{}", check.claim);
    }
    for quantity in &outcome.quantities {
        assert!(!quantity.subject.quantity.is_empty(), "{}", quantity.name);
        assert!(
            quantity.value.is_finite() && quantity.tolerance > 0.0,
            "{}",
            quantity.name
        );
    }
    for figure in &outcome.figures {
        assert!(figure.svg.starts_with("<svg") && !figure.caption.is_empty());
    }
}

/// All judged items, with their evidence.
pub(crate) fn report(outcome: &Outcome) -> String {
    let rates = outcome
        .rates
        .iter()
        .map(|NamedRate { name, rate, .. }| format!("{name}: {} {}", rate.verdict, rate.reason));
    let checks = outcome.checks.iter().map(|check| {
        let statement = check.statement();
        format!("{statement}: {} {}", check.verdict, check.evidence)
    });
    rates.chain(checks).collect::<Vec<_>>().join("\n")
}
