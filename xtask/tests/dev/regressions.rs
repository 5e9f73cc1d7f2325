//! `dev regressions`, with a fake cargo that builds the test's own `verify`.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::{Ended, ended, program, xtask};

/// Builds a `verify` that passes if `src/a.rs` holds a 1, and otherwise prints the findings of the
/// study `s`.
const CARGO: &str = r#"#!/bin/sh
while [ $# -gt 0 ]; do [ "$1" = --target-dir ] && out="$2"; shift; done
grep -q '{' src/a.rs && { echo "mismatched brackets" >&2; exit 101; }
mkdir -p "$out/regressions"
cat > "$out/regressions/xtask" <<'END'
#!/bin/sh
echo run >> ../runs
while [ $# -gt 0 ]; do [ "$1" = --out ] && out="$2"; shift; done
mkdir -p "$out"
head='{"schema": 1, "crate_version": "0", "scope": "quick", '
study='{"id": "s", "claim": "c", "tier": "quick", "kind": "k", "summary": "", "levels": [], "rates": [], "quantities": [], "failed_cases": [], "not_finite": [], '
if grep -q 1 src/a.rs; then
  echo "$head"'"verdict": "pass", "baseline_changes": [], "studies": []}' > "$out/results.json"
  exit 0
fi
check='"checks": [{"claim": "velocity", "verdict": "fail", "evidence": "the rate is low"}]'
moved='"baseline_changes": ["t: error moved from 1 to 2"], "changes": []'
echo "$head"'"verdict": "fail", '"$moved"', "studies": ['"$study"'"verdict": "fail", '"$check"'}]}' > "$out/results.json"
exit 1
END
chmod +x "$out/regressions/xtask"
"#;

fn workspace(folder: &TempDir) -> PathBuf {
    let root = folder.path().join("w");
    for name in ["studies", "src", "xtask"] {
        fs::create_dir_all(root.join(name)).expect("a folder");
    }
    fs::write(root.join("Cargo.toml"), "").expect("a file");
    fs::write(root.join("src/a.rs"), "one = 1;").expect("a file");
    program(&root.join("cargo"), CARGO);
    root
}

fn entry(name: &str, [old, new]: [&str; 2], [study, says]: [&str; 2]) -> String {
    format!(
        "[[regression]]\nname = \"{name}\"\nmethod = [\"both\"]\nfile = \"src/a.rs\"\nstudy = \"{study}\"\nsays = \"{says}\"\n\
         [[regression.edits]]\nold = \"{old}\"\nnew = \"{new}\"\n"
    )
}

fn regressions(root: &Path, list: &str, arguments: &[&str]) -> Ended {
    fs::write(root.join("xtask/regressions.toml"), list).expect("a file");
    let mut command = xtask();
    command
        .args(["dev", "regressions"])
        .args(arguments)
        .current_dir(root);
    ended(
        command
            .env("CARGO", root.join("cargo"))
            .env_remove("CARGO_MANIFEST_DIR"),
    )
}

#[test]
fn a_mistake_is_noticed_only_where_its_study_names_it() {
    if !foreign_tools::are_here(&[foreign_tools::BASH]) {
        return;
    }
    let folder = TempDir::new().expect("a folder");
    let root = workspace(&folder);
    let noticed = entry("two for one", ["1", "2"], ["s", "velocity"])
        + &entry("moved", ["1", "3"], ["t", "error moved"]);
    let ended = regressions(&root, &noticed, &["--write"]);
    assert_eq!(ended.status, Some(0), "{}{}", ended.stdout, ended.stderr);
    assert!(
        ended.stdout.contains("2 of 2 mistakes are noticed"),
        "{}",
        ended.stdout
    );
    let page = fs::read_to_string(root.join("reports/regressions.md")).expect("a report");
    assert!(
        page.contains("| two for one | src/a.rs | s          |")
            && ended.stdout.contains("s: velocity: the rate is low"),
        "{page}{}",
        ended.stdout
    );
    assert!(
        page.contains("| written | 2 of 2 |")
            && ended
                .stdout
                .contains("- **moved**, `src/a.rs`: method right"),
        "{page}{}",
        ended.stdout
    );
    // Results are kept, and nothing is run again.
    let runs = || {
        fs::read_to_string(root.join("target/regressions/runs"))
            .expect("runs")
            .lines()
            .count()
    };
    assert_eq!(runs(), 3);
    assert_eq!(regressions(&root, &noticed, &[]).status, Some(0));
    assert_eq!(runs(), 3);
    // Another study, other words, or an edit without effect.
    for unnoticed in [["s", "error moved"], ["t", "velocity"], ["u", ""]] {
        let list = noticed.clone() + &entry("unseen", ["1", "4"], unnoticed);
        let ended = regressions(&root, &list, &["--only", "unseen"]);
        assert_eq!(ended.status, Some(1), "{}", ended.stdout);
        assert!(
            ended.stdout.contains("0 of 1") && ended.stderr.contains("unseen: not noticed"),
            "{}",
            ended.stderr
        );
    }
    let harmless = regressions(
        &root,
        &entry("harmless", ["one", "two"], ["s", "velocity"]),
        &[],
    );
    assert!(
        harmless.status == Some(1) && harmless.stderr.contains("harmless: not noticed"),
        "{}",
        harmless.stderr
    );
    assert_eq!(
        fs::read_to_string(root.join("src/a.rs")).expect("a file"),
        "one = 1;",
        "the work tree is not touched"
    );
}

#[test]
fn a_list_that_cannot_be_planted_is_refused_by_name() {
    if !foreign_tools::are_here(&[foreign_tools::BASH]) {
        return;
    }
    let folder = TempDir::new().expect("a folder");
    let root = workspace(&folder);
    let s = ["s", "velocity"];
    for (list, words) in [
        (
            entry("gone", ["two", "three"], s),
            "\"gone\": found 0 times in src/a.rs",
        ),
        (
            entry("twice", ["e", "f"], s) + &entry("twice", ["e", "f"], s),
            "found a second \"twice\"",
        ),
        (
            entry("nothing", ["1", "1"], s),
            "\"nothing\": found 1 times",
        ),
        (entry("torn", ["1", "{"], s), "mismatched brackets"),
        ("[[regression]]\nname = 3\n".to_owned(), "regressions.toml"),
    ] {
        let ended = regressions(&root, &list, &[]);
        assert!(
            ended.status == Some(2) && ended.stderr.contains(words),
            "{}",
            ended.stderr
        );
        assert_eq!(ended.stdout, "");
    }
    let none = regressions(&root, &entry("two", ["1", "2"], s), &["--only", "three"]);
    assert!(
        none.status == Some(2) && none.stderr.contains("no regression with three"),
        "{}",
        none.stderr
    );
    // If `verify` fails without a mistake, it would seem to notice every mistake.
    fs::write(root.join("src/a.rs"), "one = 7;").expect("a file");
    let failing = regressions(&root, &entry("seven", ["7", "1"], s), &["--write"]);
    assert!(
        failing.status == Some(2) && failing.stderr.contains("without a mistake"),
        "{}",
        failing.stderr
    );
    assert!(!root.join("reports").exists());
}
