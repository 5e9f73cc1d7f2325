//! What a run that passes has verified: sentences of the project, one plot, and its statements, each with the numbers that answer it.

use super::Findings;
use super::markdown::{cell, table, text};
use super::section::figure;
use super::words::key_numbers;
use crate::judge::verdict::Verdict;
use crate::run::Finished;
use crate::study::Figure;
use crate::text::number::RATE_PLACES;

/// In Markdown, and the plot in it; empty where the run does not pass, or has none of the studies.
///
/// * `link`: a study's id as it is written.
pub(super) fn front<'f>(findings: &'f Findings<'_>, link: &dyn Fn(&str) -> String) -> (String, Option<&'f Figure>) {
    let record = findings.record;
    let front = &findings.project.front;
    let find = |id: &str| record.studies.iter().find(|study| study.header.id == id);
    let answered = front.statements.iter().filter_map(|(statement, id, rate)| Some((*statement, find(id)?, *rate)));
    let answered: Vec<(&str, &Finished, &str)> = answered.collect();
    if record.verdict != Verdict::Pass || answered.is_empty() {
        return (String::new(), None);
    }
    let picture = findings.figures().find(|figure| figure.file == front.plot);
    let row = |(statement, study, name): &(&str, &Finished, &str)| {
        let rate = study.outcome.rates.iter().find(|(norm, _)| norm == name);
        let rate = rate.map(|(_, rate)| format!("rate {}, claimed {}", rate.rate_in_words(RATE_PLACES), rate.claim()));
        vec![cell(statement), cell(&rate.unwrap_or_else(|| key_numbers(&study.outcome))), link(&study.header.id)]
    };
    let statements = table(&["statement", "found", "study"], answered.iter().map(row).collect());
    let plot = picture.map(figure).unwrap_or_default();
    (format!("## What is verified\n\n{}\n\n{plot}\n{statements}\n", text(front.verified)), picture)
}
