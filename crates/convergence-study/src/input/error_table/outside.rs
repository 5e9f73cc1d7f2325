//! Lines of a text that belong to none of its tables. They are counted, so that nothing is skipped
//! without a word; if they look like rows, nothing passes.

use std::collections::{HashMap, HashSet};

use super::Doubt;
use super::line::looks_like_row;
use super::names::{Word, without_markup};
use super::original::offset;
use super::pairs::Scan;
use super::parts::Part;

/// What stands outside the tables of a text.
#[derive(Default)]
pub(super) struct Outside {
    /// How many lines with words or numbers hold no cell, name or heading of a table.
    pub(super) lines: usize,
    /// Those that look like rows, if there are any.
    pub(super) rows: Option<Doubt>,
}

/// Finds the lines that belong to none of the tables.
pub(super) fn of_text(text: &str, parts: &[Part<'_>]) -> Outside {
    let unused = unused_lines(text, parts);
    let logged = logged_levels(&unused, parts);
    let mut outside = Outside::default();
    for Line { number, text, .. } in unused {
        outside.lines += 1;
        if !looks_like_row(text) && !logged.contains(&number) {
            continue;
        }
        match &mut outside.rows {
            Some(Doubt::RowsOutside { count, .. }) => *count += 1,
            rows => {
                *rows = Some(Doubt::RowsOutside {
                    line: number,
                    count: 1,
                });
            }
        }
    }
    outside
}

/// A line with words or numbers.
struct Line<'t> {
    /// From 1.
    number: usize,
    /// How many pieces of tables stand above it.
    above: usize,
    text: &'t str,
}

/// The lines without a cell, a name or the heading of a table.
fn unused_lines<'t>(text: &'t str, parts: &[Part<'_>]) -> Vec<Line<'t>> {
    let mut used: Vec<usize> = vec![];
    for Part { words, table, .. } in parts {
        let cells = table.rows.iter().flatten();
        let pieces = cells.chain(&table.names).chain(&table.groups);
        used.extend(pieces.map(|piece| offset(text, piece)));
        used.extend(words.map(|words| offset(text, words)));
    }
    used.sort_unstable();
    let mut used = used.into_iter().peekable();
    let mut unused = vec![];
    let mut end = 0;
    let mut above = 0;
    for (k, line) in text.split_inclusive('\n').enumerate() {
        end += line.len();
        let before = above;
        while used.next_if(|start| *start < end).is_some() {
            above += 1;
        }
        let is_markup = line.trim_start().starts_with('\\');
        if above == before && !is_markup && line.contains(char::is_alphanumeric) {
            unused.push(Line {
                number: k + 1,
                above,
                text: line,
            });
        }
    }
    unused
}

/// The numbers of the lines with the errors of several levels behind their names, as a log beside
/// a table has them; the settings above each of several tables are no levels. What a table leaves
/// out is no such error, unless it has the name as well.
fn logged_levels(unused: &[Line<'_>], parts: &[Part<'_>]) -> Vec<usize> {
    let mut lines: HashMap<(usize, &str), Vec<usize>> = HashMap::new();
    for Line {
        number,
        above,
        text,
    } in unused
    {
        let pairs = Scan::of(text).pairs.into_iter();
        for pair in pairs.filter(|pair| pair.is_marked) {
            let lines = lines.entry((*above, pair.name)).or_default();
            lines.extend(pair.values.iter().map(|_| *number));
        }
    }
    let tables = || parts.iter().map(|part| &part.table);
    let left_out = tables().flat_map(|table| &table.left_out);
    let left_out: HashSet<&str> = left_out.map(|one| one.column.as_str()).collect();
    let names: HashSet<&str> = tables().flat_map(|table| &table.names).copied().collect();
    lines.retain(|(_, name), lines| {
        let is_said = left_out.contains(name) && !names.contains(name);
        lines.len() > 1 && Word::of(&without_markup(name)).noun().is_none() && !is_said
    });
    lines.into_values().flatten().collect()
}
