//! The report for readers: what was claimed, what was found, and how to see it again. It only
//! reads, it never computes: its sentences stand in [`templates`].
//!
//! The same outcomes give the same bytes, except for the page: it names its commit, day and
//! machine, if given, and is not committed.

mod changes;
mod context;
mod failures;
mod forest;
mod junit;
mod markdown;
mod tables;
mod templates;
pub(crate) mod words;

use std::io;
use std::path::{Path, PathBuf};

use minijinja::value::{Serde, Value};
use serde::Serialize;

use crate::project::Project;
use crate::store::{FIGURES, ONLY_ON_PAGE, Provenance, README, Record, ReportSet, json};
use crate::study::Figure;
use templates::render;

pub(crate) use changes::Changes;
pub(crate) use failures::{text_of_diagnosis, text_of_failures};
pub(crate) use junit::junit;
pub(crate) use junit::{Suite, junit_of};
pub(crate) use tables::tables;
pub(crate) use words::{key_numbers, sentence, summary};

/// The subject of a report.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Findings<'f> {
    /// Whose studies they are.
    pub project: &'f Project,
    /// What was found.
    pub record: &'f Record,
    /// The report on the other tier, if there is one.
    pub see_also: Option<SeeAlso>,
    /// Where the run comes from: only for the page.
    pub provenance: Option<&'f Provenance>,
    /// Whether the picture of the rates has a title.
    pub has_titles: bool,
}

/// The report on the other tier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub(crate) struct SeeAlso {
    /// Its tier.
    pub tier: &'static str,
    /// Its folder, as seen from this one's.
    pub folder: &'static str,
    /// Whether it has a page, which a fresh checkout does not have.
    pub has_page: bool,
}

/// Where the picture of a figure is.
///
/// * `folder`: that of the report.
pub(crate) fn picture(folder: &Path, file: &str) -> PathBuf {
    let only_on_page = folder.join(ONLY_ON_PAGE).join(file);
    if only_on_page.exists() {
        only_on_page
    } else {
        folder.join(FIGURES).join(file)
    }
}

/// Bytes of the longest comment: GitHub takes 65536 characters.
pub(crate) const LONGEST: usize = 65_000;

impl<'f> Findings<'f> {
    /// Those of a record, without any other report and without an origin.
    pub(crate) fn of(project: &'f Project, record: &'f Record) -> Self {
        Self {
            project,
            record,
            see_also: None,
            provenance: None,
            has_titles: true,
        }
    }

    /// All files of a report; all except `index.html` have the same bytes for the same outcomes.
    ///
    /// # Errors
    /// Two figures with the same name, and errors of the writers of JSON and of the templates.
    pub(crate) fn files(&self) -> io::Result<ReportSet> {
        let record = self.record;
        let rates = forest::figure(&record.studies, self.has_titles);
        let context = Value::from(Serde(self.context(rates.as_ref())));
        let readme = render("README.md", context.clone())?;
        let mut set = ReportSet::default();
        for figure in rates.iter().chain(self.figures()) {
            let mut path = format!("{FIGURES}/{}", figure.file);
            if !readme.contains(&format!("]({path})")) {
                path = format!("{ONLY_ON_PAGE}/{}", figure.file);
            }
            set.add(path, figure.svg())?;
        }
        set.add(README, readme)?;
        set.add("index.html", render("page.html", context.clone())?)?;
        set.add("summary.md", cut(render("digest.md", context)?))?;
        set.add("results.json", json(record)?)?;
        set.add("junit.xml", junit(self.project.name, record)?)?;
        Ok(set)
    }

    fn figures(&self) -> impl Iterator<Item = &'f Figure> {
        let studies = self.record.studies.iter();
        studies.flat_map(|finished| &finished.outcome.figures)
    }

    /// The part of the report for the page of a CI run and for a comment; a longer text than
    /// [`LONGEST`] is cut, and says so.
    ///
    /// # Errors
    /// Those of the template.
    pub(crate) fn digest(&self) -> io::Result<String> {
        Ok(cut(render("digest.md", Serde(self.context(None)))?))
    }

    /// The verdict in one line, without the verdict itself.
    pub(crate) fn sentence(&self) -> String {
        sentence(&self.record.studies, self.record.changes.as_deref())
    }
}

/// At most [`LONGEST`] bytes of a text, in whole lines.
fn cut(text: String) -> String {
    const FOLD: &str = "\n</details>\n";
    const TOO_LONG: &str = "\nA comment holds no more: see the report.\n";
    if text.len() <= LONGEST {
        return text;
    }
    let kept = &text.as_bytes()[..LONGEST - FOLD.len() - TOO_LONG.len()];
    let lines = kept.iter().rposition(|byte| *byte == b'\n');
    let lines = &text[..=lines.unwrap_or(0)];
    let fold = if lines.contains("<details>") {
        FOLD
    } else {
        ""
    };
    format!("{lines}{fold}{TOO_LONG}")
}
