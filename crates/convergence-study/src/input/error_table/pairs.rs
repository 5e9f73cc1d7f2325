//! Numbers behind their names, on one line or on several: `h = 3.5E-01, E = 1.6E-01`, JSON, lists.

use super::names::Word;
use super::number::{is_dash, number};
use super::text::{Cell, Grid, Row};

/// A name and the numbers behind it.
struct Entry<'t> {
    name: Cell<'t>,
    line: usize,
    values: Vec<Cell<'t>>,
    /// Whether `=` or `:` stands between.
    is_marked: bool,
}

/// What surrounds names and values.
fn is_mark(c: char) -> bool {
    c.is_whitespace() || ",;:=()[]{}\"'".contains(c)
}

/// Reads names and numbers; `None` where there are none, or fewer than rows of numbers.
///
/// * `must_mark`: whether `=` or `:` must stand between them.
pub(super) fn read(text: &str, must_mark: bool) -> Option<Grid<'_>> {
    if must_mark && !text.contains([':', '=']) {
        return None;
    }
    let (mut entries, mut rows, mut depth, mut name) = (vec![], 0, 0, None);
    for (line, words) in text.lines().enumerate() {
        rows += usize::from(entries_of(line + 1, words, &mut depth, &mut name, &mut entries));
    }
    let marked = entries.iter().filter(|entry: &&Entry<'_>| entry.is_marked).count();
    if entries.is_empty() || if must_mark { marked < 2 || marked <= rows } else { rows > 0 } {
        return None;
    }
    let longest = entries.iter().map(|entry| entry.values.len()).max()?;
    let grid = if longest > 1 { lists(entries, longest) } else { records(&entries) };
    Some(Grid { text, ..grid })
}

/// Appends what a line holds; whether it begins with a number that has no name.
///
/// * `depth`: how many brackets are open.
/// * `above`: a name at the end of the line above, `"h": [`.
fn entries_of<'t>(
    line: usize,
    words: &'t str,
    depth: &mut usize,
    above: &mut Option<Cell<'t>>,
    entries: &mut Vec<Entry<'t>>,
) -> bool {
    let (mut label, mut position, mut is_row) = (0, 0, false);
    let mut count = |text: &str| {
        *depth = (*depth + text.matches('[').count()).saturating_sub(text.matches(']').count());
        *depth > 0
    };
    while let Some(start) = words[position..].find(|c| !is_mark(c)).map(|start| position + start) {
        position = words[start..].find(is_mark).map_or(words.len(), |end| start + end);
        let (before, word, behind) = (&words[label..start], &words[start..position], words[position..].trim_start());
        let is_marked = before.trim_end_matches(|c| is_mark(c) && !":=".contains(c)).ends_with([':', '=']);
        let is_last = behind.is_empty() || behind.starts_with([',', ';', '}', ')', ']']);
        let begins = word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        let is_value = number(word, false).is_some() && (begins || is_last);
        // Behind a name that has a number elsewhere a word says that there is none.
        let is_word = || is_dash(word) || entries.iter().any(|entry| before.contains(entry.name.text));
        if !(is_value || is_marked && is_last && is_word()) {
            continue;
        }
        let is_list = count(before);
        let value = Cell { start, text: word };
        // `Level(h=0.1, error=2e-3)`, but not `error (L2) = 2e-3`.
        let cuts = |c: char| matches!(c, ',' | ';' | '{' | '\t') || (c == '(' && !before.contains(')'));
        let cut = before.rfind(cuts).map_or(0, |cut| cut + 1);
        let name = before[cut..].trim_matches(is_mark).trim_start_matches(['-', '>', ' ']);
        let name = name.rsplit(": ").next().unwrap_or(name).trim_matches(is_mark);
        if let Some(name) = above.take().filter(|_| name.is_empty()) {
            entries.push(Entry { name, line, values: vec![value], is_marked: true });
            label = position;
            continue;
        }
        match entries.last_mut() {
            Some(last) if name.is_empty() && (is_list || (last.line == line && label > 0)) => last.values.push(value),
            _ if name.is_empty() => is_row = is_row || label == 0,
            _ => {
                let start = label + before.rfind(name).unwrap_or(0);
                entries.push(Entry { name: Cell { start, text: name }, line, values: vec![value], is_marked });
            }
        }
        label = position;
    }
    let rest = &words[label..];
    count(rest);
    let name = rest[rest.rfind([',', '{']).map_or(0, |cut| cut + 1)..].trim_matches(is_mark);
    let is_open = rest.trim_end().ends_with(['[', ':', '=']) && !name.is_empty();
    *above =
        above.take().filter(|_| rest.trim().is_empty()).or_else(|| is_open.then_some(Cell { start: 0, text: name }));
    is_row
}

/// A column for each list; rates, which are one fewer, begin on the second level.
fn lists(entries: Vec<Entry<'_>>, longest: usize) -> Grid<'_> {
    let mut grid = Grid { line: entries[0].line, ..Grid::default() };
    grid.rows = vec![Row { line: grid.line, cells: vec![] }; longest];
    for mut entry in entries {
        if entry.values.len() + 1 == longest && longest > 2 {
            entry.values.insert(0, Cell { text: "", ..entry.name });
        }
        if entry.values.len() != longest {
            let why = format!("{} instead of {longest}", crate::text::number::counted(entry.values.len(), "number"));
            grid.left_out.push((entry.name.text.to_owned(), why));
            continue;
        }
        grid.names.push(entry.name);
        grid.rows.iter_mut().zip(entry.values).for_each(|(row, value)| row.cells.push(value));
    }
    grid
}

/// A row for each time that the names come round. What is printed more often than the step, by a solver, is left out.
fn records<'t>(entries: &[Entry<'t>]) -> Grid<'t> {
    let mut names: Vec<(Cell<'t>, usize)> = vec![];
    for entry in entries {
        match names.iter_mut().find(|(name, _)| name.text == entry.name.text) {
            Some((_, count)) => *count += 1,
            None => names.push((entry.name, 1)),
        }
    }
    let is_step =
        |(name, count): &&(Cell<'_>, usize)| *count > 1 && matches!(Word::of(name.text), Word::Step | Word::Count(_));
    let alike = |count: usize| names.iter().filter(|(_, other)| *other == count).count();
    let common = || names.iter().map(|(_, count)| *count).max_by_key(|count| (alike(*count), *count));
    let levels = names.iter().find(is_step).map(|(_, count)| *count).or_else(common).unwrap_or(0);
    let mut grid = Grid { line: entries[0].line, ..Grid::default() };
    names.retain(|(name, count)| {
        let kept = *count <= levels && 2 * count >= levels;
        if !kept {
            grid.left_out.push((name.text.to_owned(), format!("printed {count} times for {levels} levels")));
        }
        kept
    });
    let first = names.iter().find(|(_, count)| *count == levels).map(|(name, _)| name.text);
    for entry in entries {
        if Some(entry.name.text) == first {
            let empty = names.iter().map(|_| Cell { start: entry.name.start, text: "" }).collect();
            grid.rows.push(Row { line: entry.line, cells: empty });
        }
        let column = names.iter().position(|(name, _)| name.text == entry.name.text);
        if let (Some(row), Some(column)) = (grid.rows.last_mut(), column) {
            row.cells[column] = entry.values[0];
        }
    }
    grid.names = names.into_iter().map(|(name, _)| name).collect();
    grid
}
