//! What did not pass, with its reasons: the first thing to read, on the page, in Markdown and on the terminal.

use super::html::{escape, phrase};
use super::markdown::{anchor, cell, text};
use super::page::badge;
use crate::input::visible;
use crate::judge::verdict::Verdict;
use crate::run::Finished;
use crate::study::case::by_reason;
use crate::study::levels::COMPLETION;
use crate::study::outcome::Check;
use crate::text::number::{RATE_PLACES, plain_text, rate_text};

/// Reasons listed of one study; its section has all of them.
const MOST_REASONS: usize = 8;

/// A study that did not pass, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct NotPassed {
    /// Its id.
    pub id: String,
    /// Fail or inconclusive.
    pub verdict: Verdict,
    /// One line for each rate, check and case that did not pass; at least one.
    pub reasons: Vec<String>,
}

/// The studies that did not pass: failed ones first, then inconclusive ones.
pub fn not_passed(finished: &[Finished]) -> Vec<NotPassed> {
    let of = |verdict: Verdict| finished.iter().filter(move |finished| finished.outcome.verdict == verdict);
    of(Verdict::Fail).chain(of(Verdict::Inconclusive)).map(reasons).collect()
}

fn reasons(Finished { header, outcome, failed_cases, .. }: &Finished) -> NotPassed {
    let rates = outcome.rates.iter().filter(|(_, rate)| rate.verdict != Verdict::Pass).map(|(name, rate)| {
        match rate.interval {
            // The reason has the claim, too.
            Some(_) => format!("{name}: rate {}: {}", rate_text(rate.fitted), rate.reason),
            None => {
                let (found, order) = (rate.rate_in_words(RATE_PLACES), plain_text(rate.order));
                format!("{name}: {found}, claimed {order} ± {}: {}", plain_text(rate.tolerance), rate.reason)
            }
        }
    });
    // That cases are missing is said with their reasons.
    let is_said = |check: &Check| check.claim == COMPLETION && !failed_cases.is_empty();
    let checks = outcome.checks.iter().filter(|check| check.verdict != Verdict::Pass && !is_said(check));
    let checks = checks.map(|check| format!("{}: {}", check.claim, check.evidence));
    // What is missing first: rates and checks fail for it.
    let cases = by_reason(failed_cases.iter().map(|failed| (&*failed.label, &*failed.reason)));
    let cases = cases.into_iter().map(|line| format!("case {line}"));
    let mut reasons: Vec<String> = cases.chain(rates).chain(checks).collect();
    if reasons.is_empty() {
        reasons.push(outcome.summary.clone());
    }
    let more = reasons.len().saturating_sub(MOST_REASONS);
    if more > 0 {
        reasons.truncate(MOST_REASONS);
        reasons.push(format!("and {more} more"));
    }
    NotPassed { id: header.id.clone(), verdict: outcome.verdict, reasons }
}

/// The same in Markdown, under a heading; empty where everything passed.
///
/// * `linked`: whether each id is a link to the section of its study.
pub(super) fn markdown(finished: &[Finished], linked: bool) -> String {
    let studies = not_passed(finished);
    if studies.is_empty() {
        return String::new();
    }
    let mut lines = String::from("## What did not pass\n\n");
    for NotPassed { id, verdict, reasons } in studies {
        let name = if linked { format!("[{}](#{})", cell(&id), anchor(&id)) } else { cell(&id) };
        lines += &format!("- {name}: **{verdict}**\n");
        for reason in reasons {
            lines += &format!("  - {}\n", text(&reason));
        }
    }
    lines + "\n"
}

/// The same for the page, each id a link to the section of its study.
pub(super) fn html(finished: &[Finished]) -> String {
    let studies = not_passed(finished);
    if studies.is_empty() {
        return String::new();
    }
    let item = |NotPassed { id, verdict, reasons }: NotPassed| {
        let reasons: String = reasons.iter().map(|reason| format!("<li>{}</li>\n", phrase(reason))).collect();
        let id = escape(&id);
        format!("<li><a href=\"#{id}\">{id}</a> {}\n<ul>\n{reasons}</ul></li>\n", badge(verdict))
    };
    format!("<h2>What did not pass</h2>\n<ul>\n{}</ul>\n", studies.into_iter().map(item).collect::<String>())
}

/// The same in plain text; empty where everything passed.
pub fn text_of_failures(finished: &[Finished]) -> String {
    let line = |NotPassed { id, verdict, reasons }: NotPassed| {
        let reasons: String = reasons.iter().map(|reason| format!("  {}\n", visible(reason))).collect();
        format!("{id}: {verdict}\n{reasons}\n")
    };
    not_passed(finished).into_iter().map(line).collect()
}
