//! What did not pass, and why, on the terminal; and the known facts about the cause.

use crate::input::visible;
use crate::rates::REASONS;
use crate::run::{Finished, advice, items_not_passed, not_passed};
use crate::store::diagnosis::Diagnosis;

/// Most items of one study; its section on the page has all of them.
const MOST_ITEMS: usize = 8;

/// The same where only the clearest failures are shown.
const MOST_OF_CLEAREST: usize = 2;

const TITLE: &str = "what the failures share";

/// What did not pass, and what that means; empty if everything passed.
///
/// * `clearest`: the studies to show, with their first items; `None` for all studies.
pub(crate) fn text_of_failures(finished: &[Finished], clearest: Option<&[String]>) -> String {
    let mut studies = not_passed(finished);
    if let Some(clearest) = clearest {
        let place = |study: &Finished| clearest.iter().position(|id| *id == study.header.id);
        studies.retain(|study| place(study).is_some());
        studies.sort_by_key(|study| place(study));
    }
    let most = clearest.map_or(MOST_ITEMS, |_| MOST_OF_CLEAREST);
    let mut text = String::new();
    let mut told: Vec<String> = vec![];
    for study in studies {
        text += &format!("{}: {}\n", study.header.id, study.outcome.verdict);
        let items = items_not_passed(study);
        let more = items.len().saturating_sub(most);
        let mut lines: Vec<String> = items.into_iter().take(most).map(|item| item.line).collect();
        if more > 0 {
            lines.push(format!("and {more} more"));
        }
        // Of many studies that fail alike, the first says what that means.
        let mut advice = advice(study);
        advice.retain(|words| !told.contains(words));
        told.extend_from_slice(&advice);
        lines.append(&mut advice);
        for line in lines {
            text += &format!("  {}\n", visible(&line));
        }
    }
    if !told.is_empty() {
        text += &format!("every reason, and what to try: {REASONS}\n");
    }
    text
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
