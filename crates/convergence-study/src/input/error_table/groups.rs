//! The tables of one grid: a column of groups parts its rows, such as `p` or `method`, and so does
//! a step that returns. Without them the rows may come in any order.

use std::collections::HashMap;

use super::Choice;
use super::columns::{Cells, sign};
use super::grid::RawTable;
use super::names::{self, Word};
use super::number::is_dash;
use super::reader;

/// Rows of a grid that are a table.
pub(super) struct Group<'t> {
    /// What its rows share, as in `p = 2`; empty for all rows of a grid.
    pub(super) heading: String,
    pub(super) columns: Vec<Cells<'t>>,
}

/// Columns of a grid that are a table.
pub(super) struct Side<'t> {
    /// The name above them; empty for all columns of a grid.
    pub(super) heading: String,
    pub(super) table: RawTable<'t>,
}

/// The groups of columns as tables, if each has a step of its own.
pub(super) fn side_by_side<'t>(table: &RawTable<'t>, choice: &Choice) -> Vec<Side<'t>> {
    let columns: Vec<usize> = (0..table.groups.len()).collect();
    let groups: Vec<&[usize]> = columns
        .chunk_by(|a, b| table.groups[*a] == table.groups[*b])
        .collect();
    let word = |k: usize| Word::of(&names::without_markup(table.names[k]));
    let has_step = |group: &&[usize]| {
        let mut words = group.iter().map(|k| word(*k));
        words.any(|word| matches!(word, Word::Step | Word::Count(_)))
    };
    if choice.names.is_some()
        || groups.len() < 2
        || !table.is_even()
        || !groups.iter().all(has_step)
    {
        return vec![Side {
            heading: String::new(),
            table: table.clone(),
        }];
    }
    // Only the error needs the name of its group.
    let own_name = |k: usize| match word(k) {
        Word::Error => table.groups[k],
        _ => "",
    };
    let side = |group: &&[usize]| Side {
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
pub(super) fn below_each_other<'t>(grid: Group<'t>, choice: &Choice) -> Vec<Group<'t>> {
    if grid.rows() < 2 {
        return vec![grid];
    }
    let is_group = |column: &Cells<'_>| {
        let is_degree =
            names::is_group(&column.name) && column.values.iter().all(|value| value.fract() == 0.0);
        repeats(column) && (is_words(column) || is_degree)
    };
    let keys: Vec<usize> = (0..grid.columns.len())
        .filter(|k| is_group(&grid.columns[*k]))
        .collect();
    let groups = if keys.is_empty() {
        vec![grid]
    } else {
        grid.by_cells(&keys)
    };
    let groups = groups.into_iter();
    groups.flat_map(|group| group.by_steps(choice)).collect()
}

impl Group<'_> {
    fn rows(&self) -> usize {
        self.columns[0].texts.len()
    }

    /// Some rows with a heading of their own, behind that of all.
    fn part(&self, heading: &str, rows: &[usize]) -> Self {
        let heading = match self.heading.as_str() {
            "" => heading.to_owned(),
            all => format!("{all}, {heading}"),
        };
        let columns = self.columns.iter().map(|column| column.select(rows));
        Self {
            heading,
            columns: columns.collect(),
        }
    }

    /// The rows with the same cells in these columns, in the order of their first row.
    fn by_cells(&self, keys: &[usize]) -> Vec<Self> {
        let keys: Vec<&Cells<'_>> = keys.iter().map(|k| &self.columns[*k]).collect();
        let mut places: HashMap<Vec<&str>, usize> = HashMap::new();
        let mut groups: Vec<Vec<usize>> = vec![];
        for row in 0..self.rows() {
            let cells: Vec<&str> = keys.iter().map(|column| column.texts[row]).collect();
            let place = *places.entry(cells).or_insert(groups.len());
            if place == groups.len() {
                groups.push(vec![]);
            }
            groups[place].push(row);
        }
        let group = |rows: &Vec<usize>| {
            let cells = keys.iter();
            let cells = cells.map(|column| format!("{} = {}", column.name, column.texts[rows[0]]));
            self.part(&cells.collect::<Vec<_>>().join(", "), rows)
        };
        groups.iter().map(group).collect()
    }

    /// Parts the rows where a step returns.
    fn by_steps(self, choice: &Choice) -> Vec<Self> {
        let chosen = choice.step.as_deref();
        let chosen = chosen.and_then(|step| reader::position(&self.columns, step));
        let is_step = |k: usize| {
            let Cells { name, word, .. } = &self.columns[k];
            let has_name = matches!(word, Word::Step | Word::Count(_)) || names::is_level(name);
            (has_name || chosen == Some(k)) && self.columns[k].has_all_numbers()
        };
        let steps: Vec<&Cells<'_>> = (0..self.columns.len())
            .filter(|k| is_step(*k))
            .map(|k| &self.columns[k])
            .collect();
        let has_repetition = steps.iter().any(|step| repeats(step));
        let steps = if steps.is_empty() {
            let first = self.columns.iter().take(1);
            first.filter(|column| column.has_all_numbers()).collect()
        } else {
            steps
        };
        let starts = returns(&steps, self.rows());
        if !has_repetition && !are_tables(&starts, self.rows()) || starts.len() == 1 {
            return vec![self];
        }
        let ends = starts.iter().copied().skip(1).chain([self.rows()]);
        let runs = starts.iter().zip(ends).enumerate();
        let runs = runs.map(|(k, (start, end))| {
            let rows: Vec<usize> = (*start..end).collect();
            self.part(&format!("table {}", k + 1), &rows)
        });
        runs.collect()
    }
}

/// Whether a column holds words that are neither states nor missing numbers.
fn is_words(column: &Cells<'_>) -> bool {
    let mut cells = column.texts.iter();
    column.values.iter().all(|value| value.is_nan())
        && cells
            .all(|cell| !is_dash(cell) && names::state(cell).is_none() && !names::is_failure(cell))
}

/// Whether some cells of a column come again, and not all.
fn repeats(column: &Cells<'_>) -> bool {
    let mut cells = column.texts.clone();
    cells.sort_unstable();
    cells.dedup();
    (2..column.texts.len()).contains(&cells.len())
}

/// The rows at which a step returns: it has fallen and grows again, or the other way round.
fn returns(steps: &[&Cells<'_>], rows: usize) -> Vec<usize> {
    let mut starts = vec![0];
    let mut directions = vec![0.0; steps.len()];
    for row in 1..rows {
        let change = |step: &Cells<'_>| sign(step.values[row] - step.values[row - 1]);
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
