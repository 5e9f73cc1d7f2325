//! Logs: names with their numbers, the levels alone on a line or as blocks of lines.

use std::collections::HashSet;

use super::super::grid::{COLUMNS, Grid};
use super::super::names::{key, says_rates};
use super::lines::Lines;
use super::{Pair, is_frame, pairs};

/// The numbers of a level.
struct Record<'t> {
    pairs: Vec<Pair<'t>>,
    lines: Vec<usize>,
    /// Other words between it and the record before, with `#` for each number.
    between: String,
}

impl<'t> Record<'t> {
    fn names(&self) -> impl Iterator<Item = &'t str> {
        self.pairs.iter().map(|pair| pair.name)
    }

    /// Drops what stands below a block that has all names of the one before; whether there is any.
    fn end_like(&mut self, before: &Self) -> bool {
        let count = before.pairs.len();
        let is_longer = self.pairs.len() > count && self.pairs.len() == self.lines.len();
        let ends = is_longer && self.names().take(count).eq(before.names());
        if ends {
            self.pairs.truncate(count);
            self.lines.truncate(count);
        }
        ends
    }

    /// Adds a blank where it lacks nothing but the last number of the next level, which is a rate.
    fn add_rate_of(&mut self, next: &Self) {
        let Some((rate, others)) = next.pairs.split_last() else {
            return;
        };
        let others = others.iter().map(|pair| pair.name);
        if says_rates(&key(rate.name)) && self.names().eq(others) {
            self.pairs.push(Pair {
                value: "-",
                ..*rate
            });
        }
    }

    /// Whether its last line stands just above the first of another.
    fn is_just_above(&self, other: &Self) -> bool {
        let last = self.lines.last();
        last.is_some_and(|last| last + 1 == other.lines[0])
    }

    /// Whether a line with one name goes on with the block that ends just above it.
    fn takes(&self, pairs: &[Pair<'_>], line: usize) -> bool {
        let is_block = self.pairs.len() == self.lines.len() && self.pairs.len() < COLUMNS;
        let is_next = self.lines.last().is_some_and(|last| last + 1 == line);
        is_block && is_next && pairs.len() == 1 && self.names().all(|name| name != pairs[0].name)
    }
}

/// Finds the records of unused lines that have the same names, and marks their lines as used.
pub(super) fn find(lines: &mut Lines<'_>) -> Vec<Grid> {
    let mut runs: Vec<Vec<Record<'_>>> = vec![];
    let mut is_cut = false;
    for mut record in records(lines) {
        if let Some([first]) = runs.last_mut().map(Vec::as_mut_slice) {
            first.add_rate_of(&record);
        }
        let last = runs.last().and_then(|run| run.last());
        let ends = last.is_some_and(|last| record.end_like(last));
        match runs.last_mut() {
            Some(run) if !is_cut && follows(run, &record) => run.push(record),
            _ => runs.push(vec![record]),
        }
        is_cut = ends;
    }
    let is_table = |run: &&Vec<Record<'_>>| {
        let names: Vec<&str> = run[0].names().collect();
        let distinct: HashSet<&str> = names.iter().copied().collect();
        run.len() > 1 && names.len() > 1 && distinct.len() == names.len()
    };
    for k in 1..runs.len().saturating_sub(1) {
        if is_table(&&runs[k])
            && let Some(run) = from_first_block(&runs[k - 1], &runs[k], &runs[k + 1])
        {
            runs[k] = run;
        }
    }
    let tables = runs.iter().filter(is_table);
    tables.map(|run| grid(run, lines)).collect()
}

/// A run of blocks as the first block of the text has them, if the run begins in the middle of it:
/// the record above ends with the last names of a block, and the one just below begins with the
/// others.
fn from_first_block<'t>(
    above: &[Record<'t>],
    run: &[Record<'t>],
    below: &[Record<'t>],
) -> Option<Vec<Record<'t>>> {
    let [below] = below else {
        return None;
    };
    let names: Vec<&str> = run[0].names().collect();
    let same = names.iter().copied().zip(below.names());
    let cut = same.take_while(|(own, other)| own == other).count();
    let last_above = &above[above.len() - 1];
    let ends: Vec<&str> = last_above.names().collect();
    let is_block = run[0].lines.len() == names.len();
    let is_in_middle = 0 < cut && cut < names.len() && ends.ends_with(&names[cut..]);
    if !is_block || !is_in_middle || !run[run.len() - 1].is_just_above(below) {
        return None;
    }
    let mut pairs: Vec<Pair<'t>> = vec![];
    let mut lines = vec![];
    if above.len() == 1 && last_above.is_just_above(&run[0]) {
        let start = ends.len() - (names.len() - cut);
        pairs.extend(&last_above.pairs[start..]);
        lines.extend(&last_above.lines[start..]);
    }
    let start = if pairs.is_empty() { cut } else { 0 };
    pairs.extend(run.iter().flat_map(|record| &record.pairs).skip(start));
    lines.extend(run.iter().flat_map(|record| &record.lines).skip(start));
    pairs.extend(&below.pairs[..cut]);
    lines.extend(&below.lines[..cut]);
    let blocks = pairs
        .chunks_exact(names.len())
        .zip(lines.chunks_exact(names.len()));
    let records = blocks.map(|(pairs, lines)| Record {
        pairs: pairs.to_vec(),
        lines: lines.to_vec(),
        between: String::new(),
    });
    Some(records.collect())
}

/// The table of a run, whose lines it takes.
fn grid(run: &[Record<'_>], lines: &mut Lines<'_>) -> Grid {
    let rows = run.iter().map(|record| {
        let values = record.pairs.iter().map(|pair| pair.value.to_owned());
        values.collect()
    });
    let own = run.iter().flat_map(|record| &record.lines);
    let own: Vec<usize> = own.copied().collect();
    Grid {
        names: run[0].names().map(str::to_owned).collect(),
        rows: rows.collect(),
        row_lines: run.iter().map(|record| record.lines[0] + 1).collect(),
        lines: lines.take(&own),
        ..Grid::default()
    }
}

fn records<'t>(lines: &Lines<'t>) -> Vec<Record<'t>> {
    let mut records: Vec<Record<'t>> = vec![];
    let mut between = String::new();
    for (k, line) in lines.text.iter().enumerate() {
        let found = if lines.used[k] { None } else { pairs(line) };
        let Some(found) = found else {
            if lines.used[k] {
                between.push('|');
            } else if !is_frame(line) {
                between.extend(line.chars().filter(|c| !c.is_ascii_digit() && *c != '.'));
            }
            continue;
        };
        match records.last_mut() {
            Some(last) if between.is_empty() && last.takes(&found, k) => {
                last.pairs.extend(found);
                last.lines.push(k);
            }
            _ => records.push(Record {
                pairs: found,
                lines: vec![k],
                between: std::mem::take(&mut between),
            }),
        }
    }
    records
}

/// Whether a record has the names of those before it, and the same words above it.
fn follows(run: &[Record<'_>], record: &Record<'_>) -> bool {
    let last = &run[run.len() - 1];
    let is_same = last.names().eq(record.names());
    is_same && (run.len() == 1 || last.between == record.between)
}
