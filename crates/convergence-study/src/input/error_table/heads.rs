//! The names of columns: a line above the rows, or names in two lines.

use super::line::{span, split};
use super::names::Word;
use super::number::{counts_rows, is_dash, number};
use super::original::blank_at;

/// Types of columns and units, as data frames write them below the names.
const TYPES: [&str; 8] = [
    "double", "f64", "i64", "float64", "int64", "float", "int", "str",
];

/// The names of columns.
#[derive(Debug, Clone, Default)]
pub(super) struct Names<'t> {
    /// One for each column, or an empty one.
    pub(super) names: Vec<&'t str>,
    /// The names in the line above them, for each column that of its group; may be empty.
    pub(super) groups: Vec<&'t str>,
}

/// The names for columns of this width in the lines above them.
pub(super) fn find<'t>(
    heads: &[&'t str],
    rows: &[Vec<&str>],
    spans: &[[usize; 2]],
    separator: Option<char>,
) -> Option<Names<'t>> {
    let width = rows.iter().map(Vec::len).max().unwrap_or(0);
    if let Some(NamesInLine { names, line }) = names(heads, rows, separator, width) {
        return Some(with_groups(names, &heads[..line], separator));
    }
    let names = heads
        .iter()
        .rev()
        .find_map(|line| by_place(line, rows, spans))?;
    Some(Names {
        names,
        groups: vec![],
    })
}

/// The names of groups of columns, above names that come again in each group: those of variables
/// above `error EOC`. The first column may have its name in the line of the groups.
fn with_groups<'t>(
    mut names: Vec<&'t str>,
    heads: &[&'t str],
    separator: Option<char>,
) -> Names<'t> {
    let lead = usize::from(names.first().is_some_and(|name| name.is_empty()));
    for cells in heads
        .last()
        .map_or(vec![], |line| splits(line, separator).to_vec())
    {
        let has_lead = lead == 1 && cells.len() == names.len();
        let (first, groups) = cells.split_at(usize::from(has_lead));
        let groups: Vec<&str> = groups
            .iter()
            .copied()
            .filter(|cell| !cell.is_empty())
            .collect();
        let width = names.len() - lead;
        let count = groups.len();
        if count < 2
            || !width.is_multiple_of(count)
            || width == count
            || groups.iter().any(is_no_name)
        {
            continue;
        }
        let size = width / count;
        let mut pairs = names[lead..].iter().zip(&names[lead + size..]);
        if pairs.all(|(a, b)| a == b) {
            let all = (0..names.len()).map(|k| match k.checked_sub(lead) {
                Some(k) => groups[k / size],
                None => "",
            });
            let groups = all.collect();
            if let Some(first) = first.first() {
                names[0] = first;
            }
            return Names { names, groups };
        }
    }
    Names {
        names,
        groups: vec![],
    }
}

/// Names that stand above their columns and have several words, parted by several blanks: the only
/// column below one that is no column of rates, or one for each word.
fn by_place<'t>(line: &'t str, rows: &[Vec<&str>], spans: &[[usize; 2]]) -> Option<Vec<&'t str>> {
    let is_rate = columns_of_rates(rows, spans.len());
    let segments = line
        .split("  ")
        .map(str::trim)
        .filter(|segment| !segment.is_empty());
    let mut names = vec![blank_at(line); spans.len()];
    let mut next = 0;
    for segment in segments {
        let [start, end] = span(line, segment);
        let below = (next..spans.len())
            .filter(|k| !is_rate[*k] && spans[*k][0] < end && start < spans[*k][1]);
        let below: Vec<usize> = below.collect();
        let words: Vec<&str> = segment.split_whitespace().collect();
        match below.len() {
            0 => return None,
            1 => names[below[0]] = segment,
            count if count == words.len() => {
                for (k, word) in below.iter().zip(words) {
                    names[*k] = word;
                }
            }
            _ => return None,
        }
        next = below[below.len() - 1] + 1;
    }
    let has_all = (0..spans.len()).all(|k| is_rate[k] || !names[k].is_empty());
    (has_all && !names.iter().any(is_no_name)).then_some(names)
}

/// The columns that begin or end with a dash, as rates do, or stand in parentheses behind others.
fn columns_of_rates(rows: &[Vec<&str>], width: usize) -> Vec<bool> {
    let ends = [rows.first(), rows.last()];
    let is_rate = |k: usize| {
        let cells = || ends.iter().flatten().filter_map(|row| row.get(k));
        cells().any(|cell| !cell.is_empty() && is_dash(cell))
            || k > 0 && cells().count() > 1 && cells().all(|cell| cell.starts_with('('))
    };
    (0..width).map(is_rate).collect()
}

/// How many cells are not blank: one alone is a heading over all columns.
fn filled(cells: &[&str]) -> usize {
    cells.iter().filter(|cell| !cell.is_empty()).count()
}

/// The names of an earlier table of this width, if no line has a word for each column.
pub(super) fn shared<'t>(
    earlier: &[&'t str],
    heads: &[&str],
    separator: Option<char>,
    width: usize,
) -> Option<Vec<&'t str>> {
    let are_few = heads
        .iter()
        .all(|head| filled(&split(head, separator)) < width.max(2));
    (earlier.len() == width && are_few).then(|| earlier.to_vec())
}

/// Whether a cell holds the type of a column, as data frames write it below the name, or a unit.
fn is_type(cell: &&str) -> bool {
    TYPES.contains(&&*cell.to_lowercase()) || is_dash(cell) || cell.starts_with(['[', '<'])
}

/// Whether a cell cannot be a name.
fn is_no_name(cell: &&str) -> bool {
    let is_finite = number(cell, false).is_some_and(|number| number.value.is_finite());
    is_finite
        || cell.ends_with(',')
        || cell.contains("  ")
        || !(matches!(*cell, "" | "#")
            || cell.contains(|c: char| c.is_alphabetic() || c.is_control()))
}

/// A line cut at its separator, at commas, at semicolons, and where there are several blanks.
fn splits(line: &str, separator: Option<char>) -> [Vec<&str>; 4] {
    let wide = line
        .split("  ")
        .map(|cell| cell.trim_matches([' ', '|', '\t']))
        .filter(|cell| !cell.is_empty());
    [
        split(line, separator),
        split(line, Some(',')),
        split(line, Some(';')),
        wide.collect(),
    ]
}

/// Names, and the number of their line.
struct NamesInLine<'t> {
    names: Vec<&'t str>,
    line: usize,
}

/// The nearest line above the rows with a name for each column. Columns of rates, which begin or
/// end with a dash, and the first column may have none.
fn names<'t>(
    heads: &[&'t str],
    rows: &[Vec<&str>],
    separator: Option<char>,
    width: usize,
) -> Option<NamesInLine<'t>> {
    let firsts: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    let is_even = rows.iter().all(|row| row.len() == width);
    let is_index = counts_rows(&firsts, false);
    let is_rate = columns_of_rates(rows, width);
    let masks = [(0, false), (0, true), (1, false), (1, true)].map(|(first, without_rates)| {
        (first..width)
            .filter(|k| !(without_rates && is_rate[*k]))
            .collect::<Vec<usize>>()
    });
    let mut first = None;
    for (k, line) in heads.iter().enumerate().rev() {
        let splits = splits(line, separator);
        // Between words of several names there are single blanks: no word is the name of a rate
        // then.
        let is_worded = separator.is_none() && (2..splits[0].len()).contains(&splits[3].len());
        let fits = |mask: &[usize], cells: &&Vec<&str>| {
            let is_sure = !is_worded
                || mask
                    .iter()
                    .zip(*cells)
                    .all(|(k, cell)| !is_rate[*k] || Word::of(cell) == Word::Rate);
            cells.len() == mask.len()
                && is_sure
                && (mask.len() < 3 || filled(cells) > 1)
                && !cells.iter().all(is_type)
                && !cells.iter().any(is_no_name)
        };
        // A data frame writes the name of its index below the others.
        let may_lack = separator.is_none() && is_even && (is_index || line.starts_with(' '));
        for mask in masks
            .iter()
            .filter(|mask| mask.len() == width || is_even && mask.first() == Some(&0) || may_lack)
        {
            if let Some(cells) = splits.iter().find(|cells| fits(mask, cells)) {
                let mut names = vec![blank_at(line); width];
                names[0] = first.unwrap_or(names[0]);
                for (column, cell) in mask.iter().zip(cells) {
                    names[*column] = cell;
                }
                // `28 (20)` below `iterations`.
                for k in 1..width {
                    let is_second = rows[0].get(k).is_some_and(|cell| cell.starts_with('('));
                    if is_second && names[k].is_empty() && Word::of(names[k - 1]) == Word::Cost {
                        names[k] = names[k - 1];
                    }
                }
                return Some(NamesInLine { names, line: k });
            }
        }
        first = match splits[0][..] {
            [name] => Some(name),
            _ => None,
        };
    }
    None
}
