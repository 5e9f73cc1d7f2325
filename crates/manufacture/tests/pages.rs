//! The pages: each note has its example. The page of ten minutes is run by the tests of programs,
//! but for its last file.

use manufacture::Language;

use crate::files::{check, found, read};

const NOTES: &str = include_str!("../NOTES.md");
const TEN_MINUTES: &str = include_str!("../TEN-MINUTES.md");

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
        let check = check(file);
        assert!(!found(&check, code).is_empty(), "{code}: {check:#?}");
        examples += 1;
    }
    assert_eq!(examples, 10);
}

#[test]
fn the_other_problem_of_ten_minutes_passes_without_a_note() {
    let file = TEN_MINUTES.rsplit("```toml\n").next().unwrap();
    let file = file.split("```").next().unwrap();
    let check = check(file);
    assert_eq!(
        (check.verdict, check.findings.len()),
        ("pass", 0),
        "{check:#?}"
    );
    let python = read(file).emit(Language::Python)[0].text.clone();
    for signature in ["def source_balance(x, t):", "def initial_c(x):"] {
        assert!(python.contains(signature), "{signature}");
    }
}
