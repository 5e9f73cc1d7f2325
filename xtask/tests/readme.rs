//! The READMEs show what the commands print and what the reports say, and no README shows output
//! that no test compares.

#[path = "../../crates/convergence-study/tests/readme/blocks.rs"]
pub(crate) mod blocks;

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::sync::LazyLock;

use blocks::{Printed, missing, printed};

use crate::place::{read, root};
use crate::sources::pages;

/// The page of the beam's program.
const BEAM: &str = "crates/thermobeam-cli/README.md";

/// The lines of `verify` that need no clock, as its report has them: verdict, and the key numbers
/// of each study.
///
/// * `line`: as printed: study, verdict, seconds, key numbers, or the last sentence.
fn is_reported(line: &str, report: &str) -> bool {
    if let Some((verdict, sentence)) = line.split_once(": ") {
        return verdict == "report" || report.contains(&format!("**{verdict}**: {sentence}\n"));
    }
    let cells: Vec<&str> = line
        .split("  ")
        .map(str::trim)
        .filter(|cell| !cell.is_empty())
        .collect();
    match cells[..] {
        ["study", "verdict", "seconds", "key numbers"] => true,
        [id, verdict, _, numbers] => {
            // The list of studies leaves out what the front has answered.
            let answer = format!(": {numbers} ({id})");
            let is_answered = report.lines().any(|item| item.ends_with(&answer));
            report.lines().any(|item| {
                item.starts_with(&format!("- **{verdict}** {id}: "))
                    && (is_answered || item.contains(&format!(" ({numbers})")))
            })
        }
        _ => false,
    }
}

/// What a command of the project prints.
fn xtask(arguments: &[String]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    let output = command.args(arguments).current_dir(root()).output();
    String::from_utf8(output.unwrap().stdout).unwrap()
}

#[test]
fn every_block_of_output_is_what_the_command_prints() {
    let blocks = printed(&read(BEAM));
    assert_eq!(blocks.len(), 2);
    for Printed { command, lines } in blocks {
        assert_eq!(command[..2], ["cargo", "xtask"]);
        // The studies take seconds when optimised: their report is what `verify` wrote, and each
        // merge writes it anew.
        if command[2] == "verify" {
            let report = read("reports/README.md");
            let wrong: Vec<&String> = lines
                .iter()
                .filter(|line| *line != "..." && !is_reported(line, &report))
                .collect();
            assert!(
                wrong.is_empty() && lines.len() > 4,
                "not in reports/README.md: {wrong:#?}"
            );
            continue;
        }
        let text = xtask(&command[2..]);
        assert_eq!(missing(&lines, &text), None, "{command:?}:\n{text}");
    }
}

#[test]
fn a_line_that_verify_does_not_report_is_found() {
    let report = "**pass**: all 2 studies pass\n\n- **It falls**: largest residual 1e-16 (c)\n\n\
                  - **pass** a-b: claim (velocity 2.000 (order 2)) [errors](figures/a-b-errors.svg)\n- **pass** c: claim\n";
    for line in [
        "a-b   pass   1.24  velocity 2.000 (order 2)",
        "c   pass   0.10  largest residual 1e-16",
        "pass: all 2 studies pass",
        "report: reports/README.md",
    ] {
        assert!(is_reported(line, report), "{line}");
    }
    for line in [
        "a-b   pass   1.24  velocity 2.001 (order 2)",
        "a-b  fail  1.24  velocity 2.000 (order 2)",
        "a-b   pass   1.24  largest residual 1e-16",
        "c   fail   0.10  largest residual 1e-16",
        "c   pass   0.10  largest residual 2e-16",
        "pass: all 3 studies pass",
    ] {
        assert!(!is_reported(line, report), "{line}");
    }
}

#[test]
fn no_other_readme_shows_output() {
    let shows_output = |path: &PathBuf| {
        path.ends_with("README.md") && fs::read_to_string(path).unwrap().contains("\n```text\n")
    };
    let pages = pages(&root()).into_iter().filter(shows_output);
    let found: BTreeSet<PathBuf> = pages
        .map(|path| path.strip_prefix(root()).unwrap().to_owned())
        .filter(|path| !path.starts_with("reports"))
        .collect();
    let expected = [
        "README.md",
        "crates/convergence-study/README.md",
        // `.ci/wheel` compares its output.
        "crates/convergence-study-python/README.md",
        BEAM,
    ];
    assert_eq!(found, expected.map(PathBuf::from).into());
}

/// The error of the paper's figures in the README is that of the record of the full tier.
#[test]
fn the_error_of_the_papers_figures_is_that_of_the_record() {
    let readme = read("README.md").replace('\n', " ");
    let (_, after) = readme
        .split_once("the figures are off by up to ")
        .expect("a sentence on the figures");
    let number = after.split(' ').next().expect("a number");
    let record = read("reports/full/README.md");
    let row = record
        .lines()
        .find(|line| line.starts_with("- **The paper's figures"))
        .expect("a row of the first table");
    assert!(
        row.contains(&format!("off by up to {number} in u(1, t)")),
        "{number}: {row}"
    );
}

/// The table of run times on the page of the program is that of the benchmark, row by row.
#[test]
fn the_run_times_are_those_of_the_benchmark() {
    let readme = read(BEAM);
    let report = read("reports/bench.md");
    let (_, after) = readme
        .split_once("\n| error in")
        .expect("a table of run times");
    let table = format!(
        "| error in{}",
        after.split("\n\n").next().expect("its rows")
    );
    assert!(table.lines().count() > 5);
    for line in table.lines() {
        let is_there = report.lines().any(|row| row == line);
        assert!(is_there, "not in reports/bench.md: {line}");
    }
}

#[test]
fn the_first_page_and_the_committed_reports_are_short() {
    for (pages, most) in [
        (&["README.md"][..], 700),
        (&["reports/README.md", "reports/full/README.md"], 8000),
    ] {
        let words = pages
            .iter()
            .map(|path| read(path).split_whitespace().count());
        let words: usize = words.sum();
        assert!(words <= most, "{pages:?}: {words} words");
    }
    let lines = read("README.md").lines().count();
    assert!(lines <= 140, "{lines} lines");
}

/// A claimed order and the interval of its rate, in a row of a table of rates of a report.
struct Claimed {
    order: f64,
    low: f64,
    high: f64,
}

impl Claimed {
    /// `None` for any other line.
    fn read(line: &str) -> Option<Self> {
        let mut cells = line.split('|').map(str::trim).skip(3);
        let (order, _) = cells.next()?.split_once(" ± ")?;
        let (low, high) = cells.nth(1)?.split_once(" to ")?;
        Some(Self {
            order: order.parse().ok()?,
            low: low.parse().ok()?,
            high: high.parse().ok()?,
        })
    }

    fn holds(&self) -> bool {
        self.low <= self.order && self.order <= self.high
    }

    /// The distance of the order from the middle of the interval, in its half-widths.
    fn half_widths(&self) -> f64 {
        let half = (self.high - self.low) / 2.0;
        ((self.low + self.high) / 2.0 - self.order).abs() / half
    }
}

/// The rule's intervals on the project's own studies, whose orders are proven: what is counted on
/// made-up laws holds here, too.
#[test]
fn most_intervals_of_the_report_hold_the_order_that_is_claimed() {
    for (path, count) in [("reports/README.md", 150), ("reports/full/README.md", 30)] {
        let report = read(path);
        let claimed: Vec<Claimed> = report.lines().filter_map(Claimed::read).collect();
        let outside: Vec<f64> = claimed
            .iter()
            .filter(|claimed| !claimed.holds())
            .map(Claimed::half_widths)
            .collect();
        let farthest = outside.iter().copied().fold(0.0, f64::max);
        assert!(claimed.len() >= count, "{path}: {} rates", claimed.len());
        assert!(
            outside.len() * 100 <= 8 * claimed.len() && farthest < 3.5,
            "{path}: {} of {} outside, by up to {farthest} half-widths",
            outside.len(),
            claimed.len()
        );
    }
}

#[test]
fn the_rates_of_the_theorem_are_those_of_the_report() {
    let readme = read("README.md").replace('\n', " ");
    let report = read("reports/README.md");
    // In h the rate of the scheme: in the theorem's own norm it is that of interpolation.
    for (title, axis) in [
        ("in h: the scheme, to the interpolant", "h"),
        ("in dt", "δt"),
    ] {
        let words = format!("- **Theorem 3.4, {title}**: rate ");
        let (_, rate) = report.split_once(&words).expect("a statement");
        let (rate, _) = rate.split_once(" from levels").expect("its levels");
        let stated = format!("{rate} in {axis}");
        assert!(readme.contains(&stated), "{stated}");
    }
}

/// A number of `rule-calibration-full` in the baseline, rounded as the first page has it.
fn counted(name: &str, digits: usize, factor: f64) -> String {
    static BASELINE: LazyLock<serde_json::Value> =
        LazyLock::new(|| serde_json::from_str(&read("studies/baseline.json")).unwrap());
    let number = &BASELINE["studies"]["rule-calibration-full"]["numbers"][name][0];
    let number = number.as_f64().unwrap_or_else(|| panic!("{name}"));
    format!("{:.digits$}", factor * number)
}

/// A sentence with numbers in place of their names: `{NAME; 2}` has two digits, `{NAME; 0 %}` is in
/// per cent.
fn filled(sentence: &str) -> String {
    let mut filled = String::new();
    for (place, part) in sentence.split(['{', '}']).enumerate() {
        match part.rsplit_once("; ") {
            Some((name, form)) if place % 2 == 1 => {
                let digits = form.trim_end_matches(" %").parse().expect("digits");
                let factor = if form.ends_with('%') { 100.0 } else { 1.0 };
                filled += &counted(name, digits, factor);
            }
            _ => filled += part,
        }
    }
    filled
}

/// How often it decides and errs, beside what people do today; and the price of levels that are added.
#[test]
fn what_the_pages_say_of_the_rule_is_what_the_baseline_has() {
    for line in include_str!("readme/sentences.txt").lines() {
        let (page, sentence) = line.split_once(": ").expect("a page");
        let said = filled(sentence);
        assert!(read(page).replace('\n', " ").contains(&said), "{said}");
    }
    let none = ["4", "8"].map(|levels| format!("benign, {levels} levels: wrong pass"));
    assert_eq!(none.map(|name| counted(&name, 0, 100.0)), ["0", "0"]);
}

/// How many studies the two tiers run.
#[test]
fn the_numbers_of_studies_are_those_of_the_list() {
    let text = xtask(&["list".to_owned()]);
    let tiers = text
        .lines()
        .filter_map(|line| line.split_whitespace().nth(1))
        .filter(|tier| ["quick", "full"].contains(tier));
    let tiers: Vec<&str> = tiers.collect();
    let quick = tiers.iter().filter(|tier| **tier == "quick").count();
    let words = format!("{quick} quick studies, --tier full all {}", tiers.len());
    assert!(quick > 0 && read("README.md").contains(&words), "{words}");
}

/// By CPU seconds, as its figure has them: elements of any order are the fastest for errors of u(1,
/// t) from 1e-3 on, in both problems.
#[test]
fn the_fastest_method_of_the_first_page_is_that_of_the_benchmark() {
    let readme = read("README.md").replace('\n', " ");
    assert!(
        readme.contains("From errors of 1e-3 on elements of any order need the fewest CPU seconds")
    );
    let report = read("reports/bench.md");
    let rows = report
        .lines()
        .filter(|line| line.starts_with("| u(1, t), 1e-") && !line.contains(", 1e-2 "));
    let mut count = 0;
    for row in rows {
        let seconds = row
            .split('|')
            .skip(2)
            .map(|cell| cell.trim().parse().unwrap_or(f64::INFINITY));
        let seconds: Vec<f64> = seconds.collect();
        let fewest = seconds.iter().copied().fold(f64::INFINITY, f64::min);
        assert_eq!(seconds[5], fewest, "{row}");
        count += 1;
    }
    assert_eq!(count, 6);
}

/// The commands that set up everything, on the first screen.
#[test]
fn the_first_screen_has_the_two_commands() {
    let readme = read("README.md");
    let screen: Vec<&str> = readme.lines().take(20).collect();
    for command in ["cargo xtask verify ", "cargo test --workspace "] {
        let found = screen.iter().any(|line| line.starts_with(command));
        assert!(found, "{command}");
    }
}
