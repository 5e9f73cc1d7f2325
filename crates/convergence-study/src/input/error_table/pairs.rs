//! Numbers after their names, on one line or on several: `h = 3.5E-01, E = 1.6E-01`, JSON, lists.

mod gap;

use std::collections::{HashMap, HashSet};

use super::names::{self, Word};
use super::number::number;
use gap::{Gap, Value, ends_with_mark, name_before};

use crate::text::number::counted;

/// A table as written. Names and cells are slices of the text, which give their places.
#[derive(Debug, Clone, Default)]
pub(super) struct RawTable<'t> {
    /// A name for each column, or an empty one.
    pub(super) names: Vec<&'t str>,
    pub(super) rows: Vec<Vec<&'t str>>,
    /// For each column the name above its name; may be empty.
    pub(super) groups: Vec<&'t str>,
    /// Whether a comma in a cell is a decimal comma.
    pub(super) decimal_comma: bool,
    /// What is not a column of the table.
    pub(super) left_out: Vec<LeftOut>,
}

/// The name of a column, and what it says.
pub(super) struct ColumnName {
    pub(super) name: String,
    pub(super) word: Word,
}

impl RawTable<'_> {
    /// The names of the columns, or those that the user has chosen. The errors of a variable have
    /// its name.
    pub(super) fn column_names(&self, chosen: Option<&[String]>) -> Vec<ColumnName> {
        if let Some(names) = chosen {
            let names = names.iter().map(|name| ColumnName {
                name: name.clone(),
                word: Word::of(name),
            });
            return names.collect();
        }
        let name = |(k, name): (usize, &&str)| {
            let name = names::without_markup(name);
            let word = Word::of(&name);
            let group = self.groups.get(k).map(|group| names::without_markup(group));
            let group = group.filter(|group| !group.is_empty());
            let name = match group {
                Some(group) if word == Word::Error => group,
                Some(group) => format!("{group} {name}"),
                None => name,
            };
            ColumnName { name, word }
        };
        self.names.iter().enumerate().map(name).collect()
    }
}

/// A column, or a list of numbers, that is not an error.
#[derive(Debug, Clone)]
pub(super) struct LeftOut {
    pub(super) name: String,
    pub(super) reason: String,
    /// Whether its numbers show the reason, and not its name alone.
    pub(super) is_checked: bool,
    /// Whether it is one number beside lists, and so no column.
    pub(super) is_single: bool,
}

impl LeftOut {
    /// Whether its name does not say that it is something else.
    pub(super) fn may_be_error(&self) -> bool {
        let word = Word::of(&names::without_markup(&self.name));
        !self.is_single && word.noun().is_none()
    }
}

/// Longest text in which a name is looked for before its number, in bytes.
const LONGEST_LABEL: usize = 400;

/// Levels of a log before a name.
const LEVELS: [&str; 4] = ["INFO ", "DEBUG ", "WARNING ", "ERROR "];

/// A name and the numbers after it.
pub(super) struct Pair<'t> {
    pub(super) name: &'t str,
    pub(super) values: Vec<&'t str>,
    /// Whether `=` or `:` separates them.
    is_marked: bool,
}

/// A name, and the place of a number in the list behind it.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Key<'t> {
    name: &'t str,
    place: usize,
}

impl<'t> Pair<'t> {
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

/// Reads names and numbers; `None` if there are none, or fewer than rows of numbers.
///
/// * `must_mark`: whether `=` or `:` must separate them.
pub(super) fn read(text: &str, must_mark: bool) -> Option<RawTable<'_>> {
    if must_mark && !may_be_log(text) {
        return None;
    }
    let found = find_pairs(text);
    let is_table_of_rows = if must_mark {
        !found.is_log()
    } else {
        !found.rows.is_empty()
    };
    if is_table_of_rows {
        return None;
    }
    let pairs = found.pairs;
    let longest = pairs.iter().map(|pair| pair.values.len()).max()?;
    Some(if longest > 1 && !repeats_a_list(&pairs) {
        lists(pairs, longest)
    } else {
        let mut table = records(&pairs);
        table
            .left_out
            .extend(words(&found.worded, table.rows.len()));
        table
    })
}

/// The numbers of a line that `=` or `:` separates from their names, such as `max error = 1.5e-3`.
#[cfg(feature = "reports")]
pub(crate) fn named_numbers(line: &str) -> Vec<(&str, f64)> {
    if !line.contains(['=', ':']) {
        return vec![];
    }
    let mut numbers = vec![];
    for pair in find_pairs(line).pairs {
        if let [text] = pair.values[..]
            && pair.is_marked
            && let Some(number) = number(text, false)
        {
            numbers.push((pair.name, number.value));
        }
    }
    numbers
}

/// What a text holds.
struct PairedText<'t> {
    pairs: Vec<Pair<'t>>,
    /// The lines that begin with a nameless number: that number.
    rows: Vec<&'t str>,
    /// Names with a word in place of a number, as often as they occur.
    worded: Vec<&'t str>,
}

impl PairedText<'_> {
    /// Whether more numbers have a name and a mark than lines have none.
    fn is_log(&self) -> bool {
        let marked = self.pairs.iter().filter(|pair| pair.is_marked).count();
        marked >= 2 && marked > self.rows.len()
    }
}

/// Whether a text has marks between names and numbers, and no rows of LaTeX, whose names may be `k=1`.
fn may_be_log(text: &str) -> bool {
    const ROWS: usize = 3;
    text.contains([':', '=']) && text.matches(" & ").nth(ROWS).is_none()
}

/// The names and numbers of a log; `None` for a text of rows.
pub(super) fn log(text: &str) -> Option<Vec<Pair<'_>>> {
    let found = may_be_log(text).then(|| find_pairs(text))?;
    found.is_log().then_some(found.pairs)
}

/// How the numbers of a line or of a list are named.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Naming {
    /// A row of numbers.
    Nameless,
    /// A name and a mark before each number.
    Each,
    /// One name and several numbers.
    List,
}

/// The first number of a row, or the one behind a name.
pub(super) struct NamedPlace<'t> {
    /// The byte of the number.
    pub(super) offset: usize,
    /// Its name; empty without.
    pub(super) name: &'t str,
    pub(super) naming: Naming,
}

/// Rows and named numbers in the order of the text.
pub(super) fn namings(text: &str) -> Vec<NamedPlace<'_>> {
    if !text.contains([':', '=']) {
        return vec![];
    }
    let PairedText { pairs, rows, .. } = find_pairs(text);
    let offset = |cell: &str| cell.as_ptr() as usize - text.as_ptr() as usize;
    let nameless = rows.into_iter().map(|cell| NamedPlace {
        offset: offset(cell),
        name: "",
        naming: Naming::Nameless,
    });
    let named = pairs.iter().filter(|pair| pair.is_marked);
    let named = named.map(|pair| NamedPlace {
        offset: offset(pair.values[0]),
        name: pair.name,
        naming: if pair.values.len() > 1 {
            Naming::List
        } else {
            Naming::Each
        },
    });
    let mut places: Vec<NamedPlace<'_>> = nameless.chain(named).collect();
    places.sort_by_key(|place| place.offset);
    places
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

/// The name whose every occurrence begins a row.
pub(super) fn key_of_records<'t>(pairs: &[Pair<'t>]) -> Option<&'t str> {
    let repetitions = count_keys(pairs);
    let levels = count_levels(&repetitions);
    let first = repetitions
        .iter()
        .find(|repetition| repetition.count == levels);
    first.map(|repetition| repetition.key.name)
}

/// Finds the pairs of a text.
fn find_pairs(text: &str) -> PairedText<'_> {
    let mut pairs: Vec<Pair<'_>> = vec![];
    let mut known: HashSet<&str> = HashSet::new();
    let mut rows = vec![];
    let mut worded = vec![];
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
            continue;
        };
        let marks = &before[before.trim_end_matches(is_mark).len()..];
        depth = (depth + marks.matches('[').count()).saturating_sub(before.matches(']').count());
        let name = name_before(before);
        // The first number of a line may have its name on the line above: `"h": [`.
        let is_first = label == 0 || before.contains('\n');
        let is_near = !marks.contains('\n') || marks.contains([':', '=', '[']);
        let has_name =
            name.contains(char::is_alphabetic) && is_near && !marks.contains(['(', ',', ';', '{']);
        is_row = !has_name && (is_first || is_row);
        if has_name {
            pairs.push(Pair {
                name,
                values: vec![word],
                is_marked: ends_with_mark(before),
            });
            known.insert(name);
        } else if let Some(last) = pairs.last_mut()
            && (depth > 0 || !is_row)
        {
            last.values.push(word);
        } else if is_first {
            rows.push(word);
        }
        label = position;
    }
    PairedText {
        pairs,
        rows,
        worded,
    }
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
            for (row, value) in grid.rows.iter_mut().zip(pair.values) {
                row.push(value);
            }
        } else {
            grid.left_out.push(LeftOut {
                name: pair.name.to_owned(),
                reason: format!(
                    "{} instead of {longest}",
                    counted(pair.values.len(), "number")
                ),
                is_checked: false,
                is_single: pair.values.len() == 1 && longest > 2,
            });
        }
    }
    grid
}

/// Whether a name with several numbers occurs again: then each list is the errors of one level.
fn repeats_a_list(pairs: &[Pair<'_>]) -> bool {
    let mut lists = HashSet::new();
    let mut several = pairs.iter().filter(|pair| pair.values.len() > 1);
    several.any(|pair| !lists.insert(pair.name))
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
fn words(worded: &[&str], levels: usize) -> Vec<LeftOut> {
    let mut counts: HashMap<&str, usize> = HashMap::new();
    let mut left_out = vec![];
    for name in worded {
        let count = counts.entry(name).or_default();
        *count += 1;
        if levels > 1 && *count == levels {
            left_out.push(LeftOut {
                name: (*name).to_owned(),
                reason: "words".to_owned(),
                is_checked: names::is_group(name),
                is_single: true,
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
    let mut names = vec![];
    let mut columns: HashMap<Key<'_>, usize> = HashMap::new();
    let mut left_out = vec![];
    let mut first = None;
    for Repetition { key, count } in repetitions {
        if count > levels || 2 * count < levels {
            left_out.push(LeftOut {
                name: key.name.to_owned(),
                reason: format!("printed {count} times for {levels} levels"),
                is_checked: false,
                is_single: false,
            });
            continue;
        }
        if count == levels && first.is_none() {
            first = Some(key.name);
        }
        columns.insert(key, names.len());
        names.push(key.name);
    }
    let mut rows: Vec<Vec<&str>> = vec![];
    for pair in pairs {
        if Some(pair.name) == first {
            rows.push(vec![&pair.name[..0]; names.len()]);
        }
        let Some(row) = rows.last_mut() else { continue };
        for (key, value) in pair.keys().zip(&pair.values) {
            if let Some(column) = columns.get(&key) {
                row[*column] = value;
            }
        }
    }
    RawTable {
        names,
        rows,
        left_out,
        ..RawTable::default()
    }
}
