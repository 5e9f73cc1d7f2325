//! All tables of a text, and what stands against them.

use std::collections::HashSet;

use super::cell::plain;
use super::forms::{self, Stray, spaced_key};
use super::grid::{Grid, Sense};
use super::refused::Refused;
use super::{Choice, Doubt, LineRange, RateTable, tables_of_grid};
use crate::input;
use crate::input::advice::{Argument, Text};
use crate::text::lists::and_more;
use crate::text::number::counted;

/// What was read of a text.
#[derive(Default)]
struct Document {
    tables: Vec<RateTable>,
    /// Where each grid stands of which there are tables.
    lines: Vec<LineRange>,
    /// The keys of the columns that are a step, an error or a value.
    names: HashSet<String>,
    unread: Vec<Refused>,
    /// Whether a table that is not read may have errors.
    has_unread_errors: bool,
    strays: Vec<Stray>,
    /// What else speaks against the tables.
    doubts: Vec<Doubt>,
}

impl Document {
    /// Reads the grids of a text one after another.
    fn read(text: &str, choice: &Choice) -> Result<Self, Refused> {
        let found = forms::find(text, choice)?;
        let mut document = Self {
            strays: found.strays,
            doubts: found.outside.into_iter().chain(found.failed).collect(),
            ..Self::default()
        };
        for grid in found.grids {
            match grid {
                Ok(grid) => document.add(&grid, choice),
                Err(refused) => {
                    document.has_unread_errors = true;
                    document.unread.push(refused);
                }
            }
        }
        Ok(document)
    }

    fn add(&mut self, grid: &Grid, choice: &Choice) {
        match tables_of_grid(grid, choice) {
            Ok(tables) => {
                let is_left_out = |name: &str, table: &RateTable| {
                    let mut left_out = table.left_out.iter();
                    left_out.any(|left_out| left_out.column == name)
                };
                let names = grid.names.iter().map(|name| plain(name));
                let is_used = |name: &String| !tables.iter().all(|table| is_left_out(name, table));
                let used = names.filter(is_used);
                self.names.extend(used.map(|name| spaced_key(&name)));
                self.tables.extend(tables);
                self.lines.extend(grid.lines);
            }
            Err(refused) => {
                self.has_unread_errors |= !has_counts_alone(grid);
                let first = grid.lines.map_or(0, |lines| lines.first);
                self.unread.push(refused.at(first));
            }
        }
    }

    /// The lines outside the tables that look like a level of one.
    fn levels_outside(&self) -> impl Iterator<Item = &Stray> {
        let strays = self.strays.iter();
        strays.filter(|stray| stray.is_level(&self.names))
    }

    /// What speaks against the tables because of the lines outside them: the first that looks like
    /// a level, or the first. `--lines` is offered where it leaves out no level.
    fn doubt_outside(&self, choice: &Choice) -> Option<Doubt> {
        let level = self.levels_outside().next();
        let stray = level.or(self.strays.first())?;
        let more = and_more(self.strays.len(), 1);
        let because = match level {
            Some(_) => format!("outside the tables: a level? {stray}{more}"),
            None => format!("outside the tables: {stray}{more}"),
        };
        let is_nothing_lost = level.is_none() && !self.has_unread_errors;
        let may_help = choice.lines.is_empty() && !self.lines.is_empty();
        let offer = choice.offer("", |choice| choice.lines.clone_from(&self.lines));
        Some(Doubt {
            offer: (is_nothing_lost && may_help).then_some(offer),
            ..Doubt::new(because)
        })
    }
}

/// How many levels some tables have.
fn levels(tables: &[RateTable]) -> usize {
    let columns = tables.iter().filter_map(|table| table.all().next());
    columns.map(|column| column.levels.len()).sum()
}

/// The doubt about chosen lines that end within a table: with the next line that has a number,
/// below or above, the tables have a level more; or the line just below looks like one.
pub(super) fn cut_off(text: &str, choice: &Choice, tables: &[RateTable]) -> Option<Doubt> {
    let lines: Vec<&str> = text.lines().collect();
    let is_chosen = |line: usize| choice.lines.iter().any(|range| range.has(line));
    for (k, range) in choice.lines.iter().enumerate() {
        let below = forms::next_with_number(&lines, range.last.saturating_add(1)..=lines.len());
        let above = forms::next_with_number(&lines, (1..range.first.min(lines.len() + 1)).rev());
        let beside = [below, above].into_iter().flatten();
        for line in beside.filter(|line| !is_chosen(*line)) {
            let longer = choice.offer("", |choice| choice.lines[k] = range.with(line));
            let Ok(document) = Document::read(text, &longer.choice) else {
                continue;
            };
            let is_row = levels(&document.tables) > levels(tables);
            let mut levels = document.levels_outside();
            let is_next = line > range.last
                && lines[range.last..line - 1]
                    .iter()
                    .all(|between| forms::is_frame(between));
            let is_level = is_next && levels.any(|stray| stray.is_at(line));
            if is_row || is_level {
                let words = forms::quoted(lines[line - 1]);
                let because =
                    format!("the chosen lines end within a table: line {line} is {words}");
                return Some(Doubt {
                    offer: is_row.then_some(longer),
                    ..Doubt::new(because)
                });
            }
        }
    }
    None
}

/// Whether a grid has nothing but whole numbers that grow: it has no errors.
fn has_counts_alone(grid: &Grid) -> bool {
    let names = vec![String::new(); grid.rows[0].len()];
    let columns = grid.columns(&names);
    let mut columns = columns.iter();
    columns.all(|column| column.is_whole() && column.sense() == Some(Sense::Rises))
}

/// The tables of a text, with what stands against them in the first.
pub(super) fn tables(text: &str, file: &str, choice: &Choice) -> Result<Vec<RateTable>, Refused> {
    let document = Document::read(text, choice)?;
    let outside = document.doubt_outside(choice);
    let Document {
        mut tables,
        unread,
        doubts,
        ..
    } = document;
    let Some(first) = tables.first_mut() else {
        let first = unread.into_iter().next();
        return Err(first.unwrap_or_else(|| no_table(text, choice)));
    };
    first.doubts.extend(outside.into_iter().chain(doubts));
    first.doubts.extend(unread.into_iter().map(|refused| {
        let error = refused.error(file);
        Doubt::new(format!("a table is not read: {error}"))
    }));
    let counts = |table: &RateTable| table.step.contains(['/', '^']);
    match choice.dim.filter(|_| !tables.iter().any(counts)) {
        Some(dim) => Err(no_count(dim, &tables, choice)),
        None => Ok(tables),
    }
}

fn no_table(text: &str, choice: &Choice) -> Refused {
    let count = text.lines().count();
    if choice.lines.iter().any(|lines| lines.first > count) {
        let expected = Argument::Lines.with_placeholder() + " of lines that are there";
        return Refused::new(expected, counted(count, "line"));
    }
    let is_read = |number: usize| {
        let mut chosen = choice.lines.iter();
        choice.lines.is_empty() || chosen.any(|lines| lines.has(number))
    };
    let lines = text.lines().zip(1..);
    let mut lines = lines.filter(|(line, number)| is_read(*number) && !line.trim().is_empty());
    let found = lines.next().map(|(line, _)| line);
    let found = found.map_or("an empty table".to_owned(), |line| {
        format!("no table, but `{}`", input::shorten(line.trim()))
    });
    let expected = "a line of names, such as `h L2 H1`, and at least two rows below, such as `0.1 1.6e-3 4e-2`";
    Refused::new(expected, found)
}

/// The refusal of a dimension where nothing counts.
fn no_count(dim: f64, tables: &[RateTable], choice: &Choice) -> Refused {
    let expected = Text::from("no ") + Argument::Dim.with(&dim.to_string());
    let expected = expected + ", which is for counts such as `cells`";
    let steps = tables.iter().map(|table| format!("`{}`", table.step));
    let found = format!("the step {}", steps.collect::<Vec<_>>().join(", "));
    let offer = choice.offer("", |choice| choice.dim = None);
    Refused::new(expected, found).offering([offer])
}
