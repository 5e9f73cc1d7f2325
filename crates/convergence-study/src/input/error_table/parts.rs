//! The tables of a text. Two tables that are read as one could pass where one of them fails, so a
//! text is cut rather too often: a part with too few levels is inconclusive.
//!
//! What stands between rows has a shape: its text with `#` in place of numbers. A shape between
//! every two rows parts nothing, such as rulers, or `Cycle 3`; one between some rows cuts the text,
//! be it a blank line, a heading, a comment or names that come again. The same holds for a log of
//! names and numbers, whose rows are the numbers from one step to the next.

use std::collections::{HashMap, HashSet};

use super::grid::{RawTable, Turned};
use super::line::{begins_with_number, is_closing, is_rule, looks_like_row};
use super::names::{self, Word};
use super::number::number;
use super::original::offset;
use super::pairs::{self, Pair, Scan};
use super::text;

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
            _ => text::read(text, &Scan::of(text), earlier),
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
    let scan = Scan::of(text);
    let mut at = vec![];
    if scan.is_log {
        at = log_cuts(text, &scan);
        if at.is_empty() {
            at = row_cuts(text);
        }
    }
    if !at.is_empty() {
        return Cuts { at, table: None };
    }
    let table = text::read(text, &scan, &[]);
    if !(scan.is_log && scan.has_columns()) {
        at = gap_cuts(&gaps(text, &table, scan.is_log));
    }
    Cuts {
        at,
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

/// Where a text is cut: at the first piece of a gap that others lack, or that is a name with other
/// words behind it than in the gap before, and above a row whose numbers have other names than those
/// before it.
fn gap_cuts(gaps: &[Gap]) -> Vec<usize> {
    let values: Vec<HashMap<&str, Vec<&str>>> = gaps.iter().map(Gap::values).collect();
    let mut occurrences: HashMap<&str, Occurrences<'_>> = HashMap::new();
    for (k, values) in values.iter().enumerate() {
        for (shape, values) in values {
            let shape = occurrences.entry(shape).or_default();
            shape.gaps += 1;
            shape.is_in_first |= k == 0;
            shape.values.insert(values);
        }
    }
    let is_common = |piece: &&Piece| occurrences[&*piece.shape].is_common(piece, gaps.len());
    let mut before: HashMap<&str, &[&str]> = HashMap::new();
    let mut above: Option<Row<'_>> = None;
    let mut cuts = vec![];
    for (gap, values) in gaps.iter().zip(&values) {
        let (named, words): (Vec<&Piece>, Vec<&Piece>) =
            gap.pieces.iter().partition(|piece| piece.is_named);
        let own = named.into_iter().filter(|piece| !is_common(piece));
        let row = Row {
            names: own.map(|piece| piece.shape.as_str()).collect(),
            end: gap.end,
        };
        if let Some(Row { names, end }) = above.replace(row)
            && above.as_ref().is_some_and(|row| row.names != names)
            && cuts.last().is_none_or(|last| *last < end)
        {
            cuts.push(end);
        }
        let cut = words.into_iter().find(|piece| {
            let shape = piece.shape.as_str();
            let changes = before
                .get(shape)
                .is_some_and(|before| *before != values[shape]);
            !is_common(piece) || changes && occurrences[shape].is_group(gaps.len())
        });
        cuts.extend(cut.map(|piece| piece.offset));
        before.extend(values.iter().map(|(shape, values)| (*shape, &values[..])));
    }
    cuts
}

/// A row of a log.
struct Row<'g> {
    /// The names in it that are not in all rows.
    names: Vec<&'g str>,
    /// The byte behind its last number.
    end: usize,
}

/// What stands between the first number of a row and that of the next one.
struct Gap {
    pieces: Vec<Piece>,
    /// The byte behind the last number of the row.
    end: usize,
}

impl Gap {
    /// The values of each shape, of which there may be several lines, as a log has levels.
    fn values(&self) -> HashMap<&str, Vec<&str>> {
        let mut values: HashMap<&str, Vec<&str>> = HashMap::new();
        for piece in &self.pieces {
            let values = values.entry(&piece.shape).or_default();
            if !piece.value.is_empty() {
                values.push(&piece.value);
            }
        }
        values
    }
}

/// A cell of a table in its text.
struct Place<'t> {
    start: usize,
    end: usize,
    row: usize,
    /// The name in front of it; empty in a table of rows.
    name: &'t str,
}

/// What stands between the rows of a table, in a log with the names of its numbers.
fn gaps(text: &str, table: &RawTable<'_>, is_log: bool) -> Vec<Gap> {
    let mut places: Vec<Place<'_>> = vec![];
    // Between steps in the head and the first row stands a ruler at most.
    let head = usize::from(table.turned == Some(Turned::Stepped));
    for (row, cells) in table.rows.iter().enumerate() {
        let cells = cells.iter().enumerate().skip(head);
        places.extend(cells.filter(|(_, cell)| !cell.is_empty()).map(|(k, cell)| {
            let start = offset(text, cell);
            Place {
                start,
                end: start + cell.len(),
                row,
                name: if is_log { table.names[k] } else { "" },
            }
        }));
    }
    places.sort_by_key(|place| place.start);
    let mut gaps = vec![];
    let mut gap = vec![];
    for two in places.windows(2) {
        let between = text.get(two[0].end..two[1].start).unwrap_or_default();
        // Between the numbers of a list there is no name.
        let words = between.trim_end_matches(pairs::is_mark);
        let words = words.strip_suffix(two[1].name).filter(|_| is_log);
        match words {
            Some(words) => gap.extend(pieces(two[0].end, words, true)),
            None => gap.extend(pieces(two[0].end, between, is_log)),
        }
        let begins_row = if is_log {
            two[0].row != two[1].row
        } else {
            between.contains('\n')
        };
        if begins_row {
            gaps.push(Gap {
                pieces: std::mem::take(&mut gap),
                end: two[0].end,
            });
        } else if let Some(words) = words {
            gap.push(Piece {
                offset: two[0].end + words.len(),
                shape: two[1].name.to_owned(),
                value: String::new(),
                is_named: true,
            });
        }
    }
    gaps
}

/// The words, rulers and blank lines between two numbers; of a table of rows only whole lines. They
/// belong to the next table from the first whole line on.
fn pieces(start: usize, between: &str, is_log: bool) -> Vec<Piece> {
    let mut pieces = vec![];
    // A list ends, and another one begins.
    if is_log
        && let Some(end) = between.find(']')
        && between[end..].contains('[')
    {
        pieces.push(Piece::of_words(start + end, "]["));
    }
    let lines: Vec<&str> = between.split('\n').collect();
    for (k, line) in lines.iter().enumerate() {
        let is_whole = 0 < k && k + 1 < lines.len();
        if !is_whole && !is_log {
            continue;
        }
        let words = line.trim_matches(|c| pairs::is_mark(c) || "-=_*#|".contains(c));
        // A line of nothing but separators is a blank one; brackets open and close records.
        let is_empty = |c: char| c.is_whitespace() || ",;\"'".contains(c);
        let is_blank = is_whole && line.chars().all(is_empty);
        let is_drawn = is_rule(line) || line.contains(|c| !pairs::is_mark(c));
        let is_ruler = words.is_empty() && is_drawn;
        if is_blank || is_ruler || !words.is_empty() {
            let begin = if k == 0 { 0 } else { lines[0].len() + 1 };
            pieces.push(Piece::of_words(
                start + begin,
                if is_ruler { "-" } else { words },
            ));
        }
    }
    pieces
}

/// Where a log is cut: lists with their names come again.
fn log_cuts(text: &str, scan: &Scan<'_>) -> Vec<usize> {
    let Some(first) = pairs::first_column(&scan.pairs) else {
        return vec![];
    };
    let is_list = |pair: &&Pair<'_>| pair.values.len() > 1;
    let lists: Vec<&Pair<'_>> = scan.pairs.iter().filter(is_list).collect();
    let again = lists.windows(2).filter(|two| two[1].name == first);
    again.map(|two| end_of_numbers(text, two[0])).collect()
}

/// Where rows of numbers begin and end in a log, with the line above them, which has their names.
fn row_cuts(text: &str) -> Vec<usize> {
    let is_row = |line: &str| {
        let is_list = line.contains(['[', ']', '{', '}', '"']) || line.ends_with(',');
        let has_cells = line.split_whitespace().count() > 1;
        !is_list && has_cells && begins_with_number(&line) && looks_like_row(line)
    };
    let lines: Vec<&str> = text
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    let runs = lines.chunk_by(|a, b| is_row(a) == is_row(b));
    let mut cuts = vec![];
    let mut above: Option<&str> = None;
    for run in runs {
        if run.len() > 1 && is_row(run[0]) {
            let begin = above
                .filter(|line| !line.contains([':', '=']))
                .unwrap_or(run[0]);
            cuts.push(offset(text, begin));
            let last = run[run.len() - 1];
            cuts.push(offset(text, last) + last.len());
        }
        above = run.last().copied();
    }
    cuts.retain(|cut| (1..text.trim_end().len()).contains(cut));
    cuts.dedup();
    cuts
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

/// The text above the first number of a table.
fn above<'t>(section: &'t str, table: &RawTable<'_>) -> &'t str {
    let cells = table.rows.iter().flatten().filter(|cell| !cell.is_empty());
    let first = cells.map(|cell| offset(section, cell)).min().unwrap_or(0);
    &section[..first.min(section.len())]
}

/// Whether a line has no more numbers than a heading may have.
fn has_few_numbers(line: &str) -> bool {
    const FEW: usize = 2;
    let words = line.split_whitespace();
    let words = words.map(|word| word.trim_matches(pairs::is_mark));
    words.filter(|word| number(word, false).is_some()).count() <= FEW
}

/// Whether a line has several numbers of one name: a list, or records beside each other.
fn has_levels(line: &str) -> bool {
    let mut names = HashSet::new();
    let mut pairs = Scan::of(line).pairs.into_iter();
    pairs.any(|pair| pair.values.len() > 1 || !names.insert(pair.name))
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
            && (has_few_numbers(line) || !(looks_like_row(line) || has_levels(line)))
    });
    let words = lines.next()?;
    let words = words.trim_matches(|c: char| c.is_whitespace() || "#%!*=-:|&{}[]\"',;".contains(c));
    Some(words).filter(|words| !words.is_empty())
}
