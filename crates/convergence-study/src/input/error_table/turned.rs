//! Tables whose columns stand as rows.

use super::grid::RawTable;
use super::number::number;
use super::original::offset;

/// Least numbers of a row with rates between its errors: three errors and two rates.
const LEAST: usize = 5;
/// Largest difference between a printed rate and that of the errors.
const NEAR: f64 = 6e-3;

/// A text in which each line is a variable, with the rates of its errors between them, as
/// `name error rate error rate error`, perhaps below a line of names; `None` if a rate of some line
/// is not that of halved steps.
pub(super) fn with_rates_between(text: &str) -> Option<RawTable<'_>> {
    let mut names = vec![];
    let mut columns: Vec<Vec<&str>> = vec![];
    let mut lines = text
        .lines()
        .filter(|line| !line.trim().is_empty())
        .peekable();
    lines.next_if(|head| Variable::of_line(head).is_none());
    for line in lines {
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
    let levels = columns.first()?.len();
    let row = |k: usize| columns.iter().map(|column| column[k]).collect();
    Some(RawTable {
        names,
        rows: (0..levels).map(row).collect(),
        decimal_comma: true,
        ..RawTable::default()
    })
}

/// A line of such a text.
struct Variable<'t> {
    name: &'t str,
    errors: Vec<&'t str>,
}

impl<'t> Variable<'t> {
    /// The words before the last numbers of a line, and the errors among these.
    fn of_line(line: &'t str) -> Option<Self> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let behind = words
            .iter()
            .rev()
            .take_while(|word| number(word, false).is_some())
            .count();
        let numbers = &words[words.len() - behind..];
        if behind < LEAST || behind.is_multiple_of(2) || behind == words.len() {
            return None;
        }
        let values: Vec<f64> = numbers
            .iter()
            .filter_map(|word| Some(number(word, false)?.value))
            .collect();
        let is_rate = |three: &[f64]| (three[1] - (three[0] / three[2]).log2()).abs() < NEAR;
        let are_rates = values.windows(3).step_by(2).all(is_rate);
        let end = offset(line, numbers[0]);
        are_rates.then(|| Self {
            name: line[..end].trim(),
            errors: numbers.iter().step_by(2).copied().collect(),
        })
    }
}

/// A table whose rows are the columns of `rows`, each with its name in front, if it has one.
pub(super) fn transpose<'t>(
    rows: &[Vec<&'t str>],
    width: usize,
    table: RawTable<'t>,
) -> RawTable<'t> {
    let mut columns: Vec<Vec<&str>> = (0..width)
        .map(|k| rows.iter().map(|row| row[k]).collect())
        .collect();
    let names = if number(rows[0][0], true).is_none() {
        columns.remove(0)
    } else {
        vec![&rows[0][0][..0]; rows.len()]
    };
    RawTable {
        names,
        rows: columns,
        ..table
    }
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
