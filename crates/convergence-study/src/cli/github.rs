//! For GitHub Actions: the job summary, and annotations for what did not pass. Elsewhere nothing is
//! written.

use std::env;
use std::fs::File;
use std::io::{self, Write};

use crate::report::{Changes, Findings, summary};
use crate::store;
use crate::text::visible::{self, visible};
use convergence_judge::verdict::Verdict;

use super::screen::{self, Format};

/// Appends the table to the job summary and annotates what did not pass.
///
/// * `format`: if standard output is one JSON object, the annotations go to standard error; GitHub
///   reads both.
pub(super) fn announce(findings: &Findings<'_>, format: Format) {
    summarise(|| findings.digest());
    if env::var_os("GITHUB_ACTIONS").is_some_and(|value| value == "true") {
        let annotations = annotations(findings);
        // If a stream is closed, annotations cannot be shown.
        let _ = if format == Format::Json {
            io::stderr().write_all(annotations.as_bytes())
        } else {
            screen::print_as_is(&annotations)
        };
    }
}

/// Appends Markdown to the job summary, if there is one.
///
/// A summary that cannot be written is reported on standard error; it does not change the exit
/// status.
pub(super) fn summarise(markdown: impl FnOnce() -> io::Result<String>) {
    let Some(page) = env::var_os("GITHUB_STEP_SUMMARY").filter(|path| !path.is_empty()) else {
        return;
    };
    let appended = markdown().and_then(|markdown| {
        let mut file = store::open(page.as_ref(), File::options().append(true).create(true))?;
        file.write_all(markdown.as_bytes())
    });
    if let Err(error) = appended {
        screen::complain(&format!(
            "GITHUB_STEP_SUMMARY={}: cannot write the job summary: {error}",
            visible::path(page.as_ref())
        ));
    }
}

fn annotations(findings: &Findings<'_>) -> String {
    let bad = findings
        .record
        .studies
        .iter()
        .filter(|finished| finished.outcome.verdict != Verdict::Pass);
    let studies = bad.map(|finished| {
        let outcome = &finished.outcome;
        annotation(
            &format!("{}: {}", finished.header.id, outcome.verdict),
            &summary(outcome),
        )
    });
    let mut changes = Changes::of(findings, true);
    if changes.is_first {
        changes.claims.push(findings.sentence());
    }
    let changes = changes.claims.iter().chain(&changes.numbers);
    let changes = changes.map(|change| annotation("baseline", change));
    capped(studies.chain(changes).collect())
}

/// GitHub shows this many annotations of a step and silently drops the others.
const SHOWN: usize = 10;

/// At most as many as are shown; the last one says how many more there are.
fn capped(mut annotations: Vec<String>) -> String {
    if annotations.len() > SHOWN {
        let more = annotations.split_off(SHOWN - 1).len();
        annotations.push(annotation(
            "and more",
            &format!("{more} more: see the summary of this job and the report"),
        ));
    }
    annotations.concat()
}

fn annotation(title: &str, message: &str) -> String {
    let title = escaped(title).replace(':', "%3A").replace(',', "%2C");
    format!("::error title={title}::{}\n", escaped(message))
}

/// One line, in the encoding of GitHub Actions.
fn escaped(text: &str) -> String {
    visible(
        &text
            .replace('%', "%25")
            .replace('\r', "%0D")
            .replace('\n', "%0A"),
    )
}

#[cfg(test)]
mod tests {
    use super::annotation;

    #[test]
    fn an_annotation_stays_on_its_line() {
        let line = annotation("a: fail, so", "50 %\n::warning::x\x1b[31m");
        assert_eq!(
            line,
            "::error title=a%3A fail%2C so::50 %25%0A::warning::x\u{fffd}[31m\n"
        );
    }
}
