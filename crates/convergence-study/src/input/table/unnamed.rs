//! Cells without a name of their own: rates behind errors, and names of two words.

use std::iter;

use super::Refused;
use super::fits::{Steps, fit};
use super::grid::{Cells, Grid};
use super::names::{key, says_error, says_rates};
use super::step::sizes;
use crate::text::number::counted;

/// Columns that may be the step: the first few.
const LEADING: usize = 4;

/// What a column is called.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Heading {
    /// By its own name.
    Name(String),
    /// It has none, and prints the rates of the error in this column.
    RatesOf(usize),
}

impl Heading {
    /// Its own name.
    pub(super) fn name(&self) -> Option<&str> {
        match self {
            Self::Name(name) => Some(name),
            Self::RatesOf(_) => None,
        }
    }
}

/// A heading for each cell of a row.
///
/// # Errors
/// More cells than names, if those without a name are no rates of the column before.
pub(super) fn headings(grid: &Grid, dim: Option<f64>) -> Result<Vec<Heading>, Refused> {
    let named = || grid.names.iter().cloned().map(Heading::Name).collect();
    let width = grid.rows[0].len();
    let count = grid.names.len();
    if width == count && grid.head.is_none() {
        return Ok(named());
    }
    let columns = grid.columns(&vec![String::new(); width]);
    if width == count + 1 && grid.is_indented && columns[0].numbers_rows {
        let names = iter::once("row".to_owned()).chain(grid.names.iter().cloned());
        return Ok(names.map(Heading::Name).collect());
    }
    for lead in 0..LEADING.min(width) {
        for steps in steps(&columns[lead], dim) {
            let is_rate = rates(&columns, lead, &steps);
            let errors = is_rate.iter().filter(|is| !**is).count();
            if errors == count && errors < width {
                return Ok(with_rates(&grid.names, &is_rate));
            }
            let hides_rates = (0..width)
                .any(|k| is_rate[k] && (width > count || !says_rates(&key(&grid.names[k]))));
            let begin_late = (0..width).all(|k| !is_rate[k] || columns[k].cells[0].is_blank());
            if let Some(head) = &grid.head
                && errors < count
                && hides_rates
                && begin_late
                && let Some(names) = joined(head, errors)
            {
                return Ok(with_rates(&names, &is_rate));
            }
        }
    }
    if width == count {
        return Ok(named());
    }
    let expected = format!(
        "{}, or the rates of each error behind it",
        counted(count, "cell")
    );
    let found = format!("{}, of which some are no rates", counted(width, "cell"));
    Err(Refused::new(expected, found))
}

/// The steps that a column may give.
fn steps(column: &Cells, dim: Option<f64>) -> Vec<Steps> {
    let dims = match dim {
        _ if !column.is_positive() || column.sense().is_none() => vec![],
        _ if !column.is_whole() => vec![None],
        Some(dim) => vec![Some(dim)],
        None => vec![Some(1.0), Some(2.0), Some(3.0)],
    };
    dims.into_iter().map(|dim| sizes(column, dim)).collect()
}

/// For each column whether its numbers are the rates of one of the two before it.
fn rates(columns: &[Cells], lead: usize, steps: &Steps) -> Vec<bool> {
    let mut is_rate = vec![false; columns.len()];
    for k in lead + 2..columns.len() {
        let mut errors = (lead + 1).max(k - 2)..k;
        is_rate[k] = !columns[k].is_whole()
            && errors
                .any(|error| !is_rate[error] && fit(&columns[k], &columns[error], steps).is_some());
    }
    is_rate
}

/// The names in their order; a column of rates has those of the last column with a name.
fn with_rates(names: &[String], is_rate: &[bool]) -> Vec<Heading> {
    let mut names = names.iter();
    let mut headings = vec![];
    let mut last = 0;
    for (column, is_rate) in is_rate.iter().enumerate() {
        if *is_rate {
            headings.push(Heading::RatesOf(last));
        } else {
            last = column;
            let name = names.next().cloned().unwrap_or_default();
            headings.push(Heading::Name(name));
        }
    }
    headings
}

/// A line of names, parted at its widest gaps into as many: one blank in a name, more before it,
/// and not two words of errors.
fn joined(head: &str, count: usize) -> Option<Vec<String>> {
    let starts = head.match_indices(' ').map(|(at, _)| at);
    let ends = starts.clone().filter(|at| !head[at + 1..].starts_with(' '));
    let begins = starts.filter(|at| !head[..*at].ends_with(' '));
    let mut gaps: Vec<std::ops::Range<usize>> = begins
        .zip(ends)
        .map(|(start, end)| start..end + 1)
        .collect();
    gaps.sort_by_key(|gap| std::cmp::Reverse(gap.len()));
    gaps.truncate(count.checked_sub(1)?);
    gaps.sort_by_key(|gap| gap.start);
    let mut names = vec![];
    let mut before = 0..0;
    for gap in gaps.into_iter().chain(iter::once(head.len()..head.len())) {
        let name = &head[before.end..gap.start];
        let errors = name.split(' ').filter(|word| says_error(&key(word)));
        let is_alone = before.end == 0 || before.len() > 1;
        if name.contains(' ') && (!is_alone || name.contains("  ") || errors.count() > 1) {
            return None;
        }
        names.push(name.to_owned());
        before = gap;
    }
    (names.len() == count).then_some(names)
}
