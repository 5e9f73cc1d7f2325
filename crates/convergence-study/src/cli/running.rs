//! Shared by the commands that take long: how studies are run, progress, report on an interruption.

use std::fmt::Write;
use std::io;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use super::exit::Unusable;
use super::flags::Flags;
use super::screen::{self, Format};
use super::{exit, github, where_lost};
use crate::project::Project;
use crate::report::Findings;
use crate::run::{self, Allowed, Effort, Finished, Progress};
use crate::store::json;
use crate::study::Study;
use convergence_judge::verdict::Verdict;

/// How the commands that run studies do it.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct RunOptions {
    /// Time limit of each case; the study of a case that exceeds it fails, and the others go on
    /// [default: none]
    #[arg(long, value_name = "SECONDS", value_parser = Flags::seconds, allow_hyphen_values = true)]
    time_limit: Option<Duration>,
    /// Run also studies that are expected to take minutes
    #[arg(long)]
    yes: bool,
    /// Search where the order of studies that do not pass is lost, by variants of their solutions
    #[arg(long = "where")]
    where_lost: bool,
    #[command(flatten)]
    pub(super) flags: Flags,
}

/// Seconds on one thread from which a run needs the user's consent. All studies of a project
/// together take less; a thousand millions of steps, which is a typing error more often than not,
/// take more on any mesh.
const LONG: f64 = 60.0;

impl Flags {
    /// Refuses work that is expected to take long.
    ///
    /// * `what`: the file, or the study.
    /// * `seconds`: the expected time on one thread.
    /// * `limit`: the flag that limits the time.
    ///
    /// # Errors
    /// More than a minute.
    pub fn consent(what: &str, seconds: f64, limit: &str) -> Result<(), Unusable> {
        if seconds <= LONG {
            return Ok(());
        }
        let found = format!("found work for about {seconds:.1e} seconds on one thread");
        Err(Unusable::because(&format!(
            "{what}: {found}; expected at most {LONG}, or --yes, or {limit} SECONDS"
        )))
    }

    /// A time limit on the command line.
    pub fn seconds(text: &str) -> Result<Duration, String> {
        let seconds = text.parse().ok().filter(|seconds| *seconds > 0.0);
        seconds
            .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
            .ok_or("expected a number > 0".to_owned())
    }

    /// A bar on standard error for `count` things, which `unit` names; hidden with `--quiet`, or if
    /// standard error is not a terminal.
    pub fn bar(&self, name: &str, count: usize, unit: &'static str) -> ProgressBar {
        if self.quiet {
            return ProgressBar::hidden();
        }
        let rate = move |state: &ProgressState, text: &mut dyn Write| {
            // Writing to the bar's line cannot fail.
            let _ = write!(text, "{:.0} {unit}/s", state.per_sec());
        };
        let style =
            style("{prefix} {wide_bar} {percent:>3} %  {rate}, {eta} left").with_key("rate", rate);
        ProgressBar::new(count as u64)
            .with_style(style)
            .with_prefix(name.to_owned())
    }

    /// Sets the report on the work done so far, printed if the process is interrupted.
    pub fn when_interrupted(said: impl Fn() -> String + Send + 'static) {
        exit::say(said);
    }

    /// Prints an error to standard error.
    pub fn complain(message: &str) {
        screen::complain(message);
    }
}

impl RunOptions {
    /// Threads and time.
    pub(super) fn effort(&self) -> Effort {
        Effort {
            jobs: self.flags.threads(),
            time_limit: self.time_limit,
            fail_fast: false,
        }
    }

    /// Refuses studies that are expected to take long, unless the user has agreed or limited the
    /// time of a case; and those without variants, if these are asked for.
    ///
    /// # Errors
    /// The first such study.
    pub(super) fn check(
        &self,
        project: &Project,
        studies: &[Box<dyn Study>],
    ) -> Result<(), Unusable> {
        let unit = project.seconds_per_cost;
        if let Some(unit) = unit.filter(|_| !self.yes && self.time_limit.is_none()) {
            for study in studies {
                let cost: f64 = study.plan().cases().iter().map(|case| case.cost).sum();
                Flags::consent(&study.header().id, unit * cost, "--time-limit")?;
            }
        }
        if self.where_lost {
            where_lost::require(studies)?;
        }
        Ok(())
    }

    /// Runs studies, naming those that do not pass, and searches where orders are lost.
    ///
    /// # Errors
    /// As [`where_lost::locate`], and threads that are refused.
    pub(super) fn run(
        &self,
        studies: &[Box<dyn Study>],
        effort: Effort,
        allowed: Allowed<'_>,
    ) -> Result<Vec<Finished>, Unusable> {
        let mut finished = self.watched(studies, true, |progress| {
            run::run_within(studies, effort, allowed, progress)
        })?;
        if self.where_lost {
            where_lost::locate(studies, &mut finished, &|variants| {
                self.watched(variants, false, |progress| {
                    run::run(variants, self.effort(), progress)
                })
            })?;
        }
        Ok(finished)
    }

    /// Prints what studies have found, and announces it to a CI server.
    ///
    /// * `text`: for people.
    pub(super) fn print(
        &self,
        findings: &Findings<'_>,
        text: impl FnOnce() -> String,
    ) -> io::Result<()> {
        let format = self.flags.format;
        screen::print(&match format {
            Format::Json => json(findings.record)?,
            _ => text(),
        })?;
        github::announce(findings, format);
        Ok(())
    }

    /// Runs studies and shows their progress, with a bar unless quiet; an interruption reports
    /// which of them had run.
    ///
    /// The time left is estimated from the cost of the remaining cases.
    ///
    /// * `names_failures`: whether a study that does not pass is named as soon as it ends.
    fn watched<T>(
        &self,
        studies: &[Box<dyn Study + '_>],
        names_failures: bool,
        run: impl FnOnce(&(dyn Fn(Progress) + Sync)) -> T,
    ) -> T {
        const STEPS: f64 = 1000.0;
        let headers = studies.iter().map(|study| study.header());
        let ids: Vec<&str> = headers.map(|header| header.id.as_str()).collect();
        let count = ids.len();
        let done: Arc<Mutex<Vec<String>>> = Arc::default();
        let completed = Arc::clone(&done);
        exit::say(move || {
            let done = completed.lock().unwrap_or_else(PoisonError::into_inner);
            sentence(&done, count)
        });
        let bar = match self.flags.quiet {
            true => ProgressBar::hidden(),
            false => ProgressBar::new(STEPS as u64),
        }
        .with_style(style("{bar:40} {msg}, {eta} left"));
        let ran = run(&|progress| {
            if let Some((study, verdict)) = progress.ended {
                let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
                done.push(ids[study].to_owned());
                if names_failures && verdict != Verdict::Pass {
                    bar.println(format!("{}: {}", screen::verdict(verdict), ids[study]));
                }
            }
            // The study that has been running longest.
            let running = progress.running.map(|study| format!(", {}", ids[study]));
            bar.set_message(format!(
                "{} of {} cases{}",
                progress.done_cases,
                progress.cases,
                running.unwrap_or_default()
            ));
            bar.set_position((STEPS * progress.done_cost / progress.cost) as u64);
        });
        bar.finish_and_clear();
        ran
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

fn sentence(done: &[String], count: usize) -> String {
    let names = if done.is_empty() {
        String::new()
    } else {
        format!(": {}", done.join(", "))
    };
    format!("{} of {count} studies had run{names}", done.len())
}
