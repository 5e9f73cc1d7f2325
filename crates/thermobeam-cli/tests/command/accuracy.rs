//! `run SCENE --target-error E`.

use crate::{Folder, ended, keys, thermobeam};

const SWING: &str = "[beam]\na = 0\n[initial]\nu_t = \"0.1*x\"\n[time]\nt_end = 1\ndt = 0.1";

#[test]
fn an_accuracy_asked_for_is_told_with_its_cost() {
    let folder = Folder::new();
    let scene = folder.file("swing.toml", SWING);
    let json = ended(thermobeam().arg("run").arg(&scene).args(["--target-error", "1e-5", "--format", "json"]));
    assert_eq!((json.status, json.stderr.as_str()), (Some(0), ""));
    let value: serde_json::Value = serde_json::from_str(&json.stdout).expect("JSON");
    let accuracy = &value["accuracy"];
    let number = |key: &str| accuracy[key].as_f64().expect(key);
    assert_eq!(accuracy["quantity"], "tip");
    assert!(number("target_error") == 1e-5 && (1e-6..=1e-5).contains(&number("believed_error")));
    let [elements, steps] = ["elements", "steps"].map(|key| value[key].as_f64().expect(key));
    assert_eq!(number("node_steps"), elements * steps);
    assert!(number("pilot_node_steps") > 0.0);
    assert!(keys(&json.stdout).iter().any(|key| key == "accuracy"));

    let text = ended(thermobeam().arg("run").arg(&scene).args(["--target-error", "1e-2", "--quantity", "theorem-3.4"]));
    assert_eq!(text.status, Some(0));
    for piece in ["asked for", "expected", "Theorem 3.4", "pilot runs"] {
        assert!(text.stdout.contains(piece), "{piece}: {}", text.stdout);
    }
}

#[test]
fn an_accuracy_out_of_reach_fails_and_says_what_is_reachable() {
    let folder = Folder::new();
    let scene = folder.file("swing.toml", SWING);
    let far = ended(thermobeam().arg("run").arg(&scene).args(["--target-error", "1e-14"]));
    assert_eq!((far.status, far.stdout.as_str()), (Some(1), ""));
    assert!(far.stderr.contains("can be reached"), "{}", far.stderr);
    for arguments in
        [&["--target-error", "0"][..], &["--target-error", "-1"], &["--target-error", "nan"], &["--quantity", "tip"]]
    {
        let ended = ended(thermobeam().arg("run").arg(&scene).args(arguments));
        assert_eq!((ended.status, ended.stdout.as_str()), (Some(2), ""), "{arguments:?}");
        let says = ended.stderr.contains("expected a finite number > 0");
        assert_eq!(says, arguments[0] == "--target-error", "{}", ended.stderr);
    }
}

#[test]
fn a_run_whose_energy_rose_or_is_not_balanced_ends_with_status_1() {
    let folder = Folder::new();
    let extreme = "[beam]\nzeta = 1e300\n[obstacles]\nepsilon = 1e-300\ng1 = -0.01\ng2 = 0.1\n[initial]\n\
        u = \"0.01*x*(x-2)\"\nu_t = \"x\"\n[mesh]\nelements = 8\n[time]\ndt = 1e-2\nt_end = 0.1\n";
    let any_order = extreme.replace("dt = 1e-2", "scheme = \"dg\"");
    for (scene, message) in
        [(extreme, "the energy rose by "), (&any_order, "the balance of the energy is violated by ")]
    {
        let ended = ended(thermobeam().arg("run").arg(folder.file("extreme.toml", scene)));
        assert_eq!(ended.status, Some(1), "{}", ended.stdout);
        assert!(ended.stderr.contains(message), "{}", ended.stderr);
    }
}
