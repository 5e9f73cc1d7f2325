//! Lines of a text that belong to none of its tables. They are counted, so that nothing is skipped
//! without a word.

use super::line::looks_like_row;
use super::original::offset;
use super::parts::Part;

/// What stands outside the tables of a text.
pub(super) struct Outside {
    /// How many lines with words or numbers hold no cell, name or heading of a table.
    pub(super) lines: usize,
    /// The numbers of those that look like rows, from 1.
    pub(super) rows: Vec<usize>,
}

/// Finds the lines that belong to none of the tables.
pub(super) fn of_text(text: &str, parts: &[Part<'_>]) -> Outside {
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
