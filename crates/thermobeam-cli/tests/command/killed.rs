//! `verify` killed at any moment, and several runs at the same time.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use convergence_study_tests::{finished, started};

use super::workspace::{all, quick, set, verify, with_studies, workspace};
use super::{Folder, ended};

/// Number of kills; `THERMOBEAM_KILLS` overrides it.
const KILLS: u32 = 12;

type Set = BTreeMap<String, Vec<u8>>;

fn studies(ids: [&'static str; 3]) -> Vec<(&'static str, String)> {
    ids.into_iter().map(|id| (id, quick(id))).collect()
}

/// The set that an undisturbed run writes, and its duration.
fn undisturbed(folder: &Folder, name: &str, studies: &[(&str, String)]) -> (Set, Duration) {
    let root = workspace(folder, name, studies);
    let start = Instant::now();
    // Without a baseline every number is new: a fail, with reports.
    assert_eq!(ended(&mut verify(&root, &[])).status, Some(1));
    (set(&failing(&root)), start.elapsed())
}

/// Where the report on a run that does not pass is.
fn failing(root: &Path) -> PathBuf {
    root.join("reports/local/quick")
}

#[test]
fn killed_at_any_moment_each_file_is_that_of_a_run_and_the_markdown_the_last() {
    let kills =
        std::env::var("THERMOBEAM_KILLS").map_or(KILLS, |kills| kills.parse().expect("a number"));
    let folder = Folder::new();
    let both = [
        studies(["a-1", "a-2", "a-3"]),
        studies(["b-1", "b-2", "b-3"]),
    ];
    let (sets, times): (Vec<Set>, Vec<Duration>) = ["a", "b"]
        .iter()
        .zip(&both)
        .map(|(name, studies)| undisturbed(&folder, name, studies))
        .unzip();
    assert_ne!(
        sets[0].keys().collect::<Vec<_>>(),
        sets[1].keys().collect::<Vec<_>>()
    );
    let root = workspace(&folder, "killed", &both[0]);
    let reports = failing(&root);
    let mut before = Set::new();
    let (mut old, mut new, mut mixed) = (0, 0, 0);
    for kill in 0..kills {
        let turn = (kill % 2) as usize;
        with_studies(&root, &both[turn]);
        let mut command = verify(&root, &["--quiet"]);
        let mut child = started(&mut command);
        // Spread over the run and slightly beyond, in an order that does not repeat.
        std::thread::sleep(times[turn] * (1 + kill * 37 % 101) / 80);
        child.kill().expect("it can be killed");
        finished(child);
        let found = set(&reports);
        for (name, bytes) in &found {
            let is_whole = [&before, &sets[turn]]
                .iter()
                .any(|set| set.get(name) == Some(bytes));
            assert!(is_whole, "kill {kill}: {name}");
        }
        let is_in_place = |(name, bytes): (&String, &Vec<u8>)| found.get(name) == Some(bytes);
        let is_new = sets[turn].iter().all(is_in_place);
        let readme = "README.md";
        if found.get(readme) == sets[turn].get(readme) && before.get(readme) != found.get(readme) {
            assert!(is_new, "kill {kill}: the Markdown came before another file");
        }
        let is_old = found == before;
        old += u32::from(is_old && !is_new);
        new += u32::from(is_new);
        mixed += u32::from(!is_old && !is_new);
        before = found;
    }
    println!("{kills} kills: {old} left the old files, {new} the new ones, {mixed} some of both");
    with_studies(&root, &both[0]);
    assert_eq!(ended(&mut verify(&root, &[])).status, Some(1));
    assert_eq!(set(&reports), sets[0]);
    let left: Vec<String> = all(&root)
        .into_keys()
        .filter(|name| name.contains("workshop/") || name.contains("/."))
        .collect();
    assert_eq!(left, ["reports/.gitignore"]);
}

#[test]
fn what_a_killed_run_has_left_is_cleared_away_even_by_a_run_of_another_scope() {
    let folder = Folder::new();
    let root = workspace(&folder, "left", &studies(["a-1", "a-2", "a-3"]));
    assert_eq!(ended(&mut verify(&root, &[])).status, Some(1));
    let before = set(&failing(&root));
    for (name, text) in [
        ("reports/local/workshop/quick/staging/README.md", "half"),
        ("reports/local/workshop/full/staging/figures/x.svg", "half"),
        ("reports/local/.provenance.json.77-3", "half"),
        ("reports/.probe.77-3", "half"),
        ("studies/.baseline.json.77-3", "half"),
    ] {
        let path = root.join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, text).expect("a file");
    }
    assert_eq!(ended(&mut verify(&root, &["a-1"])).status, Some(1));
    assert_eq!(set(&failing(&root)), before);
    let half: Vec<String> = all(&root)
        .into_iter()
        .filter(|(_, bytes)| bytes == b"half")
        .map(|(name, _)| name)
        .collect();
    assert!(half.is_empty(), "{half:?}");
}

#[test]
fn several_at_once_leave_one_whole_set() {
    let folder = Folder::new();
    let both = [
        studies(["a-1", "a-2", "a-3"]),
        studies(["b-1", "b-2", "b-3"]),
    ];
    let sets = ["a", "b"].map(|name| undisturbed(&folder, name, &both[usize::from(name == "b")]).0);
    let root = workspace(&folder, "shared", &both[0]);
    let mut children = vec![];
    for round in 0..6 {
        let arguments = if round % 3 == 2 { &["a-2"][..] } else { &[] };
        children.push(started(&mut verify(&root, arguments)));
    }
    for child in children {
        let output = finished(child);
        assert_eq!(
            output.status.code(),
            Some(1),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    assert_eq!(set(&failing(&root)), sets[0]);
    with_studies(&root, &both[1]);
    assert_eq!(ended(&mut verify(&root, &[])).status, Some(1));
    assert_eq!(set(&failing(&root)), sets[1]);
}
