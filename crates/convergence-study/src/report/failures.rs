//! What did not pass, and why: the first thing to read, on the page, in Markdown and on the
//! terminal. Then, in Markdown, what differs from the baseline: claims first and in full, then the
//! worst number of each study.

use std::cmp::Reverse;
use std::collections::HashSet;

use super::Findings;
use super::html::{badge, escape, phrase};
use super::markdown::{anchor, cell, table, text};
use super::section::folded;
use super::words::{blessing, can_be_blessed, summary};
use crate::input::visible;
use crate::judge::verdict::{Cause, Reason, Verdict};
use crate::run::Finished;
use crate::store::{Change, Movement, Record, diagnosis::Diagnosis};
use crate::study::kind::by_reason;
use crate::study::outcome::{Check, Origin};
use crate::text::number::short_text;

/// Most reasons listed for one study; its section has all of them.
const MOST_REASONS: usize = 8;

/// The same on a terminal, which shows only the clearest failures.
const SHOWN: usize = 2;

const TITLE: &str = "what fails and what does not";

/// A study that did not pass, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct NotPassed {
    /// Its id.
    pub id: String,
    /// Fail or inconclusive.
    pub verdict: Verdict,
    /// One line for each rate, check and case that did not pass; at least one.
    pub reasons: Vec<String>,
    /// What each kind of reason means, and what to do.
    pub advice: Vec<String>,
}

impl NotPassed {
    fn lines(&self) -> impl Iterator<Item = &String> {
        self.reasons.iter().chain(&self.advice)
    }
}

/// The studies that did not pass: failed ones first, then inconclusive ones, and last those that
/// did not pass because others did not.
pub fn not_passed(finished: &[Finished]) -> Vec<NotPassed> {
    in_order(finished).into_iter().map(reasons).collect()
}

/// The same studies in full.
pub(super) fn in_order(finished: &[Finished]) -> Vec<&Finished> {
    let mut studies: Vec<&Finished> = finished
        .iter()
        .filter(|finished| finished.outcome.verdict != Verdict::Pass)
        .collect();
    let ids: HashSet<&str> = studies
        .iter()
        .map(|study| study.header.id.as_str())
        .collect();
    studies.sort_by_key(|study| (names_another(study, &ids), Reverse(study.outcome.verdict)));
    studies
}

/// Whether a check that does not pass names another study that does not pass.
fn names_another(
    Finished {
        header, outcome, ..
    }: &Finished,
    ids: &HashSet<&str>,
) -> bool {
    let names = |check: &Check| {
        let others = check.other_studies.iter();
        others
            .map(String::as_str)
            .any(|id| id != header.id && ids.contains(id))
    };
    outcome
        .checks
        .iter()
        .filter(|check| check.verdict != Verdict::Pass)
        .any(names)
}

fn reasons(
    Finished {
        header,
        outcome,
        failed_cases,
        ..
    }: &Finished,
) -> NotPassed {
    let rates = outcome
        .rates
        .iter()
        .filter(|(_, rate)| rate.verdict != Verdict::Pass);
    let advice = Reason::ALL
        .into_iter()
        .filter(|&reason| rates.clone().any(|(_, rate)| rate.kind == reason));
    let advice = advice.map(|reason| format!("{}: {}", reason.code(), reason.advice()));
    let causes = Cause::ALL
        .into_iter()
        .filter(|&cause| rates.clone().any(|(_, rate)| rate.cause == Some(cause)));
    let advice = advice
        .chain(causes.map(|cause| cause.advice().to_owned()))
        .collect();
    let rates = rates.map(|(name, rate)| format!("{name}: {} ({})", rate.line(), rate.kind.code()));
    // The reasons already say that cases are missing.
    let is_said = |check: &Check| check.origin == Origin::Completion && !failed_cases.is_empty();
    let checks = outcome
        .checks
        .iter()
        .filter(|check| check.verdict != Verdict::Pass && !is_said(check));
    let checks = checks.map(|check| format!("{}: {}", check.statement(), check.evidence));
    // Missing cases first: they make rates and checks fail.
    let cases = by_reason(
        failed_cases
            .iter()
            .map(|failed| (&*failed.label, &*failed.reason)),
    );
    let cases = cases.into_iter().map(|line| format!("case {line}"));
    let mut reasons: Vec<String> = cases.chain(rates).chain(checks).collect();
    if reasons.is_empty() {
        reasons.push(summary(outcome));
    }
    let more = reasons.len().saturating_sub(MOST_REASONS);
    if more > 0 {
        reasons.truncate(MOST_REASONS);
        reasons.push(format!("and {more} more"));
    }
    NotPassed {
        id: header.id.clone(),
        verdict: outcome.verdict,
        reasons,
        advice,
    }
}

/// The same, the clearest first, and how many of them are shown; the others are folded.
fn clearest_first(record: &Record) -> (Vec<NotPassed>, usize) {
    let mut studies = not_passed(&record.studies);
    let Some(Diagnosis { clearest, .. }) = &record.diagnosis else {
        return (studies, usize::MAX);
    };
    let place = |study: &NotPassed| {
        clearest
            .iter()
            .position(|id| *id == study.id)
            .unwrap_or(usize::MAX)
    };
    studies.sort_by_key(place);
    (studies, clearest.len())
}

/// The same in Markdown, under a heading; empty if everything passed.
///
/// * `linked`: whether each id is a link to the section of its study.
pub(super) fn markdown(record: &Record, linked: bool) -> String {
    let (studies, shown) = clearest_first(record);
    let item = |study: &NotPassed| {
        let id = cell(&study.id);
        let name = if linked {
            format!("[{id}](#{})", anchor(&study.id))
        } else {
            id
        };
        let lines: String = study
            .lines()
            .map(|line| format!("  - {}\n", text(line)))
            .collect();
        format!("- {name}: **{}**\n{lines}", study.verdict)
    };
    let (first, rest) = studies.split_at(shown.min(studies.len()));
    let [first, others] = [first, rest].map(|part| part.iter().map(item).collect::<String>());
    match (first.is_empty(), rest.len()) {
        (true, _) => String::new(),
        (false, 0) => format!("## What did not pass\n\n{first}\n"),
        (false, more) => {
            format!(
                "## What did not pass\n\n{first}\n{}\n",
                folded(&format!("{more} more"), &others, false)
            )
        }
    }
}

/// The same for the page, each id a link to the section of its study.
pub(super) fn html(record: &Record) -> String {
    let (studies, shown) = clearest_first(record);
    let item = |study: &NotPassed| {
        let lines: String = study
            .lines()
            .map(|line| format!("<li>{}</li>\n", phrase(line)))
            .collect();
        let id = escape(&study.id);
        format!(
            "<li><a href=\"#{id}\">{id}</a> {}\n<ul>\n{lines}</ul></li>\n",
            badge(study.verdict)
        )
    };
    let (first, rest) = studies.split_at(shown.min(studies.len()));
    let list =
        |part: &[NotPassed]| format!("<ul>\n{}</ul>\n", part.iter().map(item).collect::<String>());
    let folded = format!(
        "<details>\n<summary>{} more</summary>\n{}</details>\n",
        rest.len(),
        list(rest)
    );
    match (first.is_empty(), rest.is_empty()) {
        (true, _) => String::new(),
        (false, true) => format!("<h2>What did not pass</h2>\n{}", list(first)),
        (false, false) => format!("<h2>What did not pass</h2>\n{}{folded}", list(first)),
    }
}

/// The same in plain text; empty if everything passed.
///
/// * `clearest`: the studies to show, with their first reasons; `None` for all studies with all
///   their reasons.
pub fn text_of_failures(finished: &[Finished], clearest: Option<&[String]>) -> String {
    let text = |study: NotPassed| {
        let lines: String = study
            .lines()
            .map(|line| format!("  {}\n", visible(line)))
            .collect();
        format!("{}: {}\n{lines}\n", study.id, study.verdict)
    };
    let mut studies = not_passed(finished);
    if let Some(ids) = clearest {
        studies.retain(|study| ids.contains(&study.id));
        studies.sort_by_key(|study| ids.iter().position(|id| *id == study.id));
        let advice: Vec<String> = studies.iter_mut().filter_map(shorten).collect();
        let first = |k: &usize| !advice[..*k].contains(&advice[*k]);
        let advice: String = (0..advice.len())
            .filter(first)
            .take(SHOWN)
            .map(|k| visible(&advice[k]) + "\n")
            .collect();
        return studies
            .into_iter()
            .map(|study| text(study).trim_end().to_owned() + "\n")
            .collect::<String>()
            + &advice;
    }
    studies.into_iter().map(text).collect()
}

/// Keeps only the first reasons; returns the first advice.
fn shorten(
    NotPassed {
        reasons, advice, ..
    }: &mut NotPassed,
) -> Option<String> {
    let left = reasons.len().saturating_sub(SHOWN);
    reasons.truncate(SHOWN);
    if let Some(last) = reasons.last_mut().filter(|_| left > 0) {
        *last += &format!("; and {left} more");
    }
    std::mem::take(advice).into_iter().next()
}

/// The known facts about the cause, line by line under a title.
pub fn text_of_diagnosis(diagnosis: &Diagnosis) -> String {
    let line = |(word, text): (&str, String)| format!("  {word:<10} {}\n", visible(&text));
    format!(
        "{TITLE}\n{}",
        diagnosis.lines().into_iter().map(line).collect::<String>()
    )
}

/// The same in Markdown; empty if nothing fails.
pub(super) fn diagnosis_in_markdown(diagnosis: Option<&Diagnosis>) -> String {
    let Some(diagnosis) = diagnosis else {
        return String::new();
    };
    // A line without a word goes on with the one before.
    let line = |(word, words): (&str, String)| match word {
        "" => format!("  - {}\n", text(&words)),
        word => format!("- **{word}**: {}\n", text(&words)),
    };
    format!(
        "## {TITLE}\n\n{}\n",
        diagnosis.lines().into_iter().map(line).collect::<String>()
    )
}

/// Claims, the worst number of each study, how to accept them, and all numbers, folded; a part may
/// be empty, otherwise it ends with an empty line.
///
/// * `link`: a study's id in Markdown, with a link if the text can have one.
pub(super) fn changes(findings: &Findings<'_>, link: &dyn Fn(&str) -> String) -> Vec<String> {
    let (claims, numbers): (Vec<&Change>, Vec<&Change>) = findings
        .record
        .moves()
        .iter()
        .partition(|change| change.movement.needs_a_reason());
    // Numbers of studies that fail move for the same cause.
    let fails = |id: &str| {
        findings
            .record
            .studies
            .iter()
            .any(|study| study.header.id == id && !study.outcome.verdict.is_pass())
    };
    let numbers: Vec<&Change> = numbers
        .into_iter()
        .filter(|change| !fails(&change.study))
        .collect();
    vec![
        of_claims(&claims, link),
        worst(&numbers, link),
        acceptance(findings),
        all(&numbers),
    ]
}

fn of_claims(changes: &[&Change], link: &dyn Fn(&str) -> String) -> String {
    if changes.is_empty() {
        return String::new();
    }
    let line = |change: &&Change| {
        let words = change.words();
        let rest = words.strip_prefix(change.study.as_str()).unwrap_or(&words);
        format!("- {}{}\n", link(&change.study), text(rest))
    };
    format!(
        "## Claims changed\n\n{}\n",
        changes.iter().map(line).collect::<String>()
    )
}

/// One row for each study: its worst number.
fn worst(changes: &[&Change], link: &dyn Fn(&str) -> String) -> String {
    if changes.is_empty() {
        return String::new();
    }
    let mut studies: Vec<(&Change, usize)> = changes
        .chunk_by(|one, next| one.study == next.study)
        .filter_map(|of_study| Some((heaviest(of_study)?, of_study.len())))
        .collect();
    // The sort is stable: of equals the first ones win.
    studies.sort_by(|(a, _), (b, _)| b.movement.weight().total_cmp(&a.movement.weight()));
    let row = |(change, count): &(&Change, usize)| {
        let Change {
            study, movement, ..
        } = change;
        vec![
            link(study),
            count.to_string(),
            cell(&change.subject()),
            cell(&movement.to_string()),
            times(movement),
        ]
    };
    let head = [
        "study",
        "numbers",
        "the worst of them",
        "change",
        "times its tolerance",
    ];
    let order = "The worst number of each study; first those that moved by the largest multiple of their tolerance.";
    format!(
        "## Moved from the baseline\n\n{order}\n\n{}\n",
        table(&head, studies.iter().map(row).collect())
    )
}

/// The first of the largest weight.
fn heaviest<'c>(changes: &[&'c Change]) -> Option<&'c Change> {
    changes
        .iter()
        .rev()
        .copied()
        .max_by(|a, b| a.movement.weight().total_cmp(&b.movement.weight()))
}

/// By how many times its tolerance a number has moved, with two digits; a dash if that is
/// undefined.
fn times(movement: &Movement) -> String {
    let weight = movement.weight();
    if weight == 0.0 || !weight.is_finite() {
        return "-".to_owned();
    }
    short_text(weight)
}

/// How to accept them, or why that is refused.
fn acceptance(findings: &Findings<'_>) -> String {
    let Findings {
        project,
        record:
            Record {
                command,
                studies,
                diagnosis,
                ..
            },
        ..
    } = findings;
    match findings.record.moves() {
        [] => String::new(),
        moves if can_be_blessed(studies) => {
            let alike = diagnosis
                .as_ref()
                .map(Diagnosis::alike)
                .filter(|alike| !alike.is_empty());
            let alike = alike.map_or(String::new(), |alike| {
                format!("Planted mistakes that move them alike: {alike}.\n\n")
            });
            format!(
                "{alike}If it is meant: `{}`.\n\n",
                blessing(project, command, studies, moves)
            )
        }
        _ => "`--bless` refuses until the studies that did not pass are mended.\n\n".to_owned(),
    }
}

/// Every number, folded; empty if the table above has them all.
fn all(changes: &[&Change]) -> String {
    if changes
        .chunk_by(|one, next| one.study == next.study)
        .all(|of_study| of_study.len() == 1)
    {
        return String::new();
    }
    let row = |change: &&Change| {
        vec![
            cell(&change.study),
            cell(&change.subject()),
            cell(&change.movement.to_string()),
        ]
    };
    let lines = table(
        &["study", "what", "change"],
        changes.iter().map(row).collect(),
    );
    folded(&format!("all {} numbers", changes.len()), &lines, false) + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::diagnosis::Resembling;

    #[test]
    fn a_line_of_the_diagnosis_without_a_word_belongs_to_the_one_before() {
        let resembling = |mistake: &str| Resembling {
            mistake: mistake.to_owned(),
            file: "f.rs".to_owned(),
            likeness: 0.9,
        };
        let diagnosis = Diagnosis {
            resembles: ["one", "two"].map(resembling).to_vec(),
            ..Diagnosis::default()
        };
        let text = diagnosis_in_markdown(Some(&diagnosis));
        let lines = "- **resembles**: \"one\" (0.90)  f.rs\n  - \"two\" (0.90)  f.rs\n";
        assert!(text.ends_with(&format!("\n{lines}\n")), "{text}");
    }
}
