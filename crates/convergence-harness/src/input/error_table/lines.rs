//! Lines of a text that belong to none of its tables. They are counted, so that nothing is skipped
//! without a word.

use super::parts::Part;

/// How many lines with words or numbers hold no cell, name or heading of a table.
pub(super) fn outside(text: &str, parts: &[Part<'_>]) -> usize {
    let mut used: Vec<usize> = vec![];
    for Part { words, table, .. } in parts {
        let cells = table.rows.iter().flatten();
        let pieces = cells.chain(&table.names).chain(&table.groups);
        used.extend(pieces.map(|piece| place(text, piece)));
        used.extend(words.map(|words| place(text, words)));
    }
    used.sort_unstable();
    let mut used = used.into_iter().peekable();
    let mut count = 0;
    let mut end = 0;
    for line in text.split_inclusive('\n') {
        end += line.len();
        let mut is_used = false;
        while used.next_if(|place| *place < end).is_some() {
            is_used = true;
        }
        let is_markup = line.trim_start().starts_with('\\');
        count += usize::from(!is_used && !is_markup && line.contains(char::is_alphanumeric));
    }
    count
}

/// The byte at which a piece begins; the end of the text for a piece of none.
fn place(text: &str, piece: &str) -> usize {
    (piece.as_ptr() as usize)
        .wrapping_sub(text.as_ptr() as usize)
        .min(text.len())
}
