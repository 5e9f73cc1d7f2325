use super::{Folder, ended, run_json, thermobeam, thrown};

#[test]
fn unusable_input_is_named_and_nothing_is_written() {
    let folder = Folder::new();
    for (name, text, pieces) in [
        (
            "range.toml",
            "[beam]\nzeta = -1\n[time]\ndt = 0.1\nt_end = 1",
            &["range.toml:2:8: beam.zeta", "-1", ">= 0"][..],
        ),
        (
            "key.toml",
            "[beam]\nzetta = 1\n[time]\ndt = 0.1\nt_end = 1",
            &["key.toml:2:1: beam.zetta", "`zeta`"],
        ),
        (
            "type.toml",
            "[time]\ndt = \"0.1\"\nt_end = 1",
            &["type.toml:2:6: time.dt", "\"0.1\"", "number > 0"],
        ),
        (
            "step.toml",
            "[time]\ndt = 0.3\nt_end = 1",
            &["step.toml:2:6: time.dt", "divides t_end"],
        ),
        (
            "mesh.toml",
            "[mesh]\nnodes = [0, 0.5, 0.5, 1]\n[time]\ndt = 0.1\nt_end = 1",
            &["mesh.toml:2:", "mesh.nodes[2]"],
        ),
        (
            "clamp.toml",
            "[initial]\nu = \"1+x\"\n[time]\ndt = 0.1\nt_end = 1",
            &["clamp.toml:2:5: initial.u", "u(0) = 1.0"],
        ),
        ("toml.toml", "[time", &["toml.toml:1:6"]),
    ] {
        let (scene, out) = (folder.file(name, text), folder.path("out"));
        for command in ["run", "equilibria"] {
            let mut program = thermobeam();
            program.arg(command).arg(&scene).args(["--format", "json"]);
            if command == "run" {
                program.arg("--out").arg(&out);
            }
            let ended = ended(&mut program);
            assert_eq!(
                (ended.status, ended.stdout.as_str()),
                (Some(2), ""),
                "{name}"
            );
            for piece in pieces {
                assert!(ended.stderr.contains(piece), "{piece}: {}", ended.stderr);
            }
            assert!(!out.exists(), "{name}");
        }
    }
}

#[test]
fn a_missing_scene_and_a_wrong_argument_are_unusable_too() {
    let folder = Folder::new();
    let missing = ended(thermobeam().arg("run").arg(folder.path("missing.toml")));
    assert_eq!((missing.status, missing.stdout.as_str()), (Some(2), ""));
    assert!(
        missing.stderr.contains("missing.toml: cannot be read"),
        "{}",
        missing.stderr
    );
    for arguments in [
        &["fly"][..],
        &["run"],
        &["run", "a", "--format", "xml"],
        &[],
    ] {
        assert_eq!(
            ended(thermobeam().args(arguments)).status,
            Some(2),
            "{arguments:?}"
        );
    }
    assert_eq!(ended(thermobeam().arg("--help")).status, Some(0));
}

#[test]
fn a_place_that_cannot_be_written_to_is_told_before_computing() {
    let folder = Folder::new();
    // It would take a year to run.
    let scene = folder.file("scene.toml", &thrown("dt = 1e-10"));
    let taken = folder.file("taken", "");
    let ended = ended(
        thermobeam()
            .arg("run")
            .arg(scene)
            .args(["--yes", "--out"])
            .arg(&taken),
    );
    assert_eq!((ended.status, ended.stdout.as_str()), (Some(2), ""));
    assert!(ended.stderr.contains("taken"), "{}", ended.stderr);
}

#[test]
fn a_diverging_iteration_keeps_what_was_done() {
    let folder = Folder::new();
    let scene = folder.file(
        "diverging.toml",
        &thrown("dt = 1e-2\nsolver = \"fixed-point\""),
    );
    let (ended_json, json) = run_json(&scene);
    assert_eq!(ended_json.status, Some(1));
    let steps = json["steps"].as_u64().expect("steps");
    assert!((1..100).contains(&steps));
    let failure = &json["failure"];
    assert_eq!(
        [&failure["kind"], &failure["step"]],
        [&"diverged".into(), &serde_json::Value::from(steps + 1)]
    );
    assert_eq!(failure["iterations"], 100);
    assert!(
        failure["contraction"]
            .as_f64()
            .is_some_and(|contraction| contraction >= 1.0)
    );
    let t = json["final"]["t"].as_f64().expect("t");
    assert!((t - 0.01 * steps as f64).abs() < 1e-14);
    for piece in [
        "diverging.toml",
        &format!("step {}", steps + 1),
        "from t = 0.",
        "100 iterations",
        "contraction factor",
    ] {
        assert!(
            ended_json.stderr.contains(piece),
            "{piece}: {}",
            ended_json.stderr
        );
    }

    let out = folder.path("out");
    let text = ended(thermobeam().arg("run").arg(&scene).arg("--out").arg(&out));
    assert_eq!(text.status, Some(1));
    assert!(
        text.stdout
            .contains(&format!("FAILED after {steps} steps, at t = ")),
        "{}",
        text.stdout
    );
    let history = std::fs::read_to_string(out.join("history.csv")).expect("a history");
    assert_eq!(history.lines().count() as u64, steps + 2);
}

#[test]
fn a_number_that_is_none_is_null() {
    let folder = Folder::new();
    // Fails in the first step: there is no largest increase of the energy, and no second increment
    // to compare.
    let scene = folder.file(
        "short.toml",
        &thrown("dt = 0.1\nsolver = \"fixed-point\"\nmax_iterations = 1"),
    );
    let (ended, json) = run_json(&scene);
    assert_eq!(ended.status, Some(1));
    assert_eq!(json["steps"], 0);
    assert!(
        json["energy"]["largest_increase"].is_null() && json["failure"]["contraction"].is_null()
    );
    assert_eq!(json["failure"]["kind"], "iteration-limit");
}
