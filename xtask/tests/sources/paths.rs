//! Files and folders that sources and pages name are there: a message that says where to look must
//! not send anybody to a file that has moved.

use std::fs;

use super::files;
use crate::place::root;

/// Begins the path of a file or folder of the workspace.
const CRATES: &str = "crates/";

/// The paths below `crates/` that a text names, without those that stand for any name: they have
/// capitals, such as `crates/thermobeam-cli/src/NAME.rs`.
fn named(text: &str) -> Vec<&str> {
    let mut found = vec![];
    for (at, _) in text.match_indices(CRATES) {
        let begins = !text[..at].ends_with(|c: char| c.is_alphanumeric() || "/.-_".contains(c));
        let path = &text[at..];
        let end = path.find(|c: char| !(c.is_ascii_alphanumeric() || "/.-_".contains(c)));
        let path = path[..end.unwrap_or(path.len())].trim_end_matches(['.', '/']);
        let pattern = path.contains(|c: char| c.is_ascii_uppercase()) && !path.ends_with(".md");
        if begins && !pattern && path.len() > CRATES.len() {
            found.push(path);
        }
    }
    found
}

#[test]
fn a_path_ends_where_its_name_does() {
    let text = "see crates/a/src/b.rs, crates/c/. `crates/d-e/X.md`; crates/f/NAME.rs, ../crates/g";
    assert_eq!(
        named(text),
        ["crates/a/src/b.rs", "crates/c", "crates/d-e/X.md"]
    );
}

#[test]
fn every_path_that_is_named_exists() {
    let mut count = 0;
    let mut missing = vec![];
    for folder in ["crates", "xtask", ".github", "studies"] {
        for file in files(&root().join(folder), &["rs", "md", "toml", "yml"]) {
            let shown = file.display().to_string();
            if shown.contains("/tests/") || shown.contains("/target/") {
                continue;
            }
            let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{shown}: {error}"));
            for path in named(&text) {
                count += 1;
                if !root().join(path).exists() {
                    missing.push(format!("{shown}: {path}"));
                }
            }
        }
    }
    assert!(count > 100, "only {count} paths were found");
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}
