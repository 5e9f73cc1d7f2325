//! What a page shows of the tables of a text.

use serde_json::{Value, json};

use super::forms::{doubts, markdown, object_of_all, plain_verdict, verdict_in_markdown};
use super::shown::{advice_of_claim, sentence_of_all, text_of_all};
use super::{Judgement, figure, verdict_of};
use crate::exchange;

/// The object of [`Request::page`](super::Request::page).
pub(super) fn page(findings: &[Judgement<'_>]) -> Value {
    let verdict = verdict_of(findings);
    let mut pages: Vec<String> = findings.iter().map(|one| markdown(one, "")).collect();
    pages.extend(verdict_in_markdown(findings));
    json!({
        "verdict": verdict,
        "sentence": sentence_of_all(findings),
        "text": text_of_all(findings, false, plain_verdict),
        "markdown": pages.join("\n"),
        "object": exchange::object(verdict, &object_of_all(findings)),
        "tables": findings.iter().map(table).collect::<Vec<_>>(),
    })
}

fn table(judgement: &Judgement<'_>) -> Value {
    let table = &judgement.source.table;
    let columns = judgement.columns.iter().map(|judged| {
        json!({
            "name": judged.column.name,
            "verdict": judged.claim.map(|_| judged.rate.verdict),
            "answer": judged.answer(),
            "advice": advice_of_claim(judgement, judged).unwrap_or_default(),
        })
    });
    json!({
        "name": judgement.source.name,
        "reading": table.reading,
        "doubts": doubts(table),
        "rows": judgement.rows(),
        "legend": judgement.legend(),
        "columns": columns.collect::<Vec<_>>(),
        "figure": figure(judgement),
    })
}
