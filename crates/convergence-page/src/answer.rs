//! The answers to the page, as JSON.

use convergence_study::rates::{Page, TableOnPage};
use serde::Serialize;
use serde_json::{Value, json};

/// Why nothing is judged: the object of `rates --format json`.
#[derive(Debug, Clone, Serialize)]
#[serde(transparent)]
pub(crate) struct Refused(Value);

impl Refused {
    pub(crate) fn of(object: Value) -> Self {
        Self(object)
    }

    /// A refusal that names no place in the text.
    pub(crate) fn because(message: &str) -> Self {
        Self(json!({ "message": message }))
    }
}

/// How the tables of a text were read.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Read {
    tables: Vec<ReadTable>,
}

#[derive(Debug, Clone, Serialize)]
struct ReadTable {
    name: String,
    reading: String,
    rows: Vec<Vec<String>>,
}

impl Read {
    pub(crate) fn of(page: &Page) -> Self {
        let table = |table: &TableOnPage| ReadTable {
            name: table.name.clone(),
            reading: table.reading.clone(),
            rows: table.rows.clone(),
        };
        Self {
            tables: page.tables.iter().map(table).collect(),
        }
    }
}

/// What is found in the tables of a text.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct JudgedText {
    #[serde(flatten)]
    pub(crate) page: Page,
    /// The command that finds the same in a file.
    pub(crate) command: String,
}
