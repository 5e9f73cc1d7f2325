//! One line of a text: its cells, and what it may be.

use super::number::number;
use super::original::offset;

/// First words of a row that sums up those above it.
const CLOSING: [&str; 6] = ["mean", "average", "avg", "median", "overall", "total"];

/// The cells of a line: between separators outside quotes, or between blanks. `0.1 (2.0)` are two
/// cells.
pub(super) fn split(line: &str, separator: Option<char>) -> Vec<&str> {
    let framed = line.trim_start().strip_prefix('|');
    let line = framed.filter(|_| separator == Some('|')).unwrap_or(line);
    let mut quoted = false;
    let mut is_start = true;
    let mut is_escaped = false;
    let separates = |c: char| {
        quoted ^= c == '"' && (quoted || is_start);
        let is_separator = separator.map_or(c.is_whitespace() || c == '|', |own| c == own);
        let is_end = !quoted && !is_escaped && is_separator;
        is_start = is_end || (is_start && c.is_whitespace());
        is_escaped = c == '\\';
        is_end
    };
    line.split(separates)
        .map(cell)
        .filter(|cell| separator.is_some() || !cell.is_empty())
        .flat_map(split_parenthesis)
        .collect()
}

/// The two cells of `0.1 (2.0)`; any other cell alone.
fn split_parenthesis(cell: &str) -> Vec<&str> {
    match cell.split_once(" (") {
        Some((one, two)) if number(one, false).is_some() => {
            vec![one, &cell[cell.len() - two.len() - 1..]]
        }
        _ => vec![cell],
    }
}

/// A cell without surrounding blanks and quotes; the end of a text of blanks alone.
pub(super) fn cell(text: &str) -> &str {
    let text = text.trim_start().trim_end();
    text.strip_prefix('"')
        .and_then(|text| text.strip_suffix('"'))
        .unwrap_or(text)
        .trim()
}

/// Whether a cell holds a number, in a table with this separator.
pub(super) fn is_number(cell: &str, separator: Option<char>) -> bool {
    number(cell, separator != Some(',')).is_some()
}

/// The first byte of a cell in its line, and the byte after its last one.
pub(super) fn span(line: &str, cell: &str) -> [usize; 2] {
    let start = offset(line, cell);
    [start, start + cell.len()]
}

/// Whether a line is a comment.
pub(super) fn is_comment(line: &&str) -> bool {
    line.trim_start().starts_with(['#', '%', '!'])
}

/// Whether a line stands between bars.
fn is_framed(line: &str) -> bool {
    let line = line.trim();
    line.len() > 1 && line.starts_with('|') && line.ends_with('|')
}

/// Whether a text has rows between bars.
fn has_framed_rows(text: &str) -> bool {
    let is_row = |line: &&str| {
        let mut cells = line.split('|').map(str::trim);
        is_framed(line) && cells.any(|cell| number(cell, true).is_some())
    };
    text.lines().filter(is_row).nth(1).is_some()
}

/// Whether a text has rows between bars, or of LaTeX: what stands around them is prose, whatever
/// numbers it has.
pub(super) fn has_table_in_prose(text: &str) -> bool {
    /// More ampersands than a sentence has.
    const MARKS: usize = 4;
    has_framed_rows(text) || text.matches(" & ").nth(MARKS - 1).is_some()
}

/// The lines that may be names and rows of a table: those between bars, if there are such rows. A
/// bar that ends all lines is an edge.
pub(super) fn table_lines(text: &str) -> Vec<&str> {
    let lines = text
        .lines()
        .filter(|line| !line.trim().is_empty() && !is_rule(line));
    let mut lines: Vec<&str> = lines.collect();
    let are_framed = has_framed_rows(text);
    if are_framed {
        lines.retain(|line| is_framed(line));
    }
    let with_bars = || lines.iter().filter(|line| line.contains('|'));
    let has_edge = with_bars().any(begins_with_number)
        && with_bars().all(|line| line.trim_end().ends_with('|'));
    if are_framed || has_edge {
        for line in &mut lines {
            *line = line.trim_end().strip_suffix('|').unwrap_or(line);
        }
    }
    lines
}

/// A line of dashes, or the border of a box.
pub(super) fn is_rule(line: &str) -> bool {
    line.chars().all(is_drawn)
        && line
            .chars()
            .filter(|c| !c.is_whitespace() && *c != '|')
            .count()
            > 2
}

/// Whether rules and boxes are drawn with a character.
fn is_drawn(c: char) -> bool {
    c.is_whitespace() || "-=_~+|:".contains(c) || ('\u{2500}'..='\u{257f}').contains(&c)
}

/// Whether a line closes a table: the mean of its rows.
pub(super) fn is_closing(line: &str) -> bool {
    let words = line.split(|c: char| !c.is_alphanumeric());
    let first = words.into_iter().find(|word| !word.is_empty());
    first.is_some_and(|word| CLOSING.contains(&&*word.to_lowercase()))
}

/// Whether the first word of a line is a number.
pub(super) fn begins_with_number(line: &&str) -> bool {
    let line = line.trim_start_matches(|c: char| c.is_whitespace() || "|\"$".contains(c));
    let first = line
        .split(|c: char| c.is_whitespace() || ";,&|\"$\\".contains(c))
        .next();
    number(first.unwrap_or_default(), true).is_some()
}

/// Whether half of the words are numbers without names, as in `finest 6e-4` or `# 0.01 6e-4`.
pub(super) fn looks_like_row(line: &str) -> bool {
    let words = line.split(|c: char| c.is_whitespace() || ",;|&".contains(c));
    let words = words.map(|word| word.trim_matches(|c| "#%*~()<>".contains(c)));
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    let numbers = words.iter().filter(|word| number(word, true).is_some());
    2 * numbers.count() >= words.len() && !line.contains([':', '=']) && !is_closing(line)
}
