//! `study`, and `verify` with files: runs study files from anywhere, compares with no baseline and
//! writes only what `--out` requests.

use std::path::PathBuf;

use super::exit::CommandOutcome;
use super::running::RunOptions;
use super::screen::{self, Format};
use crate::project::Project;
use crate::report::{Findings, summary, tables, text_of_diagnosis, text_of_failures};
use crate::run::{Effort, Finished, time_limit};
use crate::store::prepare;
use crate::study::{Study, StudyFile, Untested};
use crate::text::names::quoted;
use crate::text::visible::visible;
use crate::verify::{publish, record};
use convergence_judge::verdict::Verdict;

/// Run study files from anywhere, as `verify` with files does
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files
    #[arg(required = true, value_name = "FILE")]
    pub(super) files: Vec<PathBuf>,
    #[command(flatten)]
    pub(super) options: RunOptions,
}

/// Runs the studies of files and prints what they found.
///
/// # Errors
/// Study files that cannot be used.
pub(super) fn run(project: &Project, Arguments { files, options }: &Arguments) -> CommandOutcome {
    let read = StudyFile::read_all(project.kinds, files)?.into_iter();
    let studies: Vec<Box<dyn Study>> = read.map(|file| file.study).collect();
    options.check(project, &studies)?;
    let flags = &options.flags;
    // A folder that is not writable, or holds other files, is reported before the run.
    let out = flags.out.as_deref();
    out.map_or(Ok(()), prepare)?;
    let mut finished = options.run(&studies, options.effort(), &|_, _| None)?;
    // Searched for only if it is shown.
    let is_shown = flags.format == Format::Json || !flags.quiet;
    for (study, finished) in studies.iter().zip(&mut finished) {
        if is_shown && finished.outcome.verdict == Verdict::Pass {
            finished.untested = untested(study.as_ref(), options.effort());
        }
    }
    let mut command = format!("{} study", project.command);
    for file in files {
        command += &format!(" {}", quoted(&file.to_string_lossy()));
    }
    let record = record(&finished, &command);
    let verdict = record.verdict;
    // The results are printed first, so that a file that cannot be written does not lose them.
    let findings = Findings::of(project, &record);
    options.print(&findings, || match flags.quiet {
        true => conclusions(&findings),
        false => all_found(&findings),
    })?;
    if let Some(folder) = out {
        publish(project, record, flags.threads().get(), folder)?;
        if flags.format != Format::Json && !flags.quiet {
            screen::print(&format!("\n{}", screen::report_in(folder)))?;
        }
    }
    Ok(verdict)
}

/// What failed, where orders are lost, and the verdict.
fn conclusions(findings: &Findings<'_>) -> String {
    let studies = &findings.record.studies;
    let mut text = text_of_failures(studies, None);
    for where_lost in studies.iter().filter_map(|study| study.where_lost.as_ref()) {
        text += &format!("{}\n", where_lost.conclusion);
    }
    let verdict = screen::verdict(findings.record.verdict);
    text + &format!("{verdict}: {}\n", findings.sentence())
}

/// What each study found, and the cause of what fails.
fn all_found(findings: &Findings<'_>) -> String {
    let mut parts: Vec<String> = findings.record.studies.iter().map(text).collect();
    let diagnosis = findings.record.diagnosis.as_ref();
    parts.push(diagnosis.map(text_of_diagnosis).unwrap_or_default());
    parts.retain(|part| !part.is_empty());
    parts.join("\n")
}

/// What a study fails to test; the search takes no longer than a case may.
fn untested(study: &dyn Study, effort: Effort) -> Vec<Untested> {
    match time_limit::within(effort.time_limit, || study.untested()) {
        (untested, None) => untested,
        (_, Some(up)) => vec![Untested {
            what: "not known".to_owned(),
            why: format!("the search for it was {up}"),
        }],
    }
}

fn text(finished: &Finished) -> String {
    let Finished {
        header,
        outcome,
        spent,
        ..
    } = finished;
    let verdict = screen::verdict(outcome.verdict);
    let seconds = spent.wall.as_secs_f64();
    let mut text = format!(
        "{}: {verdict}, {seconds:.2} s\n{}\n{}\n",
        header.id,
        visible(&header.claim),
        visible(&summary(outcome))
    );
    for table in tables(finished) {
        let head: Vec<&str> = table.head.iter().map(String::as_str).collect();
        text += &format!(
            "\n{}\n{}",
            visible(&table.title),
            screen::table(&head, &table.rows)
        );
    }
    if let Some(where_lost) = &finished.where_lost {
        text += &format!("\n{}", where_lost.text());
    }
    if !finished.untested.is_empty() {
        let untested = finished.untested.iter();
        let rows: Vec<_> = untested
            .map(|one| vec![one.what.clone(), one.why.clone()])
            .collect();
        text += &format!("\n{}", screen::table(&["no test of", "because"], &rows));
    }
    text
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::run::{self, Spent};
    use crate::study::{Described, Header, levels};

    #[test]
    fn the_seconds_of_a_study_are_those_that_passed() {
        let study = Described::boxed(
            Header::new("s", "c"),
            levels([4, 8, 16], |n| 1.0 / n as f64),
        );
        let mut finished = run::run(&[study], run::available(), &|_| {}).unwrap();
        finished[0].spent = Spent {
            busy: Duration::from_secs(2),
            wall: Duration::from_millis(410),
            ..Spent::default()
        };
        let text = text(&finished[0]);
        assert!(text.lines().next().unwrap().ends_with(", 0.41 s"), "{text}");
    }
}
