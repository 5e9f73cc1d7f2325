//! The READMEs show what the commands print and what the reports say, and no README shows output
//! that no test compares.

#[path = "../../crates/convergence-study/tests/readme/blocks.rs"]
pub(crate) mod blocks;

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use blocks::{Printed, missing, printed};

use crate::place::{read, root};

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
        [id, verdict, _, numbers] => report.lines().any(|item| {
            item.starts_with(&format!("- **{verdict}** {id}: "))
                && item.contains(&format!(" ({numbers})"))
        }),
        _ => false,
    }
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
        let output = Command::new(env!("CARGO_BIN_EXE_xtask"))
            .args(&command[2..])
            .current_dir(root())
            .output()
            .unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert_eq!(missing(&lines, &text), None, "{command:?}:\n{text}");
    }
}

#[test]
fn a_line_that_verify_does_not_report_is_found() {
    let report = "**pass**: all 2 studies pass\n\n- **pass** a-b: claim (velocity 2.000 (order 2)) [errors](figures/a-b-errors.svg)\n";
    for line in [
        "a-b   pass   1.24  velocity 2.000 (order 2)",
        "pass: all 2 studies pass",
        "report: reports/README.md",
    ] {
        assert!(is_reported(line, report), "{line}");
    }
    for line in [
        "a-b   pass   1.24  velocity 2.001 (order 2)",
        "a-b  fail  1.24  velocity 2.000 (order 2)",
        "pass: all 3 studies pass",
    ] {
        assert!(!is_reported(line, report), "{line}");
    }
}

#[test]
fn no_other_readme_shows_output() {
    let mut folders = vec![root()];
    let mut with_output = vec![];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(&folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
        {
            let name = path
                .file_name()
                .and_then(|name| name.to_str())
                .unwrap_or_default();
            // Reports and what is not committed.
            if path.is_dir() && !matches!(name, "target" | "reports" | ".git" | "mutants.out") {
                folders.push(path);
            } else if name == "README.md"
                && fs::read_to_string(&path).unwrap().contains("\n```text\n")
            {
                with_output.push(path.strip_prefix(root()).unwrap().to_owned());
            }
        }
    }
    with_output.sort();
    assert_eq!(
        with_output,
        [
            "README.md",
            "crates/convergence-study/README.md",
            // `.ci/wheel` compares its output.
            "crates/convergence-study-python/README.md",
            BEAM
        ]
        .map(PathBuf::from)
    );
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

/// The table of run times on the page of the program is that of the benchmark, row by row, and says
/// how long a run may take.
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
    let wrong: Vec<&str> = table
        .lines()
        .filter(|line| !is_row(line, &report))
        .collect();
    assert!(wrong.is_empty(), "not in reports/bench.md: {wrong:#?}");
    let (_, limit) = report.split_once("A run may take ").expect("the limit");
    let limit = limit.split(" seconds").next().expect("a number");
    assert!(readme.contains(&format!("not reached within {limit} seconds")));
    assert!(!is_row("| u(1, t), 1e-3 | 0 |", &report));
}

fn is_row(line: &str, report: &str) -> bool {
    report.lines().any(|row| row == line)
}

#[test]
fn the_committed_reports_are_short() {
    let reports = ["reports/README.md", "reports/full/README.md"];
    let words = reports.map(|path| read(path).split_whitespace().count());
    assert!(words.iter().sum::<usize>() <= 8000, "{words:?} words");
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

#[test]
fn how_often_the_rule_decides_and_errs_is_what_its_page_says() {
    let readme = read("README.md").replace('\n', " ");
    let rule = read("crates/convergence-judge/src/judge/verdict/RULE.md");
    let row = |head: &str| {
        let line = rule.lines().find(|line| line.starts_with(head));
        let cells = line.unwrap_or_else(|| panic!("{head}")).split('|').skip(2);
        cells.map(|cell| cell.trim().to_owned()).collect::<Vec<_>>()
    };
    // Of the laws that were held out: nothing was tuned with them.
    let [levels, shares, smooth] = [
        "| levels | 3 | 4 |",
        "| ten laws: true pass; fail; half an order off passes |",
        "| smooth powers: true pass; fail; half an order off passes |",
    ]
    .map(row);
    let at = |shares: &[String], count: &str| {
        let place = levels.iter().position(|level| level == count).unwrap();
        let shares: Vec<String> = shares[place].split("; ").map(str::to_owned).collect();
        <[String; 3]>::try_from(shares).expect("three shares")
    };
    let [[four, ..], [eight, .., off]] = ["4", "8"].map(|count| at(&smooth, count));
    let sentence = format!(
        "Of smooth problems, {four} % of the true claims pass at four levels, {eight} % at eight, and none"
    );
    assert!(readme.contains(&sentence) && off == "0.00", "{sentence}");
    let [pass, fail, off] = at(&shares, "4");
    for sentence in [
        format!("{pass} % of the true claims pass, {fail} % fail"),
        format!("half an order off, {off} % pass"),
    ] {
        assert!(readme.contains(&sentence), "{sentence}");
    }
    let [pass, fail, off] = at(&shares, "8");
    let sentence = format!("At eight levels it is {pass}, {fail} and {off} %");
    assert!(readme.contains(&sentence), "{sentence}");
}

/// The table of what people do today is the sentence of the rule's page.
#[test]
fn the_comparison_with_other_rules_is_what_its_page_says() {
    let readme = read("README.md");
    let rule = read("crates/convergence-judge/src/judge/verdict/RULE.md");
    let (_, table) = readme
        .split_once("\n| this rule |")
        .expect("a table of rules");
    let rows: Vec<Vec<&str>> = table
        .lines()
        .take(3)
        .map(|row| row.split('|').map(str::trim).collect())
        .collect();
    let (names, shares) = (&rows[0][..5], &rows[2][2..7]);
    let own = rows[2][1];
    assert!(rule.contains(&format!(
        "this rule passes {own} of the true claims and 3.2 %"
    )));
    assert!(readme.contains("let 3.2 % of the wrong claims pass"));
    for (name, share) in names.iter().zip(shares) {
        let share = share.strip_suffix(" %").expect("per cent");
        assert!(rule.contains(&format!("{name} {share}")), "{name} {share}");
    }
}

#[test]
fn the_first_page_is_short() {
    let readme = read("README.md");
    let lines = readme.lines().count();
    assert!(lines <= 140, "{lines} lines");
    let words = readme.split_whitespace().count();
    assert!(words <= 900, "{words} words");
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
