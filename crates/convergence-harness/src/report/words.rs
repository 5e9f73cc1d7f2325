//! Verdicts in words, the same ones for report and terminal.

use crate::judge::verdict::{RateVerdict, Reason, Verdict, against_claim, judged_in_words};
use crate::project::Project;
use crate::run::Finished;
use crate::store::{Change, Movement, without_baseline};
use crate::study::coverage::incomplete;
use crate::study::outcome::{Outcome, joined};
use crate::text::lists::{self, and_more};
use crate::text::number::{RATE_PLACES, committed_rate, counted, decimals, interval_places};

/// Most studies that a sentence names.
const NAMED: usize = 3;

/// The verdict on a run in one line, without the verdict itself.
///
/// * `changes`: what moved away from the baseline; `None` without a baseline.
pub fn sentence(finished: &[Finished], changes: Option<&[Change]>) -> String {
    let of = |verdict: Verdict| {
        let ids = finished
            .iter()
            .filter(move |finished| finished.outcome.verdict == verdict);
        ids.map(|finished| finished.header.id.as_str())
            .collect::<Vec<_>>()
    };
    let failed = of(Verdict::Fail);
    let inconclusive = of(Verdict::Inconclusive);
    let studies = match finished.len() {
        0 => "no study was run".to_owned(),
        1 if failed.is_empty() && inconclusive.is_empty() => "the study passes".to_owned(),
        n if failed.is_empty() && inconclusive.is_empty() => format!("all {n} studies pass"),
        n => {
            let count = |ids: &[&str], what: &str| match ids {
                [] => None,
                ids => {
                    let more = and_more(ids.len(), NAMED);
                    let named = ids[..ids.len().min(NAMED)].join(", ");
                    Some(format!("{} of {n} {what} ({named}{more})", ids.len()))
                }
            };
            let counts = [count(&failed, "fail"), count(&inconclusive, "inconclusive")];
            counts.into_iter().flatten().collect::<Vec<_>>().join(", ")
        }
    };
    match changes {
        Some(changes) => format!("{studies}; {}", guarded(finished, changes)),
        None => studies,
    }
}

fn guarded(finished: &[Finished], changes: &[Change]) -> String {
    match without_baseline(finished, changes) {
        Some(numbers) if can_be_blessed(finished) => {
            return format!("no baseline yet: {} to accept", counted(numbers, "number"));
        }
        Some(_) => return "no baseline yet".to_owned(),
        None => {}
    }
    let guarded: usize = finished
        .iter()
        .map(|finished| finished.outcome.quantities.len())
        .sum();
    let numbers = changes
        .iter()
        .filter(|change| matches!(change.movement, Movement::New { .. }))
        .count();
    let files = changes
        .iter()
        .filter(|change| matches!(change.movement, Movement::NewFile { guarded: 0, .. }))
        .count();
    let claims = changes
        .iter()
        .filter(|change| change.movement.is_of_one_claim())
        .count();
    let deleted = changes
        .iter()
        .filter(|change| matches!(change.movement, Movement::VanishedFile { .. }))
        .count();
    let count = |n: usize, [one, many]: [&str; 2]| match n {
        0 => None,
        1 => Some(format!("1 {one}")),
        n => Some(format!("{n} {many}")),
    };
    // Whoever accepts the numbers of a new study accepts its claims, too.
    let new = match (numbers, files) {
        (0, 0) => None,
        (0, files) => count(files, ["study", "studies"]),
        (numbers, _) => count(numbers, ["number", "numbers"]),
    };
    let new = new.map(|new| format!("{new} not yet in the baseline"));
    let values = changes.len() - claims - deleted - numbers - files;
    let changed = [
        count(deleted, ["study deleted", "studies deleted"]),
        count(claims, ["claim changed", "claims changed"]),
        count(
            values,
            ["baseline value changed", "baseline values changed"],
        ),
        new,
    ];
    match (changes.len(), guarded) {
        (0, 0) => "no baseline values".to_owned(),
        (0, n) => format!("all {n} baseline values unchanged"),
        _ => changed.into_iter().flatten().collect::<Vec<_>>().join(", "),
    }
}

/// The command that blesses these changes: for the full tier if a study changed that was not run,
/// with a reason if a claim did.
///
/// * `command`: the command that was run.
pub fn blessing(
    project: &Project,
    command: &str,
    finished: &[Finished],
    changes: &[Change],
) -> String {
    let was_run = |change: &Change| {
        finished
            .iter()
            .any(|finished| finished.header.id == change.study)
    };
    let is_gone = |change: &Change| {
        matches!(
            change.movement,
            Movement::VanishedFile { .. } | Movement::Vanished { .. }
        )
    };
    let all_run = changes
        .iter()
        .all(|change| was_run(change) || is_gone(change));
    let full = format!("{} verify --tier full", project.command);
    let reason = if changes
        .iter()
        .any(|change| change.movement.needs_a_reason())
    {
        " --reason TEXT"
    } else {
        ""
    };
    format!("{} --bless{reason}", if all_run { command } else { &full })
}

/// Whether `--bless` would be accepted: it is refused if a study does not pass.
pub fn can_be_blessed(finished: &[Finished]) -> bool {
    finished
        .iter()
        .all(|finished| finished.outcome.verdict == Verdict::Pass)
}

/// The numbers to read first: the study's own, or the rate that decides against its order; then the
/// failures, and how much was not judged.
pub fn key_numbers(outcome: &Outcome) -> String {
    let Outcome {
        headline,
        rates,
        checks,
        coverage,
        ..
    } = outcome;
    let mut parts = if headline.is_empty() {
        of_rates(rates)
    } else {
        vec![headline.clone()]
    };
    parts.extend(not_passed(
        rates.iter().map(|(_, rate)| rate.verdict),
        "rates",
    ));
    parts.extend(not_passed(
        checks.iter().map(|check| check.verdict),
        "checks",
    ));
    if parts.is_empty() {
        parts.push(match checks.len() {
            0 => "nothing judged".to_owned(),
            n => format!("all {n} checks pass"),
        });
    }
    parts.extend(incomplete(coverage));
    parts.join("; ")
}

/// A study's findings in a sentence. Rates that do not pass are grouped by reason and claim; a
/// table has each of them.
pub fn summary(outcome: &Outcome) -> String {
    let all_pass = outcome
        .rates
        .iter()
        .all(|(_, rate)| rate.verdict == Verdict::Pass);
    match &outcome.after_rates {
        Some(more) if !all_pass => joined(&grouped(&outcome.rates), more),
        _ => outcome.summary.clone(),
    }
}

/// The rates that do not pass, grouped by reason and claim:
/// `8 of 8 rates too low: 1.000 to 1.004, claimed 2 ± 0.01`.
fn grouped(rates: &[(String, RateVerdict)]) -> String {
    let missed = rates
        .iter()
        .filter(|(_, rate)| rate.verdict != Verdict::Pass);
    let groups = lists::grouped(missed.map(|missed| ((missed.1.kind, missed.1.claim()), missed)));
    let one = |((kind, claim), group): &((Reason, String), Vec<&(String, RateVerdict)>)| {
        if let [(name, rate)] = group[..] {
            return format!("{name}: {}", rate.line());
        }
        let found = range(group.iter().map(|(_, rate)| rate));
        let why = kind.brief();
        let count = format!("{} of {} rates", group.len(), rates.len());
        match kind {
            Reason::TooLow | Reason::TooHigh => {
                format!("{count} {why}: {}", against_claim(&found, claim))
            }
            _ => format!("{count}: {}", judged_in_words(&found, claim, why)),
        }
    };
    groups.iter().map(one).collect::<Vec<_>>().join("; ")
}

/// From the lowest to the highest of several rates, with digits that all of them have in their
/// table.
pub(super) fn range<'r>(rates: impl Iterator<Item = &'r RateVerdict>) -> String {
    let known: Vec<(f64, usize)> = rates
        .filter_map(|rate| {
            Some((
                rate.fitted?,
                rate.interval
                    .map_or(3, |ends| interval_places(ends, RATE_PLACES)),
            ))
        })
        .collect();
    let Some(places) = known.iter().map(|(_, places)| *places).min() else {
        return "no rate".to_owned();
    };
    let end = |pick: fn(f64, f64) -> f64| {
        known
            .iter()
            .map(|(rate, _)| *rate)
            .reduce(pick)
            .unwrap_or(f64::NAN)
    };
    let [low, high] = [end(f64::min), end(f64::max)].map(|rate| decimals(rate, places));
    if low == high {
        low
    } else {
        format!("{low} to {high}")
    }
}

/// The worst rate, and the largest distance of the others from their orders.
fn of_rates(rates: &[(String, RateVerdict)]) -> Vec<String> {
    // Of several worst rates, the first that the study names.
    let Some((name, worst)) = rates.iter().rev().max_by_key(|(_, rate)| rate.verdict) else {
        return vec![];
    };
    let mut parts = vec![format!("{name} {}", worst.beside_order(RATE_PLACES - 1))];
    let distance =
        |(_, rate): &(String, RateVerdict)| Some((committed_rate(rate.fitted?) - rate.order).abs());
    let distances: Option<Vec<f64>> = rates.iter().map(distance).collect();
    if let Some(distances) = distances.filter(|_| worst.verdict == Verdict::Pass && rates.len() > 1)
    {
        // Rates are kept with four decimals: smaller distances cannot be stated.
        let farthest = distances.into_iter().fold(1e-4, f64::max);
        parts.push(format!(
            "{} rates within {farthest:.4} of their orders",
            rates.len()
        ));
    }
    parts
}

fn not_passed(verdicts: impl Iterator<Item = Verdict> + Clone, what: &str) -> Option<String> {
    let all = verdicts.clone().count();
    let missed = verdicts.filter(|verdict| *verdict != Verdict::Pass).count();
    (missed > 0).then(|| format!("{missed} of {all} {what} do not pass"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::verdict::judge_pairs;
    use crate::study::outcome::Check;

    fn rate(exponent: f64, order: f64) -> (String, RateVerdict) {
        let pairs = (3..8).map(|k| (0.5_f64.powi(k), 0.5_f64.powi(k).powf(exponent)));
        (format!("of {exponent}"), judge_pairs(pairs, order, 0.05))
    }

    #[test]
    fn passing_rates_are_summed_up_by_the_farthest_from_its_order() {
        let outcome = Outcome::new("", vec![rate(1.0, 1.0), rate(2.02, 2.0)], vec![]);
        assert_eq!(
            key_numbers(&outcome),
            "of 1 1.000 (order 1); 2 rates within 0.0200 of their orders"
        );
    }

    #[test]
    fn rates_and_checks_that_do_not_pass_are_counted() {
        let checks = vec![Check::that(false, "c", "e"), Check::that(true, "d", "e")];
        let outcome = Outcome::new("", vec![rate(1.0, 1.0), rate(1.5, 2.0)], checks);
        let expected =
            "of 1.5 1.500 (order 2); 1 of 2 rates do not pass; 1 of 2 checks do not pass";
        assert_eq!(key_numbers(&outcome), expected);
        let headline = "largest residual 1e-16".to_owned();
        let own = Outcome {
            headline,
            ..outcome
        };
        assert!(
            key_numbers(&own).starts_with("largest residual 1e-16; 1 of 2 rates"),
            "{}",
            key_numbers(&own)
        );
    }

    #[test]
    fn without_rates_and_words_of_its_own_a_study_has_its_checks() {
        let check = || Check::that(true, "c", "e");
        assert_eq!(
            key_numbers(&Outcome::new("", vec![], vec![check(), check()])),
            "all 2 checks pass"
        );
        assert_eq!(
            key_numbers(&Outcome::new("", vec![], vec![])),
            "nothing judged"
        );
    }
}
