//! `study`: runs study files from anywhere, compares them with no baseline and writes nothing.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::ValueEnum;
use thermobeam_study::record::{self, Precision, Record};
use thermobeam_study::report::tables;
use thermobeam_study::runner::{self, Finished};
use thermobeam_study::study;
use thermobeam_study::verdict::Verdict;

use crate::running::{Limits, Watched};
use crate::screen;

/// Run study files from anywhere
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Study files
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// What to print
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    #[command(flatten)]
    limits: Limits,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Debug)]
enum Format {
    /// Tables to be read
    Text,
    /// One object with all digits
    Json,
}

/// Runs the studies and prints what they found.
pub(crate) fn study(arguments: &Arguments) -> Result<ExitCode, Box<dyn Error>> {
    study::headers(&arguments.files)?;
    let studies = arguments.files.iter().map(|path| study::read(path)).collect::<Result<Vec<_>, _>>()?;
    let watched = Watched::new(&studies, true);
    let finished = runner::run(&studies, arguments.limits.effort(), &|progress| watched.show(progress));
    watched.clear();
    let finished = finished?;
    let verdict = Verdict::worst(finished.iter().map(|finished| finished.outcome.verdict));
    screen::print(&match arguments.format {
        Format::Json => record::json(&Record::new("files", verdict, vec![], &finished, Precision::Full))?,
        Format::Text => finished.iter().map(text).collect::<Vec<_>>().join("\n"),
    })?;
    Ok(screen::exit(verdict))
}

fn text(finished: &Finished) -> String {
    let Finished { header, outcome, spent, .. } = finished;
    let verdict = screen::verdict(outcome.verdict);
    let seconds = spent.busy.as_secs_f64();
    let mut text = format!("{}: {verdict}, {seconds:.2} s\n{}\n{}\n", header.id, header.claim, outcome.summary);
    for table in tables(finished) {
        let head: Vec<&str> = table.head.iter().map(String::as_str).collect();
        text += &format!("\n{}\n{}", table.title, screen::table(&head, &table.rows));
    }
    text
}
