//! The ladders of a table: rows of one method, of one degree.

use super::grid::{Cells, Grid};
use super::names::{is_degree, says_solved};
use super::{Choice, Doubt, LeftOut, Refused};
use crate::text::lists::grouped;
use crate::text::number::counted;

/// Highest degree of elements.
const HIGHEST: f64 = 20.0;
/// Fewest rows of a ladder that labels part.
const FEWEST: usize = 3;

/// Rows that belong together.
pub(super) struct Ladder {
    /// What parts them from other rows.
    pub(super) name: String,
    /// The columns, but for those that part.
    pub(super) columns: Vec<Cells>,
    /// Those that part.
    pub(super) left_out: Vec<LeftOut>,
    pub(super) degree: Option<u32>,
    pub(super) doubt: Option<Doubt>,
}

/// Parts the rows of a table by its words and by the degree of its elements.
///
/// # Errors
/// A degree that changes with the step.
pub(super) fn ladders(
    grid: &Grid,
    columns: &[Cells],
    choice: &Choice,
) -> Result<Vec<Ladder>, Refused> {
    // Errors that fall by a factor for each degree are judged over it.
    let parts_by_degree =
        |column: &Cells| !choice.by_unit && holds_degrees(column) && column.varies();
    let parts = |column: &&Cells| parts_by_degree(column) || parts_by_words(column);
    let (parting, others): (Vec<&Cells>, Vec<&Cells>) = columns.iter().partition(parts);
    let label = |row: usize| -> Vec<&str> {
        let texts = parting.iter().map(|column| column.cells[row].text.as_str());
        texts.collect()
    };
    let groups = grouped((0..columns[0].cells.len()).map(|row| (label(row), row)));
    let degree = parting.iter().find(|column| parts_by_degree(column));
    if let Some(degree) = degree
        && groups.iter().any(|(_, rows)| rows.len() == 1)
    {
        let expected = "one degree of the elements on a ladder of steps";
        let found = format!("`{}`, which changes with the step", degree.name);
        return Err(Refused::new(expected, found));
    }
    let degrees = columns.iter().find(|column| holds_degrees(column));
    let ladder = |(texts, rows): (Vec<&str>, Vec<usize>)| {
        let names = parting.iter().zip(texts).map(|(column, text)| {
            if holds_degrees(column) {
                format!("{} = {text}", column.name)
            } else {
                text.to_owned()
            }
        });
        let name = names.collect::<Vec<_>>().join(" ");
        let degree = degrees.and_then(|column| column.cells[rows[0]].text.parse().ok());
        let is_short = !parting.is_empty() && rows.len() < FEWEST;
        let left_out = parting.iter().map(|column| LeftOut::new(column, "labels"));
        Ladder {
            degree: degree.or(grid.degree),
            doubt: is_short.then(|| {
                let because = format!("leaves {} of `{name}`", counted(rows.len(), "row"));
                Doubt::of_column(&parting[0].name, because)
            }),
            left_out: left_out.collect(),
            columns: others.iter().map(|column| column.of_rows(&rows)).collect(),
            name: format!("{} {name}", grid.heading).trim().to_owned(),
        }
    };
    Ok(groups.into_iter().map(ladder).collect())
}

/// Whether a column of words names several groups of rows.
fn parts_by_words(column: &Cells) -> bool {
    let texts: std::collections::HashSet<&str> =
        column.cells.iter().map(|cell| cell.text.as_str()).collect();
    let is_parting = (2..column.cells.len()).contains(&texts.len()) && column.are_labels();
    is_parting && !column.is_named_rates() && !is_flag(column)
}

fn holds_degrees(column: &Cells) -> bool {
    let are_low = column.numbers.iter().all(|number| *number <= HIGHEST);
    is_degree(&column.key) && column.is_whole() && are_low
}

/// Whether all cells say yes or no, or 1 and 0 under a name that asks whether a level was solved.
pub(super) fn is_flag(column: &Cells) -> bool {
    let words: &[&str] = if says_solved(&column.key) {
        &["true", "false", "yes", "no", "0", "1"]
    } else {
        &["true", "false", "yes", "no"]
    };
    let says_so = |text: &str| words.contains(&text.to_lowercase().as_str());
    column.cells.iter().all(|cell| says_so(&cell.text))
}
