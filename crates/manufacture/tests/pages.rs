//! The pages: each note has its example, and the README's problem passes. The page of ten minutes
//! is run by the tests of programs.

use crate::prelude::*;

const NOTES: &str = include_str!("../NOTES.md");
const README: &str = include_str!("../README.md");

#[test]
fn each_example_of_a_note_has_it() {
    let mut examples = 0;
    for section in NOTES.split("\n## `").skip(1) {
        let (code, rest) = section.split_once('`').unwrap();
        let file = rest
            .split("```toml\n")
            .nth(1)
            .unwrap()
            .split("```")
            .next()
            .unwrap();
        // With the points of the program: a note may be there for a few points and gone for many.
        let check = read(file).check(&Sampling::default()).unwrap();
        assert!(!found(&check, code).is_empty(), "{code}: {check:#?}");
        examples += 1;
    }
    assert_eq!(examples, 17);
}

#[test]
fn the_problem_of_the_readme_passes_without_a_note() {
    let file = README.rsplit("```toml\n").next().unwrap();
    let file = file.split("```").next().unwrap();
    let check = check(file);
    assert_eq!(
        (check.verdict, check.findings.len()),
        ("pass", 0),
        "{check:#?}"
    );
    let python = library(file, Language::Python);
    for signature in ["def source_balance(x, t):", "def initial_c(x):"] {
        assert!(python.contains(signature), "{signature}");
    }
}
