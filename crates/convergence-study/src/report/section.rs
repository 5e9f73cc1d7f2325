//! The section of one study, and the head of the report of a passing run: sentences of the project,
//! one plot, and its statements, each with the numbers that answer it.

use super::Findings;
use super::html::phrase;
use super::markdown::{cell, table, text};
use super::narrow::{item, narrow};
use super::tables::{CHECKS, tables};
use super::words::{key_numbers, summary};
use crate::judge::verdict::Verdict;
use crate::run::Finished;
use crate::study::outcome::{Figure, Table};
use crate::text::number::RATE_PLACES;

/// A longer table is folded: a sentence, a rate or a figure has already summarised it.
const MOST_ROWS: usize = 12;

/// Most tables shown of a passing study: rates, checks, errors, and one of its own.
const MOST_TABLES: usize = 4;

/// Most figures shown of a passing study; the others are on the page.
const MOST_FIGURES: usize = 3;

/// The section of a study in the Markdown report; short if it passes.
///
/// * `command`: runs it again.
/// * `captions`: of the figures so far. If the only figure of a study has such a caption, it is
///   only named.
pub(super) fn section<'f>(
    finished: &'f Finished,
    command: &str,
    captions: &mut Vec<&'f str>,
) -> String {
    let Finished {
        header, outcome, ..
    } = finished;
    let head = format!("\n## {}\n\n> {}\n\n", header.id, text(&header.claim));
    if outcome.verdict != Verdict::Pass {
        return head + &body(finished, command);
    }
    let mut parts = vec![format!("pass: {}\n", text(&summary(outcome)))];
    let mut elsewhere: Vec<String> = vec![];
    for table in &tables(finished, true) {
        let Table { title, rows, .. } = table;
        match &rows[..] {
            [row] if title == CHECKS => parts.push(format!(
                "**{CHECKS}**: {} ({})\n",
                text(&row[0]),
                text(&row[2])
            )),
            rows if rows.len() > MOST_ROWS || parts.len() > MOST_TABLES => {
                elsewhere.push(text(title));
            }
            _ => parts.push(format!("**{}**\n\n{}", text(title), narrowed(table))),
        }
    }
    elsewhere.dedup();
    if !elsewhere.is_empty() {
        parts.push(format!(
            "On the page, and in `results.json`: {}\n",
            elsewhere.join("; ")
        ));
    }
    let figures = &outcome.figures;
    let count = match &figures[..] {
        [only] if captions.contains(&only.caption.as_str()) => 0,
        all => all.len().min(MOST_FIGURES),
    };
    parts.extend(figures[..count].iter().map(figure));
    if count < figures.len() {
        let names = figures[count..].iter().map(|figure| text(&figure.file));
        let names = names.collect::<Vec<_>>().join(", ");
        parts.push(format!("Figures on the page: {names}\n"));
    }
    captions.extend(figures.iter().map(|figure| figure.caption.as_str()));
    head + &parts.join("\n")
}

/// A whole section except heading and claim, nothing left out: verdict in words, tables, figures,
/// and how to run the study again.
pub(super) fn body(finished: &Finished, command: &str) -> String {
    let Finished {
        header, outcome, ..
    } = finished;
    let mut parts = vec![format!(
        "{}: {}\n",
        emphasized(outcome.verdict),
        text(&summary(outcome))
    )];
    let passes = outcome.verdict == Verdict::Pass;
    parts.extend(
        tables(finished, false)
            .iter()
            .map(|table| with_title(table, passes)),
    );
    parts.extend(outcome.figures.iter().map(figure));
    let tier = header.tier.name();
    let kind = &header.kind;
    parts.push(format!("Again: `{command}` (tier {tier}, kind {kind})\n"));
    parts.join("\n")
}

/// The verdict; in bold unless it is a pass.
pub(super) fn emphasized(verdict: Verdict) -> String {
    if verdict == Verdict::Pass {
        verdict.to_string()
    } else {
        format!("**{verdict}**")
    }
}

/// The lines of a table in Markdown, without its title.
pub fn markdown(Table { head, rows, .. }: &Table) -> String {
    table(&cells(head), rows.iter().map(|row| cells(row)).collect())
}

/// The lines of a table for the committed report.
fn narrowed(Table { head, rows, .. }: &Table) -> String {
    narrow(&cells(head), rows.iter().map(|row| cells(row)).collect())
}

/// A table under its title; a long one is folded, except in a study that does not pass.
fn with_title(table: &Table, passes: bool) -> String {
    let Table { title, rows, .. } = table;
    let lines = markdown(table);
    if rows.len() <= MOST_ROWS {
        return format!("**{}**\n\n{lines}", text(title));
    }
    folded(
        &format!("<b>{}</b>: {} rows", phrase(title), rows.len()),
        &lines,
        !passes,
    )
}

/// Lines that can be unfolded under a summary, in HTML.
pub(super) fn folded(summary: &str, lines: &str, open: bool) -> String {
    let open = if open { " open=\"\"" } else { "" };
    format!("<details{open}>\n<summary>{summary}</summary>\n\n{lines}\n</details>\n")
}

fn cells(row: &[String]) -> Vec<String> {
    row.iter().map(|raw| cell(raw)).collect()
}

/// The picture with its caption, which is also its text alternative.
pub(super) fn figure(figure: &Figure) -> String {
    let alternative = figure.caption.replace(['[', ']', '\n', '`', '\\'], " ");
    format!(
        "![{alternative}](figures/{})\n\n*{}*\n",
        figure.file,
        text(&figure.caption)
    )
}

/// A piece of the report in Markdown, with the figures that it shows.
#[derive(Default)]
pub(super) struct Piece {
    pub(super) markdown: String,
    pub(super) figures: Vec<Figure>,
}

/// What is verified; empty if the run does not pass or contains none of the studies.
///
/// * `link`: how a study's id is written.
pub(super) fn front(findings: &Findings<'_>, link: &dyn Fn(&str) -> String) -> Piece {
    let record = findings.record;
    let front = &findings.project.front;
    let mut statements = String::new();
    for statement in front.statements {
        let mut studies = record.studies.iter();
        if let Some(study) = studies.find(|study| study.header.id == statement.study) {
            statements += &item(&format!(
                "**{}**: {} ({})",
                text(statement.text),
                text(&answer(study, statement.rate)),
                link(statement.study)
            ));
        }
    }
    if record.verdict != Verdict::Pass || statements.is_empty() {
        return Piece::default();
    }
    let mut parts = vec!["## What is verified\n".to_owned()];
    let mut figures = vec![];
    if let Some((_, picture)) = find_figure(&record.studies, front.picture) {
        parts.push(figure(&Figure {
            caption: front.subject.to_owned(),
            ..picture.clone()
        }));
        figures.push(picture.clone());
    }
    if !front.finding.is_empty() {
        parts.push(text(front.finding) + "\n");
    }
    parts.push(statements);
    if let Some((study, plot)) = find_figure(&record.studies, front.plot) {
        parts.push(format!("**{}**\n", link(&study.header.id)));
        parts.push(figure(plot));
        figures.push(plot.clone());
    }
    parts.push(text(front.verified) + "\n\n");
    Piece {
        markdown: parts.join("\n"),
        figures,
    }
}

/// The figure of that file, and its study.
fn find_figure<'f>(studies: &'f [Finished], file: &str) -> Option<(&'f Finished, &'f Figure)> {
    studies.iter().find_map(|study| {
        let mut figures = study.outcome.figures.iter();
        Some((study, figures.find(|figure| figure.file == file)?))
    })
}

/// The numbers of a study that answer a statement: the rate of this name, or its key numbers.
fn answer(study: &Finished, name: &str) -> String {
    let rate = study.outcome.rate(name);
    let rate = rate.map(|rate| format!("rate {}", rate.against(RATE_PLACES)));
    rate.unwrap_or_else(|| key_numbers(&study.outcome))
}
