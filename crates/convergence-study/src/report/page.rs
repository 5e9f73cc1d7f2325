//! The report as one self-contained page: no network, no other file. It reads as well without
//! scripts.
//!
//! Its elements are closed as in XML, so that tests can parse it.

use super::html::{badge, escape, html, phrase};
use super::words::key_numbers;
use super::{Findings, changes, failures, forest, section};
use crate::judge::verdict::Verdict;
use crate::run::{Finished, not_passed};

/// Most failing studies that are unfolded; more would fill screens.
const OPEN: usize = 3;

const STYLE: &str = concat!(include_str!("page.css"), include_str!("picture.css"));
const SCRIPTS: [&str; 3] = [
    include_str!("page.js"),
    include_str!("sort.js"),
    include_str!("picture.js"),
];

/// Nothing is loaded from anywhere, whatever a study's text contains.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

/// The page: verdicts first, then the studies, all folded except those that do not pass.
pub(super) fn page(findings: &Findings<'_>) -> String {
    let groups = groups(findings);
    let finished = groups.iter().flat_map(|(_, studies)| studies);
    let mut studies = String::new();
    // Those that do not pass come first: the first of them are open.
    for (k, finished) in finished.enumerate() {
        studies += &study(finished, &findings.command_for(finished), k < OPEN);
    }
    let scripts: String = SCRIPTS
        .iter()
        .map(|script| format!("<script>\n{script}</script>\n"))
        .collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"color-scheme\" content=\"light dark\"/>\n\
         <title>{}: verification report</title>\n<link rel=\"icon\" href=\"data:,\"/>\n<style>\n{STYLE}</style>\n\
         </head>\n<body>\n{}<main>\n{}{}{studies}</main>\n{scripts}</body>\n</html>\n",
        findings.record.verdict,
        head(findings),
        front(findings),
        overview(&groups),
    )
}

fn head(findings: &Findings<'_>) -> String {
    format!(
        "<header>\n<h1>Verification report</h1>\n<p class=\"verdict\">{} {}</p>\n</header>\n",
        badge(findings.record.verdict),
        phrase(&findings.sentence()),
    )
}

/// What did not pass, what changed, the origin of the report, and the widest intervals in one
/// picture.
fn front(findings: &Findings<'_>) -> String {
    let changes = changes::changes(findings, &|id| findings.link(id, id)).concat();
    let picture = findings
        .rates()
        .map(|figure| html(&section::figure(&figure), &[figure]));
    let verified = section::front(findings, &|id| findings.link(id, id));
    html(&findings.diagnosis(), &[])
        + &failures::html(findings.record)
        + &html(&changes, &[])
        + &html(&verified.markdown, &verified.figures)
        + &origin(findings)
        + &picture.unwrap_or_default()
}

/// What wrote the report, which other report exists, and its commit, day and machine.
fn origin(findings: &Findings<'_>) -> String {
    let mut origin = format!(
        "<p>Written by <code>{}</code>, which repeats it. Orders are theory, rates are observed.",
        escape(&findings.record.command)
    );
    if let Some(page) = findings.see_also {
        origin += &format!(
            " See also <a href=\"{}\">the report on the full tier</a>.",
            escape(page)
        );
    }
    origin += "</p>\n";
    if let Some(provenance) = findings.provenance {
        let sentences: Vec<String> = provenance
            .sentences()
            .iter()
            .map(|sentence| escape(sentence))
            .collect();
        origin += &format!("<p class=\"provenance\">{}</p>\n", sentences.join(" "));
    }
    origin
}

/// Studies with their group, in the order of the page: those that did not pass, then the others by
/// the property they claim.
fn groups<'f>(findings: &Findings<'f>) -> Vec<(&'f str, Vec<&'f Finished>)> {
    let failing = not_passed(&findings.record.studies);
    let failing = failing.iter().map(|failing| failing.study).collect();
    let mut groups = vec![("did not pass", failing)];
    for (label, mut studies) in forest::grouped(findings.project, &findings.record.studies) {
        studies.retain(|study| study.outcome.verdict == Verdict::Pass);
        groups.push((label, studies));
    }
    groups.retain(|(_, studies)| !studies.is_empty());
    groups
}

/// All verdicts in one table, below the controls, which need scripts.
fn overview(groups: &[(&str, Vec<&Finished>)]) -> String {
    let mut rows = String::new();
    for (label, studies) in groups {
        rows += &format!(
            "<tr class=\"group\"><th colspan=\"4\" scope=\"rowgroup\">{}</th></tr>\n",
            phrase(label)
        );
        rows.extend(studies.iter().map(|study| row(study)));
    }
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

/// The row of a study in the table of all verdicts.
fn row(
    Finished {
        header, outcome, ..
    }: &Finished,
) -> String {
    format!(
        "<tr data-study=\"{id}\"><th scope=\"row\"><a href=\"#{id}\">{id}</a></th><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        badge(outcome.verdict),
        phrase(&key_numbers(outcome)),
        phrase(&header.claim),
        id = escape(&header.id),
    )
}

/// The section of a study.
///
/// * `command`: runs it again.
fn study(finished: &Finished, command: &str, open: bool) -> String {
    let Finished {
        header, outcome, ..
    } = finished;
    let open = if outcome.verdict == Verdict::Pass || !open {
        ""
    } else {
        " open=\"\""
    };
    format!(
        "<details class=\"study\" id=\"{id}\" data-verdict=\"{}\"{open}>\n\
         <summary>{} <h2>{id}</h2> <span class=\"claim\">{}</span></summary>\n{}</details>\n",
        outcome.verdict.name(),
        badge(outcome.verdict),
        phrase(&header.claim),
        html(&section::body(finished, command), &outcome.figures),
        id = escape(&header.id),
    )
}
