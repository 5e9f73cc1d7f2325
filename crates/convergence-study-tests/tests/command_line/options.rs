//! Options of several commands: colours, short forms, `--dry-run`, what helps say.

use std::fs;

use super::{command, read, run, run_words, study, texts, workspace, write};

const TABLE: &str = "h e\n0.4 1.600e-1\n0.2 4.000e-2\n0.1 1.000e-2\n0.05 2.500e-3\n";

const ESCAPE: char = '\u{1b}';

#[test]
fn colours_follow_the_option_then_the_environment() {
    let root = workspace(false);
    write(&root, "t", TABLE);
    let ended = |words: &[&str], option: &[&str], variables: &[(&str, &str)]| {
        let mut command = command(root.path(), words);
        for name in ["NO_COLOR", "FORCE_COLOR", "CLICOLOR_FORCE"] {
            command.env_remove(name);
        }
        texts(command.args(option).envs(variables.iter().copied()))
    };
    let is_coloured = |option: &[&str], variables: &[(&str, &str)]| {
        let (status, out, err) = ended(&["rates", "t", "--order", "2"], option, variables).parts();
        assert_eq!(status, Some(0), "{err}");
        let is_coloured = out.contains("\u{1b}[32mpass\u{1b}[0m");
        // Helps, and errors of the command line, follow the same rule.
        let help = ended(&["rates", "--help"], option, variables).stdout;
        let (status, _, err) = ended(&["rates", "--odrer", "2"], option, variables).parts();
        assert_eq!(status, Some(2), "{err}");
        assert_eq!(help.contains(ESCAPE), is_coloured, "{help}");
        assert_eq!(err.contains(ESCAPE), is_coloured, "{err}");
        is_coloured
    };
    let no_color = [("NO_COLOR", "1")];
    assert!(!is_coloured(&[], &[]));
    assert!(is_coloured(&["--color", "always"], &no_color));
    assert!(is_coloured(&["--color=always"], &[]));
    for forced in ["FORCE_COLOR", "CLICOLOR_FORCE"] {
        assert!(is_coloured(&[], &[(forced, "1"), ("NO_COLOR", "1")]));
        assert!(is_coloured(&["--color", "auto"], &[(forced, "1")]));
        assert!(!is_coloured(&[], &[(forced, "0")]));
        assert!(!is_coloured(&["--color", "never"], &[(forced, "1")]));
    }
    let ran = run(&root, "rates t --color blue");
    ran.complains(2, "'blue'");
    ran.complains(2, "never");
}

#[test]
fn files_have_no_colours() {
    let root = workspace(false);
    write(&root, "t", TABLE);
    let arguments = [
        "rates", "t", "--order", "2", "-o", "out", "--color", "always",
    ];
    run_words(&root, &arguments).says(0, "");
    let page = read(&root, "out/rates.md");
    assert!(
        page.contains("    e: pass: 2.000") && !page.contains([ESCAPE, '\u{fffd}']),
        "{page}"
    );
}

#[test]
fn short_forms_are_those_of_the_long_ones() {
    let root = workspace(false);
    let long = run(&root, "verify --jobs 1 --verbose --out a");
    let short = run(&root, "verify -j 1 -v -o b");
    assert_eq!(long.status, short.status);
    let page = |name: &str| {
        let folder = root.path().join(name).join("local/quick");
        fs::read_to_string(folder.join("README.md")).unwrap()
    };
    assert_eq!(page("a"), page("b"));
    for arguments in [["rates", "--version"], ["verify", "-V"]] {
        run_words(&root, &arguments).says(0, env!("CARGO_PKG_VERSION"));
    }
    run(&root, "verify -j 0").says(2, "");
}

#[test]
fn a_dry_run_lists_and_writes_nothing() {
    let root = workspace(true);
    let (status, out, _) = run(&root, "verify -n").parts();
    assert_eq!(status, Some(0), "{out}");
    assert!(
        out.contains("one        5        -\n")
            && out.ends_with("2 studies with 10 cases would run; 0.0 s in their last runs\n"),
        "{out}"
    );
    assert!(!root.path().join("reports").exists());
    run(&root, "verify").says(1, "");
    let before = fs::read(root.path().join("reports/local/provenance.json")).unwrap();
    let (_, out, _) = run(&root, "verify --dry-run one --format json").parts();
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(object["studies"][0]["id"], "one");
    assert_eq!(object["studies"][0]["cases"], 5);
    assert!(object["studies"][0]["seconds"].is_number(), "{out}");
    assert_eq!(object["studies"].as_array().unwrap().len(), 1);
    let after = fs::read(root.path().join("reports/local/provenance.json")).unwrap();
    assert_eq!(before, after);
    run(&root, "verify -n --bless").complains(2, "cannot be used with");
    run(&root, "verify -n three").says(2, "");
}

#[test]
fn helps_leave_out_what_means_nothing() {
    let root = workspace(false);
    for (name, with, without) in [
        ("list", "--tier", &["--jobs", "--out"][..]),
        ("new", "--out", &["--jobs"]),
        ("rates", "csv", &["--jobs"]),
        ("verify", "--jobs", &["csv"]),
        ("report", "--out", &["--jobs"]),
    ] {
        let (_, out, _) = run_words(&root, &[name, "--help"]).parts();
        assert!(out.contains(with) && out.contains("Examples:"), "{out}");
        for option in without {
            assert!(!out.contains(option), "{option}: {out}");
        }
    }
    run(&root, "verify --format csv").complains(2, "text, json");
}

#[test]
fn a_misspelt_id_among_many_has_its_nearest() {
    let root = workspace(false);
    for k in 0..13 {
        let id = format!(
            "{}-space",
            ["heat", "wave", "beam"][k % 3].repeat(1 + k / 3)
        );
        let path = root.path().join(format!("studies/{id}.toml"));
        fs::write(path, study(&id, "c", 1.0)).unwrap();
    }
    let ran = run(&root, "verify haet-space");
    ran.complains(
        2,
        "`haet-space` matches no study; expected what `powers list` shows, of which heat-space, ",
    );
    ran.complains(2, " are nearest, or a pattern such as '*-space'");
}
