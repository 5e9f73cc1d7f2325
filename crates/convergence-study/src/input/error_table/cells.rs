//! Cells of a line: separated by commas, semicolons, tabs, bars, `&` or blanks.

use super::number::number;

/// A cell without blanks and quotes around it, and its column in characters, from 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell<'t> {
    pub(super) column: usize,
    pub(super) text: &'t str,
}

/// What separates cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    /// `,`, `;` or a tab.
    Char(char),
    /// `|` or a line of a box.
    Bar,
    /// LaTeX: `&`, and `\\` at the end of a row.
    Ampersand,
    /// One blank or more.
    Blanks,
    /// Two blanks or more, for names of several words.
    WideBlanks,
}

/// Bars of boxes that programs draw around their tables.
fn is_bar(c: char) -> bool {
    matches!(c, '|' | '│' | '┃' | '┆' | '║')
}

impl Separator {
    /// The separator of a line: the first that leaves no two numbers in one cell.
    pub(super) fn of(line: &str) -> Self {
        let fits = |separator: &Self| {
            let cells = separator.split(line);
            cells.len() > 1 && !cells.iter().any(|cell| holds_two_numbers(cell.text))
        };
        let known = [Self::Bar, Self::Char(';'), Self::Char('\t'), Self::Char(',')];
        known.into_iter().find(fits).unwrap_or(Self::Blanks)
    }

    /// Whether a comma in a cell can be that of a number.
    pub(super) fn leaves_commas(self) -> bool {
        self != Self::Char(',')
    }

    /// The cells of a line.
    pub(super) fn split(self, line: &str) -> Vec<Cell<'_>> {
        match self {
            Self::Char(separator) => split_at(line, |c| c == separator),
            Self::Bar => without_outer(split_at(line, is_bar), line),
            Self::Ampersand => {
                let (before, row) = latex_row(line);
                let mut cells = split_at(row, |c| c == '&');
                cells.iter_mut().for_each(|cell| cell.column += before);
                cells
            }
            Self::Blanks => {
                let mut cells = split_at(line, |c| c.is_whitespace() || is_bar(c));
                cells.retain(|cell| !cell.text.is_empty());
                cells
            }
            Self::WideBlanks => wide(line),
        }
    }
}

/// Whether two numbers stand side by side; between those of `1.2 \times 10^{-3}` stands a word.
fn holds_two_numbers(cell: &str) -> bool {
    let mut is_number = cell.split_whitespace().map(|word| number(word, true).is_some());
    let mut last = is_number.next();
    is_number.any(|next| last.replace(next) == Some(true) && next)
}

/// Splits outside of quotes; a separator behind a backslash is a character like any other.
fn split_at(line: &str, separates: impl Fn(char) -> bool) -> Vec<Cell<'_>> {
    let mut cells = vec![];
    let (mut start, mut column, mut here) = (0, 1, 1);
    let (mut quoted, mut escaped, mut blank) = (false, false, true);
    for (at, c) in line.char_indices() {
        if !quoted && !escaped && separates(c) {
            cells.push(cell(&line[start..at], column));
            (start, column, blank) = (at + c.len_utf8(), here + 1, true);
        } else if c == '"' && (quoted || blank) {
            quoted = !quoted;
        }
        blank = blank && (c.is_whitespace() || separates(c));
        escaped = c == '\\' && !escaped;
        here += 1;
    }
    cells.push(cell(&line[start..], column));
    cells
}

fn cell(raw: &str, column: usize) -> Cell<'_> {
    let blanks = raw.chars().take_while(|c| c.is_whitespace()).count();
    let text = raw.trim();
    let text = text.strip_prefix('"').and_then(|text| text.strip_suffix('"')).unwrap_or(text).trim();
    Cell { column: column + blanks, text }
}

/// Without the empty cells before the first bar and behind the last one.
fn without_outer<'t>(mut cells: Vec<Cell<'t>>, line: &str) -> Vec<Cell<'t>> {
    if cells.len() > 1 && line.trim_end().ends_with(is_bar) {
        cells.pop();
    }
    if cells.len() > 1 && line.trim_start().starts_with(is_bar) {
        cells.remove(0);
    }
    cells
}

fn wide(line: &str) -> Vec<Cell<'_>> {
    let (mut cells, mut rest, mut column) = (vec![], line, 1);
    while let Some(gap) = rest.find("  ") {
        cells.push(cell(&rest[..gap], column));
        column += rest[..gap].chars().count() + 2;
        rest = &rest[gap + 2..];
    }
    cells.push(cell(rest, column));
    cells.retain(|cell| !cell.text.is_empty());
    cells
}

/// A row of LaTeX without rules before it and `\\` behind it, and the number of characters before it.
fn latex_row(line: &str) -> (usize, &str) {
    const BEFORE: [&str; 6] = ["\\hline", "\\toprule", "\\midrule", "\\bottomrule", "\\addlinespace", "\\rowcolor"];
    let mut row = line;
    loop {
        let trimmed = row.trim_start();
        let Some(rest) = BEFORE.iter().find_map(|rule| trimmed.strip_prefix(rule)) else { break };
        row = rest;
    }
    let before = line[..line.len() - row.len()].chars().count();
    (before, row.find("\\\\").map_or(row, |end| &row[..end]))
}
