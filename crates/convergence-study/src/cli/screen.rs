//! Standard output and error, which may be closed at any time; tables in aligned columns, and
//! verdicts in colour.

use std::env;
use std::ffi::OsString;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::Path;
use std::sync::OnceLock;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{ColorChoice, ValueEnum};

use crate::text::columns::Columns;
use crate::text::visible::{self, visible};
use convergence_judge::verdict::Verdict;

/// How results are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Format {
    /// For people
    #[default]
    Text,
    /// For programs: one JSON object
    Json,
    /// For spreadsheets: the rows, separated by commas
    Csv,
    /// For pages: the rows in Markdown
    Md,
    /// For papers: the rows in LaTeX, with booktabs
    Latex,
}

/// Reads one of these formats from the command line.
pub(super) fn formats(known: &[Format]) -> impl TypedValueParser<Value = Format> + use<> {
    let known: Vec<_> = known
        .iter()
        .filter_map(ValueEnum::to_possible_value)
        .collect();
    PossibleValuesParser::new(known).map(|name| Format::from_str(&name, false).unwrap_or_default())
}

/// What the command line says about colours.
static COLOUR: OnceLock<ColorChoice> = OnceLock::new();

/// Sets when to use colours, once for the process.
pub(super) fn set_colour(colour: ColorChoice) {
    COLOUR.get_or_init(|| colour);
}

/// Prints to standard output. A reader that closes it early, as `head` does, causes no error.
///
/// No line is a command to GitHub Actions, whatever names and claims it contains.
pub(crate) fn print(text: &str) -> io::Result<()> {
    print_as_is(&visible::without_commands(text))
}

/// Prints to standard output, commands to GitHub Actions included.
pub(super) fn print_as_is(text: &str) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush())
    {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => {
            let problem = format!("standard output cannot be written: {error}");
            Err(io::Error::new(error.kind(), problem))
        }
        Ok(()) => Ok(()),
    }
}

/// Prints an error to standard error.
pub(crate) fn complain(message: &str) {
    tell(&format!("error: {message}"));
}

/// Prints a message to standard error, without control characters other than line ends.
pub(crate) fn tell(message: &str) {
    // If standard error is closed, the message cannot be shown.
    let _ = writeln!(
        io::stderr(),
        "{}",
        visible::without_commands(&visible::lines(message))
    );
}

/// Between two columns.
const GAP: &str = "  ";

/// Least width to which a column is cut: less is worse than a line that wraps.
pub(super) const LEAST: usize = 24;

/// Rows under a head, in columns; cells without control characters.
pub(crate) fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    table_within(None, head, rows)
}

/// The same, with the last column cut so that no line is wider than the terminal.
///
/// * `width`: columns of the terminal; `None` to cut nothing.
pub(crate) fn table_within(width: Option<usize>, head: &[&str], rows: &[Vec<String>]) -> String {
    let head: Vec<String> = head.iter().map(|title| visible(title)).collect();
    let rows: Vec<Vec<String>> = rows
        .iter()
        .map(|row| row.iter().map(|cell| visible(cell)).collect())
        .collect();
    let measured = Columns::of(&head, &rows);
    let others = (0..measured.count().saturating_sub(1))
        .map(|column| measured.width(column) + GAP.len())
        .sum();
    let room = width.map(|width| width.saturating_sub(others).max(LEAST));
    let fitted = |mut row: Vec<String>| {
        if let (Some(room), Some(last)) = (room, row.last_mut()) {
            *last = cut(last, room);
        }
        row
    };
    let (head, rows) = (
        fitted(head),
        rows.into_iter().map(fitted).collect::<Vec<_>>(),
    );
    let columns = Columns::of(&head, &rows);
    let colours = colours();
    let lines = std::iter::once(&head).chain(&rows).map(|row| {
        let cells: Vec<String> = columns
            .pad(row)
            .map(|cell| if colours { coloured(cell) } else { cell })
            .collect();
        cells.join(GAP).trim_end().to_owned() + "\n"
    });
    lines.collect()
}

/// Text of at most `room` characters; an ellipsis replaces the rest.
fn cut(text: &str, room: usize) -> String {
    if text.chars().count() <= room {
        return text.to_owned();
    }
    let kept: String = text.chars().take(room.saturating_sub(1)).collect();
    kept.trim_end().to_owned() + "…"
}

/// A verdict as a word, in its colour.
pub(crate) fn verdict(verdict: Verdict) -> String {
    if colours() {
        coloured(verdict.to_string())
    } else {
        verdict.to_string()
    }
}

/// Where a report is.
pub(super) fn report_in(folder: &Path) -> String {
    let [page, readme] = ["index.html", "README.md"].map(|name| visible::path(&folder.join(name)));
    format!("report: {page}, {readme}\n")
}

/// Columns of the terminal; `None` if standard output is not a terminal.
pub(crate) fn width() -> Option<usize> {
    let terminal = console::Term::stdout();
    terminal
        .size_checked()
        .map(|(_, columns)| usize::from(columns))
        .filter(|_| io::stdout().is_terminal())
}

/// What these arguments say about colours: help texts and errors of the command line are printed
/// before it is parsed as a whole.
pub(super) fn colour_in(arguments: &[OsString]) -> Option<ColorChoice> {
    let options = arguments.iter().take_while(|argument| *argument != "--");
    let mut words = options.filter_map(|argument| argument.to_str());
    let value = loop {
        let word = words.next()?;
        if word == "--color" {
            break words.next()?;
        }
        if let Some(value) = word.strip_prefix("--color=") {
            break value;
        }
    };
    ColorChoice::from_str(value, false).ok()
}

/// When to use colours: as `--color` says, else as `FORCE_COLOR` or `CLICOLOR_FORCE` do, else on a
/// terminal, unless `NO_COLOR` is set to anything.
pub(super) fn choice() -> ColorChoice {
    let is_set = |name| env::var_os(name).is_some_and(|value| !value.is_empty());
    let forces = |name| is_set(name) && env::var_os(name).is_some_and(|value| value != "0");
    match COLOUR.get() {
        Some(choice) if *choice != ColorChoice::Auto => *choice,
        _ if forces("FORCE_COLOR") || forces("CLICOLOR_FORCE") => ColorChoice::Always,
        _ if is_set("NO_COLOR") => ColorChoice::Never,
        // Where it is left to `clap`, any value of `CLICOLOR_FORCE` forces colours.
        _ if !io::stdout().is_terminal() && !io::stderr().is_terminal() => ColorChoice::Never,
        _ => ColorChoice::Auto,
    }
}

/// Whether to use colours on standard output.
fn colours() -> bool {
    match choice() {
        ColorChoice::Always => true,
        ColorChoice::Never => false,
        ColorChoice::Auto => io::stdout().is_terminal(),
    }
}

/// A cell in the colour of the verdict that it holds; any other cell unchanged.
fn coloured(cell: String) -> String {
    let colour = match cell.trim() {
        "pass" => 32,
        "inconclusive" => 33,
        "fail" => 31,
        _ => return cell,
    };
    format!("\x1b[{colour}m{cell}\x1b[0m")
}

#[cfg(test)]
mod tests {
    use super::table_within;

    #[test]
    fn the_last_column_is_cut_at_the_width_and_never_wrapped() {
        let rows = [
            ["a", "0.01", &"long and longer ".repeat(5)],
            ["longer-id", "0.20", "short"],
        ]
        .map(|row| row.map(str::to_owned).to_vec());
        let table = |width| table_within(width, &["study", "seconds", "key numbers"], &rows);
        let widest = |text: &str| text.lines().map(|line| line.chars().count()).max().unwrap();
        assert_eq!(widest(&table(Some(50))), 50);
        assert_eq!(
            table(Some(50)).lines().nth(1),
            Some("a             0.01  long and longer long and long…")
        );
        assert!(table(Some(50)).ends_with("longer-id     0.20  short\n"));
        assert!(!table(None).contains('…') && widest(&table(None)) > 80);
        // A terminal too narrow for the other columns.
        assert_eq!(
            table(Some(10)).lines().nth(1),
            Some("a             0.01  long and longer long an…")
        );
    }
}
