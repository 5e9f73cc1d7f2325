//! Numbers behind their names, on one line or on several: `h = 3.5E-01, E = 1.6E-01`, JSON, lists.

use super::names::Word;
use super::number::{is_dash, number};
use super::text::RawTable;
use crate::text::number::counted;

/// A name and the numbers behind it.
struct Pair<'t> {
    name: &'t str,
    values: Vec<&'t str>,
    /// Whether `=` or `:` stands between.
    is_marked: bool,
}

/// What lines hold.
#[derive(Default)]
struct Entries<'t> {
    list: Vec<Pair<'t>>,
    /// How many brackets are open.
    depth: usize,
    /// A name at the end of the line above, `"h": [`.
    above: Option<&'t str>,
    /// How many lines begin with a number that has no name.
    rows: usize,
}

/// What surrounds names and values.
fn is_mark(c: char) -> bool {
    c.is_whitespace() || ",;:=()[]{}\"'".contains(c)
}

/// Reads names and numbers; `None` where there are none, or fewer than rows of numbers.
///
/// * `must_mark`: whether `=` or `:` must stand between them.
pub(super) fn read(text: &str, must_mark: bool) -> Option<RawTable<'_>> {
    if must_mark && !text.contains([':', '=']) {
        return None;
    }
    let mut entries = Entries::default();
    text.lines().for_each(|line| entries.add(line));
    let Entries { list, rows, .. } = entries;
    let marked = list.iter().filter(|entry| entry.is_marked).count();
    if list.is_empty() || if must_mark { marked < 2 || marked <= rows } else { rows > 0 } {
        return None;
    }
    let longest = list.iter().map(|entry| entry.values.len()).max()?;
    let grid = if longest > 1 { lists(list, longest) } else { records(&list) };
    Some(RawTable { text, ..grid })
}

impl<'t> Entries<'t> {
    /// Adds what a line holds.
    fn add(&mut self, words: &'t str) {
        let (mut label, mut position, mut is_row, before_line) = (0, 0, false, self.list.len());
        while let Some(start) = words[position..].find(|c| !is_mark(c)).map(|start| position + start) {
            position = words[start..].find(is_mark).map_or(words.len(), |end| start + end);
            let (before, word, behind) =
                (&words[label..start], &words[start..position], words[position..].trim_start());
            let is_marked = before.trim_end_matches(|c| is_mark(c) && !":=".contains(c)).ends_with([':', '=']);
            let is_last = behind.is_empty() || behind.starts_with([',', ';', '}', ')', ']']);
            let begins = word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
            let is_value = number(word, false).is_some() && (begins || is_last);
            // Behind a name that has a number elsewhere a word says that there is none.
            let is_word = || is_dash(word) || self.list.iter().any(|entry| before.contains(entry.name));
            if !(is_value || is_marked && is_last && is_word()) {
                continue;
            }
            self.count(before);
            // `Level(h=0.1, error=2e-3)`, but not `error (L2) = 2e-3`.
            let cuts = |c: char| matches!(c, ',' | ';' | '{' | '\t') || (c == '(' && !before.contains(')'));
            let cut = before.rfind(cuts).map_or(0, |cut| cut + 1);
            let name = before[cut..].trim_matches(is_mark).trim_start_matches(['-', '>', ' ']);
            let name = name.rsplit(": ").next().unwrap_or(name).trim_matches(is_mark);
            let is_on_line = self.list.len() > before_line;
            match (self.above.take().filter(|_| name.is_empty()), self.list.last_mut()) {
                (Some(name), _) => self.list.push(Pair { name, values: vec![word], is_marked: true }),
                (None, Some(last)) if name.is_empty() && (self.depth > 0 || (is_on_line && label > 0)) => {
                    last.values.push(word);
                }
                _ if name.is_empty() => is_row = is_row || label == 0,
                _ => self.list.push(Pair { name, values: vec![word], is_marked }),
            }
            label = position;
        }
        let rest = &words[label..];
        self.count(rest);
        let name = rest[rest.rfind([',', '{']).map_or(0, |cut| cut + 1)..].trim_matches(is_mark);
        let is_open = rest.trim_end().ends_with(['[', ':', '=']) && !name.is_empty();
        self.above = self.above.take().filter(|_| rest.trim().is_empty()).or_else(|| is_open.then_some(name));
        self.rows += usize::from(is_row);
    }

    /// Counts the brackets of a piece.
    fn count(&mut self, text: &str) {
        self.depth = (self.depth + text.matches('[').count()).saturating_sub(text.matches(']').count());
    }
}

/// A column for each list; rates, which are one fewer, begin on the second level.
fn lists(entries: Vec<Pair<'_>>, longest: usize) -> RawTable<'_> {
    let mut grid = RawTable { rows: vec![vec![]; longest], ..RawTable::default() };
    for mut entry in entries {
        if entry.values.len() + 1 == longest && longest > 2 {
            entry.values.insert(0, &entry.name[..0]);
        }
        if entry.values.len() != longest {
            let why = format!("{} instead of {longest}", counted(entry.values.len(), "number"));
            grid.left_out.push((entry.name.to_owned(), why));
            continue;
        }
        grid.names.push(entry.name);
        grid.rows.iter_mut().zip(entry.values).for_each(|(row, value)| row.push(value));
    }
    grid
}

/// A row for each time that the names come round. What is printed more often than the step, by a solver, is left out.
fn records<'t>(entries: &[Pair<'t>]) -> RawTable<'t> {
    let mut names: Vec<(&'t str, usize)> = vec![];
    for entry in entries {
        match names.iter_mut().find(|(name, _)| *name == entry.name) {
            Some((_, count)) => *count += 1,
            None => names.push((entry.name, 1)),
        }
    }
    let is_step = |(name, count): &&(&str, usize)| *count > 1 && matches!(Word::of(name), Word::Step | Word::Count(_));
    let alike = |count: usize| names.iter().filter(|(_, other)| *other == count).count();
    let common = || names.iter().map(|(_, count)| *count).max_by_key(|count| (alike(*count), *count));
    let levels = names.iter().find(is_step).map(|(_, count)| *count).or_else(common).unwrap_or(0);
    let (kept, others): (Vec<_>, Vec<_>) =
        names.into_iter().partition(|(_, count)| *count <= levels && 2 * count >= levels);
    let why = |(name, count): (&str, usize)| (name.to_owned(), format!("printed {count} times for {levels} levels"));
    let first = kept.iter().find(|(_, count)| *count == levels).map(|(name, _)| *name);
    let names: Vec<&str> = kept.iter().map(|(name, _)| *name).collect();
    let mut rows: Vec<Vec<&str>> = vec![];
    for entry in entries {
        if Some(entry.name) == first {
            rows.push(vec![&entry.name[..0]; names.len()]);
        }
        if let (Some(row), Some(column)) = (rows.last_mut(), names.iter().position(|name| *name == entry.name)) {
            row[column] = entry.values[0];
        }
    }
    RawTable { names, rows, left_out: others.into_iter().map(why).collect(), ..RawTable::default() }
}
