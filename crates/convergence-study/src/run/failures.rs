//! What did not pass, and why, as one list: terminal, Markdown, page, JUnit and JSON print it.

use std::cmp::Reverse;
use std::collections::HashSet;
use std::mem::{Discriminant, discriminant};

use serde::Serialize;

use super::Finished;
use crate::study::kind::cases_in_words;
use crate::study::{Check, NamedRate};
use crate::text::lists::grouped;
use convergence_judge::verdict::{Cause, Reason, Tendency, Verdict};

/// Something that a study judged, in words.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Item {
    /// What was judged: the name of a test case.
    #[serde(rename = "item")]
    pub name: String,
    /// Its verdict.
    pub verdict: Verdict,
    /// Why it has its verdict.
    pub why: String,
    /// The code of its reason, under which the book says more: rates have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub code: Option<&'static str>,
    /// What its reason means, and what to do: for rates that do not pass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub advice: Option<String>,
    /// All of it in a line.
    #[serde(skip)]
    pub line: String,
    /// Whether it says no more than that something is missing.
    #[serde(skip)]
    is_about_completion: bool,
}

impl Item {
    pub(crate) fn new(name: impl Into<String>, verdict: Verdict, why: impl Into<String>) -> Self {
        let [name, why] = [name.into(), why.into()];
        Self {
            line: format!("{name}: {why}"),
            name,
            verdict,
            why,
            code: None,
            advice: None,
            is_about_completion: false,
        }
    }

    fn of_rate(NamedRate { name, rate, .. }: &NamedRate) -> Self {
        let order = rate.order().map(|order| format!(": order {order}"));
        let item = format!("{name}{}", order.unwrap_or_default());
        let why = rate.line();
        let code = rate.code.name();
        Self {
            line: format!("{name}: {why} ({code})"),
            code: Some(code),
            advice: rate.advice(),
            ..Self::new(item, rate.verdict, why)
        }
    }

    fn of_check(check: &Check) -> Self {
        Self {
            is_about_completion: check.is_completion,
            ..Self::new(check.statement(), check.verdict, check.evidence.to_string())
        }
    }
}

/// Everything that a study judged: rates, then checks, then the study itself if none of them says
/// why it does not pass.
pub(crate) fn items(Finished { outcome, .. }: &Finished) -> Vec<Item> {
    let rates = outcome.rates.iter().map(Item::of_rate);
    let mut items: Vec<Item> = rates
        .chain(outcome.checks.iter().map(Item::of_check))
        .collect();
    if !outcome.verdict.is_pass() && items.iter().all(|item| item.verdict.is_pass()) {
        let why = outcome.summary.to_string();
        items.push(Item {
            line: why.clone(),
            is_about_completion: true,
            ..Item::new("verdict", outcome.verdict, why)
        });
    }
    items
}

/// What did not pass of a study: first cases without a result, together if for the same reason,
/// because they make rates and checks fail.
pub(crate) fn items_not_passed(study: &Finished) -> Vec<Item> {
    if study.outcome.verdict.is_pass() {
        return vec![];
    }
    let cases = study.failed_cases.iter();
    let cases = grouped(cases.map(|failed| (failed.reason.as_str(), failed.label.as_str())));
    let mut not_passed = vec![];
    for (reason, labels) in cases {
        let name = format!("case {}", cases_in_words(&labels));
        not_passed.push(Item::new(name, Verdict::Fail, reason));
    }
    let mut judged = items(study);
    // Cases without a result say why by themselves.
    judged.retain(|item| {
        !item.verdict.is_pass() && (not_passed.is_empty() || !item.is_about_completion)
    });
    not_passed.append(&mut judged);
    not_passed
}

/// What the errors of a study tend to, or what the reasons of its rates that do not pass mean,
/// each once, then what their causes are. Of errors that tend to several constants the first is
/// given.
pub(crate) fn advice(study: &Finished) -> Vec<String> {
    let rates = study.outcome.rates.iter().map(|named| &named.rate);
    let rates: Vec<_> = rates.filter(|rate| !rate.verdict.is_pass()).collect();
    let mut advice = vec![];
    for reason in Reason::all() {
        let of_reason = rates.iter().filter(|rate| rate.code == reason);
        let tendencies = of_reason.map(|rate| (rate.tendency.map(kind_of), rate.tendency));
        for (_, alike) in grouped(tendencies) {
            let words = alike[0].map_or_else(|| reason.advice().to_owned(), Tendency::advice);
            advice.push(format!("{}: {words}", reason.name()));
        }
    }
    for cause in Cause::ALL {
        if rates.iter().any(|rate| rate.cause == Some(cause)) {
            advice.push(cause.advice().to_owned());
        }
    }
    advice
}

/// The tendency without its numbers.
fn kind_of(tendency: Tendency) -> Discriminant<Tendency> {
    discriminant(&tendency)
}

/// The studies that did not pass: failed ones first, then inconclusive ones, and last those that
/// did not pass because others did not.
pub(crate) fn not_passed(finished: &[Finished]) -> Vec<&Finished> {
    let all = finished.iter();
    let mut studies: Vec<_> = all
        .filter(|study| !study.outcome.verdict.is_pass())
        .collect();
    let ids: HashSet<&str> = studies.iter().map(|study| &*study.header.id).collect();
    studies.sort_by_key(|study| (names_another(study, &ids), Reverse(study.outcome.verdict)));
    studies
}

/// Whether a check that does not pass is about another study that does not pass.
fn names_another(study: &Finished, ids: &HashSet<&str>) -> bool {
    let checks = study.outcome.checks.iter();
    let failing = checks.filter(|check| !check.verdict.is_pass());
    let mut cases = failing.filter_map(|check| check.subject.case.as_deref());
    cases.any(|id| id != study.header.id && ids.contains(id))
}
