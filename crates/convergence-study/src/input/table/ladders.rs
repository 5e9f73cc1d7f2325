//! The ladders of a table: rows of one method, of one degree.

use super::grid::{Cells, Grid};
use super::names::{is_degree, says_solved};
use super::{Choice, Doubt, LeftOut, RateTable, Refused};
use crate::text::lists::grouped;
use crate::text::number::counted;

/// Highest degree of elements.
const HIGHEST: f64 = 20.0;
/// Fewest rows of a ladder that labels part.
const FEWEST: usize = 3;

/// Rows that belong together.
pub(super) struct Ladder {
    /// The columns, but for those that part it from other rows.
    pub(super) columns: Vec<Cells>,
    /// What is known of its table without its step.
    pub(super) table: RateTable,
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
    let has_degrees = |column: &Cells| !choice.by_unit && holds_degrees(column) && column.varies();
    let parts = |column: &&Cells| has_degrees(column) || parts_by_words(column);
    let (parting, others): (Vec<&Cells>, Vec<&Cells>) = columns.iter().partition(parts);
    let labelled = (0..columns[0].cells.len()).map(|row| {
        let label = parting.iter().map(|column| column.cells[row].text.as_str());
        (label.collect::<Vec<_>>(), row)
    });
    let groups = grouped(labelled);
    if groups.iter().any(|(_, rows)| rows.len() == 1)
        && let Some(degree) = parting.iter().find(|column| has_degrees(column))
    {
        let expected = "one degree of the elements on a ladder of steps";
        let found = format!("`{}`, which changes with the step", degree.name);
        return Err(Refused::new(expected, found));
    }
    let ladders = groups.into_iter().map(|(_, rows)| Ladder {
        table: known(grid, columns, &parting, &rows),
        columns: others.iter().map(|column| column.of_rows(&rows)).collect(),
    });
    Ok(ladders.collect())
}

/// What is known of the table of some rows.
fn known(grid: &Grid, columns: &[Cells], parting: &[&Cells], rows: &[usize]) -> RateTable {
    let text = |column: &Cells| column.cells[rows[0]].text.clone();
    let labels = parting.iter().map(|column| match text(column) {
        degree if holds_degrees(column) => format!("{} = {degree}", column.name),
        label => label,
    });
    let name = labels.collect::<Vec<_>>().join(" ");
    let degrees = columns.iter().find(|column| holds_degrees(column));
    let degree = degrees.and_then(|column| text(column).parse().ok());
    let short = parting.first().filter(|_| rows.len() < FEWEST);
    let doubts = short.map(|column| {
        let because = format!("leaves {} of `{name}`", counted(rows.len(), "row"));
        Doubt::of_column(&column.name, because)
    });
    let left_out = parting.iter().map(|column| LeftOut::new(column, "labels"));
    RateTable {
        name: format!("{} {name}", grid.heading).trim().to_owned(),
        degree: degree.or(grid.degree),
        left_out: left_out.collect(),
        doubts: doubts.into_iter().collect(),
        ..RateTable::default()
    }
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
