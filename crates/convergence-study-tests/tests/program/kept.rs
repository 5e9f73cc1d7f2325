//! Kept results.

use std::fs;
use std::thread::sleep;
use std::time::Duration;

use convergence_study_tests::finished;

use super::{Place, SOLVER, project_of, texts};

const CACHED: &str = "files = [\"data\"]\ncache = true";

fn cached(mode: &str) -> Place {
    let mut place = Place::new(mode, "");
    fs::write(place.folder.path().join("data"), "1").unwrap();
    place.more = CACHED.to_owned();
    place.write(mode);
    place
}

#[test]
fn kept_results_are_used_until_something_changes() {
    let place = cached("count");
    assert_eq!(place.study(&[]).0, Some(0));
    let first = place.study(&["--format", "json"]);
    assert_eq!((first.0, place.runs(), place.kept().len()), (Some(0), 5, 5));
    // Only the new level is computed.
    let text = fs::read_to_string(place.folder.path().join("s.toml")).unwrap();
    place.write_text(&text.replace("32, 64", "32, 64, 128"));
    assert_eq!((place.study(&[]).0, place.runs()), (Some(0), 6));
    // A file on which the results depend.
    fs::write(place.folder.path().join("data"), "2").unwrap();
    assert_eq!((place.study(&[]).0, place.runs()), (Some(0), 12));
    // The expectation has changed: kept answers are judged by the new one.
    place.write_text(&text.replace("\"L2\"", "\"max\""));
    let (status, out, _) = place.study(&[]);
    assert!(
        status == Some(1) && out.contains("its answer has no error `max`"),
        "{out}"
    );
    // A failed case is not kept.
    let failing = cached("status");
    assert_eq!((failing.study(&[]).0, failing.kept().len()), (Some(1), 4));
}

/// A program that is rebuilt under the same name.
#[test]
fn a_kept_result_depends_on_the_program_found_through_path() {
    use std::os::unix::fs::PermissionsExt;
    let place = cached("count");
    let bin = place.folder.path().join("bin");
    fs::create_dir(&bin).unwrap();
    let text = fs::read_to_string(place.folder.path().join("s.toml")).unwrap();
    place.write_text(&text.replace(&format!("{SOLVER:?}"), "\"my-solver\""));
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
    let study = || texts(place.command(&["study", "s.toml"]).env("PATH", &path));
    for (version, runs) in [("1", 5), ("1", 5), ("version 2", 10), ("version 2", 10)] {
        let script = format!("#!/bin/sh\n# {version}\nexec '{SOLVER}' \"$@\"\n");
        let file = bin.join("my-solver");
        if fs::read_to_string(&file).ok() != Some(script.clone()) {
            fs::write(&file, script).unwrap();
            fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).unwrap();
        }
        let (status, out, err) = study();
        assert_eq!(
            (status, place.runs()),
            (Some(0), runs),
            "{version}: {out}{err}"
        );
    }
}

/// Kept results show on the terminal and in files of one machine, but in no committed byte.
#[test]
fn kept_results_are_counted_and_never_blessed() {
    let place = project_of(cached("count"));
    let root = place.folder.path();
    fs::rename(root.join("data"), root.join("studies/data")).unwrap();
    let verify = |arguments: &[&str]| texts(&mut place.command(&[&["verify"], arguments].concat()));
    let runs = || {
        fs::read_to_string(root.join("studies/runs"))
            .unwrap()
            .lines()
            .count()
    };
    let reports = || {
        ["README.md", "results.json"].map(|name| fs::read(root.join("reports").join(name)).unwrap())
    };
    let (status, out, err) = verify(&["--bless"]);
    assert_eq!((status, runs()), (Some(0), 5), "{out}{err}");
    let told = "s: 5 of 5 cases kept from an earlier run\n";
    assert!(!out.contains("kept"), "{out}");
    let computed = reports();
    let (status, out, _) = verify(&[]);
    assert!(
        status == Some(0) && runs() == 5 && out.contains(told),
        "{out}"
    );
    let provenance = fs::read_to_string(root.join("reports/local/provenance.json")).unwrap();
    assert!(provenance.contains("\"kept_cases\": 5"), "{provenance}");
    assert_eq!(reports(), computed);
    let (status, out, _) = verify(&["--bless"]);
    assert!(
        status == Some(0) && runs() == 10 && !out.contains("kept"),
        "{out}"
    );
    assert_eq!(reports(), computed);
    let (_, out, _) = texts(&mut place.command(&["study", "studies/s.toml"]));
    assert!(
        out.lines()
            .next()
            .unwrap()
            .ends_with(" s, 5 of 5 cases kept from an earlier run"),
        "{out}"
    );
}

/// The word `{n}` of the command is the name of a file.
#[test]
fn a_kept_result_depends_on_each_file_that_its_command_names() {
    let place = cached("count");
    let mesh = place.folder.path().join("8");
    fs::write(&mesh, "coarse").unwrap();
    for (content, runs) in [("coarse", 5), ("fine", 6), ("fine", 6)] {
        fs::write(&mesh, content).unwrap();
        assert_eq!(
            (place.study(&[]).0, place.runs()),
            (Some(0), runs),
            "{content}"
        );
    }
}

/// Directories may differ in other files even if `files` are the same.
#[test]
fn a_kept_result_depends_on_the_directory() {
    let mut place = cached("count");
    for directory in ["a", "b"] {
        let path = place.folder.path().join(directory);
        fs::create_dir(&path).unwrap();
        fs::write(path.join("data"), "1").unwrap();
        place.more = format!("directory = \"{directory}\"\n{CACHED}");
        place.write("count");
        assert_eq!(place.study(&[]).0, Some(0));
        let runs = fs::read_to_string(path.join("runs")).unwrap_or_default();
        assert_eq!(runs.lines().count(), 5, "{directory}");
    }
}

#[test]
fn garbage_among_kept_results_is_computed_anew() {
    let place = cached("count");
    assert_eq!(place.study(&[]).0, Some(0));
    let kept = place.kept();
    let whole = fs::read_to_string(&kept[0]).unwrap();
    // Of another case; cut off; empty; not a number; a folder.
    fs::copy(&kept[1], &kept[0]).unwrap();
    fs::write(&kept[1], &whole[..whole.len() / 2]).unwrap();
    fs::write(&kept[2], "").unwrap();
    let nan = fs::read_to_string(&kept[3]).unwrap();
    let at = nan.find("\"L2\",").unwrap() + 5;
    let end = at + nan[at..].find(']').unwrap();
    fs::write(&kept[3], format!("{}null{}", &nan[..at], &nan[end..])).unwrap();
    let (status, out, _) = place.study(&[]);
    assert_eq!((status, place.runs()), (Some(0), 9), "{out}");
    assert_eq!((place.study(&[]).0, place.runs()), (Some(0), 9));
}

#[test]
fn a_killed_harness_leaves_whole_results() {
    let place = cached("count");
    for moment in [20, 60, 90, 120] {
        let mut harness = place.start();
        sleep(Duration::from_millis(moment));
        harness.kill().unwrap();
        finished(harness);
        for path in place.kept() {
            let text = fs::read_to_string(&path).unwrap();
            assert!(
                serde_json::from_str::<serde_json::Value>(&text).is_ok(),
                "{}: {text}",
                path.display()
            );
        }
    }
    place.wait_for(|running| running == 0);
    let before = (place.kept().len(), place.runs());
    assert_eq!(place.study(&[]).0, Some(0));
    assert_eq!(
        (place.kept().len(), place.runs()),
        (5, before.1 + 5 - before.0)
    );
}

#[test]
fn results_that_cannot_be_kept_are_judged() {
    let place = cached("count");
    fs::write(
        place.folder.path().join(".convergence-study"),
        "a file, not a folder",
    )
    .unwrap();
    let (status, out, _) = place.study(&[]);
    assert_eq!((status, place.runs()), (Some(0), 5), "{out}");
    assert_eq!((place.study(&[]).0, place.runs()), (Some(0), 10));
}
