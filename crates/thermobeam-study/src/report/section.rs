//! The section of one study.

use super::html::phrase;
use super::markdown::{cell, table, text};
use super::tables::tables;
use crate::outcome::{Figure, Table};
use crate::runner::Finished;
use crate::verdict::Verdict;

/// A longer table is folded: what it shows has been said in a sentence, a rate or a figure before.
const MOST_ROWS: usize = 12;

/// Claim, verdict in words, tables, figures, and how to run it again.
pub(super) fn section(finished: &Finished) -> String {
    let header = &finished.header;
    format!("\n## {}\n\n> {}\n\n{}", header.id, text(&header.claim), body(finished))
}

/// All of a section but heading and claim.
pub(super) fn body(finished: &Finished) -> String {
    let Finished { header, outcome, .. } = finished;
    let mut parts = vec![format!("{}: {}\n", marked(outcome.verdict), text(&outcome.summary))];
    let passes = outcome.verdict == Verdict::Pass;
    parts.extend(tables(finished).iter().map(|table| titled(table, passes)));
    parts.extend(outcome.figures.iter().map(figure));
    let (tier, kind) = (header.tier.name(), &header.kind);
    parts.push(format!("Again: `cargo xtask verify {}` (tier {tier}, kind {kind})\n", header.id));
    parts.join("\n")
}

/// The verdict; in bold where it is not a pass.
pub(super) fn marked(verdict: Verdict) -> String {
    if verdict == Verdict::Pass { verdict.to_string() } else { format!("**{verdict}**") }
}

/// A table under its title; a long one is folded, but open in a study that does not pass.
fn titled(Table { title, head, rows }: &Table, passes: bool) -> String {
    let lines = table(&cells(head), rows.iter().map(|row| cells(row)).collect());
    if rows.len() <= MOST_ROWS {
        return format!("**{}**\n\n{lines}", text(title));
    }
    let open = if passes { "" } else { " open=\"\"" };
    let (title, count) = (phrase(title), rows.len());
    format!("<details{open}>\n<summary><b>{title}</b>: {count} rows</summary>\n\n{lines}\n</details>\n")
}

fn cells(row: &[String]) -> Vec<String> {
    row.iter().map(|raw| cell(raw)).collect()
}

/// The picture with its caption, which is also what is read where it cannot be seen.
fn figure(figure: &Figure) -> String {
    let alternative = figure.caption.replace(['[', ']', '\n', '`', '\\'], " ");
    format!("![{alternative}](figures/{})\n\n*{}*\n", figure.file, text(&figure.caption))
}
