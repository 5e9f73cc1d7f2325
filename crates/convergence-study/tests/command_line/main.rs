//! A project's command line as seen by a shell: this program is the project if `AS_PROJECT` is set, else its tests.

mod changes;
mod failing;
mod tables;

use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode, Output, Stdio};

use convergence_study::cli;
use convergence_study::input::{InputError, Section};
use convergence_study::program;
use convergence_study::project::Project;
use convergence_study::study::{Claim, Header, KindRow, Study, erased, levels};
use tempfile::TempDir;

use changes::{
    a_report_is_made_anew_from_its_record, a_run_fails_where_a_study_does_and_nothing_differs,
    a_study_with_a_near_extension_is_named, blessings_at_once_are_all_kept,
    one_some_or_all_changes_are_blessed_with_a_reason, records_are_compared_with_0_1_or_2,
};
use failing::{
    a_changed_claim_fails_until_it_is_blessed_with_a_reason, a_deleted_study_is_one_change_and_is_named,
    claims_of_the_full_tier_are_compared_in_the_quick_one, the_cause_is_printed_first_and_what_passes_is_counted,
    the_page_links_to_what_is_there_of_the_full_tier, what_failed_is_repeated_alone_and_the_slowest_are_listed,
};

const AS_PROJECT: &str = "CONVERGENCE_STUDY_TESTS_AS_PROJECT";

/// The order claimed instead of 1.
const ORDER: &str = "CONVERGENCE_STUDY_TESTS_ORDER";

const PROJECT: Project = Project {
    kinds: &[KindRow { name: "power", read, why: "", judged: "", failure: "" }, program::ROW],
    templates: &[program::TEMPLATE],
    ..Project::new("powers", "powers")
};

/// Errors h^exponent, claimed to be of first order, or of the order in `ORDER`, which is in no baseline.
fn read(header: Header, root: &Section<'_>, _: &Path) -> Result<Box<dyn Study>, InputError> {
    root.allow(&["study", "exponent"])?;
    let exponent = root.require("exponent", "a number > 0")?.number_where("a number > 0", |value| value > 0.0)?;
    let order = std::env::var(ORDER).map_or(1.0, |text| text.parse().unwrap());
    let study = levels([4, 8, 16, 32, 64], move |n| (n as f64).powf(-exponent));
    Ok(erased(header, study.claiming("error", Claim::new(order, 0.05))))
}

type Test = (&'static str, fn());

const TESTS: [Test; 34] = [
    (
        "what_failed_is_repeated_alone_and_the_slowest_are_listed",
        what_failed_is_repeated_alone_and_the_slowest_are_listed,
    ),
    ("verify_ends_with_0_1_or_2", verify_ends_with_0_1_or_2),
    (
        "a_changed_claim_fails_until_it_is_blessed_with_a_reason",
        a_changed_claim_fails_until_it_is_blessed_with_a_reason,
    ),
    ("a_study_with_a_near_extension_is_named", a_study_with_a_near_extension_is_named),
    ("claims_of_the_full_tier_are_compared_in_the_quick_one", claims_of_the_full_tier_are_compared_in_the_quick_one),
    ("the_cause_is_printed_first_and_what_passes_is_counted", the_cause_is_printed_first_and_what_passes_is_counted),
    ("a_deleted_study_is_one_change_and_is_named", a_deleted_study_is_one_change_and_is_named),
    ("the_page_links_to_what_is_there_of_the_full_tier", the_page_links_to_what_is_there_of_the_full_tier),
    ("an_unwritable_job_summary_keeps_the_exit_status", an_unwritable_job_summary_keeps_the_exit_status),
    ("annotations_are_commands_and_nothing_else_is", annotations_are_commands_and_nothing_else_is),
    ("claims_and_ids_with_control_characters_are_refused", claims_and_ids_with_control_characters_are_refused),
    ("names_of_columns_and_files_are_no_commands", names_of_columns_and_files_are_no_commands),
    ("pipes_in_place_of_records_do_not_hang", pipes_in_place_of_records_do_not_hang),
    ("tables_and_studies_come_from_standard_input", tables_and_studies_come_from_standard_input),
    ("rates_come_in_words_and_as_an_object", rates_come_in_words_and_as_an_object),
    ("levels_set_aside_are_marked", levels_set_aside_are_marked),
    ("rates_write_figure_markdown_and_junit", rates_write_figure_markdown_and_junit),
    ("rates_says_how_it_read_a_table", tables::rates_says_how_it_read_a_table),
    ("claims_that_contradict_each_other_are_refused", tables::claims_that_contradict_each_other_are_refused),
    ("study_writes_a_report_that_says_how_to_repeat_it", study_writes_a_report_that_says_how_to_repeat_it),
    (
        "a_report_that_cannot_be_written_is_found_before_the_run_or_takes_no_result",
        a_report_that_cannot_be_written_is_found_before_the_run_or_takes_no_result,
    ),
    ("json_is_alone_on_standard_output", json_is_alone_on_standard_output),
    ("a_report_is_made_anew_from_its_record", a_report_is_made_anew_from_its_record),
    ("records_are_compared_with_0_1_or_2", records_are_compared_with_0_1_or_2),
    ("one_some_or_all_changes_are_blessed_with_a_reason", one_some_or_all_changes_are_blessed_with_a_reason),
    ("a_run_fails_where_a_study_does_and_nothing_differs", a_run_fails_where_a_study_does_and_nothing_differs),
    ("blessings_at_once_are_all_kept", blessings_at_once_are_all_kept),
    ("every_command_is_in_the_help", every_command_is_in_the_help),
    ("a_new_study_of_a_program_passes_as_it_is", a_new_study_of_a_program_passes_as_it_is),
    ("wrong_claims_are_answered_with_what_to_do", tables::wrong_claims_are_answered_with_what_to_do),
    ("values_and_rounded_numbers_are_told_from_errors", tables::values_and_rounded_numbers_are_told_from_errors),
    ("a_column_has_one_interval_whatever_is_claimed", tables::a_column_has_one_interval_whatever_is_claimed),
    ("words_name_what_is_there", tables::words_name_what_is_there),
    ("no_error_is_too_small_or_too_large", tables::no_error_is_too_small_or_too_large),
];

fn main() -> ExitCode {
    if std::env::var_os(AS_PROJECT).is_some() {
        return cli::main(&PROJECT);
    }
    let filter = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let mut failed = 0;
    for (name, test) in TESTS.iter().filter(|(name, _)| filter.as_ref().is_none_or(|filter| name.contains(filter))) {
        let passes = std::panic::catch_unwind(test).is_ok();
        failed += usize::from(!passes);
        println!("test {name} ... {}", if passes { "ok" } else { "FAILED" });
    }
    if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// A workspace with the studies `one`, which passes, and `two`, which fails, if wanted.
fn workspace(with_a_failure: bool) -> TempDir {
    let root = tempfile::tempdir().unwrap();
    fs::create_dir(root.path().join("studies")).unwrap();
    fs::write(root.path().join("studies/one.toml"), study("one", "c", 1.0)).unwrap();
    if with_a_failure {
        fs::write(root.path().join("studies/two.toml"), study("two", "c", 0.5)).unwrap();
    }
    root
}

fn study(id: &str, claim: &str, exponent: f64) -> String {
    let head = format!("exponent = {exponent:?}\n[study]\nid = \"{id}\"\nclaim = \"{claim}\"\n");
    head + "tier = \"quick\"\nkind = \"power\"\n"
}

fn command(root: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(arguments).current_dir(root).env(AS_PROJECT, "1");
    command.env_remove("GITHUB_ACTIONS").env_remove("GITHUB_STEP_SUMMARY").stdin(Stdio::null());
    command
}

fn run(root: &TempDir, arguments: &[&str]) -> (Option<i32>, String, String) {
    texts(command(root.path(), arguments).output().unwrap())
}

fn texts(output: Output) -> (Option<i32>, String, String) {
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (output.status.code(), out, err)
}

/// No control characters except line ends, and no line that GitHub Actions would obey.
#[track_caller]
fn is_harmless(text: &str) {
    assert!(!text.contains(|c: char| c.is_control() && c != '\n'), "{text:?}");
    assert!(!text.lines().any(|line| line.trim_start().starts_with("::")), "{text:?}");
}

fn verify_ends_with_0_1_or_2() {
    let root = workspace(false);
    assert_eq!(run(&root, &["verify"]).0, Some(1), "every number is new");
    assert_eq!(run(&root, &["verify", "--bless"]).0, Some(0));
    let (status, out, _) = run(&root, &["verify"]);
    assert_eq!(status, Some(0));
    assert!(out.contains("pass: all 1 studies pass") || out.contains("pass: the study passes"), "{out}");
    fs::write(root.path().join("studies/two.toml"), study("two", "c", 0.5)).unwrap();
    assert_eq!(run(&root, &["verify"]).0, Some(1));
    fs::write(root.path().join("studies/two.toml"), study("two", "c", 1.0).replace("kind = \"power\"", "")).unwrap();
    let (status, _, err) = run(&root, &["verify"]);
    assert!(status == Some(2) && err.contains("two.toml:2:1: study.kind: missing; expected \"power\""), "{err}");
    fs::write(root.path().join("studies/two.toml"), "[study]\n").unwrap();
    let (status, _, err) = run(&root, &["verify"]);
    assert!(status == Some(2) && err.starts_with("error: studies/two.toml:1:1: study.id: missing"), "{err}");
}

fn an_unwritable_job_summary_keeps_the_exit_status() {
    for (with_a_failure, status) in [(false, 0), (true, 1)] {
        let root = workspace(with_a_failure);
        run(&root, &["verify", "one", "--bless"]);
        let scope = if with_a_failure { "two" } else { "one" };
        for page in ["/nowhere/page", "."] {
            let mut command = command(root.path(), &["verify", scope]);
            let (found, out, err) = texts(command.env("GITHUB_STEP_SUMMARY", page).output().unwrap());
            assert_eq!(found, Some(status), "{out}{err}");
            assert!(err.contains(&format!("GITHUB_STEP_SUMMARY={page}: cannot write the job summary")), "{err}");
        }
        let page = root.path().join("page.md");
        command(root.path(), &["verify", scope]).env("GITHUB_STEP_SUMMARY", &page).output().unwrap();
        assert!(fs::read_to_string(page).unwrap().starts_with("## Verification, selection\n"));
    }
}

fn annotations_are_commands_and_nothing_else_is() {
    let root = workspace(false);
    fs::write(root.path().join("studies/two.toml"), study("two", "::error title=forged::x", 0.5)).unwrap();
    let mut command = command(root.path(), &["verify"]);
    let (status, out, _) = texts(command.env("GITHUB_ACTIONS", "true").output().unwrap());
    assert_eq!(status, Some(1));
    let commands: Vec<&str> = out.lines().filter(|line| line.trim_start().starts_with("::")).collect();
    assert!(commands.len() > 1 && commands[0].starts_with("::error title=two%3A fail::"), "{commands:?}");
    // GitHub shows ten: the last one counts the others.
    assert!(commands[1..9].iter().all(|line| line.starts_with("::error title=baseline::")), "{commands:?}");
    assert!(commands.len() == 10 && commands[9].starts_with("::error title=and more::6 more: "), "{commands:?}");
    let (_, out, _) = run(&root, &["study", "studies/two.toml"]);
    assert!(out.contains("\n: :error title=forged::x\n"), "{out}");
    is_harmless(&out);
    is_harmless(&run(&root, &["list"]).1);
    is_harmless(&run(&root, &["explain", "two"]).1);
}

fn claims_and_ids_with_control_characters_are_refused() {
    let root = workspace(false);
    for (id, claim, words) in [
        ("a", r"c\n::error::forged", "study.claim: found the text"),
        ("a", r"c\u001b[31m", "study.claim: found the text"),
        ("a", r"\r", "study.claim: found the text"),
        ("a", "", "study.claim: found the text"),
        (r"a\n::error::forged", "c", "study.id: found the text"),
        (r"a\u0007", "c", "study.id: found the text"),
        ("../a", "c", "study.id: found the text"),
        ("A", "c", "study.id: found the text"),
        ("--bless", "c", "study.id: found the text"),
        (&"a".repeat(5000), "c", "study.id: found the text"),
    ] {
        fs::write(root.path().join("a.toml"), study(id, claim, 1.0)).unwrap();
        let (status, out, err) = run(&root, &["study", "a.toml"]);
        assert!(status == Some(2) && out.is_empty() && err.contains(words), "{err}");
        is_harmless(&err);
    }
    // Written raw, TOML itself refuses them.
    fs::write(root.path().join("a.toml"), study("a", "c\x1b[31m", 1.0)).unwrap();
    let (status, _, err) = run(&root, &["study", "a.toml"]);
    assert!(status == Some(2) && err.contains("not valid TOML"), "{err}");
    is_harmless(&err);
}

fn names_of_columns_and_files_are_no_commands() {
    let root = workspace(false);
    let table = |name: &str| format!("h,{name}\n0.4,4.00e-1\n0.2,2.00e-1\n0.1,1.00e-1\n0.05,5.00e-2\n");
    let write = |name: &str, text: String| fs::write(root.path().join(name), text).unwrap();
    for name in ["a\x1b", "a\u{9b}b", "\x07"] {
        write("table.csv", table(name));
        let (status, out, err) = run(&root, &["rates", "table.csv", "--order", "1"]);
        assert!(status == Some(2) && out.is_empty(), "{name:?}: {out}");
        assert!(err.contains("table.csv:1:3: expected a name without control characters, found `"), "{err}");
        is_harmless(&err);
    }
    write("table.csv", table("::error title=x::forged"));
    let (status, out, _) = run(&root, &["rates", "table.csv", "--order", "1"]);
    assert_eq!(status, Some(0), "{out}");
    is_harmless(&out);
    let file = "a\n::error::x\x1b[31m.csv";
    write(file, "h\n".to_owned());
    for arguments in [&["rates", file][..], &["study", file], &["explain", file], &["verify", file], &["list", file]] {
        let (status, out, err) = run(&root, arguments);
        assert_eq!(status, Some(2), "{arguments:?}");
        is_harmless(&out);
        is_harmless(&err);
    }
}

#[cfg(unix)]
fn pipe(path: &Path) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

fn pipes_in_place_of_records_do_not_hang() {
    #[cfg(unix)]
    for (file, arguments) in [
        ("studies/baseline.json", &["verify"][..]),
        ("reports/results.json", &["list"]),
        ("reports/local/provenance.json", &["list"]),
        ("reports/local/lock", &["verify"]),
        ("reports/manifest.txt", &["verify"]),
    ] {
        let root = workspace(false);
        pipe(&root.path().join(file));
        let (status, _, err) = run(&root, arguments);
        assert_eq!(status, Some(2), "{file}: {err}");
        assert!(err.contains("expected a regular file"), "{file}: {err}");
    }
}

fn tables_and_studies_come_from_standard_input() {
    #[cfg(unix)]
    for (text, arguments) in [
        (
            "h,e\n0.4,4.00e-1\n0.2,2.00e-1\n0.1,1.00e-1\n0.05,5.00e-2\n".to_owned(),
            &["rates", "/dev/stdin", "--order", "1"][..],
        ),
        ("# h e\n0.4 4.00e-1\n0.2 2.00e-1\n0.1 1.00e-1\n0.05 5.00e-2\n".to_owned(), &["rates", "-", "--order", "1"]),
        (study("one", "c", 1.0), &["study", "/dev/stdin"]),
    ] {
        let root = workspace(false);
        let mut child = command(root.path(), arguments).stdin(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
        std::io::Write::write_all(&mut child.stdin.take().unwrap(), text.as_bytes()).unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(0), "{arguments:?}");
    }
}

/// Errors of second and of first order, and a column without a claim that would fail.
const RATES: &str = "h L2 H1 max\n0.4 1.6000000e-1 4.0000000e-1 3\n0.2 4.0000000e-2 2.0000000e-1 3\n\
                     0.1 1.0000000e-2 1.0000000e-1 3\n0.05 2.5000000e-3 5.0000000e-2 3\n";

fn rates_come_in_words_and_as_an_object() {
    let root = workspace(false);
    fs::write(root.path().join("t"), RATES).unwrap();
    let claims = ["rates", "t", "--order", "L2=2", "--order", "H1=1"];
    let with = |more: &[&str]| run(&root, &[&claims, more].concat());
    let (status, out, err) = with(&[]);
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    assert!(out.contains("L2: pass: 2.000000 ± 0.0000005, claimed 2 ± 0.25: 2, not 1.5 or 2.5\n"), "{out}");
    assert!(out.contains("max: inconclusive: 0.000000 ± 0.0000005: no order is claimed\n"), "{out}");
    assert!(out.contains("powers rates t: --order P") && !out.contains("xtask"), "{out}");
    assert!(out.ends_with("pass: 2 of 2 columns agree with their orders\n"), "{out}");
    assert_eq!(with(&["--all"]).0, Some(1));
    assert_eq!(with(&["--quiet"]).1, "pass: 2 of 2 columns agree with their orders\n");
    // A rate that disagrees is still shown.
    let (status, out, _) = run(&root, &["rates", "t", "--order", "H1=2", "--quiet"]);
    assert_eq!(status, Some(1));
    assert!(out.starts_with("H1: fail: 1.000000 ± 0.0000005, claimed 2 ± 0.25: too low\n"), "{out}");
    let (_, out, _) = with(&["--format", "json"]);
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&object["schema"], &object["verdict"]), (&2.into(), &"pass".into()));
    assert_eq!(
        (&object["rates"][2]["decides"], &object["rates"][0]["levels"][3]["step"]),
        (&false.into(), &0.05.into())
    );
    let (status, _, err) = run(&root, &["rates", "t", "--order", "l2=2"]);
    assert!(status == Some(2) && err.contains("expected a column of errors: L2, H1, max; found `l2`"), "{err}");
    let (status, _, err) = run(&root, &["rates", "t", "--columns", "L2,L3"]);
    assert!(status == Some(2) && err.contains("t:1:1: expected a column for --columns"), "{err}");
}

fn levels_set_aside_are_marked() {
    let root = workspace(false);
    // The rates 0.3, 2, 2, 2, and a level at the floor.
    let errors = [0.16, 0.13, 0.0325, 0.008125, 0.00203125, 1e-4];
    let row = |(k, error): (usize, &f64)| format!("{} {error}\n", 0.4 / f64::powi(2.0, k as i32));
    fs::write(root.path().join("t"), "h e\n".to_owned() + &errors.iter().enumerate().map(row).collect::<String>())
        .unwrap();
    let marks = |floor: &str| {
        let (_, out, _) = run(&root, &["rates", "t", "--order", "2", "--floor", floor]);
        let rows: Vec<&str> = out.lines().skip(2).take(errors.len()).collect();
        let marked = |mark: char| rows.iter().map(|row| row.contains(mark)).collect::<Vec<bool>>();
        (marked('~'), marked('_'), out.clone())
    };
    let (coarse, fine, out) = marks("2e-4");
    assert_eq!(coarse, [true, false, false, false, false, false], "{out}");
    assert_eq!(fine, [false, false, false, false, false, true], "{out}");
    assert!(out.contains("_ set aside: not above the floor 2e-4") && out.contains("e: pass"), "{out}");
    let (_, fine, out) = marks("0");
    assert!(!fine.contains(&true) && !out.contains("e: pass"), "{out}");
    let (_, fine, out) = marks("0.01");
    assert_eq!(fine, [false, false, false, true, true, true], "{out}");
}

fn rates_write_figure_markdown_and_junit() {
    let root = workspace(false);
    fs::write(root.path().join("a&b|c"), RATES).unwrap();
    let (status, _, err) = run(&root, &["rates", "a&b|c", "--order", "L2=2", "--order", "H1=2", "--out", "out/rates"]);
    assert_eq!((status, err.as_str()), (Some(1), ""));
    let read = |name: &str| fs::read_to_string(root.path().join("out/rates").join(name)).unwrap();
    let (svg, junit, page) = (read("rates.svg"), read("junit.xml"), read("rates.md"));
    assert!(roxmltree::Document::parse(&svg).unwrap().descendants().any(|node| node.has_tag_name("svg")));
    assert!(svg.contains("L2, order 2, rate 2.000"), "{svg}");
    let document = roxmltree::Document::parse(&junit).unwrap();
    let cases: Vec<_> = document.descendants().filter(|node| node.has_tag_name("testcase")).collect();
    assert_eq!(cases.len(), 2);
    assert!(cases.iter().all(|case| case.attribute("classname") == Some("a&b|c")));
    let failure = document.descendants().find(|node| node.has_tag_name("failure")).unwrap();
    assert_eq!(failure.parent().unwrap().attribute("name"), Some("H1: order 2"));
    assert_eq!(document.root_element().attribute("failures"), Some("1"));
    assert!(
        page.starts_with("# Rates of a&b\\|c\n\n**fail**: 1 of 2 columns") && page.contains("](rates.svg)"),
        "{page}"
    );
    assert!(page.contains("    0.2  4.0000e-2   2.000000  2.0000e-1   1.000000"), "{page}");
    fs::write(root.path().join("file"), "").unwrap();
    assert_eq!(run(&root, &["rates", "a&b|c", "--order", "L2=2", "--out", "file"]).0, Some(2));
}

fn study_writes_a_report_that_says_how_to_repeat_it() {
    let root = workspace(true);
    let (status, out, err) =
        run(&root, &["study", "studies/one.toml", "studies/two.toml", "--out", "out/a b", "--quiet"]);
    assert_eq!((status, err.as_str()), (Some(1), ""));
    assert!(out.starts_with("two: fail") && out.ends_with("fail: 1 of 2 fail (two)\n"), "{out}");
    let read = |name: &str| fs::read_to_string(root.path().join("out/a b").join(name)).unwrap();
    let page = read("README.md");
    assert!(page.contains("**fail**: 1 of 2 fail (two)\n"), "{page}");
    assert_eq!(page.matches("`powers study studies/one.toml studies/two.toml`").count(), 2, "{page}");
    for (name, piece) in [("index.html", "<svg"), ("junit.xml", "<failure"), ("results.json", "\"fail\"")] {
        assert!(read(name).contains(piece), "{name}");
    }
    let (_, out, _) = run(&root, &["study", "studies/one.toml", "--out", "out"]);
    assert!(out.ends_with("\nreport: out/index.html, out/README.md\n"), "{out}");
    // A report of `verify` goes where `--out` says, and each of its studies can be run by its id.
    assert_eq!(run(&root, &["verify", "--out", "elsewhere"]).0, Some(1));
    let page = fs::read_to_string(root.path().join("elsewhere/README.md")).unwrap();
    assert!(page.contains("Again: `powers verify two` (tier quick") && !root.path().join("reports").exists(), "{page}");
}

fn a_report_that_cannot_be_written_is_found_before_the_run_or_takes_no_result() {
    let root = workspace(false);
    let study = |out: &str| run(&root, &["study", "studies/one.toml", "--out", out]);
    fs::write(root.path().join("file"), "").unwrap();
    let (status, out, err) = study("file");
    assert!(status == Some(2) && out.is_empty() && err.starts_with("error: file: "), "{err}");
    fs::create_dir(root.path().join("out")).unwrap();
    fs::write(root.path().join("out/local"), "").unwrap();
    let (status, out, err) = study("out");
    assert!(status == Some(2) && err.contains("out: the reports cannot be written"), "{err}");
    assert!(out.starts_with("one: pass") && !out.contains("report:"), "{out}");

    let leaves_a_trace = "[study]\nid = \"two\"\nclaim = \"c\"\ntier = \"quick\"\nkind = \"program\"\n[program]\n\
                          command = [\"touch\", \"ran-{n}\"]\n[refine]\nn = [4, 8, 16]\n\
                          [[expect]]\nerror = \"L2\"\norder = 2.0\ntolerance = 0.1\n";
    fs::write(root.path().join("studies/two.toml"), leaves_a_trace).unwrap();
    let (status, out, err) = run(&root, &["verify", "--out", "file"]);
    assert!(status == Some(2) && out.is_empty() && err.contains("file: the reports cannot be written"), "{err}");
    let trace = root.path().join("studies/ran-4");
    assert!(!trace.exists(), "the study was run");
    assert_eq!(run(&root, &["verify"]).0, Some(1));
    assert!(trace.exists());
}

fn json_is_alone_on_standard_output() {
    let root = workspace(true);
    for arguments in [&["verify"][..], &["study", "studies/two.toml"]] {
        let mut command = command(root.path(), arguments);
        let summary = root.path().join("summary.md");
        command.args(["--format", "json"]).env("GITHUB_ACTIONS", "true").env("GITHUB_STEP_SUMMARY", &summary);
        let (status, out, err) = texts(command.output().unwrap());
        let object: serde_json::Value = serde_json::from_str(&out).unwrap();
        assert_eq!((status, &object["verdict"], &object["schema"]), (Some(1), &"fail".into(), &1.into()));
        assert!(err.starts_with("::error title=two%3A fail::"), "{arguments:?}: {err}");
        assert!(fs::read_to_string(&summary).unwrap().contains("**fail**"), "{arguments:?}");
        fs::remove_file(summary).unwrap();
    }
}

fn a_new_study_of_a_program_passes_as_it_is() {
    let root = tempfile::tempdir().unwrap();
    let (status, out, err) = run(&root, &["new", "program", "mine"]);
    assert_eq!((status, err.as_str()), (Some(0), ""));
    assert_eq!(out, "wrote mine.toml, mine.py\nnow  powers study mine.toml\nand  powers explain mine.toml\n");
    let text = fs::read_to_string(root.path().join("mine.toml")).unwrap();
    assert!(text.contains("powers study mine.toml") && !text.contains("NAME") && !text.contains("PROGRAM"), "{text}");
    let (status, out, err) = run(&root, &["study", "mine.toml"]);
    if Command::new("python3").arg("--version").output().is_ok() {
        assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    } else {
        assert!(status == Some(1) && out.contains("python3 cannot be started"), "{out}");
    }
    // In a folder of a repository the program runs from the folder of the command: from its root.
    let (status, out, err) = run(&root, &["new", "program", "other", "--out", "studies"]);
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    let text = fs::read_to_string(root.path().join("studies/other.toml")).unwrap();
    assert!(text.contains("directory = \"..\"") && text.contains("files = [\"studies/other.py\"]"), "{text}");
    let ignored = fs::read_to_string(root.path().join("studies/.gitignore")).unwrap();
    assert!(ignored.contains("\n.convergence-study/\n"), "{ignored}");
    if Command::new("python3").arg("--version").output().is_ok() {
        assert_eq!(run(&root, &["study", "studies/other.toml"]).0, Some(0));
        fs::write(root.path().join("studies/other.py"), "print('max error: 1e-3')\n").unwrap();
        let (_, out, _) = run(&root, &["study", "studies/other.toml"]);
        assert!(out.contains("expected a last line such as {\"errors\": {\"max\": 0.001}}"), "{out}");
    }
    // The second file exists: the first is not written either.
    fs::remove_file(root.path().join("mine.toml")).unwrap();
    let (status, _, err) = run(&root, &["new", "program", "mine"]);
    assert!(status == Some(2) && err.contains("mine.py: expected a new file"), "{err}");
    assert!(!root.path().join("mine.toml").exists());
    let (status, _, err) = run(&root, &["new", "novel", "mine"]);
    assert!(status == Some(2) && err.contains("program"), "{err}");
}

fn every_command_is_in_the_help() {
    let (status, out, _) = run(&workspace(false), &["--help"]);
    assert_eq!(status, Some(0));
    assert!(cli::COMMANDS.iter().all(|name| out.contains(&format!("\n  {name}"))), "{out}");
    assert!(out.contains("Exit status: 0 "), "{out}");
    for name in cli::COMMANDS {
        let (status, out, _) = run(&workspace(false), &[name, "--help"]);
        let widest = out.lines().map(|line| line.chars().count()).max();
        assert!(status == Some(0) && widest <= Some(100), "{out}");
    }
}
