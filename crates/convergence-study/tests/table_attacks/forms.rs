//! Tables made from laws, written in the forms that people use.

use std::fmt::Write;

/// A table as cells below names.
#[derive(Debug, Clone, Default)]
pub(super) struct Table {
    pub(super) names: Vec<String>,
    pub(super) rows: Vec<Vec<String>>,
}

/// Steps that are halved, and errors `c h^p` with some scatter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Law {
    /// The first step.
    pub(super) h: f64,
    pub(super) levels: usize,
    pub(super) order: f64,
    pub(super) constant: f64,
}

impl Law {
    pub(super) fn steps(self) -> Vec<f64> {
        (0..self.levels)
            .map(|k| self.h / f64::from(1 << k))
            .collect()
    }

    pub(super) fn errors(self) -> Vec<f64> {
        let steps = self.steps().into_iter().enumerate();
        steps
            .map(|(k, h)| {
                let scatter = 1.0 + 0.004 * [0.3, -0.6, 0.5, -0.2, 0.4][k % 5];
                self.constant * h.powf(self.order) * scatter
            })
            .collect()
    }
}

pub(super) fn cells(numbers: &[f64]) -> Vec<String> {
    numbers
        .iter()
        .map(|number| format!("{number:.6e}"))
        .collect()
}

impl Table {
    /// A step and the errors of a law.
    pub(super) fn of(law: Law) -> Self {
        Self::new("h", law, &[("L2", law.order)])
    }

    /// A table of a step and errors.
    pub(super) fn new(step: &str, law: Law, errors: &[(&str, f64)]) -> Self {
        let mut table = Self::default().with(step, cells(&law.steps()));
        for (k, (name, order)) in errors.iter().enumerate() {
            let law = Law {
                order: *order,
                constant: law.constant * (1.0 + k as f64),
                ..law
            };
            table = table.with(name, cells(&law.errors()));
        }
        table
    }

    /// The same with another column.
    pub(super) fn with(mut self, name: &str, cells: impl IntoIterator<Item: ToString>) -> Self {
        let cells = cells.into_iter().map(|cell| cell.to_string());
        if self.names.is_empty() {
            self.rows = cells.map(|cell| vec![cell]).collect();
        } else {
            let rows = self.rows.iter_mut().zip(cells);
            rows.for_each(|(row, cell)| row.push(cell));
        }
        self.names.push(name.to_owned());
        self
    }
}

/// How a table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Csv,
    Blanks,
    Markdown,
    Latex,
    Ruled,
    Log,
    LongLog,
    JsonLines,
    JsonLists,
    JsonRecords,
    Html,
}

impl Form {
    pub(super) const ALL: [Self; 11] = [
        Self::Csv,
        Self::Blanks,
        Self::Markdown,
        Self::Latex,
        Self::Ruled,
        Self::Log,
        Self::LongLog,
        Self::JsonLines,
        Self::JsonLists,
        Self::JsonRecords,
        Self::Html,
    ];

    pub(super) fn is_json(self) -> bool {
        matches!(self, Self::JsonLines | Self::JsonLists | Self::JsonRecords)
    }

    pub(super) fn write(self, table: &Table) -> String {
        let Table { names, rows } = table;
        let lines = |separator: &str, end: &str| {
            let lines = [names].into_iter().chain(rows);
            lines
                .map(|line| line.join(separator) + end + "\n")
                .collect::<Vec<_>>()
        };
        let blanks = |row: &Vec<String>| {
            let cells: Vec<String> = row.iter().map(|cell| format!("{cell:>14}")).collect();
            cells.join(" ") + "\n"
        };
        let pairs = |row: &[String], mark: &str, separator: &str| {
            let pairs = names.iter().zip(row);
            let pairs = pairs.map(|(name, cell)| format!("{name}{mark}{cell}"));
            pairs.collect::<Vec<_>>().join(separator)
        };
        let json = |row: &Vec<String>| {
            let cells = row.iter().map(|cell| quoted(cell));
            let pairs = pairs(&cells.collect::<Vec<_>>(), "\": ", ", \"");
            format!("{{\"{pairs}}}")
        };
        match self {
            Self::Csv => lines(",", "").concat(),
            Self::Latex => lines(" & ", " \\\\").concat(),
            Self::Blanks => blanks(names) + &rows.iter().map(blanks).collect::<String>(),
            Self::Ruled => {
                let rule = "-".repeat(15 * names.len()) + "\n";
                let rows = rows.iter().map(|row| blanks(row) + &rule);
                blanks(names) + &rule + &rows.collect::<String>()
            }
            Self::Markdown => {
                let mut lines = lines(" | ", " |");
                lines.insert(1, "---|".repeat(names.len()) + "\n");
                lines.iter().map(|line| format!("| {line}")).collect()
            }
            Self::Log => rows
                .iter()
                .map(|row| pairs(row, " = ", ", ") + "\n")
                .collect(),
            Self::LongLog => {
                let mut text = String::new();
                for (k, row) in rows.iter().enumerate() {
                    let _ = writeln!(text, "Cycle {k}\n  {}", pairs(row, " : ", "\n  "));
                }
                text
            }
            Self::Html => {
                let lines = lines("</td><td>", "</td></tr>").into_iter();
                let lines = lines.map(|line| format!("<tr><td>{line}"));
                format!("<table>\n{}</table>\n", lines.collect::<String>())
            }
            Self::JsonLines => rows.iter().map(|row| json(row) + "\n").collect(),
            Self::JsonRecords => {
                let rows: Vec<String> = rows.iter().map(json).collect();
                format!("[{}]\n", rows.join(", "))
            }
            Self::JsonLists => {
                let list = |k: usize| {
                    let cells: Vec<String> = rows.iter().map(|row| quoted(&row[k])).collect();
                    format!("\"{}\": [{}]", names[k], cells.join(", "))
                };
                let lists: Vec<String> = (0..names.len()).map(list).collect();
                format!("{{{}}}\n", lists.join(", "))
            }
        }
    }
}

/// A cell in JSON.
fn quoted(cell: &str) -> String {
    if cell.parse::<f64>().is_ok_and(f64::is_finite) || cell == "null" {
        cell.to_owned()
    } else {
        format!("\"{cell}\"")
    }
}
