//! A text in lines: rows below names, logs and lists.

use super::super::cell::plain;
use super::super::grid::Grid;
use super::super::names::is_degree;
use super::super::{LineRange, Refused};
use super::{Found, is_frame, lists, logs, outside, rows};
use crate::input::advice::{Argument, Text};

/// Most lines of a text, but for empty ones and those that the caller has not chosen.
const LINES: usize = 100_000;
/// Lines above a table that may say its degree.
const ABOVE: usize = 3;
/// Most characters of a heading.
const HEADING: usize = 60;

/// The lines of a text.
pub(super) struct Lines<'t> {
    /// Without quotation marks of mail; empty where the caller has chosen others.
    pub(super) text: Vec<&'t str>,
    /// How many blanks stand before each.
    pub(super) indents: Vec<usize>,
    /// Whether a line stands in a table.
    pub(super) used: Vec<bool>,
}

impl<'t> Lines<'t> {
    fn of(text: &'t str, ranges: &[LineRange]) -> Self {
        let lines = (1..).zip(text.lines()).map(|(k, line)| {
            if ranges.is_empty() || ranges.iter().any(|range| range.has(k)) {
                line
            } else {
                ""
            }
        });
        // A quotation begins at the margin; blanks before a row mean nothing.
        let lines = lines.map(|line| {
            let text = line.trim_start_matches(['>', ' ']);
            (text.trim_end(), line.len() - text.len())
        });
        let (text, indents): (Vec<&str>, Vec<usize>) = lines.unzip();
        Self {
            used: vec![false; text.len()],
            text,
            indents,
        }
    }

    /// The lines that stand in no table, but for empty ones, each with its number from 0.
    pub(super) fn unused(&self) -> impl Iterator<Item = (usize, &'t str)> {
        let lines = self.text.iter().copied().enumerate();
        lines.filter(|(k, line)| !self.used[*k] && !line.is_empty())
    }

    /// Marks lines, by their numbers from 0, as those of a table; from the first to the last.
    pub(super) fn take(&mut self, own: &[usize]) -> Option<LineRange> {
        own.iter().for_each(|line| self.used[*line] = true);
        let (first, last) = own.first().zip(own.last())?;
        Some(LineRange {
            first: first + 1,
            last: last + 1,
        })
    }
}

/// The next line with a number, by their numbers from 1, unless an empty line stands before it.
pub(in super::super) fn next_with_number(
    text: &[&str],
    mut numbers: impl Iterator<Item = usize>,
) -> Option<usize> {
    let line = |number: usize| text[number - 1].trim();
    let has_number = |number: usize| line(number).contains(|c: char| c.is_ascii_digit());
    let next = numbers.find(|number| line(*number).is_empty() || has_number(*number))?;
    has_number(next).then_some(next)
}

/// Finds the tables of a text.
///
/// * `names`: as the caller gives them.
pub(super) fn find(
    text: &str,
    ranges: &[LineRange],
    names: Option<&[String]>,
) -> Result<Found, Refused> {
    let mut lines = Lines::of(text, ranges);
    if let Some((line, _)) = lines.unused().nth(LINES) {
        let expected = Text::from(format!("at most {LINES} lines, or "));
        let expected = expected + Argument::Lines.with_placeholder();
        return Err(Refused::new(expected, "more").at(line + 1));
    }
    let mut grids = rows::find(&mut lines, names)?;
    grids.extend(logs::find(&mut lines));
    grids.extend(lists::find(&mut lines));
    grids.sort_by_key(|grid| grid.lines.map(|lines| lines.first));
    let names = grids.iter().flat_map(|grid| &grid.names);
    let mut found = Found {
        strays: outside::strays(&lines, names),
        ..Found::default()
    };
    for grid in grids {
        found.add(with_heading(grid, &lines))?;
    }
    Ok(found)
}

/// The table with the line above it as its heading; refuses cells that span columns.
fn with_heading(mut grid: Grid, lines: &Lines<'_>) -> Result<Grid, Refused> {
    let first = grid.lines.map_or(0, |lines| lines.first - 1);
    let spans = |line: &&str| line.contains("\\multi");
    if lines.text[first.saturating_sub(2)..first].iter().any(spans) {
        let expected = "one cell below each name";
        let found = "cells that span columns or rows";
        return Err(Refused::new(expected, found).at(first + 1));
    }
    let above = (0..first).rev().take_while(|k| !lines.used[*k]);
    let above = above.map(|k| lines.text[k]).filter(|line| !is_frame(line));
    let mut above = above.take(ABOVE).peekable();
    if let Some(nearest) = above.peek() {
        let heading = plain(nearest);
        let heading = heading.trim_matches(['#', '%', '*', ':', '=', '-', ' ']);
        grid.heading = heading.chars().take(HEADING).collect();
    }
    grid.degree = above.find_map(degree);
    Ok(grid)
}

/// The degree of elements that a line says: `p = 2`, `P2`, `degree 2`.
pub(super) fn degree(line: &str) -> Option<u32> {
    let line = line.replace(['=', ':', '(', ')', ',', ';', '[', ']', '-'], " ");
    let words: Vec<&str> = line.split_whitespace().collect();
    let mut all = words.iter().enumerate();
    all.find_map(|(k, word)| match words.get(k + 1) {
        Some(next) if is_degree(word) => next.parse().ok(),
        _ => word.strip_prefix(['P', 'Q'])?.parse().ok(),
    })
}
