//! Studies of programs in the pages of the book: each is run as it stands there, and prints what
//! the page shows.

use std::fs;
use std::process::Output;

use tempfile::TempDir;

use super::blocks::{fenced, missing};
use crate::shell;

/// Pages with studies, and how many blocks of output they have.
const PAGES: [(&str, usize); 3] = [
    (include_str!("../../book/src/gradients.md"), 1),
    (include_str!("../../book/src/scatter.md"), 2),
    (include_str!("../../book/src/cluster.md"), 1),
];

/// The files of a page: blocks whose first line is a comment with the name of a file.
fn files(page: &str) -> Vec<(String, String)> {
    let named = |(_, text): (String, String)| {
        let first = text.strip_prefix("#!/bin/bash\n").unwrap_or(&text);
        let name = first.strip_prefix("# ")?.split([' ', ':', '\n']).next()?;
        let ends = [".py", ".toml", ".csv", ".sh"];
        let is_file = ends.iter().any(|end| name.ends_with(end));
        is_file.then(|| (name.to_owned(), format!("{text}\n")))
    };
    fenced(page).into_iter().filter_map(named).collect()
}

/// Each block of commands that is followed by what its last command prints.
fn commands(page: &str) -> Vec<(String, Vec<String>)> {
    let blocks = fenced(page);
    let shown = |pair: &[(String, String)]| {
        let [(language, command), (next, text)] = pair else {
            return None;
        };
        let is_shown = language == "sh" && next == "text";
        let lines = text.lines().map(without_size).collect();
        is_shown.then(|| (command.clone(), lines))
    };
    blocks.windows(2).filter_map(shown).collect()
}

/// A folder with files.
fn place(files: &[(String, String)]) -> TempDir {
    let place = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(place.path().join(name), text).unwrap();
    }
    place
}

/// The output without the seconds that a study took.
fn printed(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stdout);
    let without_seconds = |line: &str| {
        let seconds = line
            .rsplit_once(", ")
            .filter(|(_, end)| end.ends_with(" s"));
        without_size(seconds.map_or(line, |(start, _)| start))
    };
    let lines = text.lines().map(without_seconds);
    lines.collect::<Vec<_>>().join("\n")
}

/// A line without the size that is confirmed: it is of round-off.
fn without_size(line: &str) -> String {
    let sized = line.split_once("right to ").and_then(|(start, rest)| {
        let (size, rest) = rest.split_once(' ')?;
        let is_small = size.parse::<f64>().is_ok_and(|size| size < 1e-8);
        is_small.then(|| format!("{start}right to round-off {rest}"))
    });
    sized.unwrap_or_else(|| line.to_owned())
}

#[test]
fn each_study_of_the_book_prints_what_its_page_shows() {
    foreign_tools::needs!(PYTHON, SHELL);
    for (page, count) in PAGES {
        let files = files(page);
        let place = place(&files);
        let commands = commands(page);
        assert_eq!(commands.len(), count, "{page}");
        for (command, lines) in commands {
            let output = shell(place.path(), &command);
            let text = printed(&output);
            let errors = String::from_utf8_lossy(&output.stderr);
            assert_eq!(missing(&lines, &text), None, "{command}:\n{text}{errors}");
        }
    }
}

/// The mistakes that the page on gradients speaks of are found by its study.
#[test]
fn a_wrong_gradient_of_the_book_fails() {
    foreign_tools::needs!(PYTHON, SHELL);
    let right = files(PAGES[0].0);
    for (from, to) in [
        ("exp(x) * (d[0]", "1.001 * exp(x) * (d[0]"),
        ("exp(x) * (d[0]", "1.00001 * exp(x) * (d[0]"),
        ("d[1] * cos(y)", "0 * d[1] * cos(y)"),
        ("d[0] * sin(y) + ", "d[0] * sin(y) - "),
    ] {
        let wrong = right.iter().map(|(name, text)| {
            assert!(!name.ends_with(".py") || text.contains(from), "{from}");
            let text = text.replace(from, to);
            // One direction finds each of them, with a third of the runs.
            let end = if name.ends_with(".toml") {
                "\n[taylor]\ndirections = 1\n"
            } else {
                ""
            };
            (name.clone(), text + end)
        });
        let place = place(&wrong.collect::<Vec<_>>());
        let output = shell(place.path(), "convergence-study study misfit.toml");
        let text = printed(&output);
        assert_eq!(output.status.code(), Some(1), "{to}: {text}");
        assert!(text.starts_with("misfit: fail\n"), "{to}: {text}");
    }
}
