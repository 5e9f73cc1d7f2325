//! Numbers after their names, on one line or on several: `h = 3.5E-01, E = 1.6E-01`, JSON, lists.

mod gap;

use std::collections::{HashMap, HashSet};

use super::NotError;
use super::grid::RawTable;
use super::line::has_table_in_prose;
use super::names::{self, Word};
use super::original::{blank_at, offset};
use gap::{Gap, Value, ends_with_mark, name_before};

use crate::text::number::counted;

/// Longest text in which a name is looked for before its number, in bytes.
const LONGEST_LABEL: usize = 400;

/// Levels of a log before a name.
const LEVELS: [&str; 4] = ["INFO ", "DEBUG ", "WARNING ", "ERROR "];

/// A name and the numbers after it.
pub(super) struct Pair<'t> {
    pub(super) name: &'t str,
    pub(super) values: Vec<&'t str>,
    /// Whether `=` or `:` separates them.
    pub(super) is_marked: bool,
}

/// A name, and the place of a number in the list behind it.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Key<'t> {
    name: &'t str,
    place: usize,
}

impl<'t> Pair<'t> {
    /// Its name without the names of other columns before it.
    pub(super) fn last_word(&self) -> &'t str {
        let mut words = self.name.split_whitespace();
        words.next_back().unwrap_or_default()
    }

    /// A key for each of its numbers.
    fn keys(&self) -> impl Iterator<Item = Key<'t>> + use<'t> {
        let name = self.name;
        (0..self.values.len()).map(move |place| Key { name, place })
    }
}

/// Characters around names and values.
pub(super) fn is_mark(c: char) -> bool {
    c.is_whitespace() || ",;:=()[]{}\"'".contains(c)
}

/// What a text holds.
pub(super) struct Scan<'t> {
    pub(super) pairs: Vec<Pair<'t>>,
    /// The lines that begin with a nameless number: that number.
    pub(super) rows: Vec<&'t str>,
    /// Names with a word in place of a number, as often as they occur.
    worded: Vec<&'t str>,
    /// Names of lists that begin with a word.
    lists_of_words: Vec<&'t str>,
    /// Whether more numbers have a name and a mark than lines have none.
    pub(super) is_log: bool,
}

/// Whether more numbers have a name and a mark than lines have none. Steps in a row of names, as
/// `dx=1/32 dx=1/64`, are no log.
fn is_log(pairs: &[Pair<'_>], rows: usize) -> bool {
    let (marked, others): (Vec<&Pair<'_>>, Vec<&Pair<'_>>) =
        pairs.iter().partition(|pair| pair.is_marked);
    let has_one_name = marked
        .windows(2)
        .all(|two| two[0].last_word() == two[1].last_word());
    let is_head = has_one_name && others.iter().any(|pair| pair.values.len() > 1);
    marked.len() >= 2 && marked.len() > rows && !is_head
}

/// The name in parentheses behind a value: `3.03 (computed), 3.00 (exact)`.
fn value_name(behind: &str) -> Option<&str> {
    let (name, _) = behind
        .trim_start_matches(' ')
        .strip_prefix('(')?
        .split_once(')')?;
    (Word::of(name) == Word::Value).then_some(name)
}

impl<'t> Scan<'t> {
    /// Finds the names and numbers of a text.
    pub(super) fn of(text: &'t str) -> Self {
        let mut pairs: Vec<Pair<'_>> = vec![];
        let mut known: HashSet<&str> = HashSet::new();
        let mut rows = vec![];
        let mut worded = vec![];
        let mut lists_of_words = vec![];
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
            let gap = Gap {
                text: &text[label..position],
                behind: &text[position..],
                is_in_list: depth > 0 && label > 0,
            };
            let Some(Value { before, word }) = gap.value(start - label, &known) else {
                worded.extend(gap.name_of_word(start - label));
                lists_of_words.extend(gap.name_of_list(start - label));
                continue;
            };
            let marks = &before[before.trim_end_matches(is_mark).len()..];
            depth =
                (depth + marks.matches('[').count()).saturating_sub(before.matches(']').count());
            let behind = value_name(&text[position..]);
            let name = behind.unwrap_or_else(|| name_before(before));
            // The first number of a line may have its name on the line above: `"h": [`.
            let is_first = label == 0 || before.contains('\n');
            let is_near = !marks.contains('\n') || marks.contains([':', '=', '[']);
            let is_name = is_near && !marks.contains(['(', ',', ';', '{']);
            let has_name = behind.is_some() || is_name && name.contains(char::is_alphabetic);
            is_row = !has_name && (is_first || is_row);
            if has_name {
                pairs.push(Pair {
                    name,
                    values: vec![word],
                    is_marked: behind.is_some() || ends_with_mark(before),
                });
                known.insert(name);
            } else if let Some(last) = pairs.last_mut()
                && (depth > 0 || !is_row)
            {
                last.values.push(word);
            } else if is_first {
                rows.push(word);
            }
            position += behind.map_or(0, |name| offset(&text[position..], name) + name.len());
            label = position;
        }
        Self {
            is_log: is_log(&pairs, rows.len()) && !has_table_in_prose(text),
            pairs,
            rows,
            worded,
            lists_of_words,
        }
    }

    /// Whether the numbers of a name are a column: no list comes again. Lists that do are the errors
    /// of one level each.
    pub(super) fn has_columns(&self) -> bool {
        let mut lists = HashSet::new();
        let mut several = self.pairs.iter().filter(|pair| pair.values.len() > 1);
        several.clone().next().is_some() && several.all(|pair| lists.insert(pair.name))
    }

    /// The table of the names; `None` without numbers.
    pub(super) fn table(&self) -> Option<RawTable<'t>> {
        let longest = self.pairs.iter().map(|pair| pair.values.len()).max()?;
        if self.has_columns() {
            let mut table = lists(&self.pairs, longest);
            table.left_out.extend(words(&self.lists_of_words, 1));
            return Some(table);
        }
        let mut table = records(&self.pairs);
        let levels = table.rows.len();
        if levels > 1 {
            table.left_out.extend(words(&self.worded, levels));
        }
        Some(table)
    }
}

/// The first name of lists that are columns: one of them is a step or a count with at least three
/// numbers. Such lists come again in another table; other lists that come again are the errors of
/// one level each.
pub(super) fn first_column<'t>(pairs: &[Pair<'t>]) -> Option<&'t str> {
    let is_step = |pair: &Pair<'_>| {
        pair.values.len() > 2
            && matches!(
                Word::of(&names::without_markup(pair.name)),
                Word::Step | Word::Count(_)
            )
    };
    let mut lists = pairs.iter().filter(|pair| pair.values.len() > 1);
    let first = lists.next()?;
    pairs.iter().any(is_step).then_some(first.name)
}

/// A column for each list; rates, one fewer, begin on the second level.
fn lists<'t>(pairs: &[Pair<'t>], longest: usize) -> RawTable<'t> {
    let mut table = RawTable {
        rows: vec![vec![]; longest],
        ..RawTable::default()
    };
    let mut single = HashSet::new();
    for Pair { name, values, .. } in pairs {
        let is_late = values.len() + 1 == longest && longest > 2;
        if values.len() == longest || is_late {
            table.names.push(name);
            let first = is_late.then_some(blank_at(name));
            let cells = first.into_iter().chain(values.iter().copied());
            for (row, cell) in table.rows.iter_mut().zip(cells) {
                row.push(cell);
            }
            continue;
        }
        let count = counted(values.len(), "number");
        let one = not_error(name, format!("{count} instead of {longest}"));
        // One number beside lists is no column, unless its name comes again.
        if values.len() == 1 && longest > 2 && single.insert(name) {
            table.left_out.push(one);
        } else {
            table.leave_out_uneven(one);
        }
    }
    table
}

fn not_error(name: &str, because: String) -> NotError {
    NotError {
        column: name.to_owned(),
        because,
        is_checked: false,
    }
}

/// How often a text has a number with this name and place.
struct Repetition<'t> {
    key: Key<'t>,
    count: usize,
}

/// The numbers of a text, by name and place, in order of occurrence.
fn count_keys<'t>(pairs: &[Pair<'t>]) -> Vec<Repetition<'t>> {
    let mut places: HashMap<Key<'_>, usize> = HashMap::new();
    let mut repetitions: Vec<Repetition<'_>> = vec![];
    for key in pairs.iter().flat_map(Pair::keys) {
        let place = *places.entry(key).or_insert(repetitions.len());
        if place == repetitions.len() {
            repetitions.push(Repetition { key, count: 0 });
        }
        repetitions[place].count += 1;
    }
    repetitions
}

/// The number of levels: the count of the step, or else the one that most names share.
fn count_levels(repetitions: &[Repetition<'_>]) -> usize {
    let step = repetitions.iter().find(|Repetition { key, count }| {
        *count > 1 && matches!(Word::of(key.name), Word::Step | Word::Count(_))
    });
    if let Some(step) = step {
        return step.count;
    }
    let mut frequencies: HashMap<usize, usize> = HashMap::new();
    for Repetition { count, .. } in repetitions {
        *frequencies.entry(*count).or_default() += 1;
    }
    let common = repetitions
        .iter()
        .max_by_key(|Repetition { count, .. }| (frequencies[count], *count));
    common.map_or(0, |repetition| repetition.count)
}

/// The names that have a word on each of several levels.
fn words(worded: &[&str], levels: usize) -> Vec<NotError> {
    let mut counts: HashMap<&str, usize> = HashMap::new();
    let mut left_out = vec![];
    for name in worded {
        let count = counts.entry(name).or_default();
        *count += 1;
        if *count == levels {
            left_out.push(NotError {
                is_checked: names::is_group(name),
                ..not_error(name, "words".to_owned())
            });
        }
    }
    left_out
}

/// A row for each repetition of the names. Names that a solver prints more often than the step are
/// left out.
fn records<'t>(pairs: &[Pair<'t>]) -> RawTable<'t> {
    let repetitions = count_keys(pairs);
    let levels = count_levels(&repetitions);
    let mut table = RawTable::default();
    let mut columns: HashMap<Key<'_>, usize> = HashMap::new();
    let mut first = None;
    for Repetition { key, count } in repetitions {
        if count > levels || 2 * count < levels {
            let because = format!("printed {count} times for {levels} levels");
            table.leave_out_uneven(not_error(key.name, because));
            continue;
        }
        if count == levels && first.is_none() {
            first = Some(key.name);
        }
        columns.insert(key, table.names.len());
        table.names.push(key.name);
    }
    for pair in pairs {
        if Some(pair.name) == first {
            table
                .rows
                .push(vec![blank_at(pair.name); table.names.len()]);
        }
        let Some(row) = table.rows.last_mut() else {
            continue;
        };
        for (key, value) in pair.keys().zip(&pair.values) {
            if let Some(column) = columns.get(&key) {
                row[*column] = value;
            }
        }
    }
    table
}
