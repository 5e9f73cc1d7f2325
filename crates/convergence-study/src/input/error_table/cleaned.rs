//! A text without colours, types and other signs that are not of its table.

use super::failed_run;
use super::markup;

/// Characters with simpler equivalents. Spreadsheets write a byte order mark; the first Macintosh
/// ended lines with \r.
const MARKS: [(&str, &str); 10] = [
    ("\u{feff}", ""),
    ("\r\n", "\n"),
    ("\r", "\n"),
    ("│", "|"),
    ("┃", "|"),
    ("┆", "|"),
    ("║", "|"),
    (":math:", ""),
    ("array(", "("),
    ("\\hline", "      "),
];

/// A text without colours, and a line for each of nested lists without names.
pub(super) fn plain(text: &str) -> String {
    let marked = MARKS
        .iter()
        .fold(text.to_owned(), |text, (from, to)| text.replace(from, to));
    let marked = markup::plain(&marked);
    let text = without_numpy_types(&without_colours(&marked));
    let text: String = text.lines().map(plain_line).collect();
    if is_list(&text) {
        text.replace(['[', '(', ',', '\n'], " ")
            .replace([']', ')'], "\n")
    } else {
        text
    }
}

/// A text without the codes of a terminal's colours. A code ends after its first letter.
fn without_colours(text: &str) -> String {
    let mut parts = text.split("\x1b[");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        text + part
            .split_once(char::is_alphabetic)
            .map_or("", |(_, rest)| rest)
    })
}

/// A text with `0.1` in place of NumPy's `np.float64(0.1)`.
fn without_numpy_types(text: &str) -> String {
    let mut parts = text.split("np.float64(");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + &part.replacen(')', "", 1))
}

/// Whether a line is a command that somebody has typed, whose numbers are arguments: no message of
/// such a program, as `mpirun noticed that a process exited on signal 9`, and no results.
fn is_command(line: &str) -> bool {
    const PROGRAMS: [&str; 4] = ["./", "mpirun ", "mpiexec ", "srun "];
    let words = line.trim_start_matches(|c: char| c.is_whitespace() || "/#%>".contains(c));
    let words = words.strip_prefix("$ ").unwrap_or(words);
    PROGRAMS.iter().any(|program| words.starts_with(program))
        && !words.contains(['&', '|'])
        && ![" = ", ": "].iter().any(|mark| words.contains(mark))
        && failed_run::line(words).is_none()
}

/// A line without the end of a row of LaTeX, a command as a blank one, and single bars in place of
/// Jira's double ones: it writes `||h||L2||` above `|0.1|1.6e-3|`.
fn plain_line(line: &str) -> String {
    match line.find("\\\\").filter(|_| line.contains('&')) {
        _ if is_command(line) => "\n".to_owned(),
        Some(end) => line[..end].to_owned() + "\n",
        None if line.ends_with("||") => line.replace("||", "|") + "\n",
        None => line.to_owned() + "\n",
    }
}

/// Whether a text is a list without names.
fn is_list(text: &str) -> bool {
    text.trim_start().starts_with(['[', '(']) && !text.contains(['"', '\'', '=', '\\', '{'])
}
