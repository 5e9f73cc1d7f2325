use super::{Folder, number, read, thermobeam, thrown};
use convergence_study_tests::ended;

#[test]
fn a_wrong_command_is_unusable_and_help_is_not() {
    let folder = Folder::new();
    for line in ["fly", "run a --format xml", ""] {
        assert_eq!(folder.ended(line).status, Some(2), "{line}");
    }
    assert_eq!(ended(thermobeam().arg("--help")).status, Some(0));
}

#[test]
fn a_place_that_cannot_be_written_to_is_told_before_computing() {
    let folder = Folder::new();
    // It would take a year to run.
    folder.file("scene.toml", &thrown("dt = 1e-10"));
    folder.file("taken", "");
    folder
        .ended("run scene.toml --yes --out taken")
        .refuses("taken");
}

#[test]
fn a_diverging_iteration_keeps_what_was_done() {
    let folder = Folder::new();
    folder.file(
        "diverging.toml",
        &thrown("dt = 1e-2\nsolver = \"fixed-point\""),
    );
    let (ended, json) = folder.json("run diverging.toml");
    let steps = number(&json, "/steps");
    assert!((1.0..100.0).contains(&steps));
    assert_eq!(json["failure"]["kind"], "diverged");
    assert_eq!(number(&json, "/failure/step"), steps + 1.0);
    assert_eq!(json["failure"]["iterations"], 100);
    assert!(number(&json, "/failure/contraction") >= 1.0);
    assert!((number(&json, "/final/t") - 0.01 * steps).abs() < 1e-14);
    for piece in [
        "diverging.toml",
        &format!("step {}", steps + 1.0),
        "from t = 0.",
        "100 iterations",
        "contraction factor",
    ] {
        ended.complains(1, piece);
    }
    let text = folder.ended("run diverging.toml --out out");
    assert_eq!(text.status, Some(1));
    let words = format!("FAILED after {steps} steps, at t = ");
    assert!(text.stdout.contains(&words), "{text:?}");
    let history = read(&folder.path("out/history.csv"));
    assert_eq!(history.lines().count() as f64, steps + 2.0);
}

#[test]
fn a_number_that_is_none_is_null() {
    let folder = Folder::new();
    // Fails in the first step: there is no largest increase of the energy, and no second increment
    // to compare.
    folder.file(
        "short.toml",
        &thrown("dt = 0.1\nsolver = \"fixed-point\"\nmax_iterations = 1"),
    );
    let (ended, json) = folder.json("run short.toml");
    assert_eq!(ended.status, Some(1));
    assert_eq!(json["steps"], 0);
    assert!(
        json["energy"]["largest_increase"].is_null() && json["failure"]["contraction"].is_null()
    );
    assert_eq!(json["failure"]["kind"], "iteration-limit");
}
