//! The report as one page that needs nothing else: no network, no other file. Without scripts it reads as well.
//!
//! Its elements are closed as XML wants it, so that tests can read it.

use super::Findings;
use super::html::{escape, html, phrase};
use super::words::key_numbers;
use super::{failures, forest, section};
use crate::judge::verdict::Verdict;
use crate::run::Finished;

const STYLE: &str = concat!(include_str!("page.css"), include_str!("picture.css"));
/// What makes pictures answer the pointer.
pub(super) const PICTURES: &str = include_str!("picture.js");
const SCRIPTS: [&str; 3] = [include_str!("page.js"), include_str!("sort.js"), PICTURES];

/// Nothing is loaded from anywhere, whatever a study's text holds.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

/// The page: verdicts first, then the studies, folded but for those that do not pass.
pub(super) fn page(findings: &Findings<'_>) -> String {
    let studies: String = findings.finished.iter().map(|finished| study(finished, &findings.again(finished))).collect();
    let title = format!("{}: verification report", findings.verdict);
    let body = format!("{}<main>\n{}{}{studies}</main>\n", head(findings), front(findings), overview(findings));
    document(&title, &body, &SCRIPTS)
}

/// A page around its body, with style and scripts.
///
/// * `title`: HTML.
pub(super) fn document(title: &str, body: &str, scripts: &[&str]) -> String {
    let scripts: String = scripts.iter().map(|script| format!("<script>\n{script}</script>\n")).collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"color-scheme\" content=\"light dark\"/>\n\
         <title>{title}</title>\n<link rel=\"icon\" href=\"data:,\"/>\n<style>\n{STYLE}</style>\n\
         </head>\n<body>\n{body}{scripts}</body>\n</html>\n",
    )
}

fn head(findings: &Findings<'_>) -> String {
    let mut head = format!(
        "<header>\n<h1>Verification report</h1>\n<p class=\"verdict\">{} {}</p>\n\
         <p>Written by <code>{}</code>, which repeats it. Orders are theory, rates are observed.",
        badge(findings.verdict),
        phrase(&findings.sentence()),
        escape(findings.command),
    );
    if let Some((title, folder)) = findings.see_also {
        head += &format!(" See also <a href=\"{}/index.html\">{}</a>.", escape(folder), phrase(title));
    }
    head += "</p>\n";
    if let Some(provenance) = findings.provenance {
        let sentences: Vec<String> = provenance.sentences().iter().map(|sentence| escape(sentence)).collect();
        head += &format!("<p class=\"provenance\">{}</p>\n", sentences.join(" "));
    }
    head + "</header>\n"
}

/// What did not pass, what moved, and all rates in one picture.
fn front(findings: &Findings<'_>) -> String {
    let figure = forest::figure(findings.project, findings.finished);
    let picture = figure.as_ref().map(section::figure).unwrap_or_default();
    let markdown = format!("{}\n{picture}", findings.moved());
    failures::html(findings.finished) + &html(&markdown, figure.as_slice())
}

pub(super) fn badge(verdict: Verdict) -> String {
    format!("<span class=\"badge {0}\">{0}</span>", verdict.name())
}

/// All verdicts in one table, below the controls, which scripts bring to life.
fn overview(findings: &Findings<'_>) -> String {
    let row = |Finished { header, outcome, .. }: &Finished| {
        format!(
            "<tr data-study=\"{id}\"><th scope=\"row\"><a href=\"#{id}\">{id}</a></th><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            badge(outcome.verdict),
            phrase(&key_numbers(outcome)),
            phrase(&header.claim),
            id = escape(&header.id),
        )
    };
    let rows: String = forest::grouped(findings.project, findings.finished)
        .into_iter()
        .flat_map(|(_, studies)| studies.into_iter().map(row))
        .collect();
    let options: String = [Verdict::Pass, Verdict::Inconclusive, Verdict::Fail]
        .map(|verdict| format!("<option>{}</option>", verdict.name()))
        .concat();
    format!(
        "<form class=\"controls\" role=\"search\" hidden=\"\">\n\
         <label>Filter <input type=\"search\" placeholder=\"name, claim or number\"/></label>\n\
         <label>Verdict <select><option value=\"\">any</option>{options}</select></label>\n\
         <button type=\"button\" data-unfold=\"true\">Unfold all</button>\n\
         <button type=\"button\" data-unfold=\"false\">Fold all</button>\n\
         <output aria-live=\"polite\"></output>\n</form>\n\
         <div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"All studies\">\n\
         <table class=\"overview\">\n<thead><tr><th>study</th><th>verdict</th><th>key numbers</th><th>claim</th></tr></thead>\n\
         <tbody>\n{rows}</tbody>\n</table>\n</div>\n"
    )
}

fn study(finished: &Finished, again: &str) -> String {
    let Finished { header, outcome, .. } = finished;
    let open = if outcome.verdict == Verdict::Pass { "" } else { " open=\"\"" };
    format!(
        "<details class=\"study\" id=\"{id}\" data-verdict=\"{}\"{open}>\n\
         <summary>{} <h2>{id}</h2> <span class=\"claim\">{}</span></summary>\n{}</details>\n",
        outcome.verdict.name(),
        badge(outcome.verdict),
        phrase(&header.claim),
        html(&section::body(finished, again), &outcome.figures),
        id = escape(&header.id),
    )
}
