//! Any text as lines of names and numbers, and the table found in it.

use super::number::{is_dash, number};

/// A table as written. Names and cells are slices of the text, which give their places.
#[derive(Debug, Default)]
pub(super) struct RawTable<'t> {
    /// A name for each column, or an empty one.
    pub(super) names: Vec<&'t str>,
    pub(super) rows: Vec<Vec<&'t str>>,
    /// Whether a comma in a cell is a decimal comma.
    pub(super) decimal_comma: bool,
    /// What is not a column of the table, with the reason.
    pub(super) left_out: Vec<(String, String)>,
}

/// Put before a number that was written in parentheses.
pub(super) const BEHIND: char = '\u{1f}';
/// Characters with simpler equivalents. Spreadsheets write a byte order mark; the first Macintosh ended lines with \r.
const MARKS: [(&str, &str); 14] = [
    ("\u{feff}", ""),
    ("\r\n", "\n"),
    ("\r", "\n"),
    ("│", "|"),
    ("┃", "|"),
    ("┆", "|"),
    ("║", "|"),
    ("np.float64(", "("),
    ("np.int64(", "("),
    ("array(", "("),
    ("\\hline", "      "),
    ("\\toprule", "        "),
    ("\\midrule", "        "),
    ("\\addlinespace", "             "),
];
/// Levels of a log.
const LEVELS: [&str; 5] = ["INFO", "DEBUG", "WARNING", "WARN", "ERROR"];

/// A text without colours, timestamps and rules, `0.1 (2.0)` as two cells, and a line for each of nested lists.
pub(super) fn plain(text: &str) -> String {
    let marked = MARKS.iter().fold(text.to_owned(), |text, (from, to)| text.replace(from, to));
    let mut parts = marked.split("\x1b[");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        // A colour ends after the first character that does not belong to its number.
        let mut rest = part.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';').chars();
        text += rest.next().map_or("", |_| rest.as_str());
    }
    let line = |line: &str| {
        let line = without_stamp(line);
        // A row of LaTeX has an end; Jira writes `||h||L2||` above `|0.1|1.6e-3|`.
        let end = if line.contains('&') { line.find("\\\\") } else { None };
        let line = end.map_or(line, |end| &line[..end]);
        unbracketed(&if line.ends_with("||") { line.replace("||", "|") } else { line.to_owned() }) + "\n"
    };
    let text: String = text.lines().map(line).collect();
    let is_list = |marks: &[char]| text.trim_start().starts_with(marks) && !text.contains(['"', '\'', '=']);
    match () {
        // `{0.1: 1.6e-3, 0.05: 4e-4}`.
        () if is_list(&['{']) && !text.contains(['&', '\\']) => text.replace([',', '{', '}'], "\n").replace(':', " "),
        () if is_list(&['[', '(']) && !text.contains('{') => unnested(&text),
        () => text,
    }
}

/// `0.1 (2.0)` as two cells, and `(0.1)` as one.
fn unbracketed(line: &str) -> String {
    let mut parts = line.split('(');
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let before = text.trim_end_matches(' ').chars().last();
        let is_behind = before.is_some_and(|c| c.is_ascii_digit());
        let may_be = is_behind || before.is_none_or(|c| "([,=$}".contains(c));
        let is_cell = |inner: &str| number(inner, false).is_some() || (is_behind && is_dash(inner));
        text += &match part.split_once(')').filter(|(inner, _)| may_be && is_cell(inner)) {
            Some((inner, rest)) => format!("{BEHIND}{inner} {rest}"),
            None => format!("({part}"),
        };
    }
    text
}

/// Nested lists without names: a line for each innermost one.
fn unnested(text: &str) -> String {
    let mut depth = 0_usize;
    let kept = |c: char| match c {
        '[' | '(' => {
            depth += 1;
            ' '
        }
        ']' | ')' => {
            depth = depth.saturating_sub(1);
            '\n'
        }
        ',' | BEHIND => ' ',
        '\n' if depth > 0 => ' ',
        other => other,
    };
    text.chars().map(kept).collect()
}

/// A line of a log without date, time, level and the marks after them.
fn without_stamp(line: &str) -> &str {
    if line.split_once(':').is_some_and(|(level, _)| LEVELS.contains(&level)) {
        // `INFO:root:h=0.1`.
        return line.splitn(3, ':').nth(2).unwrap_or(line);
    }
    let is_stamp = |word: &str| {
        let word = word.trim_matches(|c| "[](),|".contains(c));
        let is_date = word.len() > 7 && word.matches(['-', '/']).count() == 2 && !word.contains('.');
        word.chars().all(|c| c.is_ascii_digit() || "-:.,T+Z/".contains(c)) && (word.matches(':').count() > 1 || is_date)
    };
    let is_level = |word: &str| {
        let word = word.trim_matches(|c: char| !c.is_alphabetic());
        word.is_empty() || LEVELS.iter().any(|level| word.eq_ignore_ascii_case(level))
    };
    let (mut rest, mut stamped) = (line, false);
    while let Some(word) = rest.split_whitespace().next() {
        let has_digit = word.contains(|c: char| c.is_ascii_digit());
        if !(has_digit && is_stamp(word) || stamped && !has_digit && is_level(word)) {
            break;
        }
        (rest, stamped) = (rest.trim_start().strip_prefix(word).unwrap_or(rest), true);
    }
    rest
}
