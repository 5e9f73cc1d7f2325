//! The READMEs of the project and of the program, and the pages of the book, show what the program
//! prints: each command before a block of output is run.

pub(crate) mod blocks;
mod programs;

use std::ffi::OsStr;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use blocks::{Printed, fenced, missing, printed};

const README: &str = include_str!("../../README.md");

/// The first page of the project.
const FIRST: &str = include_str!("../../../../README.md");

/// Pages of the book that show output.
const BOOK: [(&str, usize); 3] = [
    (include_str!("../../book/src/start.md"), 2),
    (include_str!("../../book/src/which.md"), 1),
    (include_str!("../../book/src/steps.md"), 1),
];

/// The page of the reasons.
const REASONS: &str = include_str!("../../book/src/inconclusive.md");

/// The list of the pages.
const SUMMARY: &str = include_str!("../../book/src/SUMMARY.md");

/// The files that the commands of a page read: the table is on the page, or on that of the program.
fn fill(folder: &Path, page: &str) {
    let table_on = |page: &str| fenced(page).into_iter().find(|block| block.0 == "csv");
    let (_, table) = table_on(page)
        .or_else(|| table_on(README))
        .expect("a table");
    fs::write(folder.join("errors.csv"), table + "\n").unwrap();
}

/// What the program prints in a folder.
fn ran(folder: &Path, arguments: &[impl AsRef<OsStr>]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_convergence-study"));
    let program = program.args(arguments).current_dir(folder);
    program.output().unwrap()
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
            let output = ran(folder.path(), &command[1..]);
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

/// A row of the table of reasons.
struct Given<'p> {
    code: &'p str,
    /// The table that gives it.
    csv: String,
    arguments: Vec<&'p str>,
}

/// The rows of the page: reason, errors with their steps, arguments.
fn given<'p>(page: &'p str) -> Vec<Given<'p>> {
    let (_, rows) = page.split_once("| `rates` with |").expect("a table");
    let row = |line: &'p str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let [_, code, errors, arguments, _] = cells[..] else {
            panic!("{line}")
        };
        let (errors, steps) = errors.split_once(" at ").unwrap_or((errors, ""));
        let mut steps: Vec<String> = steps.split_whitespace().map(str::to_owned).collect();
        let errors: Vec<&str> = errors.split_whitespace().collect();
        if steps.is_empty() {
            let halved = |k: usize| (0.2 * 0.5_f64.powi(k as i32)).to_string();
            steps = (0..errors.len()).map(halved).collect();
        }
        let columns = 1 + errors[0].matches(',').count();
        let names = ["h,L2\n", "h,L2,H1\n"][columns - 1];
        let lines = steps.iter().zip(&errors).map(|(h, e)| format!("{h},{e}\n"));
        Given {
            code: code.trim_matches('`'),
            csv: names.to_owned() + &lines.collect::<String>(),
            arguments: arguments.trim_matches('`').split_whitespace().collect(),
        }
    };
    let rows = rows.lines().skip(2);
    rows.take_while(|line| line.starts_with('|'))
        .map(row)
        .collect()
}

/// Each reason of an inconclusive verdict is that of the table next to it, or one that no table
/// has.
#[test]
fn each_reason_has_a_table_that_gives_it() {
    let given = given(REASONS);
    let folder = tempfile::tempdir().unwrap();
    for Given {
        code,
        csv,
        arguments,
    } in &given
    {
        fs::write(folder.path().join("table.csv"), csv).unwrap();
        let json = ["rates", "table.csv", "--format", "json"];
        let output = ran(folder.path(), &[&json[..], arguments].concat());
        let found: serde_json::Value = serde_json::from_slice(&output.stdout)
            .unwrap_or_else(|error| panic!("{code}: {error}: {csv}"));
        let rate = &found["rates"][0];
        assert_eq!(rate["code"], **code, "{csv}");
        assert_eq!(rate["verdict"], "inconclusive", "{csv}");
    }
    let (_, of_no_table) = REASONS.split_once("\n`steps`, ").expect("a sentence");
    let (of_no_table, every) = of_no_table
        .split_once("## Every reason")
        .expect("a chapter");
    let all = every.lines().filter_map(|line| {
        let (code, rest) = line.strip_prefix("- `")?.split_once("`, ")?;
        rest.starts_with("inconclusive").then_some(code)
    });
    let mut count = 0;
    for code in all {
        let is_given = given.iter().any(|row| row.code == code);
        let is_named = code == "steps" || of_no_table.contains(&format!("`{code}`"));
        assert!(is_given != is_named, "{code}");
        count += 1;
    }
    assert!(count > given.len());
}

/// The pages of users: at most 28 beside gallery and reference, each a question.
#[test]
fn each_page_of_the_book_answers_one_question() {
    let (users, _) = SUMMARY.split_once("\n# Reference").expect("a reference");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("book/src");
    let mut count = 0;
    for line in users.lines() {
        let Some((title, path)) = line
            .trim_start()
            .strip_prefix("- [")
            .and_then(|rest| rest.split_once("]("))
        else {
            continue;
        };
        let path = path.trim_end_matches(')');
        if path.starts_with("gallery/") {
            continue;
        }
        count += 1;
        // READMEs of other crates have their names as titles.
        if !(path.starts_with("../../../") && path.ends_with("/README.md")) {
            let page = fs::read_to_string(source.join(path)).unwrap();
            assert_eq!(page.lines().next(), Some(&*format!("# {title}")), "{path}");
            assert!(title.contains('?'), "{title}");
        }
    }
    assert!((20..=28).contains(&count), "{count} pages");
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
