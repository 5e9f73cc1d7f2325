//! Texts of files and programs neither command a terminal nor annotate a job.

use super::{command, run, run_words, study, texts, workspace, write};

/// No control characters except line ends, and no line that GitHub Actions would obey.
#[track_caller]
pub(crate) fn is_harmless(text: &str) {
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
        write(
            &root,
            &format!("studies/{id}.toml"),
            study(id, claim, exponent),
        );
    }
    let mut command = command(root.path(), &["verify"]);
    let ran = texts(command.env("GITHUB_ACTIONS", "true"));
    ran.says(1, "");
    let lines = ran.stdout.lines();
    let commands: Vec<&str> = lines
        .filter(|line| line.trim_start().starts_with("::"))
        .collect();
    // GitHub shows ten: the last one counts the others.
    let [first, others @ .., last] = &commands[..] else {
        panic!("{ran:?}")
    };
    let of_baseline = |line: &&str| line.starts_with("::error title=baseline::");
    assert!(
        first.starts_with("::error title=two%3A fail::")
            && others.len() == 8
            && others.iter().all(of_baseline)
            && last.starts_with("::error title=and more::6 more: "),
        "{commands:?}"
    );
    let studied = run(&root, "study studies/two.toml");
    studied.says(1, "\n: :error title=forged::x\n");
    is_harmless(&studied.stdout);
    is_harmless(&run(&root, "list").stdout);
}

/// (Escaped, a study refuses them.)
#[test]
fn raw_control_characters_are_no_toml() {
    let root = workspace();
    write(&root, "a.toml", study("a", "c\x1b[31m", 1.0));
    let ran = run(&root, "study a.toml");
    ran.refuses("not valid TOML");
    is_harmless(&ran.stderr);
}

#[test]
fn names_of_columns_and_files_are_no_commands() {
    let root = workspace();
    let table =
        |name: &str| format!("h,{name}\n0.4,4.00e-1\n0.2,2.00e-1\n0.1,1.00e-1\n0.05,5.00e-2\n");
    let write = |name: &str, text: String| write(&root, name, text);
    for name in ["a\x1b", "a\u{9b}b", "\x07"] {
        write("table.csv", table(name));
        let ran = run(&root, "rates table.csv --order 1");
        ran.refuses("table.csv:1:1: expected a name without control characters, found `");
        is_harmless(&ran.stderr);
    }
    write("table.csv", table("::error title=x::forged"));
    is_harmless(run(&root, "rates table.csv --order 1").well());
    let file = "a\n::error::x\x1b[31m.csv";
    write(file, "h\n".to_owned());
    for name in ["rates", "study", "verify", "list"] {
        let ran = run_words(&root, &[name, file]);
        ran.complains(2, "");
        is_harmless(&ran.stdout);
        is_harmless(&ran.stderr);
    }
}
