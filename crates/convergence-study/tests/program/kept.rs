//! Kept results.

use std::fs;
use std::thread::sleep;
use std::time::Duration;

use crate::tests::Place;

const CACHED: &str = "files = [\"data\"]\ncache = true";

fn cached(mode: &str) -> Place {
    let mut place = Place::new(mode, "");
    fs::write(place.folder.path().join("data"), "1").unwrap();
    place.more = CACHED.to_owned();
    place.write(mode);
    place
}

pub(crate) fn kept_results_are_used_until_something_changes() {
    let place = cached("count");
    assert_eq!(place.study(&[]).0, Some(0));
    let first = place.study(&["--format", "json"]);
    assert_eq!((first.0, place.runs(), place.kept().len()), (Some(0), 5, 5));
    // Another level is computed, and no other.
    let text = fs::read_to_string(place.folder.path().join("s.toml")).unwrap();
    place.write_text(&text.replace("32, 64", "32, 64, 128"));
    assert_eq!((place.study(&[]).0, place.runs()), (Some(0), 6));
    // A file on which they depend.
    fs::write(place.folder.path().join("data"), "2").unwrap();
    assert_eq!((place.study(&[]).0, place.runs()), (Some(0), 12));
    // What was expected has changed: kept answers are judged by what is expected now.
    place.write_text(&text.replace("\"L2\"", "\"max\""));
    let (status, out, _) = place.study(&[]);
    assert!(status == Some(1) && out.contains("its answer has no error `max`"), "{out}");
    // A failed case is not kept.
    let failing = cached("status");
    assert_eq!((failing.study(&[]).0, failing.kept().len()), (Some(1), 4));
}

/// The word `{n}` of the command is the name of a file.
pub(crate) fn a_kept_result_depends_on_each_file_that_its_command_names() {
    let place = cached("count");
    let mesh = place.folder.path().join("8");
    fs::write(&mesh, "coarse").unwrap();
    for (content, runs) in [("coarse", 5), ("fine", 6), ("fine", 6)] {
        fs::write(&mesh, content).unwrap();
        assert_eq!((place.study(&[]).0, place.runs()), (Some(0), runs), "{content}");
    }
}

/// Of two directories whose `files` are the same, other files may differ.
pub(crate) fn a_kept_result_depends_on_the_directory() {
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

pub(crate) fn garbage_among_kept_results_is_computed_anew() {
    let place = cached("count");
    assert_eq!(place.study(&[]).0, Some(0));
    let kept = place.kept();
    let whole = fs::read_to_string(&kept[0]).unwrap();
    // Of another case; cut off; empty; no number; a folder.
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

pub(crate) fn a_killed_harness_leaves_whole_results() {
    let place = cached("count");
    for moment in [20, 60, 90, 120] {
        let mut harness = place.start();
        sleep(Duration::from_millis(moment));
        harness.kill().unwrap();
        harness.wait().unwrap();
        for path in place.kept() {
            let text = fs::read_to_string(&path).unwrap();
            assert!(serde_json::from_str::<serde_json::Value>(&text).is_ok(), "{}: {text}", path.display());
        }
    }
    place.wait_for(|running| running == 0);
    let before = (place.kept().len(), place.runs());
    assert_eq!(place.study(&[]).0, Some(0));
    assert_eq!((place.kept().len(), place.runs()), (5, before.1 + 5 - before.0));
}

pub(crate) fn results_that_cannot_be_kept_are_judged() {
    let place = cached("count");
    fs::write(place.folder.path().join(".convergence-study"), "a file, not a folder").unwrap();
    let (status, out, _) = place.study(&[]);
    assert_eq!((status, place.runs()), (Some(0), 5), "{out}");
    assert_eq!((place.study(&[]).0, place.runs()), (Some(0), 10));
}
