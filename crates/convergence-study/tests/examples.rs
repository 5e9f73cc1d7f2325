//! The examples of every help text work as they stand.

use std::fs;
use std::path::Path;

use convergence_study::command_line::{self, HelpPage};
use tempfile::TempDir;

const SECOND: &str = "h,L2\n0.4,1.600e-1\n0.2,4.000e-2\n0.1,1.000e-2\n0.05,2.500e-3\n";

const BOTH: &str = "h,L2,H1\n0.4,1.600e-1,4.000e-1\n0.2,4.000e-2,2.000e-1\n0.1,1.000e-2,1.000e-1\n0.05,2.500e-3,5.000e-2\n";

const LOG: &str = "cells = 16, error = 1.600e-1\ncells = 64, error = 4.000e-2\n\
                   cells = 256, error = 1.000e-2\ncells = 1024, error = 2.500e-3\n";

/// The exit status of a line, and all that it prints.
fn ended(folder: &Path, line: &str) -> (Option<i32>, String) {
    let output = crate::shell(folder, line);
    let text = [output.stdout, output.stderr].map(|text| String::from_utf8(text).expect("UTF-8"));
    (output.status.code(), text.concat())
}

/// The files that the examples name: a study that was verified, tables, a record, a solution.
fn place() -> TempDir {
    let root = tempfile::tempdir().expect("a folder");
    let folder = root.path();
    fs::create_dir(folder.join("studies")).expect("a folder");
    for (name, text) in [
        ("errors.csv", SECOND),
        ("finer.csv", BOTH),
        ("log.txt", LOG),
    ] {
        fs::write(folder.join(name), text).expect("a file");
    }
    for line in [
        "convergence-study new program poisson --language shell",
        "convergence-study new manufacture heat",
        "convergence-study verify --bless",
    ] {
        let (status, text) = ended(folder, line);
        assert_eq!(status, Some(0), "{line}: {text}");
    }
    root
}

/// The lines below `Examples:` that are commands.
fn examples(help: &str) -> Vec<&str> {
    let (_, lines) = help.split_once("\nExamples:\n").expect("examples");
    lines
        .lines()
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .map(str::trim)
        .collect()
}

#[test]
fn every_example_of_every_help_text_ends_well() {
    foreign_tools::needs!(SHELL);
    let named: Vec<&str> = HelpPage::all().map(|page| page.command).collect();
    assert!(
        command_line::Command::NAMES
            .iter()
            .all(|name| named.contains(name)),
        "{named:?}"
    );
    let root = place();
    for name in command_line::Command::NAMES {
        let (status, help) = ended(root.path(), &format!("convergence-study {name} --help"));
        assert_eq!(status, Some(0), "{help}");
        let lines = examples(&help);
        assert!((2..=3).contains(&lines.len()), "{name}: {help}");
        for line in lines {
            assert!(
                line.contains(&format!("convergence-study {name}")),
                "{line}"
            );
            let place = place();
            let (status, text) = ended(place.path(), line);
            assert_eq!(status, Some(0), "{line}: {text}");
        }
    }
}
