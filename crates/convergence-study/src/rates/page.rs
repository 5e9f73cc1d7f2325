//! What a page shows of the tables of a text.

use serde::Serialize;
use serde_json::Value;

use super::forms::{doubts, markdown, object_of_all, plain_verdict, verdict_in_markdown};
use super::shown::{advice_of_claim, sentence_of_all, text_of_all};
use super::{JudgedColumn, Judgement, figure, verdict_of};
use crate::exchange;
use convergence_judge::verdict::Verdict;

/// What a page shows of the tables of a text.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Page {
    /// The worst verdict of the tables.
    pub verdict: Verdict,
    /// The verdict in a sentence.
    pub sentence: String,
    /// What `rates` prints.
    pub text: String,
    /// The same as `rates.md` has it, without pictures.
    pub markdown: String,
    /// What `rates --format json` prints.
    pub object: Value,
    /// The tables in the order of the text.
    pub tables: Vec<TableOnPage>,
}

/// What a page shows of a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TableOnPage {
    /// Its heading, if the text has several tables; otherwise the name of the text.
    pub name: String,
    /// How it was read.
    pub reading: String,
    /// What speaks against it, each as an object with the settings that remove it.
    pub doubts: Vec<Value>,
    /// Steps, errors and rates as text: the names, then a row for each level.
    pub rows: Vec<Vec<String>>,
    /// The meaning of the marks in the rows, a line for each.
    pub legend: String,
    /// What is found of each column.
    pub columns: Vec<ColumnOnPage>,
    /// Errors over steps, as SVG.
    pub figure: String,
}

/// What a page shows of a column.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ColumnOnPage {
    /// The name of the column.
    pub name: String,
    /// Its verdict; `None` if nothing is claimed.
    pub verdict: Option<Verdict>,
    /// Rate, claim, and the reason unless it is a pass.
    pub answer: String,
    /// What the reason means, and what to do; empty for a pass, and where nothing is claimed.
    pub advice: String,
}

impl Page {
    pub(super) fn of(findings: &[Judgement<'_>]) -> Self {
        let verdict = verdict_of(findings);
        let mut pages: Vec<String> = findings.iter().map(|one| markdown(one, "")).collect();
        pages.extend(verdict_in_markdown(findings));
        Self {
            verdict,
            sentence: sentence_of_all(findings),
            text: text_of_all(findings, false, plain_verdict),
            markdown: pages.join("\n"),
            object: exchange::object(verdict, &object_of_all(findings)),
            tables: findings.iter().map(TableOnPage::of).collect(),
        }
    }
}

impl TableOnPage {
    fn of(judgement: &Judgement<'_>) -> Self {
        let table = &judgement.source.table;
        let column = |judged: &JudgedColumn<'_>| ColumnOnPage {
            name: judged.column.name.clone(),
            verdict: judged.claim.map(|_| judged.rate.verdict),
            answer: judged.answer(),
            advice: advice_of_claim(judged, &table.step).unwrap_or_default(),
        };
        Self {
            name: judgement.source.name.clone(),
            reading: table.reading.clone(),
            doubts: doubts(table),
            rows: judgement.rows(),
            legend: judgement.legend(),
            columns: judgement.columns.iter().map(column).collect(),
            figure: figure(judgement),
        }
    }
}
