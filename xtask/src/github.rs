//! What GitHub Actions shows of a run: a page and annotations. Elsewhere nothing happens.

use std::env;
use std::fs::File;
use std::io::{self, Write};

use thermobeam_study::report::Findings;
use thermobeam_study::verdict::Verdict;

use crate::screen;

/// Appends the table to the page of the job and marks what did not pass.
pub(crate) fn announce(findings: &Findings<'_>) -> io::Result<()> {
    if let Some(page) = env::var_os("GITHUB_STEP_SUMMARY").filter(|path| !path.is_empty()) {
        let mut file = File::options().append(true).create(true).open(page)?;
        file.write_all(findings.digest().as_bytes())?;
    }
    if env::var_os("GITHUB_ACTIONS").is_some_and(|value| value == "true") {
        screen::print(&annotations(findings))?;
    }
    Ok(())
}

fn annotations(findings: &Findings<'_>) -> String {
    let bad = findings.finished.iter().filter(|finished| finished.outcome.verdict != Verdict::Pass);
    let studies = bad.map(|finished| {
        let outcome = &finished.outcome;
        annotation(&format!("{}: {}", finished.header.id, outcome.verdict), &outcome.summary)
    });
    studies.chain(findings.changes.iter().map(|change| annotation("baseline", &change.to_string()))).collect()
}

fn annotation(title: &str, message: &str) -> String {
    let title = escaped(title).replace(':', "%3A").replace(',', "%2C");
    format!("::error title={title}::{}\n", escaped(message))
}

/// One line, in the runner's own encoding.
fn escaped(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

#[cfg(test)]
mod tests {
    use super::annotation;

    #[test]
    fn an_annotation_stays_on_its_line() {
        let line = annotation("a: fail, so", "50 %\n::warning::x");
        assert_eq!(line, "::error title=a%3A fail%2C so::50 %25%0A::warning::x\n");
    }
}
