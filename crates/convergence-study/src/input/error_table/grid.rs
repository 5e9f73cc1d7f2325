//! Names and rows of a table, whatever program wrote it.

use super::cells::{Cell, Separator};
use super::number::{is_dash, number};
use super::words::{Meaning, meaning};
use super::{complaint, shown};
use crate::input::{InputError, Place};

/// Marks that begin a comment.
const COMMENTS: [char; 3] = ['#', '%', '!'];

/// What data frames write below the names.
const TYPES: [&str; 12] =
    ["f64", "f32", "i64", "i32", "u64", "u32", "str", "double", "bigint", "int64", "float64", "int32"];

/// A row and its line, from 1.
#[derive(Debug, Clone)]
pub(super) struct Row<'t> {
    pub(super) line: usize,
    pub(super) cells: Vec<Cell<'t>>,
}

/// A table as it is written.
#[derive(Debug)]
pub(super) struct Grid<'t> {
    /// Line of the names, from 1.
    pub(super) line: usize,
    /// A name for each column, with its place in the file; an empty text for none.
    pub(super) names: Vec<Cell<'t>>,
    /// All of them with a cell for each name.
    pub(super) rows: Vec<Row<'t>>,
    /// Whether a comma in a cell is that of a number.
    pub(super) decimal_comma: bool,
}

/// Lines that may have names, from the top: each with the characters before it that are no part of it.
struct Head<'t> {
    line: usize,
    before: usize,
    text: &'t str,
    is_comment: bool,
}

/// What the rows of a table show of its columns, whatever their names.
struct Shape {
    width: usize,
    /// Whether the first column counts the rows.
    indexed: bool,
    /// Which columns hold rates: their first cell is a dash.
    dashed: Vec<bool>,
}

impl Shape {
    /// The names of a line, one for each of the `width` columns; `None` where it has too few or too many.
    fn names_of<'t>(&self, head: &Head<'t>, below: Option<&Head<'t>>, separator: Separator) -> Option<Vec<Cell<'t>>> {
        // A comment may be separated in another way than the rows: `# h, L2` above columns of blanks.
        let others: &[Separator] = match separator {
            Separator::Blanks if head.is_comment => &[
                Separator::Char(','),
                Separator::Char(';'),
                Separator::Char('\t'),
                Separator::Blanks,
                Separator::WideBlanks,
            ],
            Separator::Blanks => &[Separator::Blanks, Separator::WideBlanks],
            _ if head.is_comment => &[separator, Separator::Blanks],
            _ => std::slice::from_ref(&separator),
        };
        let Self { width, indexed, ref dashed } = *self;
        let dashes = dashed.iter().filter(|dash| **dash).count();
        let mut one_each = None;
        for cells in others.iter().map(|separator| head.cells(*separator)) {
            if head.is_comment && cells.iter().any(|cell| number(cell.text, false).is_some()) {
                continue;
            }
            let nameless = Cell { column: 1, text: "" };
            let spread = |named: &dyn Fn(usize) -> bool| {
                let mut cells = cells.iter().copied();
                (0..width).map(|k| if named(k) { cells.next().unwrap_or(nameless) } else { nameless }).collect()
            };
            let index_name = below.map(|below| below.cells(separator)).filter(|below| below.len() == 1);
            if cells.len() == width {
                let is_rate = |(cell, dash): (&Cell<'_>, &bool)| {
                    !dash || matches!(meaning(cell.text), Meaning::Rate | Meaning::RateOrError)
                };
                if separator != Separator::Blanks || cells.iter().zip(dashed).all(is_rate) {
                    return Some(cells);
                }
                // A column with a dash may hold nameless rates.
                one_each.get_or_insert(cells);
            } else if let (Some(name), true) = (index_name, cells.len() + 1 == width) {
                return Some(name.into_iter().chain(cells).collect());
            } else if dashes > 0 && cells.len() + dashes == width {
                return Some(spread(&|k| !dashed[k]));
            } else if separator == Separator::Blanks && cells.len() + 1 == width && indexed {
                return Some(spread(&|k| k > 0));
            } else if dashes > 0 && cells.len() + dashes + 1 == width && indexed {
                return Some(spread(&|k| k > 0 && !dashed[k]));
            }
        }
        let tokens = head.cells(Separator::Blanks);
        if separator == Separator::Blanks && dashes > 0 && tokens.len() > width - dashes {
            return super::spans::by_position(&tokens, head.before, head.text, dashed).or(one_each);
        }
        one_each
    }
}

impl<'t> Grid<'t> {
    /// Finds separator, names and rows.
    pub(super) fn read(text: &'t str, file: &str) -> Result<Self, InputError> {
        if is_json(text) {
            return Err(complaint(file, Some(Place { line: 1, column: 1 }), TABLE, "JSON, or lists in brackets"));
        }
        let (mut heads, separator, rows) = lines(text);
        let Some(first) = rows.first().map(|row| row.cells.len()) else {
            let pairs = super::pairs::read(text, file)?;
            return pairs.ok_or_else(|| without_numbers(file, &heads, separator));
        };
        // Where the rate of the coarsest level is left blank its row is shorter than the others.
        let width = if separator == Separator::Blanks {
            rows.iter().map(|row| row.cells.len()).max().unwrap_or(first)
        } else {
            first
        };
        let mut grid = Self { line: 0, names: vec![], rows, decimal_comma: separator.leaves_commas() };
        if separator == Separator::Blanks {
            grid.fill_gaps(width);
        }
        // Names stand in the first row that has one for each column; a comment has them where no row does.
        heads.sort_by_key(|head| (head.is_comment, if head.is_comment { usize::MAX - head.line } else { head.line }));
        let shape = Shape {
            width,
            indexed: grid.counts_rows(0),
            dashed: (0..width).map(|column| grid.holds_rates(column)).collect(),
        };
        if let Some((line, names)) = numbered(&heads, width) {
            (grid.line, grid.names) = (line, names);
            return grid.rows_match(file).map(|()| grid);
        }
        for (k, head) in heads.iter().enumerate() {
            let below = heads.get(k + 1).filter(|below| !below.is_comment && !head.is_comment);
            if let Some(names) = shape.names_of(head, below, separator) {
                (grid.line, grid.names) = (head.line, names);
                grid.rows_match(file)?;
                // Below the names come numbers, or the name of the index alone.
                let words = |head: &&Head<'_>| !head.is_comment && head.cells(separator).len() == width;
                if let Some(row) = heads[k + 1..].iter().find(words).filter(|_| !head.is_comment && width > 1) {
                    let cells = row.cells(separator);
                    let cell = cells.iter().find(|cell| !cell.text.is_empty()).unwrap_or(&cells[0]);
                    let place = Place { line: row.line, column: cell.column };
                    let expected = "a number below the names, of which one row is read";
                    return Err(complaint(file, Some(place), expected, &shown(cell.text)));
                }
                return Ok(grid);
            }
        }
        Err(grid.without_names(file, heads.iter().rfind(|head| !head.is_comment), separator))
    }

    /// What is wrong where no line has a name for each column.
    fn without_names(&self, file: &str, head: Option<&Head<'t>>, separator: Separator) -> InputError {
        let place = |row: &Row<'_>| Place { line: row.line, column: row.cells.first().map_or(1, |cell| cell.column) };
        let row = &self.rows[0];
        match head {
            Some(head) => {
                let names = head.cells(separator).len();
                // Cells that were put in for missing ones are empty.
                let written = |row: &Row<'_>| row.cells.iter().filter(|cell| !cell.text.is_empty()).count();
                let row = self.rows.iter().find(|row| written(row) != names).unwrap_or(row);
                let expected = format!("{}, one for each name", plural(names, "cell"));
                let bracketed = row.cells.iter().any(|cell| cell.text.starts_with('('));
                let hint = if bracketed { "; numbers in parentheses need a column with a name" } else { "" };
                complaint(file, Some(place(row)), &expected, &(plural(written(row), "cell") + hint))
            }
            None => {
                let expected = "a name in the first row, such as `h L2 H1`";
                complaint(file, Some(place(row)), expected, &shown(row.cells.first().map_or("", |cell| cell.text)))
            }
        }
    }

    /// Whether a column is 0, 1, 2, ... or 1, 2, 3, ..., from above or from below.
    pub(super) fn counts_rows(&self, column: usize) -> bool {
        let value = |row: &Row<'_>| row.cells.get(column).and_then(|cell| cell.text.parse::<i64>().ok());
        let values: Option<Vec<i64>> = self.rows.iter().map(value).collect();
        values.is_some_and(|mut values| {
            if values.first() > values.last() {
                values.reverse();
            }
            values.first().is_some_and(|first| matches!(first, 0 | 1))
                && values.windows(2).all(|two| two[1] == two[0] + 1)
        })
    }

    /// Whether a row has no number in a column, and says so.
    pub(super) fn has_dash(&self, column: usize) -> bool {
        self.rows.iter().any(|row| row.cells.get(column).is_some_and(|cell| is_dash(cell.text)))
    }

    /// Whether a column may hold rates without a name: a dash, written as such, in the first row or the last, and few decimals in all others.
    fn holds_rates(&self, column: usize) -> bool {
        let text = |row: &Row<'t>| row.cells.get(column).map_or("", |cell| cell.text);
        let is_end = |row: Option<&Row<'t>>| row.is_some_and(|row| is_dash(text(row)) && !text(row).is_empty());
        let is_rate = |row: &Row<'t>| {
            let decimals = text(row).split_once('.').map_or("", |(_, decimals)| decimals);
            is_dash(text(row)) || (decimals.len() < 5 && !text(row).contains(['e', 'E']))
        };
        (is_end(self.rows.first()) || is_end(self.rows.last()))
            && self.rows.iter().filter(|row| is_dash(text(row))).count() == 1
            && self.rows.iter().all(is_rate)
    }

    fn rows_match(&self, file: &str) -> Result<(), InputError> {
        let Some(row) = self.rows.iter().find(|row| row.cells.len() != self.names.len()) else { return Ok(()) };
        let place = Place { line: row.line, column: row.cells.first().map_or(1, |cell| cell.column) };
        let expected = format!("{}, one for each name", plural(self.names.len(), "cell"));
        Err(complaint(file, Some(place), &expected, &plural(row.cells.len(), "cell")))
    }

    /// Puts the cells of shorter rows into the columns below which they stand, and empty ones between them.
    fn fill_gaps(&mut self, width: usize) {
        if self.rows.iter().all(|row| row.cells.len() == width) {
            return;
        }
        let spans = super::spans::spans(&self.rows, width);
        for row in self.rows.iter_mut().filter(|row| row.cells.len() < width) {
            if let Some(cells) = super::spans::place(&row.cells, &spans) {
                row.cells = cells;
            }
        }
    }
}

impl<'t> Head<'t> {
    fn cells(&self, separator: Separator) -> Vec<Cell<'t>> {
        let mut cells = separator.split(self.text);
        cells.iter_mut().for_each(|cell| cell.column += self.before);
        cells
    }
}

/// `1 cell`, `2 cells`.
pub(super) fn plural(count: usize, thing: &str) -> String {
    if count == 1 { format!("1 {thing}") } else { format!("{count} {thing}s") }
}

/// What a file must have.
const TABLE: &str = "a row of names, such as `h L2 H1`, then rows of numbers, such as `0.1 1.6e-3 4e-2`";

/// Whether a text begins as JSON does.
fn is_json(text: &str) -> bool {
    let mut marks = text.chars().filter(|c| !c.is_whitespace());
    let (first, second) = (marks.next(), marks.next());
    matches!(first, Some('{' | '[')) && matches!(second, Some('"' | '{' | '['))
}

/// What is wrong where no row has numbers.
fn without_numbers(file: &str, heads: &[Head<'_>], separator: Separator) -> InputError {
    let mut rows = heads.iter().filter(|head| !head.is_comment).map(|head| (head, head.cells(separator)));
    let Some((first, names)) = rows.next() else { return complaint(file, None, TABLE, "an empty table") };
    let is_number = |cell: &Cell<'_>| number(cell.text, separator.leaves_commas()).is_some();
    // A row that would be one of numbers, but for a cell.
    if let Some((head, cells)) = rows.find(|(_, cells)| cells.len() == names.len() && cells.iter().any(is_number))
        && let Some(cell) = cells.iter().find(|cell| !is_number(cell))
    {
        return complaint(file, Some(Place { line: head.line, column: cell.column }), "a number", &shown(cell.text));
    }
    let found = format!("no row of numbers, but {}", shown(first.text.trim()));
    complaint(file, Some(Place { line: first.line, column: 1 }), TABLE, &found)
}

/// The names of `# 1: cells`, `# 2: dofs`, ..., and the line of the first; `None` where they are not as many as columns.
fn numbered<'t>(heads: &[Head<'t>], width: usize) -> Option<(usize, Vec<Cell<'t>>)> {
    let mut comments: Vec<&Head<'t>> = heads.iter().filter(|head| head.is_comment).collect();
    comments.sort_by_key(|head| head.line);
    let name = |head: &&Head<'t>| {
        let (number, name) = head.text.split_once(':')?;
        let column = head.before + number.chars().count() + 2 + name.chars().take_while(|c| c.is_whitespace()).count();
        Some((number.trim().parse::<usize>().ok()?, head.line, Cell { column, text: name.trim() }))
    };
    let named: Vec<(usize, usize, Cell<'t>)> = comments.iter().filter_map(name).collect();
    let in_order = named.iter().enumerate().all(|(k, (number, ..))| *number == k + 1);
    (named.len() == width && in_order).then(|| (named[0].1, named.into_iter().map(|(.., name)| name).collect()))
}

/// Lines before the first row of numbers, the separator, and the rows.
fn lines(text: &str) -> (Vec<Head<'_>>, Separator, Vec<Row<'_>>) {
    let is_latex = text.contains("\\\\") && text.contains('&');
    let content = |line: &&str| !line.trim().is_empty() && !is_rule(line) && comment(line).is_none();
    let separator = if is_latex {
        Separator::Ampersand
    } else {
        let leads = |line: &&str| starts_with_number(line);
        let line = text.lines().filter(content).find(leads).or_else(|| text.lines().rfind(content));
        line.map_or(Separator::Blanks, Separator::of)
    };
    let (mut heads, mut rows) = (vec![], vec![]);
    for (number, line) in text.lines().enumerate().map(|(number, line)| (number + 1, line)) {
        if line.trim().is_empty() || is_rule(line) {
            continue;
        }
        if let Some((before, text)) = comment(line) {
            if rows.is_empty() {
                heads.push(Head { line: number, before, text, is_comment: true });
            }
            continue;
        }
        if is_latex && !line.contains('&') {
            continue;
        }
        let cells = separator.split(without_comment(line));
        if rows.is_empty() && !is_data(&cells, separator) {
            if !is_type_row(&cells) {
                heads.push(Head { line: number, before: 0, text: line, is_comment: false });
            }
        } else {
            rows.push(Row { line: number, cells });
        }
    }
    (heads, separator, rows)
}

/// A line of dashes or of a box.
fn is_rule(line: &str) -> bool {
    let drawn =
        |c: char| matches!(c, '-' | '=' | '_' | '+' | '|' | ':' | '~') || ('\u{2500}'..='\u{257f}').contains(&c);
    let strokes = |c: char| matches!(c, '-' | '=' | '_' | '~' | '─' | '═' | '━');
    line.chars().all(|c| drawn(c) || c.is_whitespace() || c == '┆')
        && (line.chars().filter(|c| strokes(*c)).count() > 2)
}

/// The text of a comment, and the number of characters before it.
fn comment(line: &str) -> Option<(usize, &str)> {
    let text = line.trim_start().strip_prefix(COMMENTS)?;
    let text = text.trim_start_matches(COMMENTS);
    Some((line[..line.len() - text.len()].chars().count(), text))
}

/// A row without a comment behind it.
fn without_comment(line: &str) -> &str {
    if !line.contains(COMMENTS) {
        return line;
    }
    let begins = |(at, c): &(usize, char)| COMMENTS.contains(c) && line[..*at].ends_with(char::is_whitespace);
    let end = line.char_indices().find(begins).map(|(at, _)| at);
    // Names may begin with `#`, `# cells`; numbers may not.
    end.filter(|_| starts_with_number(line)).map_or(line, |end| &line[..end])
}

fn starts_with_number(line: &str) -> bool {
    let line = line.trim_start_matches(|c: char| c.is_whitespace() || "|│┃║\"$".contains(c));
    let is_end = |c: char| c.is_whitespace() || ";,|│┃┆║&\"".contains(c);
    let word = line.split(is_end).next().unwrap_or("");
    number(word, false).is_some()
}

/// Whether cells are data: the first is a number, or half of them are, and more than one.
fn is_data(cells: &[Cell<'_>], separator: Separator) -> bool {
    let is_number = |cell: &Cell<'_>| number(cell.text, separator.leaves_commas()).is_some();
    let first = cells.first().is_some_and(is_number);
    let numbers = || cells.iter().filter(|cell| is_number(cell)).count();
    first || {
        let numbers = numbers();
        numbers > 1 && 2 * numbers >= cells.len()
    }
}

/// The types of columns, or their units.
fn is_type_row(cells: &[Cell<'_>]) -> bool {
    let is_type = |cell: &Cell<'_>| {
        let text = cell.text.to_lowercase();
        TYPES.contains(&text.as_str()) || (text.starts_with('[') && text.ends_with(']')) || is_dash(&text)
    };
    !cells.is_empty() && cells.iter().all(is_type)
}
