use std::process::Stdio;

use convergence_study_tests::finished;

use super::{Folder, ended, keys, run_json, thermobeam, thrown};

#[test]
fn the_reference_is_reached_with_both_solvers() {
    let folder = Folder::new();
    for solver in ["newton", "fixed-point"] {
        let time = format!("dt = 1e-3\ntolerance = 1e-12\nsolver = \"{solver}\"");
        let (ended, json) = run_json(&folder.file("reference.toml", &thrown(&time)));
        assert_eq!((ended.status, ended.stderr.as_str()), (Some(0), ""));
        for (key, expected) in [
            ("u_tip", -1.174001195293e-2),
            ("phi_tip", -9.730912695990e-2),
            ("energy", 4.539642780254e-1),
        ] {
            let found = json["final"][key].as_f64().expect(key);
            assert!(
                (found - expected).abs() < 1e-9 * f64::abs(expected),
                "{solver} {key}: {found}"
            );
        }
        assert_eq!(json["scene"], "reference");
        assert_eq!([&json["elements"], &json["steps"]], [20, 1000]);
        let [total, most] =
            ["total", "max"].map(|key| json["iterations"][key].as_u64().expect(key));
        assert!(total >= 1000 && (1..=total).contains(&most));
        assert_eq!(json["final"]["t"], 1.0);
        assert!(
            json["wall_seconds"]
                .as_f64()
                .is_some_and(|seconds| seconds > 0.0)
        );
        assert!(
            json["energy"]["largest_increase"]
                .as_f64()
                .is_some_and(|increase| increase < 0.0)
        );
        assert!(
            json["energy"]["largest_balance_residual"]
                .as_f64()
                .is_some_and(|residual| residual < 1e-12)
        );
        let [low, high] =
            ["u_tip_min", "u_tip_max"].map(|key| json["extremes"][key].as_f64().expect(key));
        assert!(low < -0.01 && high > 0.1);
    }
}

#[test]
fn the_keys_and_their_order_are_the_contract() {
    let folder = Folder::new();
    let (ended, _) = run_json(&folder.file("scene.toml", &thrown("dt = 0.1")));
    let found = keys(&ended.stdout);
    let contract = "schema verdict scene elements steps dt t_end iterations _total _max wall_seconds \
        final _t _u_tip _phi_tip _u_t_tip _phi_t_tip _theta_mid _energy extremes _u_tip_min _u_tip_max \
        energy _initial _final _largest_increase _largest_balance_residual";
    let added = "scheme solver heated contact_steps degree work _passes _factorizations";
    let expected: Vec<String> = [contract, added]
        .iter()
        .flat_map(|keys| keys.split_whitespace())
        .map(|key| {
            if let Some(inner) = key.strip_prefix('_') {
                format!(" {inner}")
            } else {
                key.to_owned()
            }
        })
        .collect();
    assert_eq!(found, expected);
}

#[test]
fn the_summary_says_what_was_left_out() {
    let folder = Folder::new();
    let cold = folder.file(
        "cold.toml",
        "[beam]\na = 0\n[initial]\nu_t = \"x\"\n[time]\nt_end = 1\ndt = 0.1",
    );
    let ended = ended(thermobeam().arg("run").arg(cold));
    assert_eq!((ended.status, ended.stderr.as_str()), (Some(0), ""));
    let digits = "Six digits are shown; --target-error makes a run whose digits are right, --format json has all.\n";
    for piece in [
        "cold: 100 elements, 10 steps",
        "nothing heats the beam",
        "the scene has none",
        "ns per element",
        digits,
    ] {
        assert!(ended.stdout.contains(piece), "{piece}: {}", ended.stdout);
    }
}

#[test]
fn the_history_and_the_pictures_of_every_scheme_are_written() {
    let folder = Folder::new();
    let any_order = super::any_order::thrown("degree = 8", "");
    for (scene, lines) in [(thrown("dt = 1e-2"), 102), (any_order, 4002)] {
        let (scene, out) = (
            folder.file("scene.toml", &scene),
            folder.path(&format!("deep/results-{lines}")),
        );
        let ended = ended(thermobeam().arg("run").arg(scene).arg("--out").arg(&out));
        assert_eq!((ended.status, ended.stderr.as_str()), (Some(0), ""));
        let mut names: Vec<String> = std::fs::read_dir(&out)
            .expect("the folder")
            .map(|entry| {
                entry
                    .expect("an entry")
                    .file_name()
                    .to_string_lossy()
                    .into_owned()
            })
            .collect();
        names.sort();
        let pictures = [
            "energy.svg",
            "space-time.svg",
            "tip-displacement.svg",
            "tip-rotation.svg",
        ];
        let mut expected = [&pictures[..], &["history.csv", "run.json"]].concat();
        expected.sort_unstable();
        assert_eq!(names, expected);
        for name in names {
            assert!(ended.stdout.contains(&name), "{}", ended.stdout);
            let text = std::fs::read_to_string(out.join(&name)).expect("text");
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
    let scene = folder.file("scene.toml", &thrown("dt = 0.1"));
    for arguments in [&["run"][..], &["run", "--format", "json"], &["equilibria"]] {
        let mut child = thermobeam()
            .args(arguments)
            .arg(&scene)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        drop(child.stdout.take());
        let output = finished(child);
        assert_eq!(
            (output.status.code(), output.stderr.as_slice()),
            (Some(0), &b""[..]),
            "{arguments:?}"
        );
    }
}
