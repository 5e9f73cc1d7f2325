//! What did not pass, and why: the first thing to read, on the page, in Markdown and on the
//! terminal; and the known facts about the cause.

use super::html::{badge, escape, phrase};
use super::markdown::{anchor, cell, text};
use super::section::folded;
use crate::input::visible;
use crate::rates::REASONS;
use crate::run::{Finished, Item, NotPassed, not_passed};
use crate::store::{Record, diagnosis::Diagnosis};

/// Most items listed of one study; its section has all of them.
const MOST_ITEMS: usize = 8;

/// Most items of one study, and most pieces of advice, on a terminal, which shows only the clearest
/// failures.
const MOST_ON_TERMINAL: usize = 2;

const TITLE: &str = "what fails and what does not";

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

/// The studies that did not pass, the clearest first.
struct ClearestFirst<'f> {
    /// Those to show.
    first: Vec<NotPassed<'f>>,
    /// Those to fold.
    rest: Vec<NotPassed<'f>>,
}

impl<'f> ClearestFirst<'f> {
    fn of(record: &'f Record) -> Self {
        let mut first = not_passed(&record.studies);
        let mut rest = vec![];
        if let Some(Diagnosis { clearest, .. }) = &record.diagnosis {
            first.sort_by_key(|study| place(clearest, study).unwrap_or(usize::MAX));
            rest = first.split_off(clearest.len().min(first.len()));
        }
        Self { first, rest }
    }
}

/// The place of a study among the clearest.
fn place(clearest: &[String], study: &NotPassed<'_>) -> Option<usize> {
    clearest.iter().position(|id| id == study.id())
}

/// The same in Markdown, under a heading; empty if everything passed.
///
/// * `linked`: whether each id is a link to the section of its study.
pub(super) fn markdown(record: &Record, linked: bool) -> String {
    let ClearestFirst { first, rest } = ClearestFirst::of(record);
    if first.is_empty() {
        return String::new();
    }
    let title = "## What did not pass";
    let first = list_in_markdown(&first, linked);
    if rest.is_empty() {
        return format!("{title}\n\n{first}\n");
    }
    let summary = format!("{} more", rest.len());
    let folded = folded(&summary, &list_in_markdown(&rest, linked), false);
    format!("{title}\n\n{first}\n{folded}\n")
}

fn list_in_markdown(studies: &[NotPassed<'_>], linked: bool) -> String {
    studies
        .iter()
        .map(|study| in_markdown(study, linked))
        .collect()
}

fn in_markdown(study: &NotPassed<'_>, linked: bool) -> String {
    let id = cell(study.id());
    let name = if linked {
        format!("[{id}](#{})", anchor(study.id()))
    } else {
        id
    };
    let lines: String = lines(study)
        .iter()
        .map(|line| format!("  - {}\n", text(line)))
        .collect();
    format!("- {name}: **{}**\n{lines}", study.verdict())
}

/// The same for the page, each id a link to the section of its study.
pub(super) fn html(record: &Record) -> String {
    let ClearestFirst { first, rest } = ClearestFirst::of(record);
    if first.is_empty() {
        return String::new();
    }
    let first = format!("<h2>What did not pass</h2>\n{}", list_in_html(&first));
    if rest.is_empty() {
        return first;
    }
    format!(
        "{first}<details>\n<summary>{} more</summary>\n{}</details>\n",
        rest.len(),
        list_in_html(&rest)
    )
}

fn list_in_html(studies: &[NotPassed<'_>]) -> String {
    let items: String = studies.iter().map(in_html).collect();
    format!("<ul>\n{items}</ul>\n")
}

fn in_html(study: &NotPassed<'_>) -> String {
    let lines: String = lines(study)
        .iter()
        .map(|line| format!("<li>{}</li>\n", phrase(line)))
        .collect();
    let id = escape(study.id());
    format!(
        "<li><a href=\"#{id}\">{id}</a> {}\n<ul>\n{lines}</ul></li>\n",
        badge(study.verdict())
    )
}

/// The same in plain text; empty if everything passed.
///
/// * `clearest`: the studies to show, with their first items; `None` for all studies with all of
///   them.
pub fn text_of_failures(finished: &[Finished], clearest: Option<&[String]>) -> String {
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

/// The known facts about the cause, line by line under a title.
pub fn text_of_diagnosis(diagnosis: &Diagnosis) -> String {
    let mut lines = format!("{TITLE}\n");
    for (word, text) in diagnosis.lines() {
        lines += &format!("  {word:<10} {}\n", visible(&text));
    }
    lines
}

/// The same in Markdown; empty if nothing fails.
pub(super) fn diagnosis_in_markdown(diagnosis: Option<&Diagnosis>) -> String {
    let Some(diagnosis) = diagnosis else {
        return String::new();
    };
    let mut lines = format!("## {TITLE}\n\n");
    for (word, words) in diagnosis.lines() {
        lines += &format!("- **{word}**: {}\n", text(&words));
    }
    lines + "\n"
}
