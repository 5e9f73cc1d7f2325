//! A project's command line.

mod changes;
mod failing;
mod tables;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use convergence_study::cli;
use convergence_study_tests::{Ended, finished, output};
use tempfile::TempDir;

/// The variable with the order that `powers` claims instead of 1.
const ORDER: &str = "CONVERGENCE_STUDY_TESTS_ORDER";

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
    let mut command = Command::new(env!("CARGO_BIN_EXE_powers"));
    command.args(arguments).current_dir(root);
    command
        .env_remove("GITHUB_ACTIONS")
        .env_remove("GITHUB_STEP_SUMMARY");
    command
}

fn run(root: &TempDir, arguments: &[&str]) -> (Option<i32>, String, String) {
    texts(&mut command(root.path(), arguments))
}

/// Exit status, standard output and standard error.
fn texts(command: &mut Command) -> (Option<i32>, String, String) {
    let Ended {
        status,
        stdout,
        stderr,
    } = output(command).into();
    (status, stdout, stderr)
}

/// No control characters except line ends, and no line that GitHub Actions would obey.
#[track_caller]
fn is_harmless(text: &str) {
    assert!(
        !text.contains(|c: char| c.is_control() && c != '\n'),
        "{text:?}"
    );
    assert!(
        !text.lines().any(|line| line.trim_start().starts_with("::")),
        "{text:?}"
    );
}

#[test]
fn verify_ends_with_0_1_or_2() {
    let root = workspace(false);
    assert_eq!(run(&root, &["verify"]).0, Some(1), "every number is new");
    assert_eq!(run(&root, &["verify", "--bless"]).0, Some(0));
    let (status, out, _) = run(&root, &["verify"]);
    assert_eq!(status, Some(0));
    assert!(
        out.contains("pass: all 1 studies pass") || out.contains("pass: the study passes"),
        "{out}"
    );
    fs::write(root.path().join("studies/two.toml"), study("two", "c", 0.5)).unwrap();
    assert_eq!(run(&root, &["verify"]).0, Some(1));
    fs::write(
        root.path().join("studies/two.toml"),
        study("two", "c", 1.0).replace("kind = \"power\"", ""),
    )
    .unwrap();
    let (status, _, err) = run(&root, &["verify"]);
    assert!(
        status == Some(2) && err.contains("two.toml:2:1: study.kind: missing; expected \"power\""),
        "{err}"
    );
    fs::write(root.path().join("studies/two.toml"), "[study]\n").unwrap();
    let (status, _, err) = run(&root, &["verify"]);
    assert!(
        status == Some(2) && err.starts_with("error: studies/two.toml:1:1: study.id: missing"),
        "{err}"
    );
}

#[test]
fn an_unwritable_job_summary_keeps_the_exit_status() {
    for (with_a_failure, status) in [(false, 0), (true, 1)] {
        let root = workspace(with_a_failure);
        run(&root, &["verify", "one", "--bless"]);
        let scope = if with_a_failure { "two" } else { "one" };
        for page in ["/nowhere/page", "."] {
            let mut command = command(root.path(), &["verify", scope]);
            let (found, out, err) = texts(command.env("GITHUB_STEP_SUMMARY", page));
            assert_eq!(found, Some(status), "{out}{err}");
            assert!(
                err.contains(&format!(
                    "GITHUB_STEP_SUMMARY={page}: cannot write the job summary"
                )),
                "{err}"
            );
        }
        let page = root.path().join("page.md");
        output(command(root.path(), &["verify", scope]).env("GITHUB_STEP_SUMMARY", &page));
        assert!(
            fs::read_to_string(page)
                .unwrap()
                .starts_with("## Verification, selection\n")
        );
    }
}

#[test]
fn annotations_are_commands_and_nothing_else_is() {
    let root = workspace(false);
    fs::write(
        root.path().join("studies/two.toml"),
        study("two", "::error title=forged::x", 0.5),
    )
    .unwrap();
    let mut command = command(root.path(), &["verify"]);
    let (status, out, _) = texts(command.env("GITHUB_ACTIONS", "true"));
    assert_eq!(status, Some(1));
    let commands: Vec<&str> = out
        .lines()
        .filter(|line| line.trim_start().starts_with("::"))
        .collect();
    assert!(
        commands.len() > 1 && commands[0].starts_with("::error title=two%3A fail::"),
        "{commands:?}"
    );
    // GitHub shows ten: the last one counts the others.
    assert!(
        commands[1..9]
            .iter()
            .all(|line| line.starts_with("::error title=baseline::")),
        "{commands:?}"
    );
    assert!(
        commands.len() == 10 && commands[9].starts_with("::error title=and more::6 more: "),
        "{commands:?}"
    );
    let (_, out, _) = run(&root, &["study", "studies/two.toml"]);
    assert!(out.contains("\n: :error title=forged::x\n"), "{out}");
    is_harmless(&out);
    is_harmless(&run(&root, &["list"]).1);
    is_harmless(&run(&root, &["explain", "two"]).1);
}

#[test]
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
        assert!(
            status == Some(2) && out.is_empty() && err.contains(words),
            "{err}"
        );
        is_harmless(&err);
    }
    // Written raw, TOML itself refuses them.
    fs::write(root.path().join("a.toml"), study("a", "c\x1b[31m", 1.0)).unwrap();
    let (status, _, err) = run(&root, &["study", "a.toml"]);
    assert!(status == Some(2) && err.contains("not valid TOML"), "{err}");
    is_harmless(&err);
}

#[test]
fn names_of_columns_and_files_are_no_commands() {
    let root = workspace(false);
    let table =
        |name: &str| format!("h,{name}\n0.4,4.00e-1\n0.2,2.00e-1\n0.1,1.00e-1\n0.05,5.00e-2\n");
    let write = |name: &str, text: String| fs::write(root.path().join(name), text).unwrap();
    for name in ["a\x1b", "a\u{9b}b", "\x07"] {
        write("table.csv", table(name));
        let (status, out, err) = run(&root, &["rates", "table.csv", "--order", "1"]);
        assert!(status == Some(2) && out.is_empty(), "{name:?}: {out}");
        assert!(
            err.contains("table.csv:1:3: expected a name without control characters, found `"),
            "{err}"
        );
        is_harmless(&err);
    }
    write("table.csv", table("::error title=x::forged"));
    let (status, out, _) = run(&root, &["rates", "table.csv", "--order", "1"]);
    assert_eq!(status, Some(0), "{out}");
    is_harmless(&out);
    let file = "a\n::error::x\x1b[31m.csv";
    write(file, "h\n".to_owned());
    for arguments in [
        &["rates", file][..],
        &["study", file],
        &["explain", file],
        &["verify", file],
        &["list", file],
    ] {
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

#[test]
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

#[test]
fn tables_and_studies_come_from_standard_input() {
    #[cfg(unix)]
    for (text, arguments) in [
        (
            "h,e\n0.4,4.00e-1\n0.2,2.00e-1\n0.1,1.00e-1\n0.05,5.00e-2\n".to_owned(),
            &["rates", "/dev/stdin", "--order", "1"][..],
        ),
        (
            "# h e\n0.4 4.00e-1\n0.2 2.00e-1\n0.1 1.00e-1\n0.05 5.00e-2\n".to_owned(),
            &["rates", "-", "--order", "1"],
        ),
        (study("one", "c", 1.0), &["study", "/dev/stdin"]),
    ] {
        let root = workspace(false);
        let mut child = command(root.path(), arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        std::io::Write::write_all(&mut child.stdin.take().unwrap(), text.as_bytes()).unwrap();
        assert_eq!(finished(child).status.code(), Some(0), "{arguments:?}");
    }
}

/// Errors of second and of first order, and a column without a claim that would fail.
const RATES: &str = "h L2 H1 max\n0.4 1.6000000e-1 4.0000000e-1 3\n0.2 4.0000000e-2 2.0000000e-1 3\n\
                     0.1 1.0000000e-2 1.0000000e-1 3\n0.05 2.5000000e-3 5.0000000e-2 3\n";

#[test]
fn rates_come_in_words_and_as_an_object() {
    let root = workspace(false);
    fs::write(root.path().join("t"), RATES).unwrap();
    let claims = ["rates", "t", "--order", "L2=2", "--order", "H1=1"];
    let with = |more: &[&str]| run(&root, &[&claims, more].concat());
    let (status, out, err) = with(&[]);
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    assert!(
        out.contains("L2: pass: 2.000000 ± 0.0000005, claimed 2 ± 0.25: 2, not 1.5 or 2.5\n"),
        "{out}"
    );
    assert!(
        out.contains("max: inconclusive: 0.000000 ± 0.0000005: no order is claimed\n"),
        "{out}"
    );
    assert!(
        out.contains("powers rates t: --order P") && !out.contains("xtask"),
        "{out}"
    );
    assert!(
        out.ends_with("pass: 2 of 2 columns agree with their orders\n"),
        "{out}"
    );
    assert_eq!(with(&["--all"]).0, Some(1));
    assert_eq!(
        with(&["--quiet"]).1,
        "pass: 2 of 2 columns agree with their orders\n"
    );
    // A rate that disagrees is still shown.
    let (status, out, _) = run(&root, &["rates", "t", "--order", "H1=2", "--quiet"]);
    assert_eq!(status, Some(1));
    assert!(
        out.starts_with("H1: fail: 1.000000 ± 0.0000005, claimed 2 ± 0.25: too low\n"),
        "{out}"
    );
    let (_, out, _) = with(&["--format", "json"]);
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (&object["schema"], &object["verdict"]),
        (&2.into(), &"pass".into())
    );
    assert_eq!(
        (
            &object["rates"][2]["decides"],
            &object["rates"][0]["levels"][3]["step"]
        ),
        (&false.into(), &0.05.into())
    );
    let (status, _, err) = run(&root, &["rates", "t", "--order", "l2=2"]);
    assert!(
        status == Some(2) && err.contains("expected a column of errors: L2, H1, max; found `l2`"),
        "{err}"
    );
    let (status, _, err) = run(&root, &["rates", "t", "--columns", "L2,L3"]);
    assert!(
        status == Some(2) && err.contains("t:1:1: expected a column for --columns"),
        "{err}"
    );
}

#[test]
fn levels_set_aside_are_marked() {
    let root = workspace(false);
    // The rates 0.3, 2, 2, 2, and a level at the floor.
    let errors = [0.16, 0.13, 0.0325, 0.008125, 0.00203125, 1e-4];
    let row = |(k, error): (usize, &f64)| format!("{} {error}\n", 0.4 / f64::powi(2.0, k as i32));
    fs::write(
        root.path().join("t"),
        "h e\n".to_owned() + &errors.iter().enumerate().map(row).collect::<String>(),
    )
    .unwrap();
    let marks = |floor: &str| {
        let (_, out, _) = run(&root, &["rates", "t", "--order", "2", "--floor", floor]);
        let rows: Vec<&str> = out.lines().skip(2).take(errors.len()).collect();
        let marked = |mark: char| {
            rows.iter()
                .map(|row| row.contains(mark))
                .collect::<Vec<bool>>()
        };
        (marked('~'), marked('_'), out.clone())
    };
    let (coarse, fine, out) = marks("2e-4");
    assert_eq!(coarse, [true, false, false, false, false, false], "{out}");
    assert_eq!(fine, [false, false, false, false, false, true], "{out}");
    assert!(
        out.contains("_ set aside: not above the floor 2e-4") && out.contains("e: pass"),
        "{out}"
    );
    let (_, fine, out) = marks("0");
    assert!(!fine.contains(&true) && !out.contains("e: pass"), "{out}");
    let (_, fine, out) = marks("0.01");
    assert_eq!(fine, [false, false, false, true, true, true], "{out}");
}

#[test]
fn rates_write_figure_markdown_and_junit() {
    let root = workspace(false);
    fs::write(root.path().join("a&b|c"), RATES).unwrap();
    let (status, _, err) = run(
        &root,
        &[
            "rates",
            "a&b|c",
            "--order",
            "L2=2",
            "--order",
            "H1=2",
            "--out",
            "out/rates",
        ],
    );
    assert_eq!((status, err.as_str()), (Some(1), ""));
    let read = |name: &str| fs::read_to_string(root.path().join("out/rates").join(name)).unwrap();
    let (svg, junit, page) = (read("rates.svg"), read("junit.xml"), read("rates.md"));
    assert!(
        roxmltree::Document::parse(&svg)
            .unwrap()
            .descendants()
            .any(|node| node.has_tag_name("svg"))
    );
    assert!(svg.contains("L2, order 2, rate 2.000"), "{svg}");
    let document = roxmltree::Document::parse(&junit).unwrap();
    let cases: Vec<_> = document
        .descendants()
        .filter(|node| node.has_tag_name("testcase"))
        .collect();
    assert_eq!(cases.len(), 2);
    assert!(
        cases
            .iter()
            .all(|case| case.attribute("classname") == Some("a&b|c"))
    );
    let failure = document
        .descendants()
        .find(|node| node.has_tag_name("failure"))
        .unwrap();
    assert_eq!(
        failure.parent().unwrap().attribute("name"),
        Some("H1: order 2")
    );
    assert_eq!(document.root_element().attribute("failures"), Some("1"));
    assert!(
        page.starts_with("# Rates of a&b\\|c\n\n**fail**: 1 of 2 columns")
            && page.contains("](rates.svg)"),
        "{page}"
    );
    assert!(
        page.contains("    0.2  4.0000e-2   2.000000  2.0000e-1   1.000000"),
        "{page}"
    );
    fs::write(root.path().join("file"), "").unwrap();
    assert_eq!(
        run(
            &root,
            &["rates", "a&b|c", "--order", "L2=2", "--out", "file"]
        )
        .0,
        Some(2)
    );
}

#[test]
fn study_writes_a_report_that_says_how_to_repeat_it() {
    let root = workspace(true);
    let (status, out, err) = run(
        &root,
        &[
            "study",
            "studies/one.toml",
            "studies/two.toml",
            "--out",
            "out/a b",
            "--quiet",
        ],
    );
    assert_eq!((status, err.as_str()), (Some(1), ""));
    assert!(
        out.starts_with("two: fail") && out.ends_with("fail: 1 of 2 fail (two)\n"),
        "{out}"
    );
    let read = |name: &str| fs::read_to_string(root.path().join("out/a b").join(name)).unwrap();
    let page = read("README.md");
    assert!(page.contains("**fail**: 1 of 2 fail (two)\n"), "{page}");
    assert_eq!(
        page.matches("`powers study studies/one.toml studies/two.toml`")
            .count(),
        2,
        "{page}"
    );
    for (name, piece) in [
        ("index.html", "<svg"),
        ("junit.xml", "<failure"),
        ("results.json", "\"fail\""),
    ] {
        assert!(read(name).contains(piece), "{name}");
    }
    let (_, out, _) = run(&root, &["study", "studies/one.toml", "--out", "out"]);
    assert!(
        out.ends_with("\nreport: out/index.html, out/README.md\n"),
        "{out}"
    );
    // A report of `verify` goes where `--out` says, and each of its studies can be run by its id.
    assert_eq!(run(&root, &["verify", "--out", "elsewhere"]).0, Some(1));
    let page = fs::read_to_string(root.path().join("elsewhere/README.md")).unwrap();
    assert!(
        page.contains("Again: `powers verify two` (tier quick")
            && !root.path().join("reports").exists(),
        "{page}"
    );
}

#[test]
fn a_report_that_cannot_be_written_is_found_before_the_run_or_takes_no_result() {
    let root = workspace(false);
    let study = |out: &str| run(&root, &["study", "studies/one.toml", "--out", out]);
    fs::write(root.path().join("file"), "").unwrap();
    let (status, out, err) = study("file");
    assert!(
        status == Some(2) && out.is_empty() && err.starts_with("error: file: "),
        "{err}"
    );
    fs::create_dir(root.path().join("out")).unwrap();
    fs::write(root.path().join("out/local"), "").unwrap();
    let (status, out, err) = study("out");
    assert!(
        status == Some(2) && err.contains("out: the reports cannot be written"),
        "{err}"
    );
    assert!(
        out.starts_with("one: pass") && !out.contains("report:"),
        "{out}"
    );

    let leaves_a_trace = "[study]\nid = \"two\"\nclaim = \"c\"\ntier = \"quick\"\nkind = \"program\"\n[program]\n\
                          command = [\"touch\", \"ran-{n}\"]\n[refine]\nn = [4, 8, 16]\n\
                          [[expect]]\nerror = \"L2\"\norder = 2.0\ntolerance = 0.1\n";
    fs::write(root.path().join("studies/two.toml"), leaves_a_trace).unwrap();
    let (status, out, err) = run(&root, &["verify", "--out", "file"]);
    assert!(
        status == Some(2) && out.is_empty() && err.contains("file: the reports cannot be written"),
        "{err}"
    );
    let trace = root.path().join("studies/ran-4");
    assert!(!trace.exists(), "the study was run");
    assert_eq!(run(&root, &["verify"]).0, Some(1));
    assert!(trace.exists());
}

#[test]
fn json_is_alone_on_standard_output() {
    let root = workspace(true);
    for arguments in [&["verify"][..], &["study", "studies/two.toml"]] {
        let mut command = command(root.path(), arguments);
        let summary = root.path().join("summary.md");
        command
            .args(["--format", "json"])
            .env("GITHUB_ACTIONS", "true")
            .env("GITHUB_STEP_SUMMARY", &summary);
        let (status, out, err) = texts(&mut command);
        let object: serde_json::Value = serde_json::from_str(&out).unwrap();
        assert_eq!(
            (status, &object["verdict"], &object["schema"]),
            (Some(1), &"fail".into(), &1.into())
        );
        assert!(
            err.starts_with("::error title=two%3A fail::"),
            "{arguments:?}: {err}"
        );
        assert!(
            fs::read_to_string(&summary).unwrap().contains("**fail**"),
            "{arguments:?}"
        );
        fs::remove_file(summary).unwrap();
    }
}

#[test]
fn a_new_study_of_a_program_passes_as_it_is() {
    let root = tempfile::tempdir().unwrap();
    let (status, out, err) = run(&root, &["new", "program", "mine"]);
    assert_eq!((status, err.as_str()), (Some(0), ""));
    assert_eq!(
        out,
        "wrote mine.toml, mine.py\nnow  powers study mine.toml\nand  powers explain mine.toml\n"
    );
    let text = fs::read_to_string(root.path().join("mine.toml")).unwrap();
    assert!(
        text.contains("powers study mine.toml")
            && !text.contains("NAME")
            && !text.contains("PROGRAM"),
        "{text}"
    );
    let (status, out, err) = run(&root, &["study", "mine.toml"]);
    if Command::new("python3").arg("--version").output().is_ok() {
        assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    } else {
        assert!(
            status == Some(1) && out.contains("python3 cannot be started"),
            "{out}"
        );
    }
    // In a folder of a repository the program runs from the folder of the command: from its root.
    let (status, out, err) = run(&root, &["new", "program", "other", "--out", "studies"]);
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    let text = fs::read_to_string(root.path().join("studies/other.toml")).unwrap();
    assert!(
        text.contains("directory = \"..\"") && text.contains("\"studies/other.py\""),
        "{text}"
    );
    // What the commands write there, git ignores: they write below the folder that they run in.
    assert!(!root.path().join("studies/.gitignore").exists());
    let git = |words: &[&str]| {
        Command::new("git")
            .args(words)
            .current_dir(root.path())
            .output()
    };
    if git(&["init", "--quiet"]).is_ok() {
        for written in ["report/index.html", "reports/local/x.json"] {
            assert!(
                git(&["check-ignore", written]).unwrap().status.success(),
                "{written}"
            );
        }
        for kept in [
            "studies/other.toml",
            "studies/report/x",
            "reports/README.md",
        ] {
            assert!(
                !git(&["check-ignore", kept]).unwrap().status.success(),
                "{kept}"
            );
        }
    }
    if Command::new("python3").arg("--version").output().is_ok() {
        assert_eq!(run(&root, &["study", "studies/other.toml"]).0, Some(0));
        fs::write(
            root.path().join("studies/other.py"),
            "print('max error: 1e-3')\n",
        )
        .unwrap();
        let (_, out, _) = run(&root, &["study", "studies/other.toml"]);
        assert!(
            out.contains("expected a last line such as {\"errors\": {\"max\": 0.001}}"),
            "{out}"
        );
        // In the check and in the table of cases: once each, although the last lines differ.
        let program =
            "import sys\nprint('level', sys.argv[1], 'max', 1 / int(sys.argv[1]), 'in 3')\n";
        fs::write(root.path().join("studies/other.py"), program).unwrap();
        let (_, out, _) = run(&root, &["study", "studies/other.toml"]);
        assert_eq!(
            out.matches("expected a last line such as {\"errors\": {\"max\": 0.125}}")
                .count(),
            2,
            "{out}"
        );
        assert_eq!(
            out.matches("expected a last line such as").count(),
            2,
            "{out}"
        );
    }
    // The second file exists: the first is not written either.
    fs::remove_file(root.path().join("mine.toml")).unwrap();
    let (status, _, err) = run(&root, &["new", "program", "mine"]);
    assert!(
        status == Some(2) && err.contains("mine.py: expected a new file"),
        "{err}"
    );
    assert!(!root.path().join("mine.toml").exists());
    let (status, _, err) = run(&root, &["new", "novel", "mine"]);
    assert!(status == Some(2) && err.contains("program"), "{err}");
}

#[test]
fn every_command_is_in_the_help() {
    let (status, out, _) = run(&workspace(false), &["--help"]);
    assert_eq!(status, Some(0));
    assert!(
        cli::COMMANDS
            .iter()
            .all(|name| out.contains(&format!("\n  {name}"))),
        "{out}"
    );
    assert!(out.contains("Exit status: 0 "), "{out}");
    for name in cli::COMMANDS {
        let (status, out, _) = run(&workspace(false), &[name, "--help"]);
        let widest = out.lines().map(|line| line.chars().count()).max();
        assert!(status == Some(0) && widest <= Some(100), "{out}");
    }
}
