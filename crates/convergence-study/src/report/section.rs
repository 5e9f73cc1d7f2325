//! The section of one study.

use super::html::phrase;
use super::markdown::{cell, table, text};
use super::tables::tables;
use super::words::summary;
use crate::judge::verdict::Verdict;
use crate::run::Finished;
use crate::study::outcome::{Figure, Table};

/// A longer table is folded: what it shows has been said in a sentence, a rate or a figure before.
const MOST_ROWS: usize = 12;

/// Claim, verdict in words, tables, figures, and how to run it again.
///
/// * `again`: the command that runs it again.
pub(super) fn section(finished: &Finished, again: &str) -> String {
    let header = &finished.header;
    format!("\n## {}\n\n> {}\n\n{}", header.id, text(&header.claim), body(finished, again, false))
}

/// All of a section but heading and claim.
///
/// * `whole`: long tables of a study that passes are in it, too; else it says where they are.
pub(super) fn body(finished: &Finished, again: &str, whole: bool) -> String {
    let Finished { header, outcome, .. } = finished;
    let mut parts = vec![format!("{}: {}\n", marked(outcome.verdict), text(&summary(outcome)))];
    let passes = outcome.verdict == Verdict::Pass;
    parts.extend(tables(finished).iter().map(|table| titled(table, passes, whole || !passes)));
    parts.extend(outcome.figures.iter().map(figure));
    let (tier, kind) = (header.tier.name(), &header.kind);
    parts.push(format!("Again: `{again}` (tier {tier}, kind {kind})\n"));
    parts.join("\n")
}

/// The verdict; in bold where it is not a pass.
pub(super) fn marked(verdict: Verdict) -> String {
    if verdict == Verdict::Pass { verdict.to_string() } else { format!("**{verdict}**") }
}

/// The lines of a table in Markdown, without its title.
pub fn markdown(Table { head, rows, .. }: &Table) -> String {
    table(&cells(head), rows.iter().map(|row| cells(row)).collect())
}

/// A table under its title; a long one is folded, but open in a study that does not pass.
fn titled(table: &Table, passes: bool, whole: bool) -> String {
    let (Table { title, rows, .. }, lines) = (table, markdown(table));
    if rows.len() <= MOST_ROWS {
        return format!("**{}**\n\n{lines}", text(title));
    }
    if !whole {
        return format!("**{}**: {} rows, in [results.json](results.json) and on the page\n", text(title), rows.len());
    }
    folded(&format!("<b>{}</b>: {} rows", phrase(title), rows.len()), &lines, !passes)
}

/// What can be unfolded under a summary, which is HTML.
pub(super) fn folded(summary: &str, lines: &str, open: bool) -> String {
    let open = if open { " open=\"\"" } else { "" };
    format!("<details{open}>\n<summary>{summary}</summary>\n\n{lines}\n</details>\n")
}

fn cells(row: &[String]) -> Vec<String> {
    row.iter().map(|raw| cell(raw)).collect()
}

/// The picture with its caption, which is also what is read where it cannot be seen.
pub(super) fn figure(figure: &Figure) -> String {
    let alternative = figure.caption.replace(['[', ']', '\n', '`', '\\'], " ");
    format!("![{alternative}](figures/{})\n\n*{}*\n", figure.file, text(&figure.caption))
}
