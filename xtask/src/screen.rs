//! What is printed: lined up, coloured where colours are seen, and without complaint where nobody reads on.

use std::env;
use std::io::{self, IsTerminal, Write};
use std::num::NonZeroUsize;
use std::process::ExitCode;
use std::thread;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use thermobeam_study::columns::Columns;
use thermobeam_study::runner::Progress;
use thermobeam_study::verdict::Verdict;

/// Prints a text. A reader that has left, such as `head`, is no error.
pub(crate) fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// Rows under a head, in columns.
pub(crate) fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    let head: Vec<String> = head.iter().map(|&title| title.to_owned()).collect();
    let columns = Columns::of(&head, rows);
    let colours = colours();
    let line = |row: &Vec<String>| {
        let cells: Vec<String> = columns.pad(row).map(|cell| if colours { coloured(cell) } else { cell }).collect();
        cells.join("  ").trim_end().to_owned() + "\n"
    };
    std::iter::once(&head).chain(rows).map(line).collect()
}

/// A verdict as a word, in its colour.
pub(crate) fn verdict(verdict: Verdict) -> String {
    if colours() { coloured(verdict.to_string()) } else { verdict.to_string() }
}

/// Exit status for a verdict.
pub(crate) fn exit(verdict: Verdict) -> ExitCode {
    if verdict == Verdict::Pass { ExitCode::SUCCESS } else { ExitCode::from(1) }
}

/// Number of threads: as asked for, or as many as the machine has.
pub(crate) fn jobs(asked: Option<NonZeroUsize>) -> NonZeroUsize {
    asked.or_else(|| thread::available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN)
}

/// A bar on standard error, if that is a terminal, with the time left by the cost of what is left.
pub(crate) struct Bar(ProgressBar);

impl Bar {
    const STEPS: f64 = 1000.0;

    /// A bar, or none where it is not wanted.
    pub(crate) fn new(wanted: bool) -> Self {
        let target = if wanted { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(Self::STEPS as u64), target);
        let style = ProgressStyle::with_template("{bar:40} {msg}, {eta} left");
        Self(bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())))
    }

    /// Moves it to where the run is.
    pub(crate) fn show(&self, progress: Progress) {
        self.0.set_message(format!("{} of {} cases", progress.done_cases, progress.cases));
        self.0.set_position((Self::STEPS * progress.done_cost / progress.cost) as u64);
    }

    /// Takes it away.
    pub(crate) fn clear(&self) {
        self.0.finish_and_clear();
    }
}

/// Columns of the terminal; `None` where standard output is none.
pub(crate) fn width() -> Option<usize> {
    let terminal = console::Term::stdout();
    terminal.size_checked().map(|(_, columns)| usize::from(columns)).filter(|_| io::stdout().is_terminal())
}

/// Whether colours are seen: on a terminal, unless `NO_COLOR` is set to anything.
fn colours() -> bool {
    io::stdout().is_terminal() && env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// A cell in the colour of the verdict that it holds; any other cell as it is.
fn coloured(cell: String) -> String {
    let colour = match cell.trim() {
        "pass" => 32,
        "inconclusive" => 33,
        "fail" => 31,
        _ => return cell,
    };
    format!("\x1b[{colour}m{cell}\x1b[0m")
}
