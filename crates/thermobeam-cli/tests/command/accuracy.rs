//! `run SCENE --target-error E`.

use serde_json::Value;

use super::{Folder, number, read};

const SWING: &str = "[beam]\na = 0\n[initial]\nu_t = \"0.1*x\"\n[time]\nt_end = 1\ndt = 0.1";

fn swing() -> Folder {
    let folder = Folder::new();
    folder.file("swing.toml", SWING);
    folder
}

#[test]
fn a_target_error_is_met_and_reported_with_its_runs() {
    let folder = swing();
    let (json, value) = folder.json("run swing.toml --target-error 1e-5");
    json.well();
    let number = |key: &str| number(&value, &format!("/accuracy/{key}"));
    assert_eq!(value["scheme"], "dg");
    assert!(number("target_error") == 1e-5 && number("believed_error") <= 1e-5);
    assert!(number("search_runs") >= 3.0 && number("search_work") > 0.0);
    assert_eq!(
        value["accuracy"]["nodes"].as_array().map(Vec::len),
        value["elements"].as_u64().map(|n| n as usize + 1)
    );
    let text = folder.ended("run swing.toml --target-error 1e-2");
    for piece in ["target", "estimated", "the difference to a coarser run"] {
        assert!(text.well().contains(piece), "{piece}: {text:?}");
    }
    assert!(!text.stdout.contains("--target-error"), "{text:?}");
}

#[test]
fn the_files_of_a_target_error_are_those_of_its_run() {
    let folder = swing();
    let ended = folder.ended("run swing.toml --target-error 1e-5 --out out");
    assert_eq!(ended.status, Some(0), "{ended:?}");
    let history = read(&folder.path("out/history.csv"));
    let last = history
        .lines()
        .last()
        .and_then(|line| line.split(',').nth(1));
    let last: f64 = last.expect("u(1)").parse().expect("a number");
    let value: Value = serde_json::from_str(&read(&folder.path("out/run.json"))).expect("JSON");
    assert_eq!(number(&value, "/final/u_tip"), last);
}

#[test]
fn an_accuracy_out_of_reach_fails_and_says_what_is_reachable() {
    let folder = swing();
    let far = folder.ended("run swing.toml --target-error 1e-17 --out out");
    far.complains(1, "rounding errors");
    far.complains(1, "can be reached");
    assert!(far.stdout.is_empty() && !folder.path("out").exists());
    for target in ["0", "-1", "nan"] {
        let ended = folder.ended(&format!("run swing.toml --target-error {target}"));
        ended.refuses("expected a finite number > 0");
    }
}

/// Scenes whose steps are far from solved, and what is found: an open balance by the midpoint rule,
/// a rise by dG.
pub(super) const UNSOLVED: [(&str, &str); 2] = [
    (
        "[beam]\nrho = 5000.0\n[initial]\nu_t = \"x\"\n[mesh]\nelements = 5\n[time]\nscheme = \"midpoint\"\nt_end = 10.0\n\
         dt = 0.1\ntolerance = 1e6\n",
        "the balance of the energy is violated by ",
    ),
    (
        "[beam]\nrho = 5000.0\n[initial]\nu_t = \"x\"\n[mesh]\nelements = 2\ndegree = 3\n[time]\nscheme = \"dg\"\nt_end = 10.0\n\
         dt = 0.5\nrestart_dt = 0.5\ntolerance = 1e6\n",
        "the energy rose by ",
    ),
];

#[test]
fn a_run_whose_energy_rose_or_is_not_balanced_ends_with_status_1() {
    let folder = Folder::new();
    for (scene, message) in UNSOLVED {
        folder.file("loose.toml", scene);
        folder.ended("run loose.toml").complains(1, message);
    }
}
