//! `study`: runs study files from anywhere, compares them with no baseline and writes nothing but a line of a journal, where one is named.

use std::path::{Path, PathBuf};

use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::report::tables;
use crate::run::{self, Finished};
use crate::store::record::{self, Precision, Record};
use crate::study::{Study, StudyFile};
use crate::text::visible::visible;

use super::exit::Outcome;
use super::history::Journal;
use super::output::{self, Format};
use crate::cli::running::{Limits, Watched};
use crate::cli::screen;

/// Run study files from anywhere
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// What to print
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    #[command(flatten)]
    limits: Limits,
    #[command(flatten)]
    journal: Journal,
}

/// Runs the studies and prints what they found.
///
/// # Errors
/// Study files that cannot be used.
pub(super) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    arguments.journal.check()?;
    let files = StudyFile::read_all(project.kinds, &arguments.files)?;
    let studies: Vec<Box<dyn Study>> = files.into_iter().map(|file| file.study).collect();
    let watched = Watched::new(&studies, true);
    let finished = run::run(&studies, arguments.limits.effort(), &|progress| watched.show(progress));
    watched.clear();
    let finished = finished?;
    let verdict = Verdict::worst(finished.iter().map(|finished| finished.outcome.verdict));
    let command = format!("{} study", project.command);
    arguments.journal.append(Path::new("."), command, verdict, &finished)?;
    output::print(&match arguments.format {
        Format::Json => record::json(&Record::new("files", verdict, vec![], &finished, Precision::Full))?,
        Format::Text => finished.iter().map(text).collect::<Vec<_>>().join("\n"),
    })?;
    Ok(verdict.into())
}

fn text(finished: &Finished) -> String {
    let Finished { header, outcome, spent, .. } = finished;
    let verdict = screen::verdict(outcome.verdict);
    let seconds = spent.busy.as_secs_f64();
    let mut text = format!(
        "{}: {verdict}, {seconds:.2} s\n{}\n{}\n",
        header.id,
        visible(&header.claim),
        visible(&outcome.summary)
    );
    for table in tables(finished) {
        let head: Vec<&str> = table.head.iter().map(String::as_str).collect();
        text += &format!("\n{}\n{}", visible(&table.title), screen::table(&head, &table.rows));
    }
    text
}
