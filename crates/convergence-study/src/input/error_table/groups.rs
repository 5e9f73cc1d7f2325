//! The tables of one grid: a column of groups parts its rows, such as `p` or `method`, and so does
//! a step that returns. Without them the rows may come in any order.

use std::collections::HashMap;

use super::Choice;
use super::names::{self, Word};
use super::number::{is_dash, number};
use super::pairs::{ColumnName, RawTable};
use super::text::counts_rows;

/// Rows of a grid that are a table.
pub(super) struct Group<'t> {
    /// What its rows share, as in `p = 2`; empty for all rows of a grid.
    pub(super) heading: String,
    pub(super) table: RawTable<'t>,
}

/// A column of a grid.
struct Column<'t> {
    name: String,
    word: Word,
    cells: Vec<&'t str>,
    /// NaN without a number.
    values: Vec<f64>,
}

impl Column<'_> {
    fn is_number(&self) -> bool {
        self.values.iter().all(|value| !value.is_nan())
    }

    fn is_whole(&self) -> bool {
        self.values.iter().all(|value| value.fract() == 0.0)
    }

    /// Whether it holds words that are neither states nor missing numbers.
    fn is_words(&self) -> bool {
        let mut cells = self.cells.iter();
        self.values.iter().all(|value| value.is_nan())
            && cells.all(|cell| {
                !is_dash(cell) && names::state(cell).is_none() && !names::is_failure(cell)
            })
    }

    fn distinct(&self) -> usize {
        let mut cells = self.cells.clone();
        cells.sort_unstable();
        cells.dedup();
        cells.len()
    }

    /// Whether some of its cells come again, and not all.
    fn repeats(&self) -> bool {
        (2..self.cells.len()).contains(&self.distinct())
    }

    /// Whether it is a step, a count or a level, by its name.
    fn is_step(&self) -> bool {
        (matches!(self.word, Word::Step | Word::Count(_)) || names::is_level(&self.name))
            && self.is_number()
    }
}

/// The tables of a grid: those side by side, each with steps of its own, and those below each other.
pub(super) fn split<'t>(table: &RawTable<'t>, choice: &Choice) -> Vec<Group<'t>> {
    let side_by_side = side_by_side(table, choice);
    let tables = side_by_side
        .into_iter()
        .flat_map(|side| with_heading(&side.heading, below_each_other(&side.table, choice)));
    tables.collect()
}

/// The groups of columns as tables, if each has a step of its own.
fn side_by_side<'t>(table: &RawTable<'t>, choice: &Choice) -> Vec<Group<'t>> {
    let columns: Vec<usize> = (0..table.groups.len()).collect();
    let groups: Vec<&[usize]> = columns
        .chunk_by(|a, b| table.groups[*a] == table.groups[*b])
        .collect();
    let has_step = |group: &&[usize]| {
        let mut words = group
            .iter()
            .map(|k| Word::of(&names::without_markup(table.names[*k])));
        words.any(|word| matches!(word, Word::Step | Word::Count(_)))
    };
    let is_even = table.rows.iter().all(|row| row.len() == table.names.len());
    if choice.names.is_some() || groups.len() < 2 || !is_even || !groups.iter().all(has_step) {
        return vec![Group {
            heading: String::new(),
            table: table.clone(),
        }];
    }
    // Only the error needs the name of its group.
    let own_name = |k: usize| match Word::of(&names::without_markup(table.names[k])) {
        Word::Error => table.groups[k],
        _ => "",
    };
    let side = |group: &&[usize]| Group {
        heading: names::without_markup(table.groups[group[0]]),
        table: RawTable {
            names: group.iter().map(|k| table.names[*k]).collect(),
            groups: group.iter().map(|k| own_name(*k)).collect(),
            rows: table
                .rows
                .iter()
                .map(|row| group.iter().map(|k| row[*k]).collect())
                .collect(),
            ..table.clone()
        },
    };
    groups.iter().map(side).collect()
}

/// The tables of rows with the same cells in the columns of groups, parted where a step returns.
fn below_each_other<'t>(table: &RawTable<'t>, choice: &Choice) -> Vec<Group<'t>> {
    let all = Group {
        heading: String::new(),
        table: table.clone(),
    };
    let width = table.names.len();
    if table.rows.len() < 2 || table.rows.iter().any(|row| row.len() != width) {
        return vec![all];
    }
    let columns = columns(table, choice);
    let is_group = |column: &&Column<'_>| {
        let is_degree = names::is_group(&column.name) && column.is_number() && column.is_whole();
        column.repeats() && (column.is_words() || is_degree)
    };
    let keys: Vec<&Column<'_>> = columns.iter().filter(is_group).collect();
    let groups = if keys.is_empty() {
        vec![all]
    } else {
        by_cells(table, &keys)
    };
    let groups = groups.into_iter();
    groups.flat_map(|group| by_steps(group, choice)).collect()
}

/// The columns of a grid, with the names that the user has chosen.
fn columns<'t>(table: &RawTable<'t>, choice: &Choice) -> Vec<Column<'t>> {
    let names = choice
        .names
        .as_deref()
        .filter(|names| names.len() == table.names.len());
    let column = |(k, ColumnName { name, word }): (usize, ColumnName)| {
        let cells: Vec<&str> = table.rows.iter().map(|row| row[k]).collect();
        let value =
            |cell: &&str| number(cell, table.decimal_comma).map_or(f64::NAN, |number| number.value);
        let is_chosen = choice
            .step
            .as_deref()
            .is_some_and(|step| step == name || step == (k + 1).to_string());
        Column {
            word: if is_chosen { Word::Step } else { word },
            values: cells.iter().map(value).collect(),
            name,
            cells,
        }
    };
    table
        .column_names(names)
        .into_iter()
        .enumerate()
        .map(column)
        .collect()
}

/// The rows with the same cells in these columns, in the order of their first row.
fn by_cells<'t>(table: &RawTable<'t>, keys: &[&Column<'t>]) -> Vec<Group<'t>> {
    let mut places: HashMap<Vec<&str>, usize> = HashMap::new();
    let mut groups: Vec<Group<'t>> = vec![];
    for (k, row) in table.rows.iter().enumerate() {
        let cells: Vec<&str> = keys.iter().map(|column| column.cells[k]).collect();
        let place = *places.entry(cells).or_insert(groups.len());
        if place == groups.len() {
            let names = keys
                .iter()
                .map(|column| format!("{} = {}", column.name, column.cells[k]));
            groups.push(Group {
                heading: names.collect::<Vec<_>>().join(", "),
                table: RawTable {
                    rows: vec![],
                    ..table.clone()
                },
            });
        }
        groups[place].table.rows.push(row.clone());
    }
    groups
}

/// Parts a grid where a step returns; by another column if each of its numbers has each step once.
fn by_steps<'t>(group: Group<'t>, choice: &Choice) -> Vec<Group<'t>> {
    let columns = columns(&group.table, choice);
    let steps: Vec<&Column<'_>> = columns.iter().filter(|column| column.is_step()).collect();
    let has_repetition = steps.iter().any(|step| step.repeats());
    let is_key = |column: &&Column<'_>| {
        !column.is_step()
            && !matches!(column.word, Word::Error | Word::Rate)
            && column.is_number()
            && column.repeats()
            && !steps.is_empty()
            && steps.iter().all(|step| is_once_in_each(column, step))
    };
    if has_repetition && let Some(key) = columns.iter().find(is_key) {
        return with_heading(&group.heading, by_cells(&group.table, &[key]));
    }
    let first = columns
        .iter()
        .take(1)
        .filter(|column| column.is_number() && !counts_rows(&column.cells));
    let steps = if steps.is_empty() {
        first.collect()
    } else {
        steps
    };
    let starts = returns(&steps, group.table.rows.len());
    if !has_repetition && !are_tables(&starts, group.table.rows.len()) {
        return vec![group];
    }
    let ends = starts
        .iter()
        .copied()
        .skip(1)
        .chain([group.table.rows.len()]);
    let runs = starts
        .iter()
        .zip(ends)
        .enumerate()
        .map(|(k, (start, end))| Group {
            heading: format!("table {}", k + 1),
            table: RawTable {
                rows: group.table.rows[*start..end].to_vec(),
                ..group.table.clone()
            },
        });
    let runs: Vec<Group<'_>> = runs.collect();
    if runs.len() == 1 {
        vec![group]
    } else {
        with_heading(&group.heading, runs)
    }
}

/// Groups with what stands above them.
fn with_heading<'t>(heading: &str, mut groups: Vec<Group<'t>>) -> Vec<Group<'t>> {
    if !heading.is_empty() {
        for group in &mut groups {
            let own = std::mem::take(&mut group.heading);
            let headings = [heading, &own];
            let headings: Vec<&str> = headings
                .into_iter()
                .filter(|heading| !heading.is_empty())
                .collect();
            group.heading = headings.join(", ");
        }
    }
    groups
}

/// Whether the rows with one number of a column have each step once, and are several.
fn is_once_in_each(key: &Column<'_>, step: &Column<'_>) -> bool {
    let mut pairs: Vec<(&str, &str)> = key
        .cells
        .iter()
        .copied()
        .zip(step.cells.iter().copied())
        .collect();
    pairs.sort_unstable();
    let are_distinct = pairs.windows(2).all(|two| two[0] != two[1]);
    are_distinct && pairs.chunk_by(|a, b| a.0 == b.0).all(|rows| rows.len() > 1)
}

/// The rows at which a step returns: it has fallen and grows again, or the other way round.
fn returns(steps: &[&Column<'_>], rows: usize) -> Vec<usize> {
    let mut starts = vec![0];
    let mut directions = vec![0.0; steps.len()];
    for row in 1..rows {
        let change = |step: &Column<'_>| match step.values[row] - step.values[row - 1] {
            0.0 => 0.0,
            change => change.signum(),
        };
        let changes: Vec<f64> = steps.iter().map(|step| change(step)).collect();
        if changes
            .iter()
            .zip(&directions)
            .any(|(change, direction)| change * direction < 0.0)
        {
            starts.push(row);
            directions.fill(0.0);
            continue;
        }
        for (direction, change) in directions.iter_mut().zip(changes) {
            if change != 0.0 {
                *direction = change;
            }
        }
    }
    starts
}

/// Whether runs of rows are tables rather than rows in any order: each has two rows and one has
/// three, or two have three.
fn are_tables(starts: &[usize], rows: usize) -> bool {
    let ends = starts.iter().copied().skip(1).chain([rows]);
    let lengths: Vec<usize> = starts
        .iter()
        .zip(ends)
        .map(|(start, end)| end - start)
        .collect();
    let long = lengths.iter().filter(|length| **length > 2).count();
    lengths.len() > 1 && (long > 1 || long == 1 && lengths.iter().all(|length| *length > 1))
}
