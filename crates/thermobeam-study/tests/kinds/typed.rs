//! Requirements on every typed kind of study, and defects planted in its results.

use convergence_study::{CaseFailure, Kind, NamedRate, Outcome, Ran, Verdict};

/// The results of a study: every case, run on this thread.
pub(crate) type Runs<K> = Vec<Ran<<K as Kind>::Data, <K as Kind>::Found>>;

/// The results after `change` was applied to each; it also receives the number of the case.
pub(crate) fn changed<K: Kind>(sound: &Runs<K>, change: impl Fn(usize, &mut K::Found)) -> Runs<K>
where
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
    K::Found: Clone,
{
    let mut planted = sound.clone();
    change(planted[index].found.as_mut().expect("a result"));
    let (before, after) = (study.outcome_of(sound), study.outcome_of(&planted));
    let less = counted(&after, items).expect("an item that is left out");
    let (judged, of_reason) = counted(&before, items).map_or((less.asked, 0), |count| {
        (count.judged, count.of_reason(reason))
    });
    assert_eq!(
        (less.judged + 1, less.of_reason(reason)),
        (judged, of_reason + 1),
        "{less:?}"
    );
    assert!(
        after.summary.to_string().contains(&less.words),
        "{}",
        after.summary
    );
}

/// How many items are judged, as the words say it.
#[derive(Debug)]
pub(crate) struct Counted {
    pub(crate) judged: usize,
    pub(crate) asked: usize,
    words: String,
}

impl Counted {
    /// Those left out for this reason.
    fn of_reason(&self, reason: &str) -> usize {
        let (_, reasons) = self.words.split_once(" not: ").expect("reasons");
        if reasons == reason {
            return self.asked - self.judged;
        }
        let end = reasons.find(&format!(" {reason}"));
        let count = end.and_then(|end| reasons[..end].rsplit(' ').next()?.parse().ok());
        count.unwrap_or(0)
    }
}

/// The count of these items; `None` if all are judged.
pub(crate) fn counted(outcome: &Outcome, items: &str) -> Option<Counted> {
    let mut all = outcome.left_out.iter();
    let words = all.find(|words| words.contains(&format!(" {items} judged;")))?;
    let mut numbers = words.split(' ').filter_map(|word| word.parse().ok());
    Some(Counted {
        judged: numbers.next()?,
        asked: numbers.next()?,
        words: words.clone(),
    })
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
