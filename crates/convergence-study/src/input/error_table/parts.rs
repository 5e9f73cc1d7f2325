//! The tables of a text. Two tables that are read as one could pass where one of them fails, so a
//! text is cut rather too often: a part with too few levels is inconclusive.
//!
//! What stands between rows has a shape: its text with `#` in place of numbers. A shape between
//! every two rows parts nothing, such as rulers, or `Cycle 3`; one between some rows cuts the text,
//! be it a blank line, a heading, a comment or names that come again. The same holds for a log of
//! names and numbers, whose rows are the numbers from one step to the next.

use std::collections::{HashMap, HashSet};

use super::names::{self, Word};
use super::number::number;
use super::pairs::{self, NamedPlace, Naming, Pair, RawTable};
use super::text::{self, begins_with_number, is_closing, is_rule};

/// A table of a text.
pub(super) struct Part<'t> {
    /// The first of several lines above its rows, or its number.
    pub(super) heading: String,
    /// The words of the heading in the text.
    pub(super) words: Option<&'t str>,
    pub(super) table: RawTable<'t>,
}

/// How often a text is cut anew: a log may stand beside a table with headings.
const DEPTH: usize = 3;

/// The tables of a text that has been made [plain](super::cleaned::plain).
pub(super) fn read(text: &str) -> Vec<Part<'_>> {
    let mut sections = vec![];
    cut(text, DEPTH, &mut sections);
    let mut parts: Vec<Part<'_>> = vec![];
    for Section { text, table } in sections {
        let earlier = parts.last().map_or(&[][..], |part| &part.table.names);
        let table = match table {
            Some(table) if earlier.is_empty() => table,
            _ => text::read(text, earlier),
        };
        let words = heading(text, &table);
        let number = parts.len() + 1;
        parts.push(Part {
            heading: words.map_or_else(|| format!("table {number}"), str::to_owned),
            words,
            table,
        });
    }
    parts
}

/// The text of a table.
struct Section<'t> {
    text: &'t str,
    /// The table, if it was read to find out that nothing is to be cut.
    table: Option<RawTable<'t>>,
}

/// Cuts a text into those of its tables.
fn cut<'t>(text: &'t str, depth: usize, sections: &mut Vec<Section<'t>>) {
    let Cuts { at, table } = cuts(text);
    if depth == 0 || at.is_empty() {
        sections.push(Section { text, table });
        return;
    }
    let starts = [0].into_iter().chain(at.iter().copied());
    let ends = at.iter().copied().chain([text.len()]);
    for (start, end) in starts.zip(ends) {
        cut(&text[start..end], depth - 1, sections);
    }
}

/// Where a text is cut.
struct Cuts<'t> {
    /// Bytes.
    at: Vec<usize>,
    /// The table of the whole text, if it was read.
    table: Option<RawTable<'t>>,
}

fn cuts(text: &str) -> Cuts<'_> {
    let mixed = mixed_cuts(text);
    if !mixed.is_empty() {
        return Cuts {
            at: mixed,
            table: None,
        };
    }
    if let Some(pairs) = pairs::log(text) {
        return Cuts {
            at: log_cuts(text, &pairs),
            table: None,
        };
    }
    let table = text::read(text, &[]);
    Cuts {
        at: gap_cuts(&row_gaps(text, &table)),
        table: Some(table),
    }
}

/// Something between two rows.
struct Piece {
    /// Its byte in the text.
    offset: usize,
    shape: String,
    /// The words behind a name and a mark, as in `scheme: upwind`; empty without.
    value: String,
    /// Whether it is a name with a number behind it.
    is_named: bool,
}

impl Piece {
    /// A line, or a piece of one between two numbers with names.
    fn of_words(offset: usize, words: &str) -> Self {
        let (name, value) = words.split_once([':', '=']).unwrap_or((words, ""));
        let value = shape(value);
        let is_pair = !value.is_empty() && value != "#" && !name.trim().is_empty();
        Self {
            offset,
            shape: if is_pair {
                shape(name) + "="
            } else {
                shape(words)
            },
            value: if is_pair { value } else { String::new() },
            is_named: false,
        }
    }
}

/// A text with `#` in place of its numbers.
fn shape(text: &str) -> String {
    let mut shape = String::new();
    for word in text.split_whitespace() {
        if !shape.is_empty() {
            shape.push(' ');
        }
        if number(word.trim_matches(pairs::is_mark), false).is_some() {
            shape.push('#');
            continue;
        }
        for c in word.chars() {
            let is_digit = c.is_ascii_digit();
            if !is_digit {
                shape.push(c);
            } else if !shape.ends_with('#') {
                shape.push('#');
            }
        }
    }
    shape
}

/// What stands in the gaps with one shape.
#[derive(Default)]
struct Occurrences<'p> {
    /// In how many gaps.
    gaps: usize,
    /// Whether the first gap is one of them.
    is_in_first: bool,
    /// The values of each gap, each list once.
    values: HashSet<&'p [&'p str]>,
}

impl Occurrences<'_> {
    /// Whether it stands in all gaps; a name with a number may be missing in the first one, as rates
    /// are.
    fn is_common(&self, piece: &Piece, gaps: usize) -> bool {
        let is_late = piece.is_named && !self.is_in_first && self.gaps + 1 == gaps;
        let is_rate = Word::of(&piece.shape) == Word::Rate;
        self.gaps == gaps || is_late && (gaps > 2 || is_rate)
    }

    /// Whether it stands in all gaps, with words of which some come again.
    fn is_group(&self, gaps: usize) -> bool {
        let mut values = self.values.iter().copied().flatten();
        let is_state = values.all(|value| names::state(value).is_some());
        self.gaps == gaps && (2..gaps).contains(&self.values.len()) && !is_state
    }
}

/// Where gaps have a piece that others lack, or a name with other words behind it than in the gap
/// before: the first such piece of each gap.
fn gap_cuts(gaps: &[Vec<Piece>]) -> Vec<usize> {
    let values: Vec<HashMap<&str, Vec<&str>>> = gaps.iter().map(|gap| values(gap)).collect();
    let mut occurrences: HashMap<&str, Occurrences<'_>> = HashMap::new();
    for (k, values) in values.iter().enumerate() {
        for (shape, values) in values {
            let shape = occurrences.entry(shape).or_default();
            shape.gaps += 1;
            shape.is_in_first |= k == 0;
            shape.values.insert(values);
        }
    }
    let mut before: HashMap<&str, &[&str]> = HashMap::new();
    let mut cuts = vec![];
    for (gap, values) in gaps.iter().zip(&values) {
        let cut = gap.iter().find(|piece| {
            let shape = piece.shape.as_str();
            let changes = before
                .get(shape)
                .is_some_and(|before| *before != values[shape]);
            let shape = &occurrences[shape];
            !shape.is_common(piece, gaps.len()) || changes && shape.is_group(gaps.len())
        });
        cuts.extend(cut.map(|piece| piece.offset));
        before.extend(values.iter().map(|(shape, values)| (*shape, &values[..])));
    }
    cuts
}

/// The values of each shape in a gap, which may have several lines of one, as a log has levels.
fn values(gap: &[Piece]) -> HashMap<&str, Vec<&str>> {
    let mut values: HashMap<&str, Vec<&str>> = HashMap::new();
    for piece in gap {
        let values = values.entry(&piece.shape).or_default();
        if !piece.value.is_empty() {
            values.push(&piece.value);
        }
    }
    values
}

/// What stands between the lines of rows.
fn row_gaps(text: &str, table: &RawTable<'_>) -> Vec<Vec<Piece>> {
    let mut starts: Vec<usize> = vec![];
    for row in &table.rows {
        starts.extend(row.iter().map(|cell| offset(text, cell)));
    }
    let first = starts.iter().copied().min().unwrap_or(text.len());
    starts.sort_unstable();
    let mut starts = starts.into_iter().peekable();
    let mut gaps = vec![];
    let mut gap = vec![];
    let mut has_rows = false;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let end = start + line.len();
        let mut is_row = start > first && begins_with_number(&line) && !is_closing(line);
        while starts.next_if(|cell| *cell < end).is_some() {
            is_row = true;
        }
        if is_row {
            if has_rows {
                gaps.push(std::mem::take(&mut gap));
            }
            gap.clear();
            has_rows = true;
        } else if is_rule(line) {
            gap.push(Piece::of_words(
                start,
                if line.trim().is_empty() { "" } else { "-" },
            ));
        } else {
            gap.push(Piece::of_words(start, line));
        }
        // The rest of a gap belongs to the next table.
        start = end;
    }
    for gap in &mut gaps {
        let begin = gap.first().map(|piece| piece.offset);
        gap.iter_mut()
            .for_each(|piece| piece.offset = begin.unwrap_or(piece.offset));
    }
    gaps
}

/// The byte at which a piece begins in its text.
fn offset(text: &str, piece: &str) -> usize {
    (piece.as_ptr() as usize).saturating_sub(text.as_ptr() as usize)
}

/// Where a log of names and numbers is cut: lists with their names come again, names end before
/// others begin, or something stands between some of its rows.
fn log_cuts(text: &str, pairs: &[Pair<'_>]) -> Vec<usize> {
    if let Some(first) = pairs::first_column(pairs) {
        let is_list = |pair: &Pair<'_>| pair.values.len() > 1;
        let lists: Vec<&Pair<'_>> = pairs.iter().filter(|pair| is_list(pair)).collect();
        let again = lists.windows(2).filter(|two| two[1].name == first);
        return again.map(|two| end_of_numbers(text, two[0])).collect();
    }
    let ends = successive_names(pairs);
    if !ends.is_empty() {
        return ends
            .into_iter()
            .map(|k| after_number(text, pairs, k))
            .collect();
    }
    gap_cuts(&log_gaps(text, pairs))
}

/// The end of the numbers behind a name, of the brackets that close there, or of their line.
fn end_of_numbers(text: &str, pair: &Pair<'_>) -> usize {
    let last = pair.values.last().copied().unwrap_or(pair.name);
    let end = offset(text, last) + last.len();
    let behind = &text[end..];
    let marks = behind.find(|c| !pairs::is_mark(c) || "[{(".contains(c));
    let marks = &behind[..marks.unwrap_or(behind.len())];
    let line = marks.rfind('\n').or_else(|| marks.rfind([']', '}', ')']));
    end + line.map_or(0, |last| last + 1)
}

/// The end of the number before the k-th name, or of its line.
fn after_number(text: &str, pairs: &[Pair<'_>], k: usize) -> usize {
    match k.checked_sub(1) {
        Some(before) => end_of_numbers(text, &pairs[before]),
        None => offset(text, pairs[k].name),
    }
}

/// The pairs with which rows begin whose names come after others that occur several times have
/// ended.
fn successive_names(pairs: &[Pair<'_>]) -> Vec<usize> {
    struct Range {
        first: usize,
        last: usize,
        count: usize,
    }
    let mut ranges: HashMap<&str, Range> = HashMap::new();
    for (k, pair) in pairs.iter().enumerate() {
        let range = ranges.entry(pair.name).or_insert(Range {
            first: k,
            last: k,
            count: 0,
        });
        range.last = k;
        range.count += 1;
    }
    let mut ranges: Vec<Range> = ranges
        .into_values()
        .filter(|range| range.count > 1)
        .collect();
    ranges.sort_by_key(|range| range.first);
    // A row begins with the name that begins the first one.
    let Some(begins) = ranges.first().map(|range| pairs[range.first].name) else {
        return vec![];
    };
    let mut cuts = vec![];
    let mut end = usize::MAX;
    for Range { first, last, .. } in ranges {
        if first > end {
            let mut between = (end + 1)..first;
            cuts.push(between.find(|k| pairs[*k].name == begins).unwrap_or(first));
            end = last;
        }
        end = end.min(last);
    }
    cuts
}

/// What stands in a log between one step and the next: other names, and words.
fn log_gaps(text: &str, pairs: &[Pair<'_>]) -> Vec<Vec<Piece>> {
    let mut gaps = vec![];
    let Some(key) = pairs::key_of_records(pairs) else {
        return gaps;
    };
    let mut gap = vec![];
    let mut has_rows = false;
    let mut end = 0;
    for pair in pairs {
        let start = offset(text, pair.name);
        let between = text.get(end..start).unwrap_or_default();
        gap.extend(pieces(end, between));
        if pair.name == key {
            if has_rows {
                gaps.push(std::mem::take(&mut gap));
            }
            gap.clear();
            has_rows = true;
        } else {
            gap.push(Piece {
                offset: start,
                shape: pair.name.to_owned(),
                value: String::new(),
                is_named: true,
            });
        }
        let last = pair.values.last().copied().unwrap_or(pair.name);
        end = offset(text, last) + last.len();
    }
    gaps
}

/// The words and blank lines between two numbers of a log.
fn pieces(start: usize, between: &str) -> Vec<Piece> {
    let mut pieces = vec![];
    let mut offset = start;
    // A list ends, and another one begins.
    if let Some(end) = between.find(']')
        && between[end..].contains('[')
    {
        pieces.push(Piece::of_words(start + end, "]["));
    }
    let lines: Vec<&str> = between.split('\n').collect();
    for (k, line) in lines.iter().enumerate() {
        let words = line.trim_matches(|c| pairs::is_mark(c) || "-=_*#|".contains(c));
        let is_whole_line = 0 < k && k + 1 < lines.len();
        // A line of nothing but separators is a blank one; brackets open and close records.
        let is_empty = |c: char| c.is_whitespace() || ",;\"'".contains(c);
        let is_blank_line = is_whole_line && line.chars().all(is_empty);
        let is_drawn = is_rule(line) && !line.trim().is_empty();
        let is_ruler = words.is_empty() && (is_drawn || line.contains(|c| !pairs::is_mark(c)));
        if is_blank_line || is_ruler || !words.is_empty() {
            pieces.push(Piece::of_words(offset, if is_ruler { "-" } else { words }));
        }
        offset += line.len() + 1;
    }
    pieces
}

/// Where a log, rows of numbers without names and lists stand beside each other, each with several
/// numbers.
fn mixed_cuts(text: &str) -> Vec<usize> {
    let places = pairs::namings(text);
    let mut runs: Vec<&[NamedPlace<'_>]> = places.chunk_by(|a, b| a.naming == b.naming).collect();
    runs.retain(|run| {
        let mut names = HashSet::new();
        let repeats = run.iter().any(|place| !names.insert(place.name));
        run.len() > 1 && (run[0].naming != Naming::Each || repeats)
    });
    let changes = runs
        .windows(2)
        .filter(|two| two[0][0].naming != two[1][0].naming);
    changes
        .map(|two| {
            let last = two[0][two[0].len() - 1].offset;
            let line = text[last..].find('\n');
            line.map_or(text.len(), |end| last + end + 1)
        })
        .collect()
}

/// The text above the first number of a table.
fn above<'t>(section: &'t str, table: &RawTable<'_>) -> &'t str {
    let cells = table.rows.iter().flatten().filter(|cell| !cell.is_empty());
    let first = cells.map(|cell| offset(section, cell)).min().unwrap_or(0);
    &section[..first.min(section.len())]
}

/// The first line of words above the rows, if there is another, which has the names, or if names
/// stand beside the numbers.
fn heading<'t>(section: &'t str, table: &RawTable<'_>) -> Option<&'t str> {
    let above = above(section, table);
    let end = above.rfind('\n').map_or(0, |end| end + 1);
    let is_name = |line: &str| {
        let names = table.names.iter().filter(|name| !name.is_empty());
        let start = offset(section, line);
        names
            .map(|name| offset(section, name))
            .any(|name| (start..start + line.len()).contains(&name))
    };
    let mut lines = above[..end].lines().filter(|line| {
        line.contains(char::is_alphabetic)
            && !line.trim().starts_with('\\')
            && !is_closing(line)
            && !is_name(line)
    });
    let words = lines.next()?;
    let words = words.trim_matches(|c: char| c.is_whitespace() || "#%!*=-:|&{}[]\"',;".contains(c));
    Some(words).filter(|words| !words.is_empty())
}
