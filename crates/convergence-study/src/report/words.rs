//! Verdicts in words, the same ones for report and terminal.

use crate::project::Project;
use crate::run::Finished;
use crate::store::{GuardedChange, Movement, without_baseline};
use crate::study::outcome::{NamedRate, Outcome};
use crate::text::lists::{self, and_more};
use crate::text::number::{
    RATE_PLACES, committed_rate, counted, counted_as, decimals, interval_places,
};
use crate::text::prose::Prose;
use convergence_judge::verdict::{RateVerdict, Reason, Verdict, against_claim, judged_in_words};

/// Most studies that a sentence names.
const NAMED: usize = 3;

/// The verdict on a run in one line, without the verdict itself.
///
/// * `changes`: what moved away from the baseline; `None` without a baseline.
pub(crate) fn sentence(finished: &[Finished], changes: Option<&[GuardedChange]>) -> String {
    let verdicts = [
        (Verdict::Fail, "fail"),
        (Verdict::Inconclusive, "inconclusive"),
    ];
    let counts: Vec<String> = verdicts
        .into_iter()
        .filter_map(|(verdict, words)| count_of_studies(finished, verdict, words))
        .collect();
    let studies = match finished {
        [] => "no study was run".to_owned(),
        [only] => match only.outcome.verdict {
            Verdict::Pass => "the study passes".to_owned(),
            Verdict::Fail => "the study fails".to_owned(),
            Verdict::Inconclusive => "the study is inconclusive".to_owned(),
        },
        _ if !counts.is_empty() => counts.join(", "),
        all => format!("all {} studies pass", all.len()),
    };
    match changes {
        Some(changes) => format!("{studies}; {}", baseline_in_words(finished, changes)),
        None => studies,
    }
}

/// `2 of 30 fail (one, another)`; `None` if no study has the verdict.
fn count_of_studies(finished: &[Finished], verdict: Verdict, words: &str) -> Option<String> {
    let ids: Vec<&str> = finished
        .iter()
        .filter(|study| study.outcome.verdict == verdict)
        .map(|study| study.header.id.as_str())
        .collect();
    if ids.is_empty() {
        return None;
    }
    let count = ids.len();
    let names = ids[..count.min(NAMED)].join(", ");
    let more = and_more(count, NAMED);
    Some(format!(
        "{count} of {} {words} ({names}{more})",
        finished.len()
    ))
}

/// How many numbers and claims differ from the baseline.
fn baseline_in_words(finished: &[Finished], changes: &[GuardedChange]) -> String {
    match without_baseline(finished, changes) {
        Some(numbers) if can_be_blessed(finished) => {
            let numbers = counted(numbers, "number");
            return format!("not yet in the baseline: {numbers} to accept");
        }
        Some(_) => return "not yet in the baseline".to_owned(),
        None => {}
    }
    if changes.is_empty() {
        let studies = finished.iter();
        return match studies.map(|study| study.outcome.quantities.len()).sum() {
            0_usize => "no baseline values".to_owned(),
            n => format!("all {n} baseline values unchanged"),
        };
    }
    // Whoever accepts the numbers of a new study accepts the study, too.
    let mut movements = changes.iter().map(|change| &change.movement);
    let has_numbers = movements.any(|movement| matches!(movement, Movement::New { .. }));
    let counted = changes
        .iter()
        .filter(|change| !(has_numbers && change.movement == Movement::NewStudy));
    let sorts = lists::grouped(counted.map(|change| (sort(&change.movement), ())));
    let sorts = sorts.into_iter();
    let parts: Vec<String> = sorts
        .map(|([one, several], alike)| counted_as(alike.len(), one, several))
        .collect();
    parts.join(", ")
}

/// What changes of this sort are called: one, and several.
fn sort(movement: &Movement) -> [&'static str; 2] {
    match movement {
        Movement::VanishedStudy { .. } => ["study deleted", "studies deleted"],
        Movement::Elsewhere => ["study not in this program", "studies not in this program"],
        Movement::Settings { .. } => [
            "study with changed settings",
            "studies with changed settings",
        ],
        Movement::Stale { .. } => [
            "table older than its inputs",
            "tables older than its inputs",
        ],
        Movement::Remade { .. } => [
            "table made anew from changed inputs",
            "tables made anew from changed inputs",
        ],
        Movement::Claim { .. } | Movement::Guard { .. } => ["claim changed", "claims changed"],
        Movement::New { .. } => [
            "number not yet in the baseline",
            "numbers not yet in the baseline",
        ],
        Movement::NewStudy => [
            "study not yet in the baseline",
            "studies not yet in the baseline",
        ],
        Movement::Moved { .. }
        | Movement::Tolerance { .. }
        | Movement::Vanished { .. }
        | Movement::DeletedLine => ["baseline value changed", "baseline values changed"],
    }
}

/// The command that blesses these changes: for the full tier if a study changed that was not run,
/// on demand if one of them loosens what is guarded.
///
/// * `command`: the command that was run.
pub(crate) fn blessing(
    project: &Project,
    command: &str,
    finished: &[Finished],
    changes: &[GuardedChange],
) -> String {
    let all_run = changes.iter().all(|change| {
        let is_gone = matches!(
            change.movement,
            Movement::VanishedStudy { .. } | Movement::Vanished { .. }
        );
        is_gone || finished.iter().any(|study| study.header.id == change.study)
    });
    let full = format!("{} verify --tier full", project.command);
    let loosened = if changes.iter().any(|change| change.movement.is_loosened()) {
        " --loosened"
    } else {
        ""
    };
    format!(
        "{} --bless{loosened}",
        if all_run { command } else { &full }
    )
}

/// Whether `--bless` would be accepted: it is refused if a study does not pass.
pub(crate) fn can_be_blessed(finished: &[Finished]) -> bool {
    finished
        .iter()
        .all(|finished| finished.outcome.verdict == Verdict::Pass)
}

/// The numbers to read first: the study's own, or the rate that decides against its order; then the
/// failures, and how much was not judged.
pub(crate) fn key_numbers(outcome: &Outcome) -> String {
    let Outcome {
        headline,
        rates,
        checks,
        left_out,
        ..
    } = outcome;
    let mut parts = if headline.is_empty() {
        rates_in_words(rates)
    } else {
        vec![headline.to_string()]
    };
    parts.extend(count_not_passed(
        rates.iter().map(|named| named.rate.verdict),
        "rates",
    ));
    parts.extend(count_not_passed(
        checks.iter().map(|check| check.verdict),
        "checks",
    ));
    if parts.is_empty() {
        parts.push(match checks.len() {
            0 => "nothing judged".to_owned(),
            n => format!("all {n} checks pass"),
        });
    }
    parts.extend(left_out.iter().cloned());
    parts.join("; ")
}

/// A study's findings in a sentence. Rates that do not pass are grouped by reason and claim; a
/// table has each of them.
pub(crate) fn summary(outcome: &Outcome) -> String {
    let mut rates = outcome.rates.iter();
    let all_pass = rates.all(|rate| rate.rate.verdict.is_pass());
    let summary = match &outcome.after_rates {
        Some(more) if !all_pass => &Prose::from(grouped(&outcome.rates)).then(more),
        _ => &outcome.summary,
    };
    summary.to_string()
}

/// The rates that do not pass, grouped by reason and claim:
/// `8 of 8 rates too low: 1.000 to 1.004, claimed 2 ± 0.01`.
fn grouped(rates: &[NamedRate]) -> String {
    let not_passed = rates.iter().filter(|rate| !rate.rate.verdict.is_pass());
    let groups =
        lists::grouped(not_passed.map(|named| ((named.rate.code, named.rate.claim()), named)));
    let mut parts = vec![];
    for ((kind, claim), group) in &groups {
        if let [NamedRate { name, rate, .. }] = group[..] {
            parts.push(format!("{name}: {}", rate.line()));
            continue;
        }
        let range = range(group.iter().map(|named| &named.rate));
        let reason = kind.brief();
        let count = format!("{} of {} rates", group.len(), rates.len());
        parts.push(match kind {
            Reason::TooLow | Reason::TooHigh => {
                format!("{count} {reason}: {}", against_claim(&range, claim))
            }
            _ => format!("{count}: {}", judged_in_words(&range, claim, reason)),
        });
    }
    parts.join("; ")
}

/// From the lowest to the highest of several rates, with digits that all of them have in their
/// table.
pub(super) fn range<'r>(rates: impl Iterator<Item = &'r RateVerdict>) -> String {
    let mut low = f64::INFINITY;
    let mut high = f64::NEG_INFINITY;
    let mut fewest_places = None;
    for rate in rates {
        let Some(fitted) = rate.fitted else { continue };
        low = low.min(fitted);
        high = high.max(fitted);
        let places = rate
            .interval
            .map_or(3, |ends| interval_places(ends, RATE_PLACES));
        fewest_places = Some(fewest_places.map_or(places, |fewest: usize| fewest.min(places)));
    }
    let Some(places) = fewest_places else {
        return "no rate".to_owned();
    };
    let low = decimals(low, places);
    let high = decimals(high, places);
    if low == high {
        low
    } else {
        format!("{low} to {high}")
    }
}

/// The worst rate, and the largest distance of the others from their orders.
fn rates_in_words(rates: &[NamedRate]) -> Vec<String> {
    // Of several worst rates, the first that the study names.
    let worst = rates.iter().rev().max_by_key(|named| named.rate.verdict);
    let Some(NamedRate {
        name, rate: worst, ..
    }) = worst
    else {
        return vec![];
    };
    let mut parts = vec![format!("{name} {}", worst.beside_order(RATE_PLACES - 1))];
    // A rate may be far above its least order.
    let distances: Option<Vec<f64>> = rates
        .iter()
        .map(|NamedRate { rate, .. }| {
            let distance = (committed_rate(rate.fitted?) - rate.order()?).abs();
            (!rate.bound.is_least()).then_some(distance)
        })
        .collect();
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

/// `1 of 3 rates do not pass`; `None` if all pass.
fn count_not_passed(verdicts: impl Iterator<Item = Verdict>, items: &str) -> Option<String> {
    let mut all = 0;
    let mut not_passed = 0;
    for verdict in verdicts {
        all += 1;
        not_passed += usize::from(verdict != Verdict::Pass);
    }
    (not_passed > 0).then(|| format!("{not_passed} of {all} {items} do not pass"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::outcome::Check;
    use convergence_judge::verdict::judge_pairs;

    fn rate(exponent: f64, order: f64) -> NamedRate {
        let pairs = (3..8).map(|k| (0.5_f64.powi(k), 0.5_f64.powi(k).powf(exponent)));
        NamedRate::new(format!("of {exponent}"), judge_pairs(pairs, order, 0.05))
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
        let headline = "largest residual 1e-16".into();
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
