//! `mutants`, with a cargo-mutants whose answers the test sets.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::{Ended, ended, program, xtask};

/// Has three mutants, all of the solver; the tests catch the first, and the quick tier whatever `caught` names besides.
const CARGO: &str = r#"#!/bin/sh
[ "$2" = --version ] && exit 0
[ "$1" = test ] && { [ ! -e broken ]; exit; }
echo "$*" >> calls
case "$*" in *"--test-package xtask"*) quick=yes ;; esac
while [ $# -gt 0 ]; do
    case "$1" in
    --output) out="$2/mutants.out"; rm -rf "$out"; mkdir -p "$out"; touch "$out/missed.txt" ;;
    --package) package="$2" ;;
    --re)
        name=$(echo "$2" | sed 's/^^//; s/\$$//; s/\\//g')
        grep -qF "$name" caught || echo "$name" >> "$out/missed.txt" ;;
    esac
    shift
done
if [ -z "$quick" ] && [ "$package" = thermobeam ]; then
    echo "src/a.rs:2:5: replace + with - in three" >> "$out/missed.txt"
    echo "src/a.rs:3:7: replace * with / in four" >> "$out/missed.txt"
fi
[ -s "$out/missed.txt" ] && exit 2
exit 0
"#;

fn workspace(folder: &TempDir) -> PathBuf {
    let root = folder.path().join("w");
    for name in ["studies", "src", "bin", ".cargo"] {
        fs::create_dir_all(root.join(name)).expect("a folder");
    }
    for (name, text) in [("caught", ""), ("src/a.rs", "fn one() {}\n  a + b;\nc * d;\n")] {
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

#[test]
fn a_survivor_fails_until_the_quick_tier_catches_it_or_a_reason_is_given() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = workspace(&folder);
    let calls = || fs::read_to_string(root.join("calls")).unwrap_or_default();
    let first = mutants(&root, &["--", "--jobs", "2"]);
    assert_eq!((first.status, calls().lines().count()), (Some(1), 4), "{}{}", first.stderr, calls());
    assert!(calls().contains("--file crates/thermobeam/src/** --jobs 2"), "{}", calls());
    assert!(first.stdout.starts_with("2 mutants missed"), "{}", first.stdout);
    assert!(first.stderr.contains("missed: src/a.rs:3:7: replace * with / in four"), "{}", first.stderr);
    fs::write(root.join("caught"), "src/a.rs:2:5: replace + with - in three\n").expect("a file");
    assert!(mutants(&root, &[]).stdout.starts_with("1 mutants missed"));
    assert_eq!(mutants(&root, &["--package", "thermobeam-exact"]).status, Some(0));

    let list = root.join(".cargo/mutants-accepted.toml");
    let entry = |code: &str, reason: &str| {
        let entry =
            format!("[[accepted]]\nfile = \"src/a.rs\"\nmutant = \"replace * with / in four\"\ncode = \"{code}\"");
        fs::write(&list, format!("{entry}\nreason = \"{reason}\"\n")).expect("a file");
    };
    entry("c * d;", "d is 1");
    let explained = mutants(&root, &[]);
    assert_eq!(explained.status, Some(0), "{}{}", explained.stdout, explained.stderr);
    entry("c * d;", " ");
    assert_eq!(mutants(&root, &[]).status, Some(2));
    // An entry about what is gone is one too many.
    entry("d * c;", "d is 1");
    let changed = mutants(&root, &[]);
    assert!(changed.status == Some(1) && changed.stderr.contains("no such line"), "{}", changed.stderr);
}

#[test]
fn a_quick_tier_that_fails_without_a_mutant_judges_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = workspace(&folder);
    fs::write(root.join("broken"), "").expect("a file");
    let ended = mutants(&root, &[]);
    let why = "without a mutant this fails: cargo test --quiet --profile=mutants --package";
    assert!(ended.status == Some(2) && ended.stderr.contains(why), "{}", ended.stderr);
}

#[test]
fn without_cargo_mutants_it_is_said_how_to_get_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = workspace(&folder);
    fs::write(root.join("bin/cargo"), "#!/bin/sh\nexit 101\n").expect("a file");
    let missing = mutants(&root, &[]);
    assert_eq!((missing.status, missing.stdout.as_str()), (Some(2), ""));
    assert!(missing.stderr.contains("cargo install --locked cargo-mutants"), "{}", missing.stderr);
    assert!(!root.join("target").exists());
    fs::write(root.join(".cargo/mutants-accepted.toml"), "[[accepted]]\nfile = 3\n").expect("a file");
    let unusable = mutants(&root, &[]);
    assert!(unusable.status == Some(2) && unusable.stderr.contains("mutants-accepted.toml"), "{}", unusable.stderr);
}
