//! Numbers after their names, on one line or on several: `h = 3.5E-01, E = 1.6E-01`, JSON, lists.

use std::collections::{HashMap, HashSet};

use super::names::Word;
use super::number::{is_dash, number};
use crate::text::number::counted;

/// A table as written. Names and cells are slices of the text, which give their places.
#[derive(Debug, Default)]
pub(super) struct RawTable<'t> {
    /// A name for each column, or an empty one.
    pub(super) names: Vec<&'t str>,
    pub(super) rows: Vec<Vec<&'t str>>,
    /// Whether a comma in a cell is a decimal comma.
    pub(super) decimal_comma: bool,
    /// What is not a column of the table, with the reason.
    pub(super) left_out: Vec<(String, String)>,
}

/// Longest text in which a name is looked for before its number, in bytes.
const LONGEST_LABEL: usize = 400;

/// Levels of a log before a name.
const LEVELS: [&str; 4] = ["INFO ", "DEBUG ", "WARNING ", "ERROR "];

/// A name and the numbers after it.
struct Pair<'t> {
    name: &'t str,
    values: Vec<&'t str>,
    /// Whether `=` or `:` separates them.
    is_marked: bool,
}

/// A name, and the place of a number in the list behind it.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Key<'t> {
    name: &'t str,
    place: usize,
}

/// Characters around names and values.
fn is_mark(c: char) -> bool {
    c.is_whitespace() || ",;:=()[]{}\"'".contains(c)
}

/// Reads names and numbers; `None` if there are none, or fewer than rows of numbers.
///
/// * `must_mark`: whether `=` or `:` must separate them.
pub(super) fn read(text: &str, must_mark: bool) -> Option<RawTable<'_>> {
    if must_mark && !text.contains([':', '=']) {
        return None;
    }
    let (pairs, rows) = pairs(text);
    let marked = pairs.iter().filter(|pair| pair.is_marked).count();
    let longest = pairs.iter().map(|pair| pair.values.len()).max()?;
    if if must_mark {
        marked < 2 || marked <= rows
    } else {
        rows > 0
    } {
        return None;
    }
    Some(if longest > 1 && !repeats_a_list(&pairs) {
        lists(pairs, longest)
    } else {
        records(&pairs)
    })
}

/// The numbers of a line that `=` or `:` separates from their names, such as `max error = 1.5e-3`.
pub(crate) fn named_numbers(line: &str) -> Vec<(&str, f64)> {
    if !line.contains(['=', ':']) {
        return vec![];
    }
    let (pairs, _) = pairs(line);
    let named = |pair: &Pair<'_>| match pair.values[..] {
        [value] if pair.is_marked => number(value, false).map(|number| number.value),
        _ => None,
    };
    let numbers = pairs
        .iter()
        .filter_map(|pair| Some((pair.name, named(pair)?)));
    numbers.collect()
}

/// The pairs of a text, and how many lines begin with a nameless number.
fn pairs(text: &str) -> (Vec<Pair<'_>>, usize) {
    let (mut pairs, mut known): (Vec<Pair<'_>>, HashSet<&str>) = Default::default();
    let mut rows = 0;
    let mut is_row = false;
    let mut depth = 0_usize;
    let mut label = 0;
    let mut position = 0;
    while let Some(start) = text[position..]
        .find(|c| !is_mark(c))
        .map(|start| position + start)
    {
        position = text[start..]
            .find(is_mark)
            .map_or(text.len(), |end| start + end);
        let before = &text[label..start];
        let word = &text[start..position];
        let behind = text[position..].trim_start_matches([' ', '\t']);
        let is_last = behind.is_empty() || behind.starts_with(['\n', ',', ';', '}', ')', ']']);
        let is_marked = before
            .trim_end_matches(|c| is_mark(c) && !":=".contains(c))
            .ends_with([':', '=']);
        let begins = word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        // After a name that has a number elsewhere, a word means that the number is missing.
        let is_word = || is_dash(word) || known.contains(name_before(before));
        if !((begins || is_last) && number(word, false).is_some()
            || is_marked && is_last && is_word())
        {
            continue;
        }
        let marks = &before[before.trim_end_matches(is_mark).len()..];
        depth = (depth + marks.matches('[').count()).saturating_sub(before.matches(']').count());
        let name = name_before(before);
        // The first number of a line may have its name on the line above: `"h": [`.
        let is_first = label == 0 || before.contains('\n');
        let is_near = !marks.contains('\n') || marks.contains([':', '=', '[']);
        let has_name =
            name.contains(char::is_alphabetic) && is_near && !marks.contains(['(', ',', ';', '{']);
        is_row = !has_name && (is_first || is_row);
        match pairs.last_mut() {
            _ if has_name => {
                pairs.push(Pair {
                    name,
                    values: vec![word],
                    is_marked,
                });
                known.insert(name);
            }
            Some(last) if depth > 0 || !is_row => last.values.push(word),
            _ => rows += usize::from(is_first),
        }
        label = position;
    }
    (pairs, rows)
}

/// The name that a text ends with, before marks.
fn name_before(text: &str) -> &str {
    let words = text.trim_end_matches(is_mark);
    // The search for a name is bounded, because a text may have a hundred thousand words before its
    // next number.
    let start =
        (words.len().saturating_sub(LONGEST_LABEL)..).find(|at| words.is_char_boundary(*at));
    let words = words[start.unwrap_or(0)..]
        .rsplit('\n')
        .next()
        .unwrap_or_default();
    // `Level(h=0.1, error=2e-3)`, but not `error (L2) = 2e-3`.
    let cuts = |c: char| matches!(c, ',' | ';' | '{' | '\t') || (c == '(' && !words.contains(')'));
    let name = words.rsplit(cuts).next().unwrap_or_default();
    let name = name
        .trim_matches(is_mark)
        .trim_start_matches(['-', '>', ' ']);
    let name = name
        .rsplit([':', ']'])
        .next()
        .unwrap_or_default()
        .trim_matches(is_mark);
    LEVELS
        .iter()
        .find_map(|level| name.strip_prefix(level))
        .unwrap_or(name)
        .trim_start()
}

/// A column for each list; rates, one fewer, begin on the second level.
fn lists(pairs: Vec<Pair<'_>>, longest: usize) -> RawTable<'_> {
    let mut grid = RawTable {
        rows: vec![vec![]; longest],
        ..RawTable::default()
    };
    for mut pair in pairs {
        if pair.values.len() + 1 == longest && longest > 2 {
            pair.values.insert(0, &pair.name[..0]);
        }
        if pair.values.len() == longest {
            grid.names.push(pair.name);
            grid.rows
                .iter_mut()
                .zip(pair.values)
                .for_each(|(row, value)| row.push(value));
        } else {
            let why = format!(
                "{} instead of {longest}",
                counted(pair.values.len(), "number")
            );
            grid.left_out.push((pair.name.to_owned(), why));
        }
    }
    grid
}

/// Whether a name with several numbers occurs again: then each list is the errors of one level.
fn repeats_a_list(pairs: &[Pair<'_>]) -> bool {
    let mut lists = HashSet::new();
    pairs
        .iter()
        .any(|pair| pair.values.len() > 1 && !lists.insert(pair.name))
}

/// The keys of a pair, one for each of its numbers.
fn keys<'t>(pair: &Pair<'t>) -> impl Iterator<Item = Key<'t>> + use<'t> {
    let name = pair.name;
    (0..pair.values.len()).map(move |place| Key { name, place })
}

/// How often each key occurs, in the order of the text.
fn counts<'t>(pairs: &[Pair<'t>]) -> Vec<(Key<'t>, usize)> {
    let mut places: HashMap<Key<'_>, usize> = HashMap::new();
    let mut counts: Vec<(Key<'t>, usize)> = vec![];
    for key in pairs.iter().flat_map(keys) {
        let place = *places.entry(key).or_insert(counts.len());
        if place == counts.len() {
            counts.push((key, 0));
        }
        counts[place].1 += 1;
    }
    counts
}

/// A row for each repetition of the names. Names that a solver prints more often than the step are
/// left out.
fn records<'t>(pairs: &[Pair<'t>]) -> RawTable<'t> {
    let counts = counts(pairs);
    let mut alike: HashMap<usize, usize> = HashMap::new();
    counts
        .iter()
        .for_each(|(_, count)| *alike.entry(*count).or_default() += 1);
    let is_step = |(key, count): &&(Key<'_>, usize)| {
        *count > 1 && matches!(Word::of(key.name), Word::Step | Word::Count(_))
    };
    let common = || {
        counts
            .iter()
            .max_by_key(|(_, count)| (alike[count], *count))
    };
    let levels = counts
        .iter()
        .find(is_step)
        .or_else(common)
        .map_or(0, |(_, count)| *count);
    let (kept, others): (Vec<_>, Vec<_>) = counts
        .iter()
        .partition(|(_, count)| *count <= levels && 2 * count >= levels);
    let why = |(key, count): (Key<'_>, usize)| {
        (
            key.name.to_owned(),
            format!("printed {count} times for {levels} levels"),
        )
    };
    let first = kept
        .iter()
        .find(|(_, count)| *count == levels)
        .map(|(key, _)| key.name);
    let names: Vec<&str> = kept.iter().map(|(key, _)| key.name).collect();
    let columns: HashMap<Key<'_>, usize> = kept
        .iter()
        .enumerate()
        .map(|(column, (key, _))| (*key, column))
        .collect();
    let mut rows: Vec<Vec<&str>> = vec![];
    for pair in pairs {
        if Some(pair.name) == first {
            rows.push(vec![&pair.name[..0]; names.len()]);
        }
        let Some(row) = rows.last_mut() else { continue };
        for (key, value) in keys(pair).zip(&pair.values) {
            if let Some(column) = columns.get(&key) {
                row[*column] = value;
            }
        }
    }
    RawTable {
        names,
        rows,
        left_out: others.into_iter().map(why).collect(),
        ..RawTable::default()
    }
}
