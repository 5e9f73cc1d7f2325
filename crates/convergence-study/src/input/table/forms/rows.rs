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
        // What stands between the names and the rows belongs to the names.
        let rows = grid.row_lines.iter().map(|line| line - 1);
        let above = (0..k).rev().find(|above| !is_frame(lines.text[*above]));
        let shape = above.filter(|above| says_shape(lines.text[*above], &grid));
        let own = shape
            .into_iter()
            .chain(k..grid.row_lines[0] - 1)
            .chain(rows);
        let own: Vec<usize> = own.collect();
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
    if let Some(grid) = below_index(lines, at, mark, &names) {
        return Some(grid);
    }
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

/// The table whose index has its name on a line of its own, to the left below the others, as pandas
/// prints it.
fn below_index(lines: &Lines<'_>, at: usize, mark: Mark, names: &[String]) -> Option<Grid> {
    let index = lines.text.get(at + 1).filter(|line| !is_frame(line))?;
    let names = [mark.split(index), names.to_vec()].concat();
    if !are_names(&names) || lines.indents[at + 1] >= lines.indents[at] {
        return None;
    }
    let grid = rows_below(lines, at + 2, mark, names)?;
    (grid.rows[0].len() == grid.names.len()).then_some(grid)
}

/// Whether a line below names has the types of their columns, as polars, Julia and R print them.
fn are_types(cells: &[String]) -> bool {
    const TYPES: &str = "str string chr bool lgl int dbl double float num any";
    let is_type = |cell: &String| {
        let name = cell.trim_matches(['<', '>', '?', '-']).to_lowercase();
        let kind = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let is_sized = kind != name && ["i", "u", "f", "int", "uint", "float"].contains(&kind);
        is_sized || TYPES.split(' ').any(|known| known == name)
    };
    cells.iter().all(is_type)
}

/// Whether a line above a table says how many rows and columns it has, as `shape: (4, 3)`.
fn says_shape(line: &str, grid: &Grid) -> bool {
    const WORDS: &str = "shape dataframe a tibble x rows columns";
    let parts = line.split(|c: char| !c.is_alphanumeric());
    let parts = parts.filter(|part| !part.is_empty());
    let (numbers, words): (Vec<&str>, Vec<&str>) =
        parts.partition(|part| part.starts_with(|c: char| c.is_ascii_digit()));
    let are_known = words.iter().all(|word| {
        let word = word.to_lowercase();
        WORDS.split(' ').any(|known| known == word)
    });
    let [rows, columns] = numbers[..] else {
        return false;
    };
    let [rows, columns] = [rows, columns].map(|number| number.parse::<usize>().ok());
    // Numbers of rows are no column of a data frame.
    let width = grid.rows[0].len();
    let has_width = [Some(width), Some(width - 1)].contains(&columns);
    !words.is_empty() && are_known && rows == Some(grid.rows.len()) && has_width
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
        if grid.rows.is_empty() && are_types(&cells) {
            continue;
        }
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
