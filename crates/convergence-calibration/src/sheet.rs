//! Shares that were counted, row by row.

/// Shares of one subject.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Its name in a study file.
    pub key: &'static str,
    /// What it is.
    pub title: String,
    /// The rows, which have the same columns.
    pub rows: Vec<SheetRow>,
}

/// A row of a [`Sheet`].
#[derive(Debug, Clone, PartialEq)]
pub struct SheetRow {
    /// Its name.
    pub name: String,
    /// Whether the rule answers for it.
    pub declared: bool,
    /// What was counted.
    pub cells: Vec<SheetCell>,
}

/// A number of a [`SheetRow`].
#[derive(Debug, Clone, PartialEq)]
pub struct SheetCell {
    /// What is counted: the head of the column.
    pub column: String,
    /// A share, or the median of a length; NaN if nothing was counted.
    pub value: f64,
}

impl Sheet {
    /// The heads of the columns.
    pub fn columns(&self) -> Vec<&str> {
        let cells = self.rows.first().into_iter().flat_map(|row| &row.cells);
        cells.map(|cell| cell.column.as_str()).collect()
    }

    /// The row with this name.
    pub fn row(&self, name: &str) -> Option<&SheetRow> {
        self.rows.iter().find(|row| row.name == name)
    }
}

impl SheetRow {
    pub(crate) fn new(name: impl Into<String>, declared: bool, cells: Vec<SheetCell>) -> Self {
        let name = name.into();
        Self {
            name,
            declared,
            cells,
        }
    }

    /// The number in a column; `None` if the sheet has no such column.
    pub fn value(&self, column: &str) -> Option<f64> {
        let cell = self.cells.iter().find(|cell| cell.column == column)?;
        Some(cell.value)
    }
}

/// How often something was true.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct HitShare {
    hits: usize,
    of: usize,
}

impl HitShare {
    pub(crate) fn count(&mut self, hit: bool) {
        self.add(usize::from(hit));
    }

    /// Counts a number instead of 0 or 1: the share is then a mean.
    pub(crate) fn add(&mut self, number: usize) {
        self.hits += number;
        self.of += 1;
    }

    /// NaN if nothing was counted.
    fn value(self) -> f64 {
        self.hits as f64 / self.of as f64
    }

    /// The share under the head of its column.
    pub(crate) fn cell(self, column: impl Into<String>) -> SheetCell {
        SheetCell {
            column: column.into(),
            value: self.value(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_of_nothing_is_none() {
        assert!(HitShare::default().value().is_nan());
    }
}
