//! What did not pass, and why, on the terminal; and the known facts about the cause.

use crate::input::visible;
use crate::rates::REASONS;
use crate::run::{Finished, Item, NotPassed, not_passed};
use crate::store::diagnosis::Diagnosis;

/// Most items listed of one study; its section has all of them.
const MOST_ITEMS: usize = 8;

/// Most items of one study, and most pieces of advice, on a terminal, which shows only the clearest
/// failures.
const MOST_ON_TERMINAL: usize = 2;

const TITLE: &str = "what the failures share";

/// What did not pass of a study, and what that means, line by line.
fn lines(study: &NotPassed<'_>) -> Vec<String> {
    let items = study.items.iter().take(MOST_ITEMS);
    let mut lines: Vec<String> = items.map(Item::to_string).collect();
    let more = study.items.len().saturating_sub(MOST_ITEMS);
    if more > 0 {
        lines.push(format!("and {more} more"));
    }
    lines.extend(study.advice());
    lines
}

/// The place of a study among the clearest.
fn place(clearest: &[String], study: &NotPassed<'_>) -> Option<usize> {
    clearest.iter().position(|id| id == study.id())
}

/// What did not pass; empty if everything passed.
///
/// * `clearest`: the studies to show, with their first items; `None` for all studies with all of
///   them.
pub(crate) fn text_of_failures(finished: &[Finished], clearest: Option<&[String]>) -> String {
    let mut studies = not_passed(finished);
    let has_reasons = studies.iter().any(|study| !study.advice().is_empty());
    let page = has_reasons.then(|| format!("every reason, and what to try: {REASONS}\n"));
    let page = page.unwrap_or_default();
    let Some(clearest) = clearest else {
        let texts = studies
            .iter()
            .map(|study| in_text(study, &lines(study)) + "\n");
        return texts.collect::<String>() + &page;
    };
    studies.retain(|study| place(clearest, study).is_some());
    studies.sort_by_key(|study| place(clearest, study));
    let items: String = studies
        .iter()
        .map(|study| in_text(study, &first_items(study)))
        .collect();
    let mut advice: Vec<String> = vec![];
    for first in studies
        .iter()
        .filter_map(|study| study.advice().into_iter().next())
    {
        if advice.len() < MOST_ON_TERMINAL && !advice.contains(&first) {
            advice.push(first);
        }
    }
    let advice = advice.iter().map(|advice| visible(advice) + "\n");
    items + &advice.collect::<String>() + &page
}

fn in_text(study: &NotPassed<'_>, lines: &[String]) -> String {
    let lines = lines.iter().map(|line| format!("  {}\n", visible(line)));
    format!(
        "{}: {}\n{}",
        study.id(),
        study.verdict(),
        lines.collect::<String>()
    )
}

/// The first items, the last of them with how many more there are.
fn first_items(study: &NotPassed<'_>) -> Vec<String> {
    let mut lines: Vec<String> = study
        .items
        .iter()
        .take(MOST_ON_TERMINAL)
        .map(Item::to_string)
        .collect();
    let more = study.items.len().saturating_sub(MOST_ON_TERMINAL);
    if let Some(last) = lines.last_mut().filter(|_| more > 0) {
        *last += &format!("; and {more} more");
    }
    lines
}

/// The known facts about the cause, line by line under a title; empty without any.
pub(crate) fn text_of_diagnosis(diagnosis: &Diagnosis) -> String {
    let facts = diagnosis.lines();
    if facts.is_empty() {
        return String::new();
    }
    let mut lines = format!("{TITLE}\n");
    for (word, text) in facts {
        lines += &format!("  {word:<8} {}\n", visible(&text));
    }
    lines
}
