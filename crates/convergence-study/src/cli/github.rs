//! For GitHub Actions: the job summary, and annotations for what did not pass. Elsewhere nothing is written.

use std::env;
use std::fs::File;
use std::io::Write;

use crate::judge::verdict::Verdict;
use crate::report::Findings;
use crate::store::regular;
use crate::text::visible::{self, visible};

use crate::cli::output;

/// Appends the table to the job summary and annotates what did not pass.
pub(super) fn announce(findings: &Findings<'_>) {
    summarise(&findings.digest());
    if env::var_os("GITHUB_ACTIONS").is_some_and(|value| value == "true") {
        // Where standard output is closed, annotations cannot be shown.
        let _ = output::print_as_is(&annotations(findings));
    }
}

/// Appends Markdown to the job summary.
///
/// A summary that cannot be written is reported on standard error; it does not change the exit status.
pub(super) fn summarise(markdown: &str) {
    if let Some(page) = env::var_os("GITHUB_STEP_SUMMARY").filter(|path| !path.is_empty()) {
        let file = regular::open(page.as_ref(), File::options().append(true).create(true));
        if let Err(error) = file.and_then(|mut file| file.write_all(markdown.as_bytes())) {
            output::complain(&format!(
                "GITHUB_STEP_SUMMARY={}: cannot write the job summary: {error}",
                visible::path(page.as_ref())
            ));
        }
    }
}

fn annotations(findings: &Findings<'_>) -> String {
    let bad = findings.finished.iter().filter(|finished| finished.outcome.verdict != Verdict::Pass);
    let studies = bad.map(|finished| {
        let outcome = &finished.outcome;
        annotation(&format!("{}: {}", finished.header.id, outcome.verdict), &outcome.summary)
    });
    studies.chain(findings.moves().iter().map(|change| annotation("baseline", &change.to_string()))).collect()
}

fn annotation(title: &str, message: &str) -> String {
    let title = escaped(title).replace(':', "%3A").replace(',', "%2C");
    format!("::error title={title}::{}\n", escaped(message))
}

/// One line, in the encoding of GitHub Actions.
fn escaped(text: &str) -> String {
    visible(&text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A"))
}

#[cfg(test)]
mod tests {
    use super::annotation;

    #[test]
    fn an_annotation_stays_on_its_line() {
        let line = annotation("a: fail, so", "50 %\n::warning::x\x1b[31m");
        assert_eq!(line, "::error title=a%3A fail%2C so::50 %25%0A::warning::x\u{fffd}[31m\n");
    }
}
