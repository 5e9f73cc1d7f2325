//! Tables for a terminal: columns lined up, verdicts coloured where colours are shown.

use std::env;
use std::io::{self, IsTerminal};
use std::num::NonZeroUsize;
use std::thread;

use crate::judge::verdict::Verdict;
use crate::text::columns::Columns;
use crate::text::visible::visible;

/// Rows under a head, in columns; cells without control characters.
pub fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    let head: Vec<String> = head.iter().map(|title| visible(title)).collect();
    let rows: Vec<Vec<String>> = rows.iter().map(|row| row.iter().map(|cell| visible(cell)).collect()).collect();
    let columns = Columns::of(&head, &rows);
    let colours = colours();
    let line = |row: &Vec<String>| {
        let cells: Vec<String> = columns.pad(row).map(|cell| if colours { coloured(cell) } else { cell }).collect();
        cells.join("  ").trim_end().to_owned() + "\n"
    };
    std::iter::once(&head).chain(&rows).map(line).collect()
}

/// A verdict as a word, in its colour.
pub fn verdict(verdict: Verdict) -> String {
    if colours() { coloured(verdict.to_string()) } else { verdict.to_string() }
}

/// Number of threads: as asked for, or as many as the machine has.
pub fn jobs(asked: Option<NonZeroUsize>) -> NonZeroUsize {
    asked.or_else(|| thread::available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN)
}

/// Columns of the terminal; `None` where standard output is none.
pub fn width() -> Option<usize> {
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
