//! Progress bars, on a terminal only.

use std::fmt::Write;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use crate::run::Progress;

const TEMPLATE: &str = "{prefix} {wide_bar} {percent:>3} %  {rate}, {eta} left";

/// A bar on standard error for so many steps; hidden with `quiet`, or where standard error is not a terminal.
pub fn bar(name: &str, steps: usize, quiet: bool) -> ProgressBar {
    counting(name, steps, "steps", quiet)
}

/// The same for other things than steps, which `unit` names.
pub fn counting(name: &str, count: usize, unit: &'static str, quiet: bool) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let rate = move |state: &ProgressState, text: &mut dyn Write| {
        // Writing to the bar's line cannot fail.
        let _ = write!(text, "{:.0} {unit}/s", state.per_sec());
    };
    let style = ProgressStyle::with_template(TEMPLATE).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(count as u64).with_style(style.with_key("rate", rate)).with_prefix(name.to_owned())
}

/// A bar for the cases of studies, with the time left estimated from the cost of what is left.
pub struct Bar(ProgressBar);

impl Bar {
    const STEPS: f64 = 1000.0;

    /// A bar, or none where it is not wanted.
    pub fn new(wanted: bool) -> Self {
        let target = if wanted { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(Self::STEPS as u64), target);
        let style = ProgressStyle::with_template("{bar:40} {msg}, {eta} left");
        Self(bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())))
    }

    /// Moves it to the progress of the run.
    pub fn show(&self, progress: Progress) {
        self.0.set_message(format!("{} of {} cases", progress.done_cases, progress.cases));
        self.0.set_position((Self::STEPS * progress.done_cost / progress.cost) as u64);
    }

    /// Removes it.
    pub fn clear(&self) {
        self.0.finish_and_clear();
    }
}
