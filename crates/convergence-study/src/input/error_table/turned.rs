//! Tables whose columns stand as rows.

use std::f64::consts::LN_2;

use super::grid::{RawTable, Turned};
use super::line::is_rule;
use super::number::{Number, halves, number};
use super::original::{blank_at, offset};
use super::pairs::{Pair, Scan};

/// Least numbers of a row with rates between its errors: three errors and two rates.
const LEAST: usize = 5;

/// A column of steps.
struct Steps<'t> {
    name: &'t str,
    cells: Vec<&'t str>,
}

/// The steps in the head of a turned table: `dx=1/32  dx=1/64`.
fn steps<'t>(heads: &[&'t str], levels: usize) -> Option<Steps<'t>> {
    heads.iter().find_map(|head| {
        let pairs = Scan::of(head).pairs;
        let name = pairs.first()?.last_word();
        let is_step = |pair: &Pair<'_>| pair.last_word() == name && pair.values.len() == 1;
        let cells = pairs.iter().map(|pair| pair.values[0]).collect();
        let are_steps = pairs.len() == levels && pairs.iter().all(is_step);
        are_steps.then_some(Steps { name, cells })
    })
}

/// A table of these columns; the steps may stand in the lines above.
fn table<'t>(
    mut names: Vec<&'t str>,
    mut columns: Vec<Vec<&'t str>>,
    heads: &[&'t str],
    turned: Option<Turned>,
) -> RawTable<'t> {
    let levels = columns.first().map_or(0, Vec::len);
    let steps = steps(heads, levels);
    let turned = match steps {
        Some(_) => Some(Turned::Stepped),
        None => turned,
    };
    if let Some(Steps { name, cells }) = steps {
        names.insert(0, name);
        columns.insert(0, cells);
    }
    let row = |k: usize| columns.iter().map(|column| column[k]).collect();
    RawTable {
        names,
        rows: (0..levels).map(row).collect(),
        decimal_comma: true,
        turned,
        ..RawTable::default()
    }
}

/// A text in which each line is a variable, with the rates of its errors between them, as
/// `name error rate error rate error`, perhaps below a line of names; `None` if a rate of some line
/// is not that of halved steps.
pub(super) fn with_rates_between(text: &str) -> Option<RawTable<'_>> {
    let mut names = vec![];
    let mut columns: Vec<Vec<&str>> = vec![];
    let lines = text.lines().filter(|line| !line.trim().is_empty());
    let lines = lines.filter(|line| !is_rule(line) && !line.trim_start().starts_with('\\'));
    let lines: Vec<&str> = lines.collect();
    let is_head = |line: &&str| Variable::of_line(line).is_none();
    let heads = lines.iter().take_while(|line| is_head(line)).count();
    // A variable whose numbers are no errors and rates is none to be skipped.
    let has_numbers = |head: &&str| {
        let words = head
            .split(separates)
            .filter(|word| number(word, false).is_some());
        words.count() >= LEAST
    };
    if lines[..heads].iter().any(has_numbers) {
        return None;
    }
    for line in &lines[heads..] {
        let Variable { name, errors } = Variable::of_line(line)?;
        if columns
            .first()
            .is_some_and(|first| first.len() != errors.len())
        {
            return None;
        }
        names.push(name);
        columns.push(errors);
    }
    let is_table = !columns.is_empty();
    is_table.then(|| table(names, columns, &lines[..heads], Some(Turned::Halved)))
}

fn separates(c: char) -> bool {
    c.is_whitespace() || "|&".contains(c)
}

/// A line of such a text.
struct Variable<'t> {
    name: &'t str,
    errors: Vec<&'t str>,
}

impl<'t> Variable<'t> {
    /// The words before the last numbers of a line, and the errors among these.
    fn of_line(line: &'t str) -> Option<Self> {
        let words = line.split(separates);
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        let behind = words
            .iter()
            .rev()
            .take_while(|word| number(word, false).is_some())
            .count();
        let numbers = &words[words.len() - behind..];
        if behind < LEAST || behind.is_multiple_of(2) || behind == words.len() {
            return None;
        }
        let numbers_of_words: Vec<Option<Number>> =
            numbers.iter().map(|word| number(word, false)).collect();
        let mut threes = numbers_of_words.windows(3).step_by(2);
        let are_rates = threes.all(is_rate_between);
        let end = offset(line, numbers[0]);
        are_rates.then(|| Self {
            name: line[..end].trim_matches(separates),
            errors: numbers.iter().step_by(2).copied().collect(),
        })
    }
}

/// Whether the middle one of three numbers is the rate of the others over halved steps, to their
/// digits.
fn is_rate_between(three: &[Option<Number>]) -> bool {
    let [Some(coarse), Some(rate), Some(fine)] = three[..] else {
        return false;
    };
    let half = |number: Number| halves(&[Some(number)])[0];
    let doubt = (half(coarse) / coarse.value + half(fine) / fine.value) / LN_2;
    (rate.value - (coarse.value / fine.value).log2()).abs() <= half(rate) + doubt + 1e-3
}

/// A table whose rows are the columns of `rows`, each with its name in front, if it has one.
pub(super) fn transpose<'t>(rows: &[Vec<&'t str>], heads: &[&'t str]) -> RawTable<'t> {
    let has_names = number(rows[0][0], true).is_none();
    let first = usize::from(has_names);
    let names = rows
        .iter()
        .map(|row| if has_names { row[0] } else { blank_at(row[0]) });
    let columns = rows.iter().map(|row| row[first..].to_vec());
    let turned = has_names.then_some(Turned::Plain);
    table(names.collect(), columns.collect(), heads, turned)
}

/// Whether the steps stand above rows that have the names of variables in front.
pub(super) fn has_steps_in_head(rows: &[Vec<&str>], heads: &[&str]) -> bool {
    let width = rows[0].len();
    let is_variable = |row: &Vec<&str>| row.len() == width && number(row[0], true).is_none();
    width > 2 && rows.iter().all(is_variable) && steps(heads, width - 1).is_some()
}

/// Whether numbers have a constant ratio, as those of a step do.
fn has_constant_ratio(cells: &[&str]) -> bool {
    let numbers: Vec<f64> = cells
        .iter()
        .filter_map(|cell| Some(number(cell, true)?.value))
        .collect();
    numbers.len() > 2
        && numbers
            .windows(3)
            .all(|three| (three[0] * three[2] / three[1].powi(2) - 1.0).abs() < 1e-3)
}

/// Whether columns stand as rows: words before them and none above, two rows of numbers, or the
/// steps in the first one.
pub(super) fn is_turned(rows: &[Vec<&str>]) -> bool {
    let width = rows[0].len();
    if rows.len() < 2 || rows.iter().any(|row| row.len() != width || row.len() < 3) {
        return false;
    }
    let firsts: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    firsts.iter().all(|cell| number(cell, true).is_none())
        || rows.len() == 2
        || has_constant_ratio(&rows[0]) && !has_constant_ratio(&firsts)
}
