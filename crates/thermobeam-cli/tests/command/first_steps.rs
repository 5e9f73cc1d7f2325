use convergence_study_tests::ended;
use thermobeam_cli::project;

use super::{Folder, read, thermobeam};

#[test]
fn a_new_study_passes_as_it_is() {
    let folder = Folder::new();
    let new = folder.ended("new study my-own.1 --out .");
    assert!(new.well().contains("thermobeam study"), "{new:?}");
    let study = folder.ended("study my-own.1.toml");
    assert!(study.well().starts_with("my-own.1: pass"), "{study:?}");
    let untested = study.stdout.split_once("\nno test of");
    assert!(
        untested.is_some_and(|(_, untested)| untested.contains("theta_a  ")),
        "{study:?}"
    );
    // Each table once.
    for title in ["\nRates\n", "\nErrors\n"] {
        assert_eq!(study.stdout.matches(title).count(), 1, "{study:?}");
    }
}

#[test]
fn a_new_scene_of_either_sort_runs_as_it_is() {
    for (what, elements) in [
        ("scene", "mine: 100 elements"),
        ("any-order-scene", "mine: 1 element"),
    ] {
        let folder = Folder::new();
        let new = folder.ended(&format!("new {what} mine --quiet"));
        assert_eq!(new.well(), "pass: wrote mine.toml\n", "{what}");
        let ran = folder.ended("run mine.toml");
        assert!(ran.well().starts_with(elements), "{ran:?}");
    }
}

#[test]
fn a_file_that_is_there_is_not_written_over_and_a_bad_name_is_refused() {
    let folder = Folder::new();
    let path = folder.file("taken.toml", "mine");
    folder
        .ended("new scene taken")
        .complains(2, "taken.toml: expected a new file, found one of that name");
    assert_eq!(read(&path), "mine");
    for name in ["", "../x", "A", "a b", ".hidden", "-x"] {
        let mut new = thermobeam();
        new.args(["new", "study", "--", name]);
        assert_eq!(
            ended(new.current_dir(folder.path(""))).status,
            Some(2),
            "{name}"
        );
    }
    folder
        .ended("new study x --out taken.toml")
        .complains(2, "");
}

#[test]
fn every_shell_gets_completions_that_know_the_commands() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = folder.ended(&format!("completions {shell}"));
        for name in ["sweep", "report", "rates"] {
            assert!(script.well().contains(name), "{shell}");
        }
    }
}

#[test]
fn the_schemas_are_printed() {
    let (folder, project) = (Folder::new(), project("thermobeam"));
    let schemas = project.schemas();
    let made = |files: &str| {
        let own = schemas.iter().find(|(name, _)| *name == files);
        format!("{:#}\n", own.expect("a schema").1)
    };
    for (files, title) in [
        ("study", "study files of thermobeam"),
        ("scene", "scene files"),
        ("manufacture", "manufacture files"),
    ] {
        let printed = folder.ended(&format!("schema {files}"));
        let schema: serde_json::Value = serde_json::from_str(printed.well()).expect("JSON");
        assert_eq!(schema["title"], title);
        assert_eq!(printed.stdout, made(files));
    }
}

#[test]
fn nothing_is_coloured_where_nobody_looks() {
    for program in [
        &mut thermobeam(),
        thermobeam().env("NO_COLOR", "1"),
        thermobeam().env("TERM", "dumb"),
    ] {
        let refused = ended(program.args(["schema", "magic"]));
        let help = ended(thermobeam().env("NO_COLOR", "1").arg("--help"));
        for text in [refused.stdout, refused.stderr, help.stdout] {
            assert!(!text.contains('\u{1b}'), "{text}");
        }
    }
}
