//! Tables in Markdown: what is given and what is expected, a row a case.
//!
//! Programs of tests that may not depend on this crate include this file.

/// The cells of each row of the first table of a text, below its head.
///
/// # Panics
/// The text has no table, or a row has another number of cells.
pub fn rows<const N: usize>(text: &str) -> Vec<[&str; N]> {
    let (_, below) = text.split_once("\n|--").expect("a head");
    let lines = below.lines().skip(1);
    let lines = lines.take_while(|line| line.starts_with('|'));
    lines.map(cells).collect()
}

fn cells<const N: usize>(line: &str) -> [&str; N] {
    let inside = line
        .strip_prefix('|')
        .and_then(|rest| rest.strip_suffix('|'));
    let cells: Vec<&str> = inside.expect(line).split('|').map(str::trim).collect();
    cells
        .try_into()
        .unwrap_or_else(|cells| panic!("expected {N} cells, found {cells:?}"))
}
