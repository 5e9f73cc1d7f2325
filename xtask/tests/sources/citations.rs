//! The sources cite equations of the paper, and only those that exist.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::{crate_folder, files};

/// How many equations each chapter of Bernardi and Copetti numbers: the last are the initial
/// temperatures of the experiments, (5.4) and (5.5).
const EQUATIONS: [usize; 5] = [3, 15, 16, 5, 5];

/// The equations that the crate implements: each is cited in the implementing file, not just in
/// lib.rs.
const IMPLEMENTED: [(&str, &str); 14] = [
    ("1.1", "parameters.rs"),
    ("1.2", "one_step.rs"),
    ("1.3", "contact.rs"),
    ("2.3", "kirchhoff.rs"),
    ("2.5", "contact.rs"),
    ("3.6", "one_step.rs"),
    ("3.7", "solve/sweeps.rs"),
    ("3.8", "solve/sweeps.rs"),
    ("3.9", "energy.rs"),
    ("3.14", "norms.rs"),
    ("4.1", "solve/fixed_point.rs"),
    ("4.2", "solve/fixed_point.rs"),
    ("4.3", "solve/fixed_point.rs"),
    ("4.5", "solve/fixed_point.rs"),
];

/// Equation numbers `(chapter.number)` in a text; the argument of a call such as `f(2.5)` does not
/// count.
fn numbers(text: &str) -> impl Iterator<Item = &str> {
    text.match_indices('(').filter_map(|(at, _)| {
        let is_call = text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let (inside, _) = text[at + 1..].split_once(')')?;
        let (chapter, number) = inside.split_once('.')?;
        let is_chapter = matches!(chapter.as_bytes(), [b'1'..=b'9']);
        let is_number = matches!(
            number.as_bytes(),
            [b'1'..=b'9'] | [b'1'..=b'9', b'0'..=b'9']
        );
        (!is_call && is_chapter && is_number).then_some(inside)
    })
}

/// The comments of a Rust source, or the whole text of any other file.
fn prose(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("a source file");
    if path.extension().is_none_or(|extension| extension != "rs") {
        return text;
    }
    text.lines()
        .filter_map(|line| line.split_once("//"))
        .map(|(_, comment)| format!("{comment}\n"))
        .collect()
}

/// Cited numbers by file, for the solver and the exact solutions.
fn citations() -> BTreeMap<PathBuf, BTreeSet<String>> {
    let folders = ["thermobeam", "thermobeam-exact"].map(crate_folder);
    let paths = folders
        .iter()
        .flat_map(|folder| files(folder, &["rs", "md"]));
    let cited = |path: PathBuf| {
        let set = numbers(&prose(&path)).map(str::to_owned).collect();
        (path, set)
    };
    paths.map(cited).collect()
}

/// Citations of numbers that the paper does not have.
fn unknown<'a>(cited: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let is_known = |number: &str| {
        let (chapter, number) = number.split_once('.')?;
        let [chapter, number] = [chapter, number].map(|digits| digits.parse::<usize>());
        let count = EQUATIONS.get(chapter.ok()? - 1)?;
        Some((1..=*count).contains(&number.ok()?))
    };
    let cited = cited.into_iter();
    cited
        .filter(|cited| is_known(cited) != Some(true))
        .collect()
}

#[test]
fn every_cited_equation_is_in_the_paper() {
    let mut count = 0;
    for (path, cited) in citations() {
        count += cited.len();
        assert_eq!(
            unknown(cited.iter().map(String::as_str)),
            [""; 0],
            "{}",
            path.display()
        );
    }
    assert!(count > 50, "{count} citations");
    assert_eq!(
        unknown(numbers(
            "the scheme (3.7), its limit (3.17), and (4.6); f(2.5), (12.5), (0.5)"
        )),
        ["3.17", "4.6"]
    );
}

#[test]
fn every_implemented_equation_is_cited_where_it_is_implemented() {
    let source = crate_folder("thermobeam").join("src");
    let citations = citations();
    for (number, file) in IMPLEMENTED {
        assert!(
            citations[&source.join(file)].contains(number),
            "({number}) is not cited in src/{file}"
        );
    }
}
