//! Lines of a text that belong to none of its tables. They are counted, so that nothing is skipped
//! without a word.

use super::number::number;
use super::original::offset;
use super::parts::Part;
use super::text::is_closing;

/// What stands outside the tables of a text.
pub(super) struct Outside {
    /// How many lines with words or numbers hold no cell, name or heading of a table.
    pub(super) lines: usize,
    /// The numbers of those that look like rows, from 1.
    pub(super) rows: Vec<usize>,
}

pub(super) fn outside(text: &str, parts: &[Part<'_>]) -> Outside {
    let mut used: Vec<usize> = vec![];
    for Part { words, table, .. } in parts {
        let cells = table.rows.iter().flatten();
        let pieces = cells.chain(&table.names).chain(&table.groups);
        used.extend(pieces.map(|piece| offset(text, piece)));
        used.extend(words.map(|words| offset(text, words)));
    }
    used.sort_unstable();
    let mut used = used.into_iter().peekable();
    let mut outside = Outside {
        lines: 0,
        rows: vec![],
    };
    let mut end = 0;
    for (k, line) in text.split_inclusive('\n').enumerate() {
        end += line.len();
        let mut is_used = false;
        while used.next_if(|start| *start < end).is_some() {
            is_used = true;
        }
        let is_markup = line.trim_start().starts_with('\\');
        if is_used || is_markup || !line.contains(char::is_alphanumeric) {
            continue;
        }
        outside.lines += 1;
        if looks_like_row(line) {
            outside.rows.push(k + 1);
        }
    }
    outside
}

/// Whether half of the words are numbers without names, as in `finest 6e-4` or `# 0.01 6e-4`.
pub(super) fn looks_like_row(line: &str) -> bool {
    let words = line.split_whitespace();
    let words = words.map(|word| word.trim_matches(|c| ",;|&#%*~()<>".contains(c)));
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    let numbers = words.iter().filter(|word| number(word, true).is_some());
    2 * numbers.count() >= words.len() && !line.contains([':', '=']) && !is_closing(line)
}
