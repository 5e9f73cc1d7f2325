//! The tests and studies that THEORY.md names exist.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use super::{crate_folder, files, root};

const THEORY: &str = include_str!("../../../crates/thermobeam/THEORY.md");

/// The start of the table of the paper's statements, whose rows name tests and studies.
const STATEMENTS: &str = "| statement |";

/// The names in back quotes in each paragraph that begins with **Checked by**, and in the table of
/// statements, by section.
fn cited(text: &str) -> Vec<(&str, Vec<&str>)> {
    let sections = text.split("\n## ").skip(1);
    sections
        .map(|section| {
            let title = section.lines().next().unwrap_or_default();
            let held = section.split("\n\n").filter(|paragraph| {
                let paragraph = paragraph.trim_start();
                paragraph.starts_with("**Checked by**") || paragraph.starts_with(STATEMENTS)
            });
            (
                title,
                held.flat_map(|paragraph| paragraph.split('`').skip(1).step_by(2))
                    .collect(),
            )
        })
        .collect()
}

/// Names of the functions marked as tests.
fn tests_of(source: &str) -> impl Iterator<Item = String> {
    let marked = source.split("#[test]").skip(1);
    marked.filter_map(|rest| {
        let (_, rest) = rest.split_once("fn ")?;
        Some(rest.split(['(', '<']).next()?.trim().to_owned())
    })
}

/// Names of all tests and studies of the workspace.
fn known() -> BTreeSet<String> {
    let mut sources = vec![];
    for part in [
        "thermobeam",
        "thermobeam-exact",
        "thermobeam-study",
        "thermobeam-cli",
        "convergence-study",
    ] {
        for folder in ["src", "tests"] {
            sources.extend(files(&crate_folder(part).join(folder), &["rs"]));
        }
    }
    sources.extend(files(&root().join("xtask/tests"), &["rs"]));
    let read = |path: &PathBuf| fs::read_to_string(path).expect("a source file");
    let tests = sources
        .iter()
        .flat_map(|path| tests_of(&read(path)).collect::<Vec<_>>());
    let studies = files(&root().join("studies"), &["toml"]);
    let id = |path: &PathBuf| {
        let text = read(path);
        let line = text.lines().find(|line| line.starts_with("id = "))?;
        line.split('"').nth(1).map(str::to_owned)
    };
    let in_code = xtask::PROJECT.studies.iter();
    let in_code = in_code.map(|code| code().header().id.clone());
    tests
        .chain(studies.iter().filter_map(id))
        .chain(in_code)
        .collect()
}

/// Names that are neither tests nor studies.
fn missing(text: &str, known: &BTreeSet<String>) -> Vec<String> {
    let names = cited(text).into_iter().flat_map(|(_, names)| names);
    names
        .filter(|&name| !known.contains(name))
        .map(str::to_owned)
        .collect()
}

#[test]
fn every_result_names_tests_and_studies_that_exist() {
    for (title, names) in cited(THEORY) {
        assert!(!names.is_empty(), "nothing checks \"{title}\"");
    }
    let known = known();
    assert_eq!(missing(THEORY, &known), Vec::<String>::new());
    let renamed = THEORY
        .replace("`energy-decay`", "`energy-rise`")
        .replace("| `theorem-2.6`:", "| `theorem-2.7`:")
        .replace("`each_entry_is_its_integral`", "`none_is`");
    assert_eq!(
        missing(&renamed, &known),
        [
            "energy-rise",
            "theorem-2.7",
            "energy-rise",
            "energy-rise",
            "none_is"
        ]
    );
}

/// Titles in quotes after the word "section" that no heading has.
fn lost_sections(text: &str) -> Vec<String> {
    let titles: Vec<&str> = text
        .lines()
        .filter_map(|line| line.strip_prefix("## "))
        .collect();
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let quoted = words
        .split("section \"")
        .skip(1)
        .filter_map(|rest| rest.split('"').next().map(str::to_owned));
    quoted
        .filter(|title| !titles.contains(&title.as_str()))
        .collect()
}

#[test]
fn every_section_that_is_referred_to_exists() {
    assert_eq!(lost_sections(THEORY), Vec::<String>::new());
    let renamed = THEORY.replace("## Penetration of an impact", "## How deep an impact goes");
    assert_eq!(lost_sections(&renamed), ["Penetration of an impact"]);
}

/// The decimals of the buckling number in a text: `7116` of `-0.7116`.
fn buckling_decimals(text: &str) -> impl Iterator<Item = &str> {
    let starts = text.match_indices("0.711").map(|(start, _)| start + 2);
    starts.map(|start| {
        let rest = &text[start..];
        let end = rest.find(|c: char| !c.is_ascii_digit());
        &rest[..end.unwrap_or(rest.len())]
    })
}

#[test]
fn texts_state_the_buckling_number_that_the_solver_computes() {
    let root = root();
    let readme = root.join("README.md");
    let mut sources = vec![readme.clone(), root.join("crates/thermobeam/THEORY.md")];
    for entry in fs::read_dir(root.join("crates")).unwrap().flatten() {
        let source = entry.path().join("src");
        if source.is_dir() {
            sources.extend(files(&source, &["rs"]));
        }
    }
    let mut stated = BTreeSet::new();
    for path in sources {
        let text = fs::read_to_string(&path).unwrap();
        for decimals in buckling_decimals(&text) {
            let places = decimals.len();
            let expected = format!("{:.places$}", thermobeam::kirchhoff::BUCKLING);
            assert_eq!(format!("0.{decimals}"), expected, "{}", path.display());
            stated.insert(path.clone());
        }
    }
    for path in [readme, root.join("crates/thermobeam-cli/src/project.rs")] {
        assert!(stated.contains(&path), "{}: {stated:?}", path.display());
    }
}

#[test]
fn only_functions_marked_as_tests_are_found() {
    let source = "fn helper() {}\n#[test]\n#[ignore]\nfn a_law() {}\n#[test]\n    fn another(x in 0..1) {}\nfn last() {}";
    assert_eq!(tests_of(source).collect::<Vec<_>>(), ["a_law", "another"]);
}
