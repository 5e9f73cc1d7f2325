//! Names with lists of numbers: each list is a column.

use super::super::cell::{is_failure, is_number, plain};
use super::super::grid::Grid;
use super::super::names::{key, says_rates};
use super::lines::Lines;

/// A name, and the numbers behind it.
pub(super) struct List {
    pub(super) name: String,
    pub(super) cells: Vec<String>,
}

/// The table of the lists with the most numbers, and of rates, which are one fewer; for each list
/// whether it is a column.
pub(super) fn table(lists: Vec<List>) -> (Grid, Vec<bool>) {
    let rows = lists.iter().map(|list| list.cells.len()).max().unwrap_or(0);
    let mut grid = Grid {
        rows: vec![vec![]; rows],
        ..Grid::default()
    };
    let mut is_column = vec![];
    for List { name, mut cells } in lists {
        if cells.len() + 1 == rows && says_rates(&key(&name)) {
            cells.insert(0, "-".to_owned());
        }
        is_column.push(cells.len() == rows);
        if cells.len() == rows {
            grid.names.push(name);
            let cells = grid.rows.iter_mut().zip(cells);
            cells.for_each(|(row, cell)| row.push(cell));
        }
    }
    (grid, is_column)
}

/// Finds the lists of unused lines, `L2 = [0.1, 0.025]`, and marks their lines as used.
pub(super) fn find(lines: &mut Lines<'_>) -> Option<Grid> {
    let lists = lines
        .unused()
        .filter_map(|(k, line)| Some((k, list(line)?)));
    let (at, lists): (Vec<usize>, Vec<List>) = lists.unzip();
    let (grid, is_column) = table(lists);
    let at = at.into_iter().zip(is_column).filter(|(_, is)| *is);
    let at: Vec<usize> = at.map(|(line, _)| line).collect();
    let lines = lines.take(&at)?;
    Some(Grid {
        lines: Some(lines),
        ..grid
    })
}

/// A list without the types that NumPy prints: `[np.float64(0.1), np.float64(0.2)]`,
/// `array([0.1, 0.2])`.
fn without_types(list: &str) -> String {
    let inside = list.strip_prefix("np.").unwrap_or(list);
    let inside = inside.strip_prefix("array(");
    let inside = inside.and_then(|inside| inside.strip_suffix(')'));
    let mut parts = inside.unwrap_or(list).split("np.float64(");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + &part.replacen(')', "", 1))
}

fn list(line: &str) -> Option<List> {
    let (name, list) = line.split_once(['=', ':'])?;
    let list = without_types(list.trim());
    let list = list.strip_prefix(['[', '('])?;
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
