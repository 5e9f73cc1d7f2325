//! Cells aligned in columns, for the terminal and for the source of Markdown alike.

/// Widths of the columns of a table, in characters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Columns {
    widths: Vec<usize>,
    numeric: Vec<bool>,
}

impl Columns {
    /// Measures a table: the head gives the number of columns; a column that holds only numbers is
    /// aligned right.
    pub fn of(head: &[String], rows: &[Vec<String>]) -> Self {
        let mut widths = vec![];
        let mut numeric = vec![];
        for (i, title) in head.iter().enumerate() {
            let mut cells = rows.iter().filter_map(|row| row.get(i));
            let texts = cells.clone().chain([title]);
            widths.push(texts.map(|text| text.chars().count()).max().unwrap_or(0));
            numeric.push(!rows.is_empty() && cells.all(|cell| is_number(cell)));
        }
        Self { widths, numeric }
    }

    /// Number of columns.
    pub fn count(&self) -> usize {
        self.widths.len()
    }

    /// Width of a column.
    pub fn width(&self, column: usize) -> usize {
        self.widths[column]
    }

    /// Whether a column is aligned right.
    pub fn is_numeric(&self, column: usize) -> bool {
        self.numeric[column]
    }

    /// The cells of a row, padded to the widths; one per column.
    pub fn pad<'r>(&'r self, row: &'r [String]) -> impl Iterator<Item = String> + 'r {
        (0..self.count()).map(|i| {
            let cell = row.get(i).map_or("", String::as_str);
            let width = self.widths[i];
            if self.numeric[i] {
                format!("{cell:>width$}")
            } else {
                format!("{cell:<width$}")
            }
        })
    }
}

/// Numbers, and the dash that stands for one.
fn is_number(cell: &str) -> bool {
    cell.is_empty() || cell == "-" || cell.parse::<f64>().is_ok()
}
