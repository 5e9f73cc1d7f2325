//! Verdicts in words, the same ones for report and terminal.

use crate::baseline::Change;
use crate::outcome::Outcome;
use crate::record::rate_text;
use crate::runner::Finished;
use crate::verdict::Verdict;

/// The verdict on a run in one line, without the verdict itself.
pub fn sentence(finished: &[Finished], changes: &[Change]) -> String {
    let of = |verdict: Verdict| {
        let ids = finished.iter().filter(move |finished| finished.outcome.verdict == verdict);
        ids.map(|finished| finished.header.id.as_str()).collect::<Vec<_>>()
    };
    let (failed, inconclusive) = (of(Verdict::Fail), of(Verdict::Inconclusive));
    let studies = match finished.len() {
        0 => "no study was run".to_owned(),
        1 if failed.is_empty() && inconclusive.is_empty() => "the study passes".to_owned(),
        n if failed.is_empty() && inconclusive.is_empty() => format!("all {n} studies pass"),
        n => {
            let count = |ids: &[&str], what: &str| match ids {
                [] => None,
                ids => Some(format!("{} of {n} {what} ({})", ids.len(), ids.join(", "))),
            };
            [count(&failed, "fail"), count(&inconclusive, "inconclusive")]
                .into_iter()
                .flatten()
                .collect::<Vec<_>>()
                .join(", ")
        }
    };
    format!("{studies}; {}", guarded(finished, changes))
}

fn guarded(finished: &[Finished], changes: &[Change]) -> String {
    let guarded: usize = finished.iter().map(|finished| finished.outcome.quantities.len()).sum();
    match (changes.len(), guarded) {
        (0, 0) => "no number is guarded".to_owned(),
        (0, n) => format!("of {n} guarded numbers none has moved"),
        (1, _) => "one guarded number is not what it was".to_owned(),
        (n, _) => format!("{n} guarded numbers are not what they were"),
    }
}

/// Whether a blessing is worth a hint: it is refused where a study does not pass.
pub fn can_be_blessed(finished: &[Finished]) -> bool {
    finished.iter().all(|finished| finished.outcome.verdict == Verdict::Pass)
}

/// The numbers to read first: the rate that decides against its order, and how many of all parts pass.
pub fn key_numbers(outcome: &Outcome) -> String {
    let mut parts = Vec::new();
    // The last of the worst would do as well; the first is the one that the study names first.
    let worst = outcome.rates.iter().rev().max_by_key(|(_, rate)| rate.verdict);
    if let Some((norm, rate)) = worst {
        let fitted = rate.fitted.map_or_else(|| "has no rate".to_owned(), |fitted| rate_text(Some(fitted)));
        parts.push(format!("{norm} {fitted}, order {}", rate.order));
    }
    let rates = outcome.rates.iter().map(|(_, rate)| rate.verdict);
    parts.extend(passed(rates, "rates"));
    parts.extend(passed(outcome.checks.iter().map(|check| check.verdict), "checks"));
    if parts.is_empty() { "nothing judged".to_owned() } else { parts.join("; ") }
}

fn passed(verdicts: impl Iterator<Item = Verdict> + Clone, what: &str) -> Option<String> {
    let all = verdicts.clone().count();
    let passed = verdicts.filter(|verdict| *verdict == Verdict::Pass).count();
    (all > 0).then(|| format!("{passed}/{all} {what}"))
}
