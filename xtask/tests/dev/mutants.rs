//! `mutants`, with a cargo-mutants whose answers the test sets.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::{Ended, ended, program, xtask};

/// Lists three mutants, all of the solver; the tests catch the first, and whatever `caught` names besides.
/// It counts its calls.
const CARGO: &str = r#"#!/bin/sh
[ "$2" = --version ] && exit 0
[ "$1" = test ] && { [ ! -e broken ]; exit; }
if [ "$2" = --list ]; then
    case "$*" in *thermobeam-*) exit 0 ;; esac
    echo "src/a.rs:1:9: replace one with two"
    echo "src/a.rs:2:5: replace + with - in three"
    echo "src/a.rs:3:7: replace * with / in four"
    exit 0
fi
echo "$*" >> calls
status=0
while [ $# -gt 0 ]; do
    case "$1" in
    --output) out="$2/mutants.out"; rm -rf "$out"; mkdir -p "$out" ;;
    --re)
        name=$(echo "$2" | sed 's/^^//; s/\$$//; s/\\//g')
        case "$name" in
        *one*) echo "$name" >> "$out/caught.txt" ;;
        *) if grep -qF "$name" caught; then echo "$name" >> "$out/caught.txt"; else
            echo "$name" >> "$out/missed.txt"; status=2; fi ;;
        esac ;;
    esac
    shift
done
exit $status
"#;

fn workspace(folder: &TempDir) -> PathBuf {
    let root = folder.path().join("w");
    for name in ["studies", "src", "bin", ".cargo"] {
        fs::create_dir_all(root.join(name)).expect("a folder");
    }
    for (name, text) in [("Cargo.toml", ""), ("caught", ""), ("src/a.rs", "fn one() {}\n  a + b;\nc * d;\n")] {
        fs::write(root.join(name), text).expect("a file");
    }
    program(&root.join("bin/cargo"), CARGO);
    root
}

fn mutants(root: &Path, arguments: &[&str]) -> Ended {
    let path = format!("{}:{}", root.join("bin").display(), std::env::var("PATH").unwrap_or_default());
    let mut command = xtask();
    command.args(["dev", "mutants"]).args(arguments).current_dir(root).env("PATH", path);
    ended(&mut command)
}

fn calls(root: &Path) -> usize {
    fs::read_to_string(root.join("calls")).map_or(0, |calls| calls.lines().count())
}

#[test]
fn a_survivor_fails_until_a_test_catches_it_or_a_reason_is_given() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = workspace(&folder);
    let first = mutants(&root, &[]);
    assert_eq!((first.status, calls(&root)), (Some(1), 3), "{}", first.stderr);
    assert!(
        first.stdout.contains("3 mutants: 1 caught, 0 timed out, 0 accepted with a reason, 2 missed"),
        "{}",
        first.stdout
    );
    let page = || {
        let page = fs::read_to_string(root.join("reports/mutants.md")).expect("a report");
        page.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ") + "\n").collect::<String>()
    };
    assert!(page().contains("| src/a.rs | replace + with - in three | `a + b;` | none |"), "{}", page());
    assert!(page().contains("| src/a.rs | 1 | 0 | 0 | 2 | 0 | 0 | 33.3 % |"), "{}", page());

    // What is known is not judged again, unless it was missed and a test was added.
    assert_eq!((mutants(&root, &[]).status, calls(&root)), (Some(1), 3));
    fs::write(root.join("caught"), "src/a.rs:2:5: replace + with - in three\n").expect("a file");
    let again = mutants(&root, &["--again"]);
    assert!(again.stdout.contains("2 caught") && again.stdout.contains("1 missed"), "{}", again.stdout);

    let list = root.join(".cargo/mutants-accepted.toml");
    let entry = |reason: &str| {
        let entry = "[[accepted]]\nfile = \"src/a.rs\"\nmutant = \"replace * with / in four\"\ncode = \"c * d;\"";
        fs::write(&list, format!("{entry}\nreason = \"{reason}\"\n")).expect("a file");
    };
    entry("d is 1");
    let explained = mutants(&root, &[]);
    assert_eq!(explained.status, Some(0), "{}{}", explained.stdout, explained.stderr);
    assert!(page().contains("| `c * d;` | d is 1 |"), "{}", page());
    // What is accepted is not judged again, and is shown to one judge only.
    let before = calls(&root);
    assert_eq!((mutants(&root, &["--again"]).status, calls(&root)), (Some(0), before));
    fs::remove_file(root.join("target/mutants/outcomes.tsv")).expect("a ledger");
    assert_eq!((mutants(&root, &[]).status, calls(&root)), (Some(0), before + 1));
    // A test that is added to a file changes nothing of what is known.
    let tested = fs::read_to_string(root.join("src/a.rs")).expect("a file") + "\n#[cfg(test)]\nmod tests {}\n";
    fs::write(root.join("src/a.rs"), tested).expect("a file");
    assert_eq!((mutants(&root, &[]).status, calls(&root)), (Some(0), before + 1));
    entry(" ");
    assert_eq!(mutants(&root, &[]).status, Some(2));

    // Where the file has changed, everything is open again, and an entry about what is gone is one too many.
    entry("d is 1");
    fs::write(root.join("src/a.rs"), "fn one() {}\n  a + b;\nd * c;\n").expect("a file");
    let changed = mutants(&root, &["--report"]);
    assert_eq!(changed.status, Some(1));
    assert!(changed.stdout.contains("3 open") && changed.stderr.contains("no such mutant"), "{}", changed.stderr);
}

#[test]
fn tests_that_fail_without_a_mutant_judge_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = workspace(&folder);
    fs::write(root.join("broken"), "").expect("a file");
    let ended = mutants(&root, &[]);
    assert_eq!((ended.status, calls(&root)), (Some(2), 2), "{}", ended.stderr);
    assert!(ended.stderr.contains("without a mutant this fails: cargo test --profile=mutants --package xtask"));
    // What is missed so far is open, not left out.
    fs::remove_file(root.join("broken")).expect("a file");
    let report = mutants(&root, &["--report", "--sample", "0"]);
    assert!(report.stdout.contains("3 mutants: 1 caught") && report.stdout.contains("2 open"), "{}", report.stdout);
    // What the judges before have said is kept.
    assert!(fs::read_to_string(root.join("target/mutants/outcomes.tsv")).expect("a ledger").lines().count() == 5);
}

#[test]
fn a_sample_is_the_same_for_the_same_seed_and_part_of_a_larger_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = workspace(&folder);
    assert!(mutants(&root, &["--sample", "1"]).stdout.contains("1 mutants: "));
    let one = fs::read_to_string(root.join("target/mutants/outcomes.tsv")).expect("a ledger");
    assert!(mutants(&root, &["--sample", "2"]).stdout.contains("2 mutants: "));
    let two = fs::read_to_string(root.join("target/mutants/outcomes.tsv")).expect("a ledger");
    assert!(two.starts_with(&one) && two.len() > one.len());
}

#[test]
fn without_cargo_mutants_it_is_said_how_to_get_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = workspace(&folder);
    fs::write(root.join("bin/cargo"), "#!/bin/sh\nexit 101\n").expect("a file");
    let missing = mutants(&root, &[]);
    assert_eq!((missing.status, missing.stdout.as_str()), (Some(2), ""));
    assert!(missing.stderr.contains("cargo install --locked cargo-mutants"), "{}", missing.stderr);
    assert!(!root.join("reports").exists() && !root.join("target").exists());
    fs::write(root.join(".cargo/mutants-accepted.toml"), "[[accepted]]\nfile = 3\n").expect("a file");
    let unusable = mutants(&root, &[]);
    assert!(unusable.status == Some(2) && unusable.stderr.contains("mutants-accepted.toml"), "{}", unusable.stderr);
}
