//! Several tables in one text, each under its heading.

use super::number::number;
use crate::input::{Complaint, InputError, failed};

/// A part of a text that may be a table.
pub(super) struct Block<'t> {
    /// The first of several lines above its rows, or its number.
    pub(super) heading: String,
    pub(super) text: &'t str,
}

/// The parts of a text: after rows of numbers, a line of words begins the next one. What stands
/// behind the last rows belongs to them.
pub(super) fn split(text: &str) -> Vec<Block<'_>> {
    let mut starts = vec![];
    let mut start = 0;
    let mut offset = 0;
    let mut has_rows = false;
    for line in text.split_inclusive('\n') {
        if is_row(line) {
            if !has_rows {
                starts.push(start);
            }
            has_rows = true;
        } else if has_rows && line.contains(char::is_alphabetic) {
            has_rows = false;
            start = offset;
        }
        offset += line.len();
    }
    let ends = starts.iter().copied().skip(1).chain([text.len()]);
    let parts: Vec<&str> = starts
        .iter()
        .zip(ends)
        .map(|(start, end)| &text[*start..end])
        .collect();
    parts
        .iter()
        .enumerate()
        .map(|(k, part)| Block {
            heading: heading(part).unwrap_or_else(|| format!("table {}", k + 1)),
            text: part,
        })
        .collect()
}

/// Whether there are several parts, and not one for each row: `Cycle 3` above each row parts nothing.
pub(super) fn are_tables(blocks: &[Block<'_>]) -> bool {
    let rows = |block: &Block<'_>| block.text.lines().filter(|line| is_row(line)).count();
    blocks.len() > 1 && blocks.iter().any(|block| rows(block) > 1)
}

/// The refusal of a text whose parts cannot be read one by one.
pub(super) fn refusal(file_name: &str) -> InputError {
    let complaint = Complaint::Table {
        expected:
            "one table, or several that can each be read: take out lines between rows of one table"
                .into(),
        found: "lines of words between some of the rows".to_owned(),
    };
    failed(file_name, complaint)
}

/// Whether a line begins with a number.
fn is_row(line: &str) -> bool {
    let line = line.trim_start_matches(|c: char| c.is_whitespace() || "|&$\"".contains(c));
    let first = line
        .split(|c: char| c.is_whitespace() || "|&$\",;".contains(c))
        .next();
    first.is_some_and(|first| number(first, true).is_some())
}

/// The first line of words above the rows, if there is another, which has the names.
fn heading(part: &str) -> Option<String> {
    let mut above = part
        .lines()
        .take_while(|line| !is_row(line))
        .filter(|line| line.contains(char::is_alphabetic) && !line.trim().starts_with('\\'));
    let first = above.next()?;
    above.next()?;
    let words = first.trim_matches(|c: char| c.is_whitespace() || "#%!*=-:|&".contains(c));
    Some(words.to_owned()).filter(|words| !words.is_empty())
}
