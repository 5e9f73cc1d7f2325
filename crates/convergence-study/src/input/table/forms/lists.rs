//! Names with lists of numbers: each list is a column.

use super::super::cell::{is_failure, is_number, plain};
use super::super::grid::Grid;
use super::super::names::{key, says_rates};
use super::lines::{Block, Lines};

/// A name, and the numbers behind it.
pub(super) struct List {
    pub(super) name: String,
    pub(super) cells: Vec<String>,
}

/// The table of the lists with the most numbers, and of rates, which are one fewer; for each list
/// whether it is a column.
pub(super) fn table(lists: Vec<List>) -> Option<(Grid, Vec<bool>)> {
    let count = lists.iter().map(|list| list.cells.len()).max()?;
    let are_rates = |list: &List| list.cells.len() + 1 == count && says_rates(&key(&list.name));
    let is_column = |list: &List| list.cells.len() == count || are_rates(list);
    let taken: Vec<bool> = lists.iter().map(is_column).collect();
    let mut grid = Grid {
        rows: vec![vec![]; count],
        ..Grid::default()
    };
    for list in lists.into_iter().filter(is_column) {
        let first = (list.cells.len() < count).then(|| "-".to_owned());
        let cells = first.into_iter().chain(list.cells);
        grid.rows
            .iter_mut()
            .zip(cells)
            .for_each(|(row, cell)| row.push(cell));
        grid.names.push(list.name);
    }
    Some((grid, taken))
}

/// Finds the lists of unused lines, `L2 = [0.1, 0.025]`, and marks their lines as used.
pub(super) fn find(lines: &mut Lines<'_>) -> Option<Block> {
    let mut at = vec![];
    let mut lists = vec![];
    for (k, line) in lines
        .text
        .iter()
        .enumerate()
        .filter(|(k, _)| !lines.used[*k])
    {
        if let Some(list) = list(line) {
            at.push(k);
            lists.push(list);
        }
    }
    let (grid, taken) = table(lists)?;
    let at: Vec<usize> = at
        .into_iter()
        .zip(taken)
        .filter_map(|(k, is_taken)| is_taken.then_some(k))
        .collect();
    at.iter().for_each(|line| lines.used[*line] = true);
    Some(Block { grid, lines: at })
}

fn list(line: &str) -> Option<List> {
    let (name, list) = line.split_once(['=', ':'])?;
    let list = list.trim().strip_prefix(['[', '('])?;
    let (list, behind) = list.split_once([']', ')'])?;
    let behind = behind.trim_start_matches([',', ';', ' ']);
    let name = plain(name);
    let is_name = name.starts_with(char::is_alphabetic) && !name.contains([',', '(', '[']);
    let cells = list.split([',', ' ', '\t']).filter(|cell| !cell.is_empty());
    let cells: Vec<String> = cells.map(str::to_owned).collect();
    let are_numbers = cells.iter().all(|cell| is_number(cell) || is_failure(cell));
    let is_end = behind.is_empty() || behind.starts_with(['#', '%']);
    (is_name && is_end && are_numbers && cells.len() > 1).then_some(List { name, cells })
}
