//! A project's command line.

mod begun;
mod changes;
mod failing;
mod first;
mod manufacture;
mod options;
mod rates;
mod several;
mod tables;
mod visible;
#[cfg(unix)]
mod where_lost;

use convergence_study::command_line::Command as Harness;
use convergence_study_tests::{Ended, finished, output};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// The variable with the order that `powers` claims instead of 1.
const ORDER: &str = "CONVERGENCE_STUDY_TESTS_ORDER";

/// A workspace with the studies `one`, which passes, and `two`, which fails, if wanted.
fn workspace(with_a_failure: bool) -> TempDir {
    let root = tempfile::tempdir().unwrap();
    fs::create_dir(root.path().join("studies")).unwrap();
    write(&root, "studies/one.toml", study("one", "c", 1.0));
    if with_a_failure {
        write(&root, "studies/two.toml", study("two", "c", 0.5));
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

#[track_caller]
fn read(root: &TempDir, name: &str) -> String {
    fs::read_to_string(root.path().join(name)).unwrap()
}

#[track_caller]
fn write(root: &TempDir, name: &str, text: impl AsRef<[u8]>) {
    fs::write(root.path().join(name), text).unwrap();
}

/// A command line of words without blanks.
fn run(root: &TempDir, line: &str) -> Ended {
    run_words(root, &line.split_whitespace().collect::<Vec<_>>())
}

fn run_words(root: &TempDir, arguments: &[&str]) -> Ended {
    texts(&mut command(root.path(), arguments))
}

/// Exit status, standard output and standard error.
fn texts(command: &mut Command) -> Ended {
    output(command).into()
}

#[test]
fn verify_ends_with_0_1_or_2() {
    let root = workspace(false);
    run(&root, "verify").says(1, "");
    run(&root, "verify --bless").says(0, "");
    run(&root, "verify").says(0, "pass: the study passes");
    write(&root, "studies/two.toml", study("two", "c", 0.5));
    run(&root, "verify").says(1, "");
    write(
        &root,
        "studies/two.toml",
        study("two", "c", 1.0).replace("kind = \"power\"", ""),
    );
    run(&root, "verify").complains(2, "two.toml:2:1: study.kind: missing; expected \"power\"");
    write(&root, "studies/two.toml", "[study]\n");
    let (status, _, err) = run(&root, "verify").parts();
    assert!(
        status == Some(2) && err.starts_with("error: studies/two.toml:1:1: study.id: missing"),
        "{err}"
    );
}

#[test]
fn an_unwritable_job_summary_keeps_the_exit_status() {
    for (with_a_failure, status) in [(false, 0), (true, 1)] {
        let root = workspace(with_a_failure);
        run(&root, "verify one --bless");
        let scope = if with_a_failure { "two" } else { "one" };
        for page in ["/nowhere/page", "."] {
            let mut command = command(root.path(), &["verify", scope]);
            texts(command.env("GITHUB_STEP_SUMMARY", page)).complains(
                status,
                &format!("GITHUB_STEP_SUMMARY={page}: cannot write the job summary"),
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

#[cfg(unix)]
fn pipe(path: &Path) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

#[cfg(unix)]
#[test]
fn pipes_in_place_of_records_do_not_hang() {
    if !foreign_tools::are_here(&[foreign_tools::MKFIFO]) {
        return;
    }
    for (file, line) in [
        ("studies/baseline.json", "verify"),
        ("reports/results.json", "list"),
        ("reports/local/provenance.json", "list"),
        ("reports/local/lock", "verify"),
    ] {
        let root = workspace(false);
        pipe(&root.path().join(file));
        run(&root, line).complains(2, "expected a regular file");
    }
}

/// Runs the program with a text as its standard input; it must pass.
#[track_caller]
fn passes_with_input(text: &str, arguments: &[&str]) {
    let root = workspace(false);
    let mut child = command(root.path(), arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    std::io::Write::write_all(&mut child.stdin.take().unwrap(), text.as_bytes()).unwrap();
    assert_eq!(finished(child).status.code(), Some(0), "{arguments:?}");
}

#[test]
fn a_table_comes_from_standard_input() {
    let table = "# h e\n0.4 4.00e-1\n0.2 2.00e-1\n0.1 1.00e-1\n0.05 5.00e-2\n";
    passes_with_input(table, &["rates", "-", "--order", "1"]);
}

#[cfg(unix)]
#[test]
fn tables_and_studies_come_from_a_file_that_is_standard_input() {
    let table = "h,e\n0.4,4.00e-1\n0.2,2.00e-1\n0.1,1.00e-1\n0.05,5.00e-2\n";
    passes_with_input(table, &["rates", "/dev/stdin", "--order", "1"]);
    passes_with_input(&study("one", "c", 1.0), &["study", "/dev/stdin"]);
}

#[test]
fn study_writes_a_report_that_says_how_to_repeat_it() {
    let root = workspace(true);
    let (status, out, err) = run_words(
        &root,
        &[
            "study",
            "studies/one.toml",
            "studies/two.toml",
            "--out",
            "out/a b",
            "--quiet",
        ],
    )
    .parts();
    assert_eq!((status, err.as_str()), (Some(1), ""));
    assert!(
        out.starts_with("two: fail") && out.ends_with("fail: 1 of 2 fail (two)\n"),
        "{out}"
    );
    let read = |name: &str| fs::read_to_string(root.path().join("out/a b").join(name)).unwrap();
    let page = read("README.md");
    assert!(page.contains("**fail**: 1 of 2 fail (two)\n"), "{page}");
    assert!(
        page.contains("`powers study studies/one.toml studies/two.toml`"),
        "{page}"
    );
    for (name, piece) in [
        ("index.html", "<svg"),
        ("index.html", "Again: <code>powers study studies/one.toml "),
        ("junit.xml", "<failure"),
        ("results.json", "\"fail\""),
    ] {
        assert!(read(name).contains(piece), "{name}");
    }
    let (_, out, _) = run(&root, "study studies/one.toml --out out").parts();
    assert!(
        out.ends_with("\nreport: out/index.html, out/README.md\n"),
        "{out}"
    );
    // A report of `verify` goes where `--out` says, and each of its studies can be run by its id.
    run(&root, "verify --out elsewhere").says(1, "");
    let page = self::read(&root, "elsewhere/local/quick/index.html");
    assert!(
        page.contains("Again: <code>powers verify two</code> (tier quick")
            && !root.path().join("reports").exists(),
        "{page}"
    );
}

#[test]
fn a_report_that_cannot_be_written_is_found_before_the_run_or_takes_no_result() {
    if !foreign_tools::are_here(&[foreign_tools::TOUCH]) {
        return;
    }
    let root = workspace(false);
    let study = |out: &str| run_words(&root, &["study", "studies/one.toml", "--out", out]);
    write(&root, "file", "");
    let (status, out, err) = study("file").parts();
    assert!(
        status == Some(2) && out.is_empty() && err.starts_with("error: file: "),
        "{err}"
    );
    fs::create_dir(root.path().join("out")).unwrap();
    write(&root, "out/local", "");
    let (status, out, err) = study("out").parts();
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
    write(&root, "studies/two.toml", leaves_a_trace);
    run(&root, "verify --out file").refuses("file: the reports cannot be written");
    let trace = root.path().join("studies/ran-4");
    assert!(!trace.exists(), "the study was run");
    run(&root, "verify").says(1, "");
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
        let (status, out, err) = texts(&mut command).parts();
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
    let (status, out, err) = run(&root, "new program mine").parts();
    assert_eq!((status, err.as_str()), (Some(0), ""));
    assert_eq!(
        out,
        "wrote mine.toml, mine.py\nrun: powers study mine.toml\n"
    );
    let text = read(&root, "mine.toml");
    assert!(
        text.contains("powers study mine.toml")
            && !text.contains("NAME")
            && !text.contains("PROGRAM"),
        "{text}"
    );
    let (status, out, err) = run(&root, "study mine.toml").parts();
    if foreign_tools::is_here(foreign_tools::PYTHON) {
        assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    } else {
        assert!(
            status == Some(1) && out.contains("python3 cannot be started"),
            "{out}"
        );
    }
    // In a folder of a repository the program runs from the folder of the command: from its root.
    let (status, out, err) = run(&root, "new program other --out studies").parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    let text = read(&root, "studies/other.toml");
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
    if foreign_tools::is_here(foreign_tools::PYTHON) {
        run(&root, "study studies/other.toml").says(0, "");
        write(&root, "studies/other.py", "print('max error: 1e-3')\n");
        let (_, out, _) = run(&root, "study studies/other.toml").parts();
        assert!(
            out.contains("expected a last line such as {\"errors\": {\"max\": 0.001}}"),
            "{out}"
        );
        // In the check and in the table of cases: once each, although the last lines differ.
        let program =
            "import sys\nprint('level', sys.argv[1], 'max', 1 / int(sys.argv[1]), 'in 3')\n";
        write(&root, "studies/other.py", program);
        let (_, out, _) = run(&root, "study studies/other.toml").parts();
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
    run(&root, "new program mine --out .").complains(2, "mine.py: expected a new file");
    assert!(!root.path().join("mine.toml").exists());
    run(&root, "new novel mine").complains(2, "program");
}

#[test]
fn every_command_is_in_the_help() {
    let (status, out, _) = run(&workspace(false), "--help").parts();
    assert_eq!(status, Some(0));
    assert!(
        Harness::NAMES
            .iter()
            .all(|name| out.contains(&format!("\n  {name}"))),
        "{out}"
    );
    assert!(out.contains("Exit status: 0 "), "{out}");
    for name in Harness::NAMES {
        let (status, out, _) = run(&workspace(false), &format!("{name} --help")).parts();
        let widest = out.lines().map(|line| line.chars().count()).max();
        assert!(status == Some(0) && widest <= Some(100), "{out}");
    }
}
