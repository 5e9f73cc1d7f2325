//! Any text as rows of cells below names.

use super::grid::RawTable;
use super::heads::{self, Names};
use super::line::{
    begins_with_number, is_closing, is_comment, is_number, span, split, table_lines,
};
use super::names;
use super::number::number;
use super::original::{blank_at, offset};
use super::pairs::Scan;
use super::turned;

/// A row that is filled has at least one cell in this many columns.
const FULL: usize = 4;

/// Finds the table in a text that has been made [plain](super::cleaned::plain): names with numbers
/// after them, or rows below names.
///
/// * `scan`: the names and numbers of the text.
/// * `earlier`: the names of the table above it in the same text, which it may share.
pub(super) fn read<'t>(text: &'t str, scan: &Scan<'t>, earlier: &[&'t str]) -> RawTable<'t> {
    if let Some(table) = turned::with_rates_between(text) {
        return table;
    }
    if scan.is_log
        && let Some(table) = scan.table()
    {
        return table;
    }
    let Lines {
        mut heads,
        mut rows,
        quoted_names,
        separator,
    } = sort_lines(text);
    // A comment has the names only if no other line does.
    heads.sort_by_key(|line| !is_comment(line));
    heads
        .iter_mut()
        .for_each(|line| *line = line.trim_start_matches(['#', '%', '!']));
    if rows.is_empty() {
        let table = scan.table().filter(|_| scan.rows.is_empty());
        return table.unwrap_or_default();
    }
    let spans = spans(&rows);
    if separator.is_none() {
        fill(&mut rows, &spans);
    }
    let rows: Vec<Vec<&str>> = rows.into_iter().map(|(_, cells)| cells).collect();
    let width = rows.iter().map(Vec::len).max().unwrap_or(0);
    if turned::has_steps_in_head(&rows, &heads) {
        return turned::transpose(&rows, &heads);
    }
    let table = RawTable::with_separator(separator);
    let quoted_names = quoted_names.and_then(|names| fitting(names, width, text));
    let with_names = |names| Names {
        names,
        groups: vec![],
    };
    match quoted_names
        .map(with_names)
        .or_else(|| heads::find(&heads, &rows, &spans, separator))
        .or_else(|| heads::shared(earlier, &heads, separator, width).map(with_names))
    {
        None if turned::is_turned(&rows) => RawTable {
            decimal_comma: table.decimal_comma,
            ..turned::transpose(&rows, &heads)
        },
        names => {
            let Names { names, groups } =
                names.unwrap_or_else(|| with_names(nameless(text, &heads, separator, width)));
            RawTable {
                names,
                groups,
                rows,
                ..table
            }
        }
    }
}

/// Names for so many columns; R writes none above the names of rows.
fn fitting<'t>(names: Vec<&'t str>, width: usize, text: &'t str) -> Option<Vec<&'t str>> {
    match width.checked_sub(names.len())? {
        0 => Some(names),
        1 => Some([&[blank_at(text)], names.as_slice()].concat()),
        _ => None,
    }
}

/// No names: if the number of words above is not that of the columns, it says how many columns
/// there should be.
fn nameless<'t>(
    text: &'t str,
    heads: &[&str],
    separator: Option<char>,
    width: usize,
) -> Vec<&'t str> {
    let words = heads
        .iter()
        .map(|head| split(head, separator).len())
        .rfind(|words| *words > 1);
    vec![blank_at(text); words.unwrap_or(width)]
}

/// The lines of a text by what they hold.
struct Lines<'t> {
    /// Possibly names.
    heads: Vec<&'t str>,
    /// Rows of numbers, each with its cells.
    rows: Vec<(&'t str, Vec<&'t str>)>,
    /// Names that are numbers in quotes.
    quoted_names: Option<Vec<&'t str>>,
    /// Of cells; `None` for blanks.
    separator: Option<char>,
}

/// Separates rows of numbers from the lines above them.
fn sort_lines(text: &str) -> Lines<'_> {
    let lines = table_lines(text);
    let separator = separator(lines.iter().copied().filter(|line| !is_comment(line)));
    let mut heads = vec![];
    let mut rows: Vec<(&str, Vec<&str>)> = vec![];
    let mut quoted_names = None;
    let mut lines = lines.into_iter().peekable();
    while let Some(line) = lines.next() {
        if rows.is_empty()
            && let Some(below) = lines.peek()
            && let Some(names) = names_in_quotes(line, below, separator)
        {
            quoted_names = Some(names);
            continue;
        }
        let cells = split(without_comment(line), separator);
        let is_first = rows.is_empty();
        if !is_comment(&line)
            && (is_first || !is_closing(line))
            && (is_row(&cells, separator)
                || rows
                    .last()
                    .is_some_and(|(_, above)| is_row_below(&cells, above)))
        {
            rows.push((line, cells));
        } else if is_first {
            heads.push(line);
        }
    }
    Lines {
        heads,
        rows,
        quoted_names,
        separator,
    }
}

/// A row without the comment after it; spreadsheets write `#N/A` and `#DIV/0!` for a failed cell.
fn without_comment(line: &str) -> &str {
    let comment = line.find(" #").filter(|start| {
        let word = line[*start..].split_whitespace().next();
        !word.is_some_and(names::is_failure)
    });
    &line[..comment.unwrap_or(line.len())]
}

/// Whether cells begin with a number, or are numbers but for one word.
fn is_row(cells: &[&str], separator: Option<char>) -> bool {
    if cells.first().is_some_and(|cell| is_number(cell, separator)) {
        return true;
    }
    let numbers = cells
        .iter()
        .filter(|cell| is_number(cell, separator))
        .count();
    match separator {
        None => numbers > 1 && numbers + 1 >= cells.len(),
        Some(_) => numbers > 0 && cells.len() > 1,
    }
}

/// Whether cells stand below those of a row as another one: each holds a number or what stands for
/// one, or more than half of them begin with a digit, or half of them with the first. A word in place
/// of a number will be refused.
fn is_row_below(cells: &[&str], above: &[&str]) -> bool {
    let stands_for_number = |cell: &&str| names::is_failure(cell) || number(cell, true).is_some();
    if cells.len() == above.len() && cells.iter().all(stands_for_number) {
        return true;
    }
    let is_digit = |cell: &&str| cell.starts_with(|c: char| c.is_ascii_digit());
    let digits = cells.iter().filter(|cell| is_digit(cell)).count();
    2 * digits > cells.len() || 2 * digits == cells.len() && cells.first().is_some_and(is_digit)
}

/// The cells of a line in which each number is in quotes, if some stand above a number without:
/// they are names.
fn names_in_quotes<'t>(
    line: &'t str,
    below: &str,
    separator: Option<char>,
) -> Option<Vec<&'t str>> {
    if !line.contains('"') {
        return None;
    }
    let names = split(line, separator);
    let cells = split(below, separator);
    let is_head = names
        .iter()
        .filter(|name| is_number(name, separator))
        .all(|name| is_quoted(line, name));
    let is_above_number = names
        .iter()
        .rev()
        .zip(cells.iter().rev())
        .any(|(name, cell)| {
            is_number(name, separator) && is_number(cell, separator) && !is_quoted(below, cell)
        });
    (is_head && is_above_number).then_some(names)
}

/// Whether a quote stands before a cell in its line.
fn is_quoted(line: &str, cell: &str) -> bool {
    line[..offset(line, cell)].ends_with('"')
}

/// The separator of a table: the first that leaves no two numbers in one cell of its first row;
/// `None` for blanks.
fn separator<'t>(mut lines: impl DoubleEndedIterator<Item = &'t str> + Clone) -> Option<char> {
    let line = lines
        .clone()
        .find(begins_with_number)
        .or_else(|| lines.next_back())?;
    if line.trim_start().starts_with('|') && line.matches('|').count() > 1 {
        return Some('|');
    }
    ['&', '|', ';', '\t', ',']
        .into_iter()
        .find(|c| line.contains(*c) && !split(line, Some(*c)).iter().any(holds_two_numbers))
}

/// Whether a cell holds two numbers next to each other.
fn holds_two_numbers(cell: &&str) -> bool {
    let words: Vec<&str> = cell.split_whitespace().collect();
    words
        .windows(2)
        .any(|two| two.iter().all(|word| number(word, true).is_some()))
}

/// The column below which a cell stands.
///
/// * `spans`: of the columns. Starts and ends grow from column to column.
fn column_above(line: &str, cell: &str, spans: &[[usize; 2]]) -> Option<usize> {
    let [start, end] = span(line, cell);
    let column = spans.partition_point(|column| column[1] <= start);
    spans
        .get(column)
        .is_some_and(|column| column[0] < end)
        .then_some(column)
}

/// The bytes of a line between which the cells of each column stand, in the longest rows.
fn spans(rows: &[(&str, Vec<&str>)]) -> Vec<[usize; 2]> {
    let width = rows.iter().map(|(_, cells)| cells.len()).max().unwrap_or(0);
    let mut spans = vec![[usize::MAX, 0]; width];
    for (line, cells) in rows.iter().filter(|(_, cells)| cells.len() == width) {
        for (all, [start, end]) in spans
            .iter_mut()
            .zip(cells.iter().map(|cell| span(line, cell)))
        {
            *all = [all[0].min(start), all[1].max(end)];
        }
    }
    spans
}

/// Moves the cells of short rows into the columns below which they stand: a blank in place of a
/// rate makes a row shorter than the others.
///
/// A row with less than a [`FULL`]-th of the cells stays short: filled, such rows could be many
/// times as long as the text.
fn fill<'t>(rows: &mut [(&'t str, Vec<&'t str>)], spans: &[[usize; 2]]) {
    let width = spans.len();
    for (line, cells) in rows
        .iter_mut()
        .filter(|(_, cells)| (width..FULL * width).contains(&(FULL * cells.len())))
    {
        let columns: Vec<usize> = cells
            .iter()
            .filter_map(|cell| column_above(line, cell, spans))
            .collect();
        if columns.len() == cells.len() && columns.is_sorted_by(|a, b| a < b) {
            let mut all = vec![&line[line.len()..]; width];
            for (column, cell) in columns.into_iter().zip(cells.iter()) {
                all[column] = cell;
            }
            *cells = all;
        }
    }
}
