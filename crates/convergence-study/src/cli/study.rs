//! `study`, and `verify` with files: runs study files from anywhere, compares with no baseline and
//! writes only what `--out` requests.

use std::path::PathBuf;

use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::report::{Findings, summary, tables, text_of_diagnosis, text_of_failures};
use crate::run::{self, Effort, Finished, time_limit};
use crate::store::{atomic, json};
use crate::study::{Study, StudyFile, Untested};
use crate::text::names::quoted;
use crate::text::visible::visible;
use crate::verify::{publish, record};

use super::exit::CommandOutcome;
use super::flags::Flags;
use super::github;
use super::running::{Limits, watched};
use super::screen::{self, Format};
use super::where_lost;

/// Run study files from anywhere, as `verify` with files does
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    limits: Limits,
    /// Search where the order of studies that do not pass is lost, by variants of their solutions
    #[arg(long = "where")]
    located: bool,
    #[command(flatten)]
    flags: Flags,
}

/// Runs the command.
///
/// # Errors
/// As [`run_files`].
pub(super) fn run(project: &Project, arguments: &Arguments) -> CommandOutcome {
    run_files(
        project,
        &arguments.files,
        arguments.limits,
        arguments.located,
        &arguments.flags,
    )
}

/// What failed, where orders are lost, and the verdict.
fn conclusions(findings: &Findings<'_>) -> String {
    let studies = &findings.record.studies;
    let located = studies.iter().filter_map(|study| study.located.as_ref());
    let conclusions: String = located
        .map(|located| format!("{}\n", located.conclusion))
        .collect();
    format!(
        "{}{conclusions}{}: {}\n",
        text_of_failures(studies, None),
        screen::verdict(findings.record.verdict),
        findings.sentence()
    )
}

/// What each study found, and the cause of what fails.
fn all_found(findings: &Findings<'_>) -> String {
    let studies: Vec<String> = findings.record.studies.iter().map(text).collect();
    let diagnosis = findings.record.diagnosis.as_ref();
    let cause = diagnosis.map(text_of_diagnosis).unwrap_or_default();
    let parts = studies.into_iter().chain([cause]);
    let parts: Vec<String> = parts.filter(|part| !part.is_empty()).collect();
    parts.join("\n")
}

/// Runs the studies of files and prints what they found.
///
/// * `located`: whether to search where the order is lost.
///
/// # Errors
/// Study files that cannot be used.
pub(super) fn run_files(
    project: &Project,
    files: &[PathBuf],
    limits: Limits,
    located: bool,
    flags: &Flags,
) -> CommandOutcome {
    let studies = StudyFile::read_all(project.kinds, files)?;
    let studies: Vec<Box<dyn Study>> = studies.into_iter().map(|file| file.study).collect();
    limits.consent(project, &studies)?;
    if located {
        where_lost::require(&studies)?;
    }
    // A folder that is not writable is reported before the run.
    flags
        .out
        .as_deref()
        .map_or(Ok(()), atomic::prepare_folder)?;
    let effort = flags.effort(limits.time_limit);
    let mut finished = watched(&studies, flags.quiet, |progress| {
        run::run(&studies, effort, progress)
    })?;
    if located {
        where_lost::locate(&studies, &mut finished, effort, flags.quiet)?;
    }
    let words = files.iter().map(|file| quoted(&file.to_string_lossy()));
    let command = words.fold(format!("{} study", project.command), |command, word| {
        command + " " + &word
    });
    // Searched for only if it is shown.
    let is_shown = flags.format == Format::Json || !flags.quiet;
    for (study, finished) in studies.iter().zip(&mut finished) {
        if is_shown && finished.outcome.verdict == Verdict::Pass {
            finished.untested = untested(study.as_ref(), effort);
        }
    }
    let record = record(&finished, &command);
    let verdict = record.verdict;
    let findings = Findings {
        project,
        record: &record,
        see_also: None,
        provenance: None,
    };
    let text = match flags.format {
        Format::Json => json(&record)?,
        _ if flags.quiet => conclusions(&findings),
        _ => all_found(&findings),
    };
    // The results are printed first, so that a file that cannot be written does not lose them.
    screen::print(&text)?;
    github::announce(&findings, flags.format);
    if let Some(folder) = &flags.out {
        publish(project, record, effort.jobs.get(), folder)?;
        if flags.format != Format::Json && !flags.quiet {
            screen::print(&format!("\n{}", screen::report_in(folder)))?;
        }
    }
    Ok(verdict)
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

/// The table of what a passing study does not test; empty if there is nothing.
fn no_test_of(untested: &[Untested]) -> String {
    let rows: Vec<Vec<String>> = untested
        .iter()
        .map(|one| vec![one.what.clone(), one.why.clone()])
        .collect();
    if rows.is_empty() {
        String::new()
    } else {
        format!("\n{}", screen::table(&["no test of", "because"], &rows))
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
    let located = finished
        .located
        .as_ref()
        .map(|located| format!("\n{}", located.text()));
    text + &located.unwrap_or_default() + &no_test_of(&finished.untested)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::run::Spent;
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
