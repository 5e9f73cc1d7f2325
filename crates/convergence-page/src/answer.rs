//! What the page is told.

use convergence_harness::judge::verdict::Verdict;
use convergence_harness::rates::{ColumnSheet, Sheet, TableSheet};
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
    pub(crate) fn of(sheet: &Sheet) -> Self {
        let table = |table: &TableSheet| ReadTable {
            name: table.name.clone(),
            reading: table.reading.clone(),
            rows: table.rows.clone(),
        };
        Self {
            tables: sheet.tables.iter().map(table).collect(),
        }
    }
}

/// What is found in the tables of a text.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Judged {
    verdict: &'static str,
    sentence: String,
    /// What `rates` prints.
    text: String,
    /// For an issue, or a message.
    markdown: String,
    /// The command that finds the same in a file.
    command: String,
    tables: Vec<JudgedTable>,
    /// What `rates --format json` prints.
    object: Value,
}

#[derive(Debug, Clone, Serialize)]
struct JudgedTable {
    name: String,
    reading: String,
    rows: Vec<Vec<String>>,
    legend: String,
    columns: Vec<JudgedColumn>,
    figure: String,
}

#[derive(Debug, Clone, Serialize)]
struct JudgedColumn {
    name: String,
    verdict: Option<&'static str>,
    answer: String,
    advice: String,
}

impl Judged {
    pub(crate) fn of(sheet: Sheet, command: String) -> Self {
        Self {
            verdict: sheet.verdict.name(),
            sentence: sheet.sentence,
            text: sheet.text,
            markdown: sheet.markdown,
            command,
            tables: sheet.tables.into_iter().map(JudgedTable::of).collect(),
            object: sheet.object,
        }
    }
}

impl JudgedTable {
    fn of(table: TableSheet) -> Self {
        Self {
            name: table.name,
            reading: table.reading,
            rows: table.rows,
            legend: table.legend,
            columns: table.columns.into_iter().map(JudgedColumn::of).collect(),
            figure: table.figure,
        }
    }
}

impl JudgedColumn {
    fn of(column: ColumnSheet) -> Self {
        Self {
            name: column.name,
            verdict: column.verdict.map(Verdict::name),
            answer: column.answer,
            advice: column.advice,
        }
    }
}
