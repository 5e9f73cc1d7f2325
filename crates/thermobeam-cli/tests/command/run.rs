use std::process::Stdio;

use convergence_study_tests::finished;

use super::{Folder, command, keys, number, read, thrown};

/// The numbers are those of an independent implementation, as in the tests of the solver.
#[test]
fn the_end_and_the_extremes_of_a_run_are_those_of_the_reference() {
    let folder = Folder::new();
    folder.file("reference.toml", &thrown("dt = 1e-3\ntolerance = 1e-12"));
    let (ended, json) = folder.json("run reference.toml");
    ended.well();
    for (key, expected) in [
        ("u_tip", -1.174001195293e-2),
        ("phi_tip", -9.730912695990e-2),
        ("energy", 4.539642780254e-1),
    ] {
        let found = number(&json, &format!("/final/{key}"));
        let is_close = (found - expected).abs() < 1e-9 * f64::abs(expected);
        assert!(is_close, "{key}: {found}");
    }
    assert_eq!(json["scene"], "reference");
    assert_eq!([&json["elements"], &json["steps"]], [20, 1000]);
    let [total, most] = ["total", "max"].map(|key| number(&json, &format!("/iterations/{key}")));
    assert!(total >= 1000.0 && (1.0..=total).contains(&most));
    assert_eq!(json["final"]["t"], 1.0);
    assert!(number(&json, "/wall_seconds") > 0.0);
    assert!(number(&json, "/energy/largest_increase") < 0.0);
    assert!(number(&json, "/energy/largest_balance_residual") < 1e-12);
    let [low, high] = ["min", "max"].map(|end| number(&json, &format!("/extremes/u_tip_{end}")));
    assert!(low < -0.01 && high > 0.1);
}

#[test]
fn the_keys_and_their_order_are_the_contract() {
    let folder = Folder::new();
    folder.file("scene.toml", &thrown("dt = 0.1"));
    let (ended, _) = folder.json("run scene.toml");
    let contract = "schema verdict scene elements steps dt t_end iterations _total _max wall_seconds \
        final _t _u_tip _phi_tip _u_t_tip _phi_t_tip _theta_mid _energy extremes _u_tip_min _u_tip_max \
        energy _initial _final _largest_increase _largest_balance_residual \
        scheme solver heated contact_steps degree work _passes _factorizations";
    let inner = |key: &str| match key.strip_prefix('_') {
        Some(inner) => format!(" {inner}"),
        None => key.to_owned(),
    };
    let expected: Vec<String> = contract.split_whitespace().map(inner).collect();
    assert_eq!(keys(&ended.stdout), expected);
}

#[test]
fn the_summary_says_what_was_left_out() {
    let folder = Folder::new();
    folder.file(
        "cold.toml",
        "[beam]\na = 0\n[initial]\nu_t = \"x\"\n[time]\nt_end = 1\ndt = 0.1",
    );
    let ended = folder.ended("run cold.toml");
    let digits = "Six digits are shown; --target-error makes a run whose digits are right, --format json has all.\n";
    for piece in [
        "cold: 100 elements, 10 steps",
        "nothing heats the beam",
        "the scene has none",
        "ns per element",
        digits,
    ] {
        assert!(ended.well().contains(piece), "{piece}: {ended:?}");
    }
}

#[test]
fn the_history_and_the_pictures_of_every_scheme_are_written() {
    let folder = Folder::new();
    let any_order = super::any_order::thrown("degree = 8", "");
    for (scene, lines) in [(thrown("dt = 1e-2"), 102), (any_order, 4002)] {
        folder.file("scene.toml", &scene);
        let out = format!("deep/results-{lines}");
        let ended = folder.ended(&format!("run scene.toml --out {out}"));
        let entries = std::fs::read_dir(folder.path(&out)).expect("the folder");
        let name = |entry: std::io::Result<std::fs::DirEntry>| {
            let name = entry.expect("an entry").file_name();
            name.into_string().expect("UTF-8")
        };
        let mut names: Vec<String> = entries.map(name).collect();
        names.sort();
        assert_eq!(
            names.join(" "),
            "energy.svg history.csv run.json space-time.svg tip-displacement.svg tip-rotation.svg"
        );
        for name in names {
            assert!(ended.well().contains(&name), "{ended:?}");
            let text = read(&folder.path(&out).join(&name));
            let is_whole = match name.as_str() {
                "history.csv" => text.lines().count() == lines,
                "run.json" => text.starts_with("{\n  \"schema\": 2,\n  \"verdict\": \"pass\",\n"),
                _ => text.starts_with("<svg"),
            };
            assert!(is_whole, "{name}");
        }
    }
}

#[test]
fn a_reader_who_leaves_early_is_no_error() {
    let folder = Folder::new();
    folder.file("scene.toml", &thrown("dt = 0.1"));
    for words in ["run", "run --format json", "equilibria"] {
        let mut child = command(&folder.path(""), &format!("{words} scene.toml"))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        drop(child.stdout.take());
        let output = finished(child);
        assert_eq!(
            (output.status.code(), output.stderr.as_slice()),
            (Some(0), &b""[..]),
            "{words}"
        );
    }
}
