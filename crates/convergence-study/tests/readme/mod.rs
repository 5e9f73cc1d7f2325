//! The READMEs of the project and of the program, and the pages of the book, show what the program
//! prints: each command before a block of output is run.

mod blocks;

use std::fs;
use std::path::Path;
use std::process::Command;

use blocks::{Printed, fenced, missing, printed};

const README: &str = include_str!("../../README.md");

/// The first page of the project.
const FIRST: &str = include_str!("../../../../README.md");

/// Pages of the book that show output.
const BOOK: [(&str, usize); 1] = [(include_str!("../../book/src/start.md"), 2)];

/// What published tools passed: the name in the first column of the page's table, and a table of
/// errors like theirs.
const MISTAKES: [(&str, &str); 2] = [
    (
        "| [polaris 471]",
        "n,L2\n8,0.041\n16,0.0103\n32,nan\n64,nan\n",
    ),
    // The rate of 75.975 between neighbours.
    (
        "| [polaris 491]",
        "n,L2\n60,1.0\n90,4.1828e-14\n120,1.3466e-23\n150,5.8413e-31\n",
    ),
];

/// The files that the commands of a page read: the table is on the page, or on that of the program.
fn fill(folder: &Path, page: &str) {
    let table_on = |page: &str| fenced(page).into_iter().find(|block| block.0 == "csv");
    let (_, table) = table_on(page)
        .or_else(|| table_on(README))
        .expect("a table");
    fs::write(folder.join("errors.csv"), table + "\n").unwrap();
}

#[test]
fn every_block_of_output_is_what_the_program_prints() {
    assert!(fenced(FIRST).iter().any(|block| block.0 == "csv"));
    for (page, count) in [(README, 1), (FIRST, 2)].into_iter().chain(BOOK) {
        let folder = tempfile::tempdir().unwrap();
        fill(folder.path(), page);
        let blocks = printed(page);
        assert_eq!(blocks.len(), count, "{page}");
        for Printed { command, lines } in blocks {
            assert_eq!(command[0], "convergence-study");
            let mut program = Command::new(env!("CARGO_BIN_EXE_convergence-study"));
            let output = program
                .args(&command[1..])
                .current_dir(folder.path())
                .output()
                .unwrap();
            let text = String::from_utf8(output.stdout).unwrap();
            assert_eq!(
                missing(&lines, &text),
                None,
                "{command:?}:\n{text}{}",
                String::from_utf8_lossy(&output.stderr)
            );
        }
    }
}

/// The last column of the table of mistakes: the verdict.
#[test]
fn what_published_tools_passed_is_judged_as_the_first_page_says() {
    let folder = tempfile::tempdir().unwrap();
    for (name, table) in MISTAKES {
        let row = FIRST.lines().find(|line| line.starts_with(name)).unwrap();
        let verdict = row.trim_end_matches(" |").rsplit("| ").next().unwrap();
        fs::write(folder.path().join("table.csv"), table).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_convergence-study"))
            .args(["rates", "table.csv", "--order", "2", "--dim", "1"])
            .current_dir(folder.path())
            .output()
            .unwrap();
        let printed = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        let reason = verdict.strip_prefix("fail: ").expect("a failure");
        assert_eq!(output.status.code(), Some(1), "{name}: {printed}");
        let is_said = printed
            .lines()
            .any(|line| line.starts_with("L2: fail: ") && line.contains(reason));
        assert!(is_said, "{name}: {reason} in {printed}");
    }
}

#[test]
fn a_line_that_is_not_printed_is_found() {
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let output = "a 1\nb 3e-15 c\n\nd 2.5\n";
    for (block, found) in [
        ("a 1\nb 1e-14 c\nd 2.5", None),
        ("a 1\n...\nd 2.5", None),
        ("...\nd 2.5", None),
        ("a 1\n...", None),
        ("a 1\nb 3e-15 c", Some("nothing, found d 2.5")),
        ("a 1\nd 2.5", Some("d 2.5")),
        ("a 1\n...\nd 2.6", Some("d 2.6")),
        ("a 1\nb 3e-5 c\n...", Some("b 3e-5 c")),
        ("a 1\nb 0 c\n...", Some("b 0 c")),
    ] {
        assert_eq!(
            missing(&lines(block), output),
            found.map(str::to_owned),
            "{block}"
        );
    }
}
