//! The pages: each note has its example. The page of ten minutes is run by the tests of programs.

use crate::files::{check, found};

const NOTES: &str = include_str!("../NOTES.md");

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
