//! Cells without a name of their own: rates behind errors, and names of two words.

use super::Refused;
use super::fits::{Steps, fit};
use super::grid::{Cells, Grid, moves};
use super::names::{key, says_error, says_rates};
use super::step::sizes;
use crate::text::number::counted;

/// Columns that may be the step: the first few.
const LEADING: usize = 4;

/// A name for each cell of a row.
///
/// # Errors
/// More cells than names, if those without a name are no rates of the column before.
pub(super) fn names(grid: &Grid, dim: Option<f64>) -> Result<Vec<String>, Refused> {
    let width = grid.rows[0].len();
    let count = grid.names.len();
    if width == count && grid.head.is_none() {
        return Ok(grid.names.clone());
    }
    let numbered: Vec<String> = (1..=width).map(|k| k.to_string()).collect();
    let columns = grid.columns(&numbered);
    for lead in 0..LEADING.min(width) {
        for steps in ladders(&columns[lead], dim) {
            let is_rate = rates(&columns, lead, &steps);
            let errors = is_rate.iter().filter(|is| !**is).count();
            if errors == width {
                continue;
            }
            if errors == count {
                return Ok(with_rates(&grid.names, &is_rate));
            }
            let is_hidden = |k: usize| is_rate[k] && !says_rates(&key(&grid.names[k]));
            let begins_late = |k: usize| !is_rate[k] || columns[k].cells[0].is_blank();
            if errors < count
                && (width != count || (0..width).any(is_hidden))
                && (0..width).all(begins_late)
                && let Some(names) = grid.head.as_ref().and_then(|head| joined(head, errors))
            {
                return Ok(with_rates(&names, &is_rate));
            }
        }
    }
    if width == count {
        return Ok(grid.names.clone());
    }
    let found = format!("{}, of which some are no rates", counted(width, "cell"));
    Err(grid.refuse(
        format!(
            "{}, or the rates of each error behind it",
            counted(count, "cell")
        ),
        found,
    ))
}

/// The steps that a column may give.
fn ladders(column: &Cells, dim: Option<f64>) -> Vec<Steps> {
    let values = column.values().unwrap_or_default();
    if !column.is_positive() || moves(&values).is_none() {
        return vec![];
    }
    let dims = match dim {
        Some(dim) => vec![dim],
        None => vec![1.0, 2.0, 3.0],
    };
    if column.is_whole() {
        return dims
            .into_iter()
            .map(|dim| sizes(column, Some(dim)))
            .collect();
    }
    vec![sizes(column, None)]
}

/// For each column whether its numbers are the rates of one of the two before it.
fn rates(columns: &[Cells], lead: usize, steps: &Steps) -> Vec<bool> {
    let mut is_rate = vec![false; columns.len()];
    for k in lead + 2..columns.len() {
        let before = (lead + 1).max(k.saturating_sub(2))..k;
        let belongs = |error: usize| fit(&columns[k], &columns[error], steps).is_some();
        is_rate[k] = !columns[k].is_whole() && before.filter(|error| !is_rate[*error]).any(belongs);
    }
    is_rate
}

fn with_rates(names: &[String], is_rate: &[bool]) -> Vec<String> {
    let mut names = names.iter();
    let mut last = "";
    let name = |is_rate: &bool| {
        if *is_rate {
            return format!("rate of {last}");
        }
        last = names.next().map_or("", String::as_str);
        last.to_owned()
    };
    is_rate.iter().map(name).collect()
}

/// A line of names, parted at its widest gaps into as many: one blank in a name, more before it,
/// and not two words of errors.
fn joined(head: &str, count: usize) -> Option<Vec<String>> {
    let head = head.trim();
    let mut gaps: Vec<std::ops::Range<usize>> = vec![];
    for (at, _) in head.match_indices(' ') {
        match gaps.last_mut() {
            Some(gap) if gap.end == at => gap.end = at + 1,
            _ => gaps.push(at..at + 1),
        }
    }
    gaps.sort_by_key(|gap| (std::cmp::Reverse(gap.len()), gap.start));
    let mut gaps: Vec<_> = gaps.get(..count.checked_sub(1)?)?.to_vec();
    gaps.sort_by_key(|gap| gap.start);
    let is_chosen = |at: usize| gaps.iter().any(|gap| gap.end == at && gap.len() > 1);
    let starts = [0].into_iter().chain(gaps.iter().map(|gap| gap.end));
    let ends = gaps.iter().map(|gap| gap.start).chain([head.len()]);
    let name = |(start, end): (usize, usize)| {
        let name = &head[start..end];
        let errors = name.split(' ').filter(|word| says_error(&key(word)));
        let is_one = !name.contains(' ');
        let is_name =
            !name.contains("  ") && errors.count() < 2 && (start == 0 || is_chosen(start));
        (is_one || is_name).then(|| name.to_owned())
    };
    starts.zip(ends).map(name).collect()
}
