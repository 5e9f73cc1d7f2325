//! What did not pass, and why, as one list: terminal, Markdown, page, JUnit and JSON print it.

use std::cmp::Reverse;
use std::collections::HashSet;
use std::fmt;
use std::mem::{Discriminant, discriminant};

use super::Finished;
use crate::judge::verdict::{Cause, RateVerdict, Reason, Tendency, Verdict};
use crate::study::kind::cases_in_words;
use crate::study::{Check, NamedRate, Outcome};
use crate::text::lists::grouped;

/// Something that a study judged; [`Display`](fmt::Display) gives it in a line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Item<'f> {
    /// Cases that have no result for the same reason.
    Cases {
        /// Their labels; at least one.
        labels: Vec<&'f str>,
        /// The reason.
        reason: &'f str,
    },
    /// A rate.
    Rate {
        /// Its name.
        name: &'f str,
        /// Its judgement.
        rate: &'f RateVerdict,
    },
    /// Anything else that was judged.
    Check(&'f Check),
    /// The study itself, where no item says why it does not pass.
    Study(&'f Outcome),
}

impl Item<'_> {
    /// Its verdict.
    pub(crate) fn verdict(&self) -> Verdict {
        match self {
            Item::Cases { .. } => Verdict::Fail,
            Item::Rate { rate, .. } => rate.verdict,
            Item::Check(check) => check.verdict,
            Item::Study(outcome) => outcome.verdict,
        }
    }

    /// What was judged: the name of a test case.
    pub(crate) fn name(&self) -> String {
        match self {
            Item::Cases { labels, .. } => format!("case {}", cases_in_words(labels)),
            Item::Rate { name, rate } => match rate.order() {
                Some(order) => format!("{name}: order {order}"),
                None => (*name).to_owned(),
            },
            Item::Check(check) => check.statement(),
            Item::Study(_) => "verdict".to_owned(),
        }
    }

    /// Why it has its verdict.
    pub(crate) fn why(&self) -> String {
        match self {
            Item::Cases { reason, .. } => (*reason).to_owned(),
            Item::Rate { rate, .. } => rate.line(),
            Item::Check(check) => check.evidence.to_string(),
            Item::Study(outcome) => outcome.summary.to_string(),
        }
    }

    /// Whether it says no more than that something is missing.
    fn is_about_completion(&self) -> bool {
        match self {
            Item::Check(check) => check.is_completion,
            Item::Study(_) => true,
            Item::Cases { .. } | Item::Rate { .. } => false,
        }
    }

    /// The code of its reason, under which the book says more: rates have one.
    pub(crate) fn code(&self) -> Option<&'static str> {
        match self {
            Item::Rate { rate, .. } => Some(rate.code.name()),
            _ => None,
        }
    }

    /// What its reason means, and what to do: for rates that do not pass.
    pub(crate) fn advice(&self) -> Option<String> {
        match self {
            Item::Rate { rate, .. } => rate.advice(),
            _ => None,
        }
    }
}

impl fmt::Display for Item<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reason = self.why();
        match self {
            Item::Rate { name, rate } => write!(f, "{name}: {reason} ({})", rate.code.name()),
            Item::Study(_) => f.write_str(&reason),
            Item::Cases { .. } | Item::Check(_) => write!(f, "{}: {reason}", self.name()),
        }
    }
}

/// Everything that a study judged: cases without a result first, because they make rates and
/// checks fail, then rates, then checks.
pub(crate) fn items(finished: &Finished) -> Vec<Item<'_>> {
    let outcome = &finished.outcome;
    let cases = finished.failed_cases.iter();
    let cases = grouped(cases.map(|failed| (failed.reason.as_str(), failed.label.as_str())));
    let cases = cases
        .into_iter()
        .map(|(reason, labels)| Item::Cases { labels, reason });
    let rates = outcome
        .rates
        .iter()
        .map(|NamedRate { name, rate, .. }| Item::Rate { name, rate });
    let judged: Vec<Item<'_>> = rates
        .chain(outcome.checks.iter().map(Item::Check))
        .collect();
    // A study may be worse than its items, or may have none.
    let is_worse = !outcome.verdict.is_pass() && judged.iter().all(|item| item.verdict().is_pass());
    let study = is_worse.then_some(Item::Study(outcome));
    cases.chain(judged).chain(study).collect()
}

/// A study that did not pass.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NotPassed<'f> {
    /// The study.
    pub study: &'f Finished,
    /// What did not pass of it; at least one item.
    pub items: Vec<Item<'f>>,
}

impl<'f> NotPassed<'f> {
    /// What did not pass of a study; `None` for one that passes.
    pub(crate) fn of(study: &'f Finished) -> Option<Self> {
        if study.outcome.verdict.is_pass() {
            return None;
        }
        let mut items = items(study);
        items.retain(|item| !item.verdict().is_pass());
        // Cases without a result say why by themselves.
        if !study.failed_cases.is_empty() {
            items.retain(|item| !item.is_about_completion());
        }
        Some(Self { study, items })
    }

    /// Its id.
    pub(crate) fn id(&self) -> &'f str {
        &self.study.header.id
    }

    /// Fail or inconclusive.
    pub(crate) fn verdict(&self) -> Verdict {
        self.study.outcome.verdict
    }

    /// What the errors tend to, or what the reasons of its rates mean, each once, then what their
    /// causes are. Of errors that tend to several constants the first is given.
    pub(crate) fn advice(&self) -> Vec<String> {
        let mut rates = vec![];
        for item in &self.items {
            if let Item::Rate { rate, .. } = item {
                rates.push(*rate);
            }
        }
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
}

/// The tendency without its numbers.
fn kind_of(tendency: Tendency) -> Discriminant<Tendency> {
    discriminant(&tendency)
}

/// The studies that did not pass: failed ones first, then inconclusive ones, and last those that
/// did not pass because others did not.
pub(crate) fn not_passed(finished: &[Finished]) -> Vec<NotPassed<'_>> {
    let mut studies: Vec<NotPassed<'_>> = finished.iter().filter_map(NotPassed::of).collect();
    let ids: HashSet<&str> = studies.iter().map(NotPassed::id).collect();
    studies.sort_by_key(|study| (names_another(study, &ids), Reverse(study.verdict())));
    studies
}

/// Whether a check that does not pass is about another study that does not pass.
fn names_another(not_passed: &NotPassed<'_>, ids: &HashSet<&str>) -> bool {
    let checks = &not_passed.study.outcome.checks;
    let failing = checks.iter().filter(|check| !check.verdict.is_pass());
    let mut cases = failing.filter_map(|check| check.subject.case.as_deref());
    cases.any(|id| id != not_passed.id() && ids.contains(id))
}
