//! The progress bar, on a terminal only.

use std::fmt::Write;

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

const TEMPLATE: &str = "{prefix} {wide_bar} {percent:>3} %  {rate}, {eta} left";

/// A bar on standard error for so many steps; hidden with `quiet`, or where standard error is not a terminal.
pub(crate) fn bar(name: &str, steps: usize, quiet: bool) -> ProgressBar {
    counting(name, steps, "steps", quiet)
}

/// The same for other things than steps, which `unit` names.
pub(crate) fn counting(name: &str, count: usize, unit: &'static str, quiet: bool) -> ProgressBar {
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
