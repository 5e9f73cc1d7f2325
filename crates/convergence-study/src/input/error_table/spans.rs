//! Columns by the places of their characters, where cells are missing or names have blanks in them.

use std::ops::Range;

use super::cells::Cell;
use super::grid::Row;
use super::words::{Meaning, meaning};

/// The characters that each of the `width` columns takes, over the rows that have a cell in each.
pub(super) fn spans(rows: &[Row<'_>], width: usize) -> Vec<Range<usize>> {
    let mut spans = vec![Range { start: usize::MAX, end: 0 }; width];
    for row in rows.iter().filter(|row| row.cells.len() == width) {
        for (span, cell) in spans.iter_mut().zip(&row.cells) {
            *span = span.start.min(cell.column)..span.end.max(end(cell));
        }
    }
    spans
}

fn end(cell: &Cell<'_>) -> usize {
    cell.column + cell.text.chars().count()
}

/// Cells in the columns whose characters they share, with empty ones between them; `None` where a cell stands below none or below two.
pub(super) fn place<'t>(cells: &[Cell<'t>], spans: &[Range<usize>]) -> Option<Vec<Cell<'t>>> {
    let mut placed: Vec<Cell<'t>> = spans.iter().map(|span| Cell { column: span.start, text: "" }).collect();
    for cell in cells {
        let shared = |span: &Range<usize>| span.start < end(cell) && cell.column < span.end;
        let column = spans.partition_point(|span| span.end <= cell.column);
        if !spans.get(column).is_some_and(shared) || spans.get(column + 1).is_some_and(shared) {
            return None;
        }
        if !placed[column].text.is_empty() {
            return None;
        }
        placed[column] = *cell;
    }
    Some(placed)
}

/// Names of several words above columns of which some hold rates: words with one blank between them are one name, unless each of them is
/// the name of a step or a count.
///
/// * `before`: characters before `line`, which holds the words.
/// * `dashed`: the columns that hold rates.
pub(super) fn by_position<'t>(
    words: &[Cell<'t>],
    before: usize,
    line: &'t str,
    dashed: &[bool],
) -> Option<Vec<Cell<'t>>> {
    let known = |cell: &Cell<'_>| matches!(meaning(cell.text), Meaning::Step | Meaning::Count(_) | Meaning::Index);
    let bytes = |column: usize| line.char_indices().nth(column - before - 1).map_or(line.len(), |(at, _)| at);
    let mut names: Vec<Cell<'t>> = vec![];
    for word in words {
        match names.last_mut() {
            Some(last) if end(last) + 1 == word.column && !known(last) && !known(word) => {
                last.text = &line[bytes(last.column)..bytes(end(word))];
            }
            _ => names.push(*word),
        }
    }
    let missing = dashed.len().checked_sub(names.len())?;
    let rates = dashed.iter().filter(|dash| **dash).count();
    if missing != rates {
        return None;
    }
    let mut names = names.into_iter();
    let nameless = Cell { column: 1, text: "" };
    Some(dashed.iter().map(|dash| if *dash { nameless } else { names.next().unwrap_or(nameless) }).collect())
}
