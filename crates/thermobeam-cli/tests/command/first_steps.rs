use convergence_study::internal::cli::schema::{of_studies, other_files, text};
use convergence_study_tests::output;
use thermobeam_cli::project;

use super::{Folder, ended, thermobeam};

#[test]
fn a_new_study_passes_as_it_is() {
    let folder = Folder::new();
    let ended = ended(
        thermobeam()
            .args(["new", "study", "my-own.1", "--out"])
            .arg(folder.path("")),
    );
    assert_eq!(ended.status, Some(0), "{}", ended.stderr);
    assert!(
        ended.stdout.contains("thermobeam study"),
        "{}",
        ended.stdout
    );
    let study = super::ended(thermobeam().arg("study").arg(folder.path("my-own.1.toml")));
    assert_eq!((study.status, study.stderr.as_str()), (Some(0), ""));
    assert!(
        study.stdout.starts_with("my-own.1: pass"),
        "{}",
        study.stdout
    );
    let untested = study
        .stdout
        .split_once("\nno test of")
        .map(|(_, untested)| untested);
    assert!(
        untested.is_some_and(|untested| untested.contains("theta_a  ")),
        "{}",
        study.stdout
    );
    // Each table once.
    for title in ["\nRates\n", "\nErrors\n"] {
        assert_eq!(study.stdout.matches(title).count(), 1, "{}", study.stdout);
    }
}

#[test]
fn a_new_scene_of_either_sort_runs_as_it_is() {
    for (what, elements) in [
        ("scene", "mine: 100 elements"),
        ("any-order-scene", "mine: 1 element"),
    ] {
        let folder = Folder::new();
        let new = output(
            thermobeam()
                .args(["new", what, "mine", "--quiet"])
                .current_dir(folder.path("")),
        );
        assert!(
            new.status.success() && new.stdout == b"pass: wrote mine.toml\n",
            "{what}"
        );
        let ended = ended(thermobeam().arg("run").arg(folder.path("mine.toml")));
        assert_eq!(
            (ended.status, ended.stderr.as_str()),
            (Some(0), ""),
            "{what}"
        );
        assert!(ended.stdout.starts_with(elements), "{}", ended.stdout);
    }
}

#[test]
fn a_file_that_is_there_is_not_written_over_and_a_bad_name_is_refused() {
    let folder = Folder::new();
    let path = folder.file("taken.toml", "mine");
    let again = ended(
        thermobeam()
            .args(["new", "scene", "taken", "--out"])
            .arg(folder.path("")),
    );
    assert!(
        again.status == Some(2)
            && again
                .stderr
                .contains("taken.toml: expected a new file, found one of that name"),
        "{}",
        again.stderr
    );
    assert_eq!(std::fs::read_to_string(path).expect("the file"), "mine");
    for name in ["", "../x", "A", "a b", ".hidden", "-x"] {
        assert_eq!(
            ended(
                thermobeam()
                    .args(["new", "study", "--", name])
                    .current_dir(folder.path(""))
            )
            .status,
            Some(2),
            "{name}"
        );
    }
    let in_a_file = ended(
        thermobeam()
            .args(["new", "study", "x", "--out"])
            .arg(folder.path("taken.toml")),
    );
    assert_eq!(in_a_file.status, Some(2), "{}", in_a_file.stderr);
}

#[test]
fn every_shell_gets_completions_that_know_the_commands() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let ended = ended(thermobeam().args(["completions", shell]));
        assert_eq!(ended.status, Some(0));
        assert!(
            ["sweep", "report", "rates"]
                .iter()
                .all(|name| ended.stdout.contains(name)),
            "{shell}"
        );
    }
}

#[test]
fn the_schemas_are_printed() {
    let project = project("thermobeam");
    let others = other_files(&project);
    let made = |files: &str| match others.iter().find(|(name, _)| *name == files) {
        Some((_, schema)) => text(schema),
        None => text(&of_studies(&project)),
    };
    for (files, title) in [
        ("study", "study files of thermobeam"),
        ("scene", "scene files"),
        ("manufacture", "manufacture files"),
    ] {
        let ended = ended(thermobeam().args(["schema", files]));
        let schema: serde_json::Value = serde_json::from_str(&ended.stdout).expect("JSON");
        assert_eq!(schema["title"], title);
        assert_eq!((ended.status, ended.stdout), (Some(0), made(files)));
    }
    let other = ended(thermobeam().args(["schema", "mesh"]));
    assert_eq!(other.status, Some(2));
    assert_eq!(
        other.stderr,
        "error: schema: found `mesh`; expected one of study, scene, manufacture\n"
    );
}

#[test]
fn nothing_is_coloured_where_nobody_looks() {
    for program in [
        &mut thermobeam(),
        thermobeam().env("NO_COLOR", "1"),
        thermobeam().env("TERM", "dumb"),
    ] {
        let ended = ended(program.args(["schema", "magic"]));
        let help = super::ended(thermobeam().env("NO_COLOR", "1").arg("--help"));
        for text in [ended.stdout, ended.stderr, help.stdout] {
            assert!(!text.contains('\u{1b}'), "{text}");
        }
    }
}
