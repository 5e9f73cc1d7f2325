//! Shared by the commands that run studies: progress bar, report on an interruption, time limit.

use std::fmt::Write;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use crate::cli::{interrupt, screen};
use crate::judge::verdict::Verdict;
use crate::run::{Progress, Spent};
use crate::study::Study;

/// Time limits of the commands that run studies.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct Limits {
    /// The longest that a case may take; its study fails and the others go on [default: as long as it takes]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
    pub(super) case_limit: Option<Duration>,
}

/// A time limit on the command line.
pub fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|seconds| *seconds > 0.0);
    seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()).ok_or("expected a number > 0".to_owned())
}

/// Shows the progress of a run, and reports it if the run is interrupted.
pub struct Watched {
    /// For the cases of studies; the time left is estimated from the cost of the remaining ones.
    bar: ProgressBar,
    ids: Vec<String>,
    done: Arc<Mutex<Vec<String>>>,
}

impl Watched {
    /// Steps of the bar.
    const STEPS: f64 = 1000.0;

    /// For these studies; `bar`: whether to show a progress bar.
    pub fn new(studies: &[Box<dyn Study>], bar: bool) -> Self {
        let ids: Vec<String> = studies.iter().map(|study| study.header().id.clone()).collect();
        let done = Arc::new(Mutex::new(vec![]));
        let (told, count) = (Arc::clone(&done), ids.len());
        interrupt::say(move || sentence(&told.lock().unwrap_or_else(PoisonError::into_inner), count));
        let target = if bar { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(Self::STEPS as u64), target);
        Self { bar: bar.with_style(style("{bar:40} {msg}, {eta} left")), ids, done }
    }

    /// Shows that a case has ended.
    pub fn show(&self, progress: Progress) {
        if let Some((study, verdict)) = progress.ended {
            self.done.lock().unwrap_or_else(PoisonError::into_inner).push(self.ids[study].clone());
            if verdict != Verdict::Pass {
                self.bar.println(format!("{}: {}", screen::verdict(verdict), self.ids[study]));
            }
        }
        // The study that has been running longest.
        let running = progress.running.map_or("", |study| &self.ids[study]);
        self.bar.set_message(format!("{} of {} cases, {running}", progress.done_cases, progress.cases));
        self.bar.set_position((Self::STEPS * progress.done_cost / progress.cost) as u64);
    }

    /// Removes the bar.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// How many results an earlier run computed; `None` for zero.
pub fn kept(spent: &Spent) -> Option<String> {
    let Spent { cases, kept, .. } = spent;
    (*kept > 0).then(|| format!("{kept} of {cases} cases kept from an earlier run"))
}

fn sentence(done: &[String], count: usize) -> String {
    let names = if done.is_empty() { String::new() } else { format!(": {}", done.join(", ")) };
    format!("{} of {count} studies had run{names}", done.len())
}

/// A bar on standard error for `count` things, which `unit` names; hidden with `quiet`, or if standard error is not a terminal.
pub fn counting(name: &str, count: usize, unit: &'static str, quiet: bool) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let rate = move |state: &ProgressState, text: &mut dyn Write| {
        // Writing to the bar's line cannot fail.
        let _ = write!(text, "{:.0} {unit}/s", state.per_sec());
    };
    let style = style("{prefix} {wide_bar} {percent:>3} %  {rate}, {eta} left").with_key("rate", rate);
    ProgressBar::new(count as u64).with_style(style).with_prefix(name.to_owned())
}
