//! `run SCENE --target-error E`.

use super::{Folder, ended, thermobeam};

const SWING: &str = "[beam]\na = 0\n[initial]\nu_t = \"0.1*x\"\n[time]\nt_end = 1\ndt = 0.1";

#[test]
fn a_target_error_is_met_and_reported_with_method_parts_and_cost() {
    let folder = Folder::new();
    let scene = folder.file("swing.toml", SWING);
    let with = |arguments: &[&str]| ended(thermobeam().arg("run").arg(&scene).args(arguments));
    let object = |arguments: &[&str]| {
        let json = with(&[arguments, &["--format", "json"]].concat());
        assert_eq!((json.status, json.stderr.as_str()), (Some(0), ""));
        serde_json::from_str::<serde_json::Value>(&json.stdout).expect("JSON")
    };
    let cheapest = object(&["--target-error", "1e-5"]);
    let number = |of: &serde_json::Value, key: &str| {
        of[key].as_f64().unwrap_or_else(|| panic!("{key}: {of}"))
    };
    let accuracy = &cheapest["accuracy"];
    assert_eq!(
        (&cheapest["scheme"], &accuracy["quantity"]),
        (&"dg".into(), &"tip".into())
    );
    assert!(
        number(accuracy, "target_error") == 1e-5
            && (1e-9..=1e-5).contains(&number(accuracy, "believed_error"))
    );
    assert!(number(accuracy, "search_work") > number(accuracy, "unknown_solves"));

    let kept = object(&["--target-error", "1e-3", "--keep-scheme"]);
    let accuracy = &kept["accuracy"];
    assert_eq!(kept["scheme"], "euler-crank-nicolson");
    assert!((1e-4..=1e-3).contains(&number(accuracy, "believed_error")));
    assert_eq!(
        number(accuracy, "node_steps"),
        number(&kept, "elements") * number(&kept, "steps")
    );

    let text = with(&["--target-error", "1e-2", "--quantity", "theorem-3.4"]);
    assert_eq!(text.status, Some(0));
    for piece in ["target", "estimated", "Theorem 3.4", "the cheapest"] {
        assert!(text.stdout.contains(piece), "{piece}: {}", text.stdout);
    }
}

#[test]
fn the_errors_of_any_scheme_are_measured_and_shown() {
    let folder = Folder::new();
    for (scheme, left) in [
        ("dt = 0.1", 1e-5),
        ("scheme = \"midpoint\"\ndt = 0.1", 1e-5),
        ("scheme = \"dg\"", 0.0),
    ] {
        let scene = folder.file("swing.toml", &SWING.replace("dt = 0.1", scheme));
        let json = ended(thermobeam().arg("run").arg(&scene).args([
            "--estimate-error",
            "--format",
            "json",
        ]));
        let value: serde_json::Value = serde_json::from_str(&json.stdout).expect("JSON");
        let quantities = value["error_budget"]["quantities"]
            .as_array()
            .expect("quantities");
        assert_eq!(quantities.len(), 8, "{value}");
        let [tip, end] = [3, 0].map(|k| quantities[k]["total"].as_f64().expect("an error"));
        assert!(tip > left && tip < 0.1 && end <= 1.01 * tip, "{value}");
        let text = ended(thermobeam().arg("run").arg(&scene).arg("--estimate-error"));
        assert!(
            text.stdout.contains("Errors, by a run of any order"),
            "{}",
            text.stdout
        );
    }
}

#[test]
fn an_accuracy_out_of_reach_fails_and_says_what_is_reachable() {
    let folder = Folder::new();
    let scene = folder.file("swing.toml", SWING);
    let far = ended(
        thermobeam()
            .arg("run")
            .arg(&scene)
            .args(["--target-error", "1e-17"]),
    );
    assert_eq!((far.status, far.stdout.as_str()), (Some(1), ""));
    assert!(far.stderr.contains("can be reached"), "{}", far.stderr);
    let kept = ended(thermobeam().arg("run").arg(&scene).args([
        "--target-error",
        "1e-9",
        "--keep-scheme",
    ]));
    assert_eq!((kept.status, kept.stdout.as_str()), (Some(1), ""));
    assert!(
        kept.stderr.contains("limit of 2.0e10") && kept.stderr.contains("can be reached"),
        "{}",
        kept.stderr
    );
    for arguments in [
        &["--target-error", "0"][..],
        &["--target-error", "-1"],
        &["--target-error", "nan"],
        &["--quantity", "tip"],
        &["--keep-scheme"],
    ] {
        let ended = ended(thermobeam().arg("run").arg(&scene).args(arguments));
        assert_eq!(
            (ended.status, ended.stdout.as_str()),
            (Some(2), ""),
            "{arguments:?}"
        );
        let says = ended.stderr.contains("expected a finite number > 0");
        assert_eq!(says, arguments[0] == "--target-error", "{}", ended.stderr);
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
