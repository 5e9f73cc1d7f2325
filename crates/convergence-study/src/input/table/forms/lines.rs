//! A text in lines: rows below names, logs and lists.

use super::super::Refused;
use super::super::cell::plain;
use super::super::grid::Grid;
use super::super::{Choice, LineRange};
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
    /// Whether a line stands in a table.
    pub(super) used: Vec<bool>,
}

/// A table, and the numbers of its lines from 0.
pub(super) struct Block {
    pub(super) grid: Grid,
    pub(super) lines: Vec<usize>,
}

impl<'t> Lines<'t> {
    pub(super) fn of(text: &'t str, ranges: &[LineRange]) -> Self {
        let line = |(k, line): (usize, &'t str)| {
            let is_chosen = ranges.is_empty() || ranges.iter().any(|range| range.has(k + 1));
            if is_chosen {
                line.trim_start_matches(['>', ' ']).trim_end()
            } else {
                ""
            }
        };
        // A quotation begins at the margin; blanks before a row mean nothing.
        let text: Vec<&str> = text.lines().enumerate().map(line).collect();
        Self {
            used: vec![false; text.len()],
            text,
        }
    }
}

/// Finds the tables of a text.
pub(super) fn find(text: &str, choice: &Choice) -> Result<Found, Refused> {
    let mut lines = Lines::of(text, &choice.lines);
    let mut filled = (1..).zip(&lines.text).filter(|(_, line)| !line.is_empty());
    if let Some((line, _)) = filled.nth(LINES) {
        let expected =
            Text::from(format!("at most {LINES} lines, or ")) + Argument::Lines.with_placeholder();
        return Err(Refused::new(expected, "more").at(line));
    }
    let mut blocks = rows::find(&mut lines, choice.names.as_deref())?;
    blocks.extend(logs::find(&mut lines)?);
    blocks.extend(lists::find(&mut lines));
    blocks.sort_by_key(|block| block.lines[0]);
    let names = blocks.iter().flat_map(|block| &block.grid.names);
    let mut found = Found {
        doubts: outside::doubts(&lines, names).into_iter().collect(),
        ..Found::default()
    };
    for block in blocks {
        found.add(with_heading(block, &lines))?;
    }
    Ok(found)
}

/// The table with the line above it as its heading; refuses cells that span columns.
fn with_heading(block: Block, lines: &Lines<'_>) -> Result<Grid, Refused> {
    let Block {
        mut grid,
        lines: own,
    } = block;
    let first = own[0];
    grid.lines = [first + 1, own[own.len() - 1] + 1];
    let above = &lines.text[first.saturating_sub(2)..first];
    if above.iter().any(|line| line.contains("\\multi")) {
        return Err(grid.refuse(
            "one cell below each name",
            "cells that span columns or rows",
        ));
    }
    let above = (0..first).rev().take_while(|k| !lines.used[*k]);
    let above = above.filter(|k| !is_frame(lines.text[*k])).take(ABOVE);
    let above: Vec<&str> = above.map(|k| lines.text[k]).collect();
    if let Some(nearest) = above.first() {
        let heading = plain(nearest);
        let heading = heading.trim_matches(['#', '%', '*', ':', '=', '-', ' ']);
        grid.heading = heading.chars().take(HEADING).collect();
        grid.degree = above.iter().find_map(|line| degree(line));
    }
    Ok(grid)
}

/// The degree of elements that a line says: `p = 2`, `P2`, `degree 2`.
pub(super) fn degree(line: &str) -> Option<u32> {
    let line = line.replace(['=', ':', '(', ')', ',', ';', '[', ']', '-'], " ");
    let words: Vec<&str> = line.split_whitespace().collect();
    let of = |(k, word): (usize, &&str)| match words.get(k + 1) {
        Some(next) if super::super::names::is_degree(word) => next.parse().ok(),
        _ => word.strip_prefix(['P', 'Q'])?.parse().ok(),
    };
    words.iter().enumerate().find_map(of)
}
