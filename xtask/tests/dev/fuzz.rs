//! `fuzz`, with a cargo whose test prints what the case asks for.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::{Ended, ended, program, xtask};

/// Notes what it was asked for, prints what the test is to print, and ends as the test is to end.
const CARGO: &str = r#"#!/bin/sh
echo "$THERMOBEAM_FUZZ from $THERMOBEAM_FUZZ_SEED" > asked
cat prints
exit "$(cat ends)"
"#;

fn workspace(folder: &TempDir) -> PathBuf {
    let root = folder.path().join("w");
    fs::create_dir_all(root.join("studies")).expect("a folder");
    fs::write(root.join("Cargo.toml"), "").expect("a file");
    program(&root.join("cargo"), CARGO);
    root
}

fn fuzz(root: &Path, prints: &str, ends: i32, arguments: &[&str]) -> Ended {
    fs::write(root.join("prints"), prints).expect("a file");
    fs::write(root.join("ends"), ends.to_string()).expect("a file");
    let mut command = xtask();
    command.args(["dev", "fuzz"]).args(arguments).current_dir(root).env("CARGO", root.join("cargo"));
    ended(&mut command)
}

fn page(root: &Path) -> Option<String> {
    fs::read_to_string(root.join("reports/fuzz.md")).ok()
}

#[test]
fn the_counts_of_the_test_become_a_report() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = workspace(&folder);
    let prints = "running 1 test\nfuzz scene 150 20 130 0 2.5\nfuzz study 50 1 49 0 7.25\ntest fuzz ... ok\n";
    let fuzzed = fuzz(&root, prints, 0, &["--inputs", "200", "--first", "7", "--write"]);
    assert_eq!(fuzzed.status, Some(0), "{}", fuzzed.stderr);
    assert_eq!(fs::read_to_string(root.join("asked")).expect("a note"), "200 from 7\n");
    let page = page(&root).expect("a report");
    for text in [&fuzzed.stdout, &page] {
        let sentence =
            "200 damaged files: 21 read, 179 refused, none ended in a panic, a hang or a message without a place";
        assert!(text.contains(sentence), "{text}");
    }
    assert!(page.contains("| all   |    200 |   21 |     179 |      0 |          7.2 |"), "{page}");
    assert!(page.contains("cargo xtask dev fuzz --write --inputs 200 --first 7"), "{page}");
}

#[test]
fn an_input_that_fails_fails_the_command_and_is_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = workspace(&folder);
    let fuzzed = fuzz(&root, "fuzz scene 200 20 178 2 2.5\n", 1, &["--inputs", "200", "--write"]);
    assert_eq!(fuzzed.status, Some(1));
    let page = page(&root).expect("a report");
    assert!(page.contains("2 ended in a panic, a hang or a message without a place"), "{page}");
}

#[test]
fn a_test_that_fails_for_another_reason_fails_the_command_and_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = workspace(&folder);
    let fuzzed = fuzz(&root, "fuzz scene 200 20 180 0 2.5\n", 1, &["--inputs", "200"]);
    assert_eq!(fuzzed.status, Some(1));
    assert!(fuzzed.stderr.contains("damaged_files_are_read_or_refused_with_their_place failed"), "{}", fuzzed.stderr);
    assert_eq!(page(&root), None, "nobody has asked for a report");
}

#[test]
fn counts_that_do_not_add_up_and_too_few_inputs_leave_the_report_as_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = workspace(&folder);
    for (prints, inputs, told) in [
        ("", "200", "0 of 200 inputs"),
        ("fuzz scene 199 20 179 0 2.5\n", "200", "199 of 200 inputs"),
        ("fuzz scene 5 5 0 0 2.5\n", "5", "5 is not in 200.."),
    ] {
        let fuzzed = fuzz(&root, prints, 0, &["--inputs", inputs, "--write"]);
        assert_eq!(fuzzed.status, Some(2), "{}", fuzzed.stdout);
        assert!(fuzzed.stderr.contains(told), "{}", fuzzed.stderr);
        assert_eq!(page(&root), None);
    }
}
