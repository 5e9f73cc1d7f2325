//! Shares, counted row by row.

/// Shares of one subject.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Its name in a study.
    pub key: &'static str,
    /// What it is.
    pub title: String,
    /// The rows, which have the same columns.
    pub rows: Vec<SheetRow>,
}

/// A row of a [`Sheet`]: what is counted, under the heads of the columns.
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
    sum: f64,
    of: usize,
}

impl SheetRow {
    /// A row of which nothing is counted yet.
    pub(crate) fn new(name: impl Into<String>, declared: bool, columns: &[impl ToString]) -> Self {
        let mut cells = vec![];
        for column in columns {
            cells.push(SheetCell {
                column: column.to_string(),
                sum: 0.0,
                of: 0,
            });
        }
        Self {
            name: name.into(),
            declared,
            cells,
        }
    }

    /// Counts whether something was true.
    pub(crate) fn count(&mut self, column: &str, hit: bool) {
        self.add(column, f64::from(hit));
    }

    /// Counts a number instead of 0 or 1: the share is then a mean.
    ///
    /// # Panics
    /// If the row was made without this column.
    pub(crate) fn add(&mut self, column: &str, number: f64) {
        let cell = self.cells.iter_mut().find(|cell| cell.column == column);
        let cell = cell.unwrap_or_else(|| unreachable!("the row has no column {column}"));
        cell.sum += number;
        cell.of += 1;
    }

    /// The number in a column; `None` if the sheet has no such column.
    pub fn value(&self, column: &str) -> Option<f64> {
        let cell = self.cells.iter().find(|cell| cell.column == column)?;
        Some(cell.value())
    }
}

impl SheetCell {
    /// A share, or the mean of what was added; NaN if nothing was counted.
    pub fn value(&self) -> f64 {
        self.sum / self.of as f64
    }

    /// Puts a number in place of what was counted.
    pub fn set(&mut self, value: f64) {
        self.sum = value;
        self.of = 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_of_nothing_is_none() {
        let mut row = SheetRow::new("", true, &["hits", "mean"]);
        assert!(row.cells.iter().all(|cell| cell.value().is_nan()));
        for hit in [true, false, false, true, true] {
            row.count("hits", hit);
        }
        row.add("mean", 3.0);
        row.add("mean", 4.0);
        assert_eq!(
            ["hits", "mean", "none"].map(|column| row.value(column)),
            [Some(0.6), Some(3.5), None]
        );
    }
}
