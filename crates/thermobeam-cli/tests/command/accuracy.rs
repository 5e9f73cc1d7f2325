//! `run SCENE --target-error E`.

use super::{Folder, ended, thermobeam};

const SWING: &str = "[beam]\na = 0\n[initial]\nu_t = \"0.1*x\"\n[time]\nt_end = 1\ndt = 0.1";

#[test]
fn a_target_error_is_met_and_reported_with_its_runs() {
    let folder = Folder::new();
    let scene = folder.file("swing.toml", SWING);
    let with = |arguments: &[&str]| ended(thermobeam().arg("run").arg(&scene).args(arguments));
    let json = with(&["--target-error", "1e-5", "--format", "json"]);
    assert_eq!((json.status, json.stderr.as_str()), (Some(0), ""));
    let value: serde_json::Value = serde_json::from_str(&json.stdout).expect("JSON");
    let accuracy = &value["accuracy"];
    let number = |key: &str| accuracy[key].as_f64().unwrap_or_else(|| panic!("no {key}"));
    assert_eq!(value["scheme"], "dg");
    assert!(number("target_error") == 1e-5 && number("believed_error") <= 1e-5);
    assert!(number("search_runs") >= 3.0 && number("search_work") > 0.0);
    assert_eq!(
        accuracy["nodes"].as_array().map(Vec::len),
        value["elements"].as_u64().map(|n| n as usize + 1)
    );
    let text = with(&["--target-error", "1e-2"]);
    assert_eq!(text.status, Some(0));
    for piece in ["target", "estimated", "the difference to a coarser run"] {
        assert!(text.stdout.contains(piece), "{piece}: {}", text.stdout);
    }
    assert!(!text.stdout.contains("--target-error"), "{}", text.stdout);
}

#[test]
fn the_files_of_a_target_error_are_those_of_its_run() {
    let folder = Folder::new();
    let scene = folder.file("swing.toml", SWING);
    let out = folder.path("out");
    let ended = ended(
        thermobeam()
            .arg("run")
            .arg(&scene)
            .args(["--target-error", "1e-5", "--out"])
            .arg(&out),
    );
    assert_eq!(ended.status, Some(0), "{}", ended.stderr);
    let history = std::fs::read_to_string(out.join("history.csv")).expect("a history");
    let last: f64 = history
        .lines()
        .last()
        .and_then(|line| line.split(',').nth(1)?.parse().ok())
        .expect("u(1)");
    let text = std::fs::read_to_string(out.join("run.json")).expect("JSON");
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(value["final"]["u_tip"].as_f64(), Some(last));
}

#[test]
fn an_accuracy_out_of_reach_fails_and_says_what_is_reachable() {
    let folder = Folder::new();
    let scene = folder.file("swing.toml", SWING);
    let out = folder.path("out");
    let far = ended(
        thermobeam()
            .arg("run")
            .arg(&scene)
            .args(["--target-error", "1e-17", "--out"])
            .arg(&out),
    );
    assert_eq!((far.status, far.stdout.as_str()), (Some(1), ""));
    assert!(
        far.stderr.contains("rounding errors") && far.stderr.contains("can be reached"),
        "{}",
        far.stderr
    );
    assert!(!out.exists());
    for target in ["0", "-1", "nan"] {
        let ended = ended(
            thermobeam()
                .arg("run")
                .arg(&scene)
                .args(["--target-error", target]),
        );
        assert_eq!((ended.status, ended.stdout.as_str()), (Some(2), ""));
        assert!(
            ended.stderr.contains("expected a finite number > 0"),
            "{}",
            ended.stderr
        );
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
        let ended = ended(
            thermobeam()
                .arg("run")
                .arg(folder.file("loose.toml", scene)),
        );
        assert_eq!(ended.status, Some(1), "{}", ended.stdout);
        assert!(ended.stderr.contains(message), "{}", ended.stderr);
    }
}
