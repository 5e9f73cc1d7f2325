//! What differs from the baseline, in Markdown: claims first and in full, then the worst number of
//! each study, then all numbers, folded.

use super::Findings;
use super::markdown::{cell, table, text};
use super::section::folded;
use super::words::{blessing, can_be_blessed};
use crate::store::{GuardedChange, Movement, Record, without_baseline};
use crate::text::number::short_text;

/// Claims, the worst number of each study, how to accept them, and all numbers, folded; a part may
/// be empty, otherwise it ends with an empty line.
///
/// * `link`: a study's id in Markdown, with a link if the text can have one.
pub(super) fn changes(findings: &Findings<'_>, link: &dyn Fn(&str) -> String) -> Vec<String> {
    let record = findings.record;
    if without_baseline(&record.studies, record.moves()).is_some() {
        return vec![acceptance(findings)];
    }
    let (claims, numbers): (Vec<&GuardedChange>, Vec<&GuardedChange>) = record
        .moves()
        .iter()
        .partition(|change| change.movement.is_of_claims());
    // Numbers of studies that fail move for the same cause.
    let failing: Vec<&str> = record
        .studies
        .iter()
        .filter(|study| !study.outcome.verdict.is_pass())
        .map(|study| study.header.id.as_str())
        .collect();
    let numbers: Vec<&GuardedChange> = numbers
        .into_iter()
        .filter(|change| !failing.contains(&change.study.as_str()))
        .collect();
    vec![
        list_of_claims(&claims, link),
        table_of_worst_numbers(&numbers, link),
        acceptance(findings),
        table_of_all_numbers(&numbers),
    ]
}

fn list_of_claims(changes: &[&GuardedChange], link: &dyn Fn(&str) -> String) -> String {
    if changes.is_empty() {
        return String::new();
    }
    let mut list = "## Claims changed\n\n".to_owned();
    for change in changes {
        let GuardedChange {
            study,
            name,
            movement,
        } = change;
        list += &format!(
            "- {}: {} {}\n",
            link(study),
            text(name),
            text(&movement.to_string())
        );
    }
    list + "\n"
}

/// One row for each study: its worst number.
fn table_of_worst_numbers(changes: &[&GuardedChange], link: &dyn Fn(&str) -> String) -> String {
    if changes.is_empty() {
        return String::new();
    }
    let mut studies: Vec<(&GuardedChange, usize)> = changes
        .chunk_by(|one, next| one.study == next.study)
        .filter_map(|of_study| Some((heaviest(of_study)?, of_study.len())))
        .collect();
    // The sort is stable: of equals the first ones win.
    studies.sort_by(|(a, _), (b, _)| b.movement.weight().total_cmp(&a.movement.weight()));
    let mut rows = vec![];
    for (change, count) in studies {
        rows.push(vec![
            link(&change.study),
            count.to_string(),
            cell(&change.name),
            cell(&change.movement.to_string()),
            multiple_of_tolerance(&change.movement),
        ]);
    }
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
        table(&head, rows)
    )
}

/// The first of the largest weight.
fn heaviest<'c>(changes: &[&'c GuardedChange]) -> Option<&'c GuardedChange> {
    changes
        .iter()
        .rev()
        .copied()
        .max_by(|a, b| a.movement.weight().total_cmp(&b.movement.weight()))
}

/// By how many times its tolerance a number has moved, with two digits; a dash if that is
/// undefined.
fn multiple_of_tolerance(movement: &Movement) -> String {
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
        record: Record {
            command, studies, ..
        },
        ..
    } = findings;
    match findings.record.moves() {
        [] => String::new(),
        moves if can_be_blessed(studies) && without_baseline(studies, moves).is_some() => {
            let command = blessing(project, command, studies, moves);
            format!("`{command}` accepts them.\n\n")
        }
        moves if can_be_blessed(studies) => {
            let command = blessing(project, command, studies, moves);
            format!("If it is meant: `{command}`.\n\n")
        }
        _ => "`--bless` refuses until the studies that did not pass are mended.\n\n".to_owned(),
    }
}

/// Every number, folded; empty if the table above has them all.
fn table_of_all_numbers(changes: &[&GuardedChange]) -> String {
    if changes
        .chunk_by(|one, next| one.study == next.study)
        .all(|of_study| of_study.len() == 1)
    {
        return String::new();
    }
    let mut rows = vec![];
    for change in changes {
        rows.push(vec![
            cell(&change.study),
            cell(&change.name),
            cell(&change.movement.to_string()),
        ]);
    }
    let lines = table(&["study", "what", "change"], rows);
    folded(&format!("all {} numbers", changes.len()), &lines, false) + "\n"
}
