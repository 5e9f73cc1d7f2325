//! A line of names, then rows of cells, parted by marks or by blanks.

use super::super::Refused;
use super::super::cell::is_number;
use super::super::grid::{Grid, ROWS};
use super::super::names::{key, says_rates};
use super::lines::{Block, Lines};
use super::{TABLES, is_frame, pairs, too_many_tables};

/// What parts the cells of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mark {
    Char(char),
    Blanks,
    /// Two blanks or more.
    WideBlanks,
}

const MARKS: [Mark; 7] = [
    Mark::Char('|'),
    Mark::Char('&'),
    Mark::Char('\t'),
    Mark::Char(';'),
    Mark::Char(','),
    Mark::Blanks,
    Mark::WideBlanks,
];

impl Mark {
    fn split(self, line: &str) -> Vec<String> {
        let line = line.trim_matches(' ');
        let parts = match self {
            Self::Blanks => line.split_whitespace().collect(),
            Self::WideBlanks => line
                .split("  ")
                .filter(|part| !part.trim().is_empty())
                .collect(),
            Self::Char('|') => {
                let mut parts = fields(line, '|');
                if line.starts_with('|') {
                    parts.remove(0);
                    parts.pop_if(|last| last.trim().is_empty());
                }
                parts
            }
            Self::Char('&') => fields(
                line.trim_end_matches("\\hline")
                    .trim_end_matches(['\\', ' ']),
                '&',
            ),
            Self::Char(mark) => fields(line, mark),
        };
        let trim = |part: &str| part.trim().trim_matches('"').trim().to_owned();
        parts.into_iter().map(trim).collect()
    }
}

/// The parts of a line between marks outside quotes and behind no backslash.
fn fields(line: &str, mark: char) -> Vec<&str> {
    let mut is_quoted = false;
    let mut before = ' ';
    let is_end = |c: char| {
        is_quoted ^= c == '"';
        let ends = c == mark && !is_quoted && before != '\\';
        before = c;
        ends
    };
    line.split(is_end).collect()
}

/// Rows below names, and the numbers of their lines.
struct Rows {
    names: Vec<String>,
    mark: Mark,
    cells: Vec<Vec<String>>,
    lines: Vec<usize>,
}

/// Finds all tables of this form, and marks their lines as used.
///
/// * `names`: as the caller gives them; they make rows without a line of names a table.
pub(super) fn find(lines: &mut Lines<'_>, names: Option<&[String]>) -> Result<Vec<Block>, Refused> {
    let mut blocks = vec![];
    let mut k = 0;
    while k < lines.text.len() {
        let nameless = || rows_from(lines, k, names?);
        let Some(rows) = table_at(lines, k).or_else(nameless) else {
            k += 1;
            continue;
        };
        let head = (rows.lines[0] > k).then_some(k);
        let own: Vec<usize> = head.into_iter().chain(rows.lines).collect();
        own.iter().for_each(|line| lines.used[*line] = true);
        let is_blank = matches!(rows.mark, Mark::Blanks | Mark::WideBlanks);
        let row_lines = own[usize::from(head.is_some())..].iter();
        let grid = Grid {
            names: rows.names,
            head: (is_blank && names.is_none()).then(|| without_comment(lines.text[k]).to_owned()),
            rows: rows.cells,
            row_lines: row_lines.map(|line| line + 1).collect(),
            ..Grid::default()
        };
        if grid.rows.len() > ROWS {
            grid.check()?;
        }
        k = own[own.len() - 1] + 1;
        blocks.push(Block { grid, lines: own });
        if blocks.len() > TABLES {
            return Err(too_many_tables());
        }
    }
    Ok(blocks)
}

fn without_comment(line: &str) -> &str {
    let text = line.trim_start_matches(['#', '%']);
    if text.starts_with([' ', '\t']) {
        text.trim()
    } else {
        line.trim()
    }
}

/// The table whose names stand on a line: with as many cells as names, if a mark gives one.
fn table_at(lines: &Lines<'_>, at: usize) -> Option<Rows> {
    let line = lines.text[at];
    if line.is_empty() || is_frame(line) || pairs(line).is_some() {
        return None;
    }
    let mut other = None;
    for mark in MARKS {
        let head = without_comment(line);
        if matches!(mark, Mark::Char(mark) if !head.contains(mark)) {
            continue;
        }
        let mut names = mark.split(head);
        if mark == Mark::Blanks {
            names
                .iter_mut()
                .for_each(|name| *name = name.trim_end_matches(',').to_owned());
        }
        if !are_names(&names) {
            continue;
        }
        if let Some(rows) = rows_below(lines, at + 1, mark, names) {
            if rows.cells[0].len() == rows.names.len() {
                return Some(rows);
            }
            other.get_or_insert(rows);
        }
    }
    other
}

fn are_names(names: &[String]) -> bool {
    names.len() > 1
        && !names.iter().any(|name| is_number(name))
        && names
            .iter()
            .any(|name| name.contains(|c: char| c.is_alphabetic() || c == '#'))
}

/// The rows that begin on a line, with as many cells as these names.
fn rows_from(lines: &Lines<'_>, at: usize, names: &[String]) -> Option<Rows> {
    let line = lines.text[at];
    let is_row = |mark: &Mark| {
        let cells = mark.split(line);
        cells.len() == names.len() && is_number(&cells[0])
    };
    let mark = MARKS.into_iter().find(is_row).filter(|_| names.len() > 1)?;
    rows_below(lines, at, mark, names.to_vec())
}

/// The rows below names: at least two, with as many cells as the first, not fewer than names.
///
/// * `from`: the first line that may be a row.
fn rows_below(lines: &Lines<'_>, from: usize, mark: Mark, names: Vec<String>) -> Option<Rows> {
    let mut rows = Rows {
        names,
        mark,
        cells: vec![],
        lines: vec![],
    };
    for (k, line) in lines.text.iter().enumerate().skip(from) {
        if is_frame(line) && (!line.is_empty() || rows.cells.is_empty()) {
            continue;
        }
        let is_other = |other: char| mark != Mark::Char(other) && line.contains(other);
        let is_comment = line.starts_with(['#', '%']);
        if is_other('|') || is_other('&') || is_comment || pairs(line).is_some() {
            break;
        }
        let mut cells = mark.split(line);
        // The first row may lack the rate of the coarsest level.
        let lacks_rate = rows.cells.is_empty()
            && mark == Mark::Blanks
            && cells.len() + 1 == rows.names.len()
            && rows.names.last().is_some_and(|name| says_rates(&key(name)));
        if lacks_rate {
            cells.push("-".to_owned());
        }
        let width = rows.cells.first().map_or(cells.len(), Vec::len);
        let fits = cells.len() == width && width >= rows.names.len();
        if !fits || !cells.iter().any(|cell| is_number(cell)) || rows.cells.len() > ROWS {
            break;
        }
        rows.cells.push(cells);
        rows.lines.push(k);
    }
    (rows.cells.len() > 1).then_some(rows)
}
