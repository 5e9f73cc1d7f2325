//! The ladders of a table: rows of one method, of one degree.

use super::grid::{Cells, Grid};
use super::names::{is_degree, says_solved};
use super::{Choice, Doubt, Refused};
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
    /// The names of those that part.
    pub(super) labels: Vec<String>,
    pub(super) degree: Option<u32>,
    pub(super) doubt: Option<Doubt>,
}

/// The texts of a row in the columns that part.
#[derive(PartialEq, Clone)]
struct Label(Vec<String>);

/// Parts the rows of a table by its words and by the degree of its elements.
///
/// # Errors
/// A degree that changes with the step.
pub(super) fn ladders(
    grid: &Grid,
    columns: &[Cells],
    choice: &Choice,
) -> Result<Vec<Ladder>, Refused> {
    let count = grid.rows.len();
    // Errors that fall by a factor for each degree are judged over it.
    let degree_varies = |column: &Cells| degree_varies(column) && !choice.by_unit;
    let parts = |column: &&Cells| parts_rows(column, count) || degree_varies(column);
    let (parting, others): (Vec<&Cells>, Vec<&Cells>) = columns.iter().partition(parts);
    let label = |row: usize| {
        Label(
            parting
                .iter()
                .map(|column| column.cells[row].text.clone())
                .collect(),
        )
    };
    let groups = grouped((0..count).map(|row| (label(row), row)));
    let is_alone = groups.iter().any(|(_, rows)| rows.len() == 1);
    if let Some(degree) = parting
        .iter()
        .find(|column| is_alone && degree_varies(column))
    {
        let expected = "one degree of the elements on a ladder of steps";
        let found = format!("`{}`, which changes with the step", degree.name);
        return Err(grid.refuse(expected, found));
    }
    let of_degree = columns.iter().find(|column| holds_degrees(column));
    let ladder = |(Label(texts), rows): (Label, Vec<usize>)| {
        let name = |(column, text): (&&Cells, String)| {
            if holds_degrees(column) {
                format!("{} = {text}", column.name)
            } else {
                text
            }
        };
        let names: Vec<String> = parting.iter().zip(texts).map(name).collect();
        let name = names.join(" ");
        let degree = of_degree.and_then(|column| column.cells[rows[0]].text.parse().ok());
        Ladder {
            degree: degree.or(grid.degree),
            doubt: (!parting.is_empty() && rows.len() < FEWEST).then(|| Doubt::Column {
                column: parting[0].name.clone(),
                because: format!("leaves {} of `{name}`", counted(rows.len(), "row")),
            }),
            labels: parting.iter().map(|column| column.name.clone()).collect(),
            columns: others.iter().map(|column| column.of_rows(&rows)).collect(),
            name,
        }
    };
    Ok(groups.into_iter().map(ladder).collect())
}

/// Whether a column of words names several groups of rows.
fn parts_rows(column: &Cells, count: usize) -> bool {
    let mut texts: Vec<&str> = column.cells.iter().map(|cell| cell.text.as_str()).collect();
    texts.sort_unstable();
    texts.dedup();
    let is_parting = 1 < texts.len() && texts.len() < count && column.are_labels();
    is_parting && !column.is_named_rates() && !is_flag(column)
}

fn holds_degrees(column: &Cells) -> bool {
    let values = column.values().unwrap_or_default();
    is_degree(&column.key) && column.is_whole() && values.iter().all(|value| *value <= HIGHEST)
}

fn degree_varies(column: &Cells) -> bool {
    holds_degrees(column) && column.varies()
}

/// Whether all cells say yes or no, or 1 and 0 under a name that asks whether a level was solved.
pub(super) fn is_flag(column: &Cells) -> bool {
    const FLAGS: [&str; 6] = ["true", "false", "yes", "no", "0", "1"];
    let known = if says_solved(&column.key) {
        &FLAGS[..]
    } else {
        &FLAGS[..4]
    };
    column
        .cells
        .iter()
        .all(|cell| known.contains(&cell.text.to_lowercase().as_str()))
}
