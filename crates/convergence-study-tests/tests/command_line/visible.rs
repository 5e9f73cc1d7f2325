//! Texts of files and programs neither command a terminal nor annotate a job.

use std::fs;

use super::{command, run, run_words, study, texts, workspace, write};

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
fn annotations_are_commands_and_nothing_else_is() {
    let root = workspace();
    run(&root, "verify --bless").says(0, "");
    for (id, claim, exponent) in [("one", "c", 1.01), ("two", "::error title=forged::x", 0.5)] {
        let path = root.path().join(format!("studies/{id}.toml"));
        fs::write(path, study(id, claim, exponent)).unwrap();
    }
    let mut command = command(root.path(), &["verify"]);
    let (status, out, _) = texts(command.env("GITHUB_ACTIONS", "true")).parts();
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
    let (_, out, _) = run(&root, "study studies/two.toml").parts();
    assert!(out.contains("\n: :error title=forged::x\n"), "{out}");
    is_harmless(&out);
    is_harmless(&run(&root, "list").stdout);
}

#[test]
fn claims_and_ids_with_control_characters_are_refused() {
    let root = workspace();
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
        write(&root, "a.toml", study(id, claim, 1.0));
        let (status, out, err) = run(&root, "study a.toml").parts();
        assert!(
            status == Some(2) && out.is_empty() && err.contains(words),
            "{err}"
        );
        is_harmless(&err);
    }
    // Written raw, TOML itself refuses them.
    write(&root, "a.toml", study("a", "c\x1b[31m", 1.0));
    let (status, _, err) = run(&root, "study a.toml").parts();
    assert!(status == Some(2) && err.contains("not valid TOML"), "{err}");
    is_harmless(&err);
}

#[test]
fn names_of_columns_and_files_are_no_commands() {
    let root = workspace();
    let table =
        |name: &str| format!("h,{name}\n0.4,4.00e-1\n0.2,2.00e-1\n0.1,1.00e-1\n0.05,5.00e-2\n");
    let write = |name: &str, text: String| write(&root, name, text);
    for name in ["a\x1b", "a\u{9b}b", "\x07"] {
        write("table.csv", table(name));
        let (status, out, err) = run(&root, "rates table.csv --order 1").parts();
        assert!(status == Some(2) && out.is_empty(), "{name:?}: {out}");
        assert!(
            err.contains("table.csv:1:1: expected a name without control characters, found `"),
            "{err}"
        );
        is_harmless(&err);
    }
    write("table.csv", table("::error title=x::forged"));
    let (status, out, _) = run(&root, "rates table.csv --order 1").parts();
    assert_eq!(status, Some(0), "{out}");
    is_harmless(&out);
    let file = "a\n::error::x\x1b[31m.csv";
    write(file, "h\n".to_owned());
    for name in ["rates", "study", "verify", "list"] {
        let (status, out, err) = run_words(&root, &[name, file]).parts();
        assert_eq!(status, Some(2), "{name}");
        is_harmless(&out);
        is_harmless(&err);
    }
}
