//! A refusal of a table names arguments by their type, so that each caller reads its own words.

use std::fs;
use std::path::PathBuf;

use super::{code, crate_folder, files};

/// Files and folders of sources whose messages reach the command line, Python and JSON.
fn sources() -> Vec<PathBuf> {
    let harness = crate_folder("convergence-study").join("src");
    let rates = harness.join("rates");
    let mut sources = files(&harness.join("input"), &["rs"]);
    sources.extend(files(
        &crate_folder("convergence-judge").join("src"),
        &["rs"],
    ));
    sources.extend(["claims.rs", "refusal.rs"].map(|name| rates.join(name)));
    sources
}

/// The options that a source writes as text: `--dim`.
fn options(code: &str) -> Vec<String> {
    let after = code.split("--").skip(1);
    let words = after.map(|rest| {
        let end = rest.find(|c: char| !c.is_ascii_lowercase());
        &rest[..end.unwrap_or(rest.len())]
    });
    let options = words.filter(|word| !word.is_empty());
    options.map(str::to_owned).collect()
}

#[test]
fn no_message_of_a_reader_has_an_option_as_text() {
    let sources = sources();
    assert!(sources.len() > 40, "{}", sources.len());
    for path in sources {
        let code = code(&fs::read_to_string(&path).expect("a source"));
        let found = options(&code);
        assert!(
            found.is_empty(),
            "{}: found --{}; name it as an `Argument`",
            path.display(),
            found.join(", --")
        );
    }
}

#[test]
fn an_option_is_found_in_a_text() {
    assert_eq!(
        options("refuse(\"no --dim, or --step X\")"),
        ["dim", "step"]
    );
    assert!(options("format!(\"--{name}\"); a -- b; i--").is_empty());
}
