//! The report for readers: what was claimed, what was found, and how to see it again. It only
//! reads, it never computes.
//!
//! The same outcomes give the same bytes, except for the page: it names its commit, day and
//! machine, if given, and should not be committed.

mod changes;
mod failures;
mod forest;
mod html;
mod markdown;
mod narrow;
mod page;
mod section;
pub(crate) mod shared;
mod tables;
mod words;

use std::io;

use crate::exchange::csv_field;
use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::run::Finished;
use crate::store::{Provenance, README, Record, ReportSet, json, junit};
use crate::study::outcome::Figure;
use crate::text::lists::distinct;
use crate::text::named::NamedNumber;
use crate::text::number::committed;
use markdown::{cell, text};

pub use failures::{text_of_diagnosis, text_of_failures};
pub use section::markdown;
pub use tables::tables;
pub use words::{blessing, sentence};
pub(crate) use words::{can_be_blessed, key_numbers, summary};

/// The subject of a report.
#[derive(Debug, Clone, Copy)]
pub struct Findings<'f> {
    /// Whose studies they are.
    pub project: &'f Project,
    /// What was found.
    pub record: &'f Record,
    /// The page of the report on the full tier to point to, relative to this one's folder; its
    /// Markdown if it has no page.
    pub see_also: Option<&'f str>,
    /// Where the run comes from: only for the page.
    pub provenance: Option<&'f Provenance>,
}

/// The report on the full tier in Markdown, which is committed, as seen from the folder of that on
/// the quick one.
pub(crate) const FULL: &str = "full/README.md";

/// The files of a report that git ignores, and that browsers, programs and continuous integration
/// read: they show the newest run, whether it passes or not.
pub const NEWEST: [&str; 5] = [
    "errors.csv",
    "index.html",
    "junit.xml",
    "results.json",
    "summary.md",
];

/// [`NEWEST`] of a report.
pub(crate) fn newest(set: &ReportSet) -> ReportSet {
    let mut newest = ReportSet::default();
    for path in NEWEST {
        if let Some(bytes) = set.get(path) {
            newest.replace(path, bytes.clone());
        }
    }
    newest
}

/// Bytes of the longest comment: GitHub takes 65536 characters.
pub const LONGEST: usize = 65_000;

impl Findings<'_> {
    /// All files of a report; all except `index.html` have the same bytes for the same outcomes.
    ///
    /// # Errors
    /// Two figures with the same name, and errors of the writers of JSON and XML.
    pub fn files(&self) -> io::Result<ReportSet> {
        let Self {
            project, record, ..
        } = self;
        let mut set = ReportSet::default();
        let readme = self.readme();
        set.add(README, readme.as_str())?;
        set.add("index.html", self.page())?;
        set.add("summary.md", self.digest())?;
        set.add("results.json", json(record)?)?;
        set.add("junit.xml", junit(project.name, record))?;
        set.add("errors.csv", self.errors_csv())?;
        for figure in self.rates().iter().chain(self.figures()) {
            set.add(shared::path(&readme, &figure.file), figure.svg.as_str())?;
        }
        Ok(set)
    }

    fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.record
            .studies
            .iter()
            .flat_map(|finished| &finished.outcome.figures)
    }

    /// The picture of the rates nearest to a failure.
    fn rates(&self) -> Option<Figure> {
        forest::figure(&self.record.studies)
    }

    /// The report in Markdown: the verdict, one table, then a section for each study.
    pub fn readme(&self) -> String {
        let link = |id: &str| self.link(id, &markdown::anchor(id));
        let mut page = format!("# Verification report\n\n{}", self.verdict_line());
        let one = if self.record.changes.is_some() {
            "; a name after it repeats one study"
        } else {
            ""
        };
        page += &format!(
            "Written by `{}`, which repeats it{one}. ",
            self.record.command
        );
        page += "Orders are theory, rates are observed.";
        if self.see_also.is_some() {
            page += &format!(" See also [the report on the full tier]({FULL}).");
        }
        page += &format!(
            "\n\n{}{}{}",
            self.diagnosis(),
            failures::markdown(self.record, true),
            changes::changes(self, &link).concat()
        );
        page += &section::front(self, &link).markdown;
        page += &self
            .rates()
            .as_ref()
            .map(section::figure)
            .unwrap_or_default();
        page += &format!("\n## All studies\n{}", self.overview(link));
        let mut captions = vec![];
        for study in &self.record.studies {
            page += &section::section(study, &self.command_for(study), &mut captions);
        }
        page
    }

    /// A study's id in Markdown; a link to its section if it has one.
    fn link(&self, id: &str, anchor: &str) -> String {
        let has_a_section = self
            .record
            .studies
            .iter()
            .any(|finished| finished.header.id == id);
        if has_a_section {
            format!("[{}](#{anchor})", cell(id))
        } else {
            cell(id)
        }
    }

    /// The same as one self-contained page.
    pub fn page(&self) -> String {
        page::page(self)
    }

    /// The part of the report for the page of a CI run and for a comment: no links, no sections.
    ///
    /// Failures come first; a part that would make the text longer than [`LONGEST`] is left out,
    /// and the text says so.
    pub fn digest(&self) -> String {
        let mut digest = format!(
            "## Verification, {}\n\n{}",
            self.record.scope,
            self.verdict_line()
        );
        let passes = self
            .record
            .studies
            .iter()
            .filter(|finished| finished.outcome.verdict == Verdict::Pass)
            .count();
        let folded = section::folded(
            &format!("{passes} of {} studies pass", self.record.studies.len()),
            &self.overview(cell),
            false,
        );
        let failures = failures::markdown(self.record, false);
        let parts = [
            vec![self.diagnosis(), failures],
            changes::changes(self, &cell),
            vec![folded],
        ]
        .concat();
        let too_long = "\nA comment holds no more: see the report.\n";
        for part in parts {
            if digest.len() + part.len() + too_long.len() > LONGEST {
                return digest + too_long;
            }
            digest += &part;
        }
        digest
    }

    fn diagnosis(&self) -> String {
        failures::diagnosis_in_markdown(self.record.diagnosis.as_ref())
    }

    /// The command that runs a study again.
    pub(super) fn command_for(&self, finished: &Finished) -> String {
        // Numbers compared with the baseline come from `verify`, which knows each study by its id.
        if self.record.changes.is_some() {
            format!("{} verify {}", self.project.command, finished.header.id)
        } else {
            self.record.command.clone()
        }
    }

    /// The verdict in one line, without the verdict itself.
    pub fn sentence(&self) -> String {
        sentence(&self.record.studies, self.record.changes.as_deref())
    }

    fn verdict_line(&self) -> String {
        format!(
            "**{}**: {}\n\n",
            self.record.verdict,
            text(&self.sentence())
        )
    }

    /// A list for each group of studies.
    fn overview(&self, id: impl Fn(&str) -> String) -> String {
        let mut overview = String::new();
        for (group, studies) in forest::grouped(self.project, &self.record.studies) {
            overview += &format!("\n**{}**\n\n", text(group));
            for Finished {
                header, outcome, ..
            } in studies
            {
                overview += &narrow::item(&format!(
                    "**{}** {}: {} ({})",
                    outcome.verdict,
                    id(&header.id),
                    text(&header.claim),
                    text(&key_numbers(outcome))
                ));
            }
        }
        overview
    }

    /// Errors in long form, one per line.
    pub fn errors_csv(&self) -> String {
        let levels = self
            .record
            .studies
            .iter()
            .flat_map(|finished| &finished.outcome.levels);
        let parameters =
            distinct(levels.flat_map(|level| level.parameters.iter().map(|known| &known.name)));
        let mut csv: String = ["study"]
            .into_iter()
            .chain(parameters.iter().map(|name| name.as_str()))
            .map(|name| csv_field(name) + ",")
            .collect();
        csv += "norm,error\n";
        for Finished {
            header, outcome, ..
        } in &self.record.studies
        {
            for level in &outcome.levels {
                let mut values = String::new();
                for name in &parameters {
                    if let Some(value) = level.parameter(name) {
                        values += &value.to_string();
                    }
                    values += ",";
                }
                for NamedNumber { name, value } in &level.errors {
                    csv += &format!(
                        "{},{values}{},{}\n",
                        csv_field(&header.id),
                        csv_field(name),
                        committed(*value)
                    );
                }
            }
        }
        csv
    }
}
