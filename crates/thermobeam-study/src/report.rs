//! The report for readers: what was claimed, what was found, and how to see it again. It reads, it never computes.
//!
//! The same outcomes give the same bytes. Nothing here knows of times or machines.

mod html;
mod markdown;
mod page;
mod section;
mod tables;
mod words;

use std::io;

use crate::baseline::Change;
use crate::junit::junit;
use crate::number::committed;
use crate::outcome::Figure;
use crate::record::{self, Precision, Record};
use crate::runner::Finished;
use crate::shelf::ReportSet;
use crate::verdict::Verdict;
use markdown::{cell, text};

pub use section::markdown;
pub use tables::tables;
pub use words::{can_be_blessed, key_numbers, sentence};

/// The figure that is put beside the report as `beam.svg`: others show it, and need a name that studies do not change.
const FRONT_PICTURE: &str = "section-5-beam.svg";

/// What is reported on.
#[derive(Debug, Clone, Copy)]
pub struct Findings<'f> {
    /// What was run, such as `quick`.
    pub scope: &'f str,
    /// The command that runs it again.
    pub command: &'f str,
    /// The studies.
    pub finished: &'f [Finished],
    /// What moved away from the baseline.
    pub changes: &'f [Change],
    /// The verdict on all.
    pub verdict: Verdict,
    /// Another report to point to: its title, and the path of its folder from this one's.
    pub see_also: Option<(&'f str, &'f str)>,
}

impl Findings<'_> {
    /// All committed files of a report.
    ///
    /// # Errors
    /// Two figures of one name, and what the writers of JSON and XML refuse.
    pub fn files(&self) -> io::Result<ReportSet> {
        let changes = self.changes.iter().map(Change::to_string).collect();
        let record = Record::new(self.scope, self.verdict, changes, self.finished, Precision::Committed);
        let mut set = ReportSet::default();
        set.add("README.md", self.readme())?;
        set.add("index.html", self.page())?;
        set.add("results.json", record::json(&record)?)?;
        set.add("junit.xml", junit(self.finished, self.changes).map_err(io::Error::other)?)?;
        set.add("errors.csv", self.errors_csv())?;
        if let Some(beam) = self.figures().find(|figure| figure.file == FRONT_PICTURE) {
            set.add("beam.svg", beam.svg.as_str())?;
        }
        for figure in self.figures() {
            set.add(format!("figures/{}", figure.file), figure.svg.as_str())?;
        }
        Ok(set)
    }

    fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.finished.iter().flat_map(|finished| &finished.outcome.figures)
    }

    /// The report in Markdown: the verdict, one table, then a section for each study.
    pub fn readme(&self) -> String {
        let link = |id: &str| format!("[{}](#{})", cell(id), markdown::anchor(id));
        let mut page = format!("# Verification report\n\n{}", self.verdict_line());
        page += &format!("Written by `{}`, which repeats it. Orders are theory, rates are observed.", self.command);
        if let Some((title, folder)) = self.see_also {
            page += &format!(" See also [{}]({folder}/README.md).", text(title));
        }
        page += &format!("\n\n{}{}", self.overview(link), self.moved());
        page.extend(self.finished.iter().map(section::section));
        page
    }

    /// The same as one page that needs nothing else.
    pub fn page(&self) -> String {
        page::page(self)
    }

    /// What of the report fits on one page of a continuous integration: no links, no sections.
    pub fn digest(&self) -> String {
        let title = format!("## Verification, {}\n\n", self.scope);
        title + &self.verdict_line() + &self.overview(cell) + &self.moved()
    }

    fn verdict_line(&self) -> String {
        format!("**{}**: {}\n\n", self.verdict, text(&sentence(self.finished, self.changes)))
    }

    fn overview(&self, id: impl Fn(&str) -> String) -> String {
        let row = |Finished { header, outcome, .. }: &Finished| {
            let verdict = section::marked(outcome.verdict);
            vec![id(&header.id), cell(&header.claim), verdict, cell(&key_numbers(outcome))]
        };
        markdown::table(&["study", "claim", "verdict", "key numbers"], self.finished.iter().map(row).collect())
    }

    /// What moved away from the baseline; nothing where nothing did.
    fn moved(&self) -> String {
        if self.changes.is_empty() {
            return String::new();
        }
        let row = |change: &Change| vec![cell(&change.study), cell(&change.name), cell(&change.movement.to_string())];
        let rows = self.changes.iter().map(row).collect();
        let table = section::untitled(&["study", "quantity", "change"], rows, "numbers");
        let bless = if can_be_blessed(self.finished) {
            format!("\nIf it is meant: `{} --bless`.\n", self.command)
        } else {
            String::new()
        };
        format!("\n## Moved from the baseline\n\n{table}{bless}")
    }

    /// Errors in long form, one a line.
    pub fn errors_csv(&self) -> String {
        let mut csv = String::from("study,elements,steps,norm,error\n");
        for Finished { header, outcome, .. } in self.finished {
            for level in &outcome.levels {
                for (norm, error) in &level.errors {
                    let (elements, steps) = (level.elements, level.steps);
                    csv += &format!("{},{elements},{steps},{},{}\n", field(&header.id), field(norm), committed(*error));
                }
            }
        }
        csv
    }
}

/// A field of a CSV line, in quotes where it needs them (RFC 4180).
fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}
