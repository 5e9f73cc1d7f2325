//! The tables of a text, in each form in which they may stand.

mod html;
mod json;
mod lines;
mod lists;
mod logs;
mod outside;
mod rows;

use super::cell::is_failure;
use super::grid::{Grid, check};
use super::{Choice, Doubt, Refused};
pub(super) use lines::next_with_number;
pub(super) use outside::{Stray, quoted, spaced_key};

/// Most tables of a text.
const TABLES: usize = 1_000;

/// What a text holds.
#[derive(Default)]
pub(super) struct Found {
    pub(super) grids: Vec<Result<Grid, Refused>>,
    /// Lines outside the tables that may belong to one.
    pub(super) strays: Vec<Stray>,
    /// What else stands outside the tables, and may belong to one.
    pub(super) outside: Vec<Doubt>,
    /// A line that says that the run has failed.
    pub(super) failed: Option<Doubt>,
}

impl Found {
    /// Adds a table; refuses one more than a text may have.
    fn add(&mut self, grid: Result<Grid, Refused>) -> Result<(), Refused> {
        if self.grids.len() == TABLES {
            return Err(too_many_tables());
        }
        self.grids.push(grid.and_then(|grid| {
            let first = grid.lines.map_or(0, |lines| lines.first);
            check(&grid.names, grid.rows.len(), grid.rows[0].len())
                .map_err(|refused| refused.at(first))?;
            Ok(grid)
        }));
        Ok(())
    }
}

/// A text whose bars are those of a keyboard. Julia parts the numbers of rows by a bar, and all
/// else by blanks.
fn in_bars(text: &str) -> String {
    let mut lines = text.lines();
    let has_numbered_rows = lines.any(|line| line.trim_start().starts_with("Row │"));
    let bar = if has_numbered_rows { " " } else { "|" };
    text.replace(['│', '┃', '║', '┆'], bar)
}

fn too_many_tables() -> Refused {
    Refused::new(format!("at most {TABLES} tables"), "more")
}

/// Finds the tables of a text, and the lines that are a doubt.
pub(super) fn find(text: &str, choice: &Choice) -> Result<Found, Refused> {
    let names = choice.names.as_deref();
    let found = if let Some(value) = json::value(text) {
        json::find(value)?
    } else if html::has_table(text) {
        html::find(text, names)?
    } else {
        lines::find(&in_bars(text), &choice.lines, names)?
    };
    Ok(Found {
        failed: outside::failed_run(text),
        ..found
    })
}

/// A name with its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Pair<'t> {
    name: &'t str,
    value: &'t str,
}

/// The names and numbers of a line that holds nothing else, but for words beside numbers:
/// `h = 0.1, L2 error: 1e-3, method = SIPG`.
fn pairs(line: &str) -> Option<Vec<Pair<'_>>> {
    let mut pairs = vec![];
    let mut has_number = false;
    let mut rest = line.trim();
    while !rest.is_empty() {
        let (name, behind) = rest.split_once(['=', ':'])?;
        let behind = behind.trim_start();
        let end = behind.find(|c: char| c.is_whitespace() || ",;)".contains(c));
        let (value, more) = behind.split_at(end.unwrap_or(behind.len()));
        let name = name.trim();
        let is_name = name.starts_with(|c: char| c.is_alphabetic() || "$\\|".contains(c));
        let is_word = value
            .chars()
            .all(|c| c.is_alphanumeric() || "+-._×⁻".contains(c));
        let digits = value.trim_start_matches(['+', '-']);
        let is_flag = ["true", "false"].contains(&value.to_lowercase().as_str());
        has_number |= is_word && digits.starts_with(|c: char| c.is_ascii_digit() || c == '.');
        has_number |= is_failure(value) || is_flag;
        if !is_name
            || name.contains([',', ';'])
            || value.is_empty()
            || !is_word && !is_failure(value)
        {
            return None;
        }
        pairs.push(Pair { name, value });
        rest = more.trim_start_matches([',', ';', ' ', '\t']);
    }
    has_number.then_some(pairs)
}

/// Whether a line draws a frame, or is LaTeX around a table: it stands for nothing.
pub(super) fn is_frame(line: &str) -> bool {
    const LATEX: &str =
        r"\hline \toprule \midrule \bottomrule \begin \end \centering \label \cline \small";
    let line = line.trim();
    let is_box = |c: char| ('\u{2500}'..='\u{257f}').contains(&c);
    let is_drawn = |c: char| c.is_whitespace() || is_box(c) || "|+:=_*#–—&-".contains(c);
    let is_latex = || LATEX.split(' ').any(|start| line.starts_with(start));
    line.chars().all(is_drawn) || line.starts_with('\\') && is_latex()
}
