//! The section of one study.

use super::markdown::{cell, table, text};
use super::tables::tables;
use crate::outcome::{Figure, Table};
use crate::runner::Finished;
use crate::verdict::Verdict;

/// Claim, verdict in words, tables, figures, and how to run it again.
pub(super) fn section(finished: &Finished) -> String {
    let Finished { header, outcome, .. } = finished;
    let mut parts = vec![
        format!("\n## {}\n", header.id),
        format!("> {}\n", text(&header.claim)),
        format!("{}: {}\n", marked(outcome.verdict), text(&outcome.summary)),
    ];
    parts.extend(tables(finished).iter().map(titled));
    parts.extend(outcome.figures.iter().map(figure));
    let (tier, kind) = (header.tier.name(), &header.kind);
    parts.push(format!("Again: `cargo xtask verify {}` (tier {tier}, kind {kind})\n", header.id));
    parts.join("\n")
}

/// The verdict; in bold where it is not a pass.
pub(super) fn marked(verdict: Verdict) -> String {
    if verdict == Verdict::Pass { verdict.to_string() } else { format!("**{verdict}**") }
}

fn titled(Table { title, head, rows }: &Table) -> String {
    let rows = rows.iter().map(|row| cells(row)).collect();
    format!("**{}**\n\n{}", text(title), table(&cells(head), rows))
}

fn cells(row: &[String]) -> Vec<String> {
    row.iter().map(|raw| cell(raw)).collect()
}

/// The picture with its caption, which is also what is read where it cannot be seen.
fn figure(figure: &Figure) -> String {
    let alternative = figure.caption.replace(['[', ']', '\n', '`', '\\'], " ");
    format!("![{alternative}](figures/{})\n\n*{}*\n", figure.file, text(&figure.caption))
}
