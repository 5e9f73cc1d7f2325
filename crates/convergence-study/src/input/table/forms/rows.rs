//! A line of names, then rows of cells, parted by marks or by blanks.

use super::super::Refused;
use super::super::cell::is_number_of_any_style;
use super::super::grid::{Grid, ROWS, check};
use super::super::names::{key, says_rates};
use super::lines::Lines;
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
        parts
            .into_iter()
            .map(|part| part.trim().trim_matches('"').trim().replace("\\|", "|"))
            .collect()
    }
}

/// The parts of a line between marks outside quotes and behind no backslash.
fn fields(line: &str, mark: char) -> Vec<&str> {
    let mut is_quoted = false;
    let mut before = ' ';
    let fields = line.split(|c: char| {
        is_quoted ^= c == '"';
        let ends = c == mark && !is_quoted && before != '\\';
        before = c;
        ends
    });
    fields.collect()
}

/// Finds all tables of this form, and marks their lines as used.
///
/// * `names`: as the caller gives them; they make rows without a line of names a table.
pub(super) fn find(lines: &mut Lines<'_>, names: Option<&[String]>) -> Result<Vec<Grid>, Refused> {
    let mut grids = vec![];
    let mut k = 0;
    while k < lines.text.len() {
        let Some(grid) = table_at(lines, k, names) else {
            k += 1;
            continue;
        };
        if grid.rows.len() > ROWS || grids.len() == TABLES {
            check(&grid.names, grid.rows.len(), grid.rows[0].len())?;
            return Err(too_many_tables());
        }
        let mut own: Vec<usize> = grid.row_lines.iter().map(|line| line - 1).collect();
        own.insert(0, k);
        let lines = lines.take(&own);
        k = own[own.len() - 1] + 1;
        grids.push(Grid { lines, ..grid });
    }
    Ok(grids)
}

fn without_comment(line: &str) -> &str {
    let text = line.trim_start_matches(['#', '%']);
    if text.starts_with([' ', '\t']) {
        text.trim()
    } else {
        line.trim()
    }
}

/// The table whose names stand on a line, or whose first row does, with the names that the caller
/// gives: with as many cells as names, if a mark gives one.
fn table_at(lines: &Lines<'_>, at: usize, given: Option<&[String]>) -> Option<Grid> {
    let line = lines.text[at];
    if line.is_empty() || is_frame(line) || pairs(line).is_some() {
        return None;
    }
    let head = without_comment(line);
    let is_in = |mark: &Mark| !matches!(mark, Mark::Char(mark) if !head.contains(*mark));
    let grids = MARKS.into_iter().filter(is_in);
    let mut grids = grids
        .filter_map(|mark| table_by(mark, lines, at, given))
        .peekable();
    let first = grids.peek().cloned();
    let fits = |grid: &Grid| grid.rows[0].len() == grid.names.len();
    grids.find(fits).or(first)
}

/// The table that begins there, if that mark parts its cells.
fn table_by(mark: Mark, lines: &Lines<'_>, at: usize, given: Option<&[String]>) -> Option<Grid> {
    let head = without_comment(lines.text[at]);
    let mut names = mark.split(head);
    if let Some(given) = given
        && given.len() == names.len()
        && is_number_of_any_style(&names[0])
    {
        return rows_below(lines, at, mark, given.to_vec());
    }
    if mark == Mark::Blanks {
        for name in &mut names {
            name.truncate(name.trim_end_matches(',').len());
        }
    }
    let parted_by_blanks = matches!(mark, Mark::Blanks | Mark::WideBlanks);
    let grid = rows_below(
        lines,
        at + 1,
        mark,
        Some(names).filter(|names| are_names(names))?,
    )?;
    let end_of_first_cell = lines.indents[grid.row_lines[0] - 1] + grid.rows[0][0].len();
    Some(Grid {
        head: parted_by_blanks.then(|| head.to_owned()),
        is_indented: lines.indents[at] >= end_of_first_cell,
        ..grid
    })
}

fn are_names(names: &[String]) -> bool {
    names.len() > 1
        && !names.iter().any(|name| is_number_of_any_style(name))
        && names
            .iter()
            .any(|name| name.contains(|c: char| c.is_alphabetic() || c == '#'))
}

/// The rows below names: at least two, with as many cells as the first, not fewer than names.
///
/// * `from`: the first line that may be a row.
fn rows_below(lines: &Lines<'_>, from: usize, mark: Mark, names: Vec<String>) -> Option<Grid> {
    let mut grid = Grid {
        names,
        ..Grid::default()
    };
    for (line, number) in lines.text[from..].iter().zip(from + 1..) {
        if is_frame(line) && (!line.is_empty() || grid.rows.is_empty()) {
            continue;
        }
        let is_other = |other: char| mark != Mark::Char(other) && line.contains(other);
        let is_comment = line.starts_with(['#', '%']);
        if is_other('|') || is_other('&') || is_comment || pairs(line).is_some() {
            break;
        }
        let mut cells = mark.split(line);
        // The first row may lack the rate of the coarsest level.
        let is_short = cells.len() + 1 == grid.names.len() && grid.rows.is_empty();
        let ends_in_rates = grid.names.last().is_some_and(|name| says_rates(&key(name)));
        if mark == Mark::Blanks && is_short && ends_in_rates {
            cells.push("-".to_owned());
        }
        let width = grid.rows.first().map_or(cells.len(), Vec::len);
        let fits = cells.len() == width && width >= grid.names.len();
        let has_number = cells.iter().any(|cell| is_number_of_any_style(cell));
        if !fits || !has_number || grid.rows.len() > ROWS {
            break;
        }
        grid.rows.push(cells);
        grid.row_lines.push(number);
    }
    (grid.rows.len() > 1).then_some(grid)
}
