//! The commands as a shell sees them, in a workspace of their own.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use convergence_study_tests::output;
use tempfile::TempDir;

fn workspace(studies: &[(&str, &str)]) -> TempDir {
    let root = tempfile::tempdir().unwrap();
    fs::create_dir_all(root.path().join("studies/scenes")).unwrap();
    for (name, text) in studies {
        fs::write(root.path().join("studies").join(name), text).unwrap();
    }
    root
}

fn thermobeam(root: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_thermobeam"));
    command.args(arguments).current_dir(root);
    output(&mut command)
}

/// Unusable input: status 2, these words on standard error, nothing on standard output, nothing
/// written.
#[track_caller]
fn unusable(root: &TempDir, arguments: &[&str], words: &str) {
    let output = thermobeam(root.path(), arguments);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains(words), "{words} is not in {error}");
    assert!(output.stdout.is_empty());
    assert!(
        !root.path().join("reports").exists()
            && !root.path().join("studies/baseline.json").exists()
    );
}

fn study(id: &str, kind: &str) -> String {
    format!("[study]\nid = \"{id}\"\nclaim = \"c\"\ntier = \"quick\"\nkind = \"{kind}\"\n")
}

#[test]
fn an_unknown_kind_is_refused_with_its_line() {
    let root = workspace(&[("a.toml", &study("a", "nonsense"))]);
    for arguments in [
        &["verify"][..],
        &["verify", "--bless"],
        &["study", "studies/a.toml"],
        &["list"],
    ] {
        unusable(
            &root,
            arguments,
            "error: studies/a.toml:5:8: study.kind: found \"nonsense\"; expected ",
        );
    }
}

#[test]
fn a_source_in_place_of_a_kind_is_refused_with_the_name_of_the_kind() {
    for (source, kind) in [("vibration", "orders/vibration"), ("scenes", "runs/scenes")] {
        let root = workspace(&[("a.toml", &study("a", source))]);
        unusable(
            &root,
            &["verify"],
            &format!(
                "error: studies/a.toml:5:8: study.kind: found \"{source}\"; expected \"{kind}\"\n"
            ),
        );
    }
}

#[test]
fn a_kind_may_have_a_source_after_a_slash_but_no_empty_one() {
    let root = workspace(&[("a.toml", &study("a", "orders/"))]);
    unusable(
        &root,
        &["verify"],
        "study.kind: found the text \"orders/\"; expected 1 to 100 lowercase letters, digits, `.` or `-`, the first a \
         letter or digit; a source like this may follow a `/`",
    );
}

#[test]
fn a_study_file_that_is_none_is_refused_with_its_line() {
    let root = workspace(&[("a.toml", "[study]\nid = \"A b\"\n")]);
    unusable(
        &root,
        &["verify"],
        "a.toml:2:6: study.id: found the text \"A b\"",
    );
    unusable(
        &root,
        &["study", "missing.toml"],
        "missing.toml: cannot be read",
    );
}

#[test]
fn where_no_study_is_meant_nothing_passes() {
    let root = workspace(&[]);
    unusable(&root, &["verify"], "no study in the tier quick");
    unusable(
        &root,
        &["verify", "theorem*"],
        "`theorem*` matches no study",
    );
    unusable(&root, &["verify", "--tier", "slow"], "slow");
    unusable(
        &root,
        &["verify", "--jobs", "0"],
        "expected a whole number >= 1",
    );
    unusable(&root, &["study"], "FILE");
}

#[test]
fn without_a_folder_of_studies_there_is_nothing_to_verify() {
    let folder = tempfile::tempdir().unwrap();
    unusable(
        &folder,
        &["verify"],
        "expected a folder studies/, here or above; found none",
    );
}

#[test]
fn the_list_tells_the_last_verdict_whichever_record_has_it() {
    let body = "[frequencies]\ncount = 1\nelements = [4, 8, 16]\norder = 2.0\ntolerance = 0.1\n";
    let [a, b] = ["a", "b"].map(|id| study(id, "orders/frequencies") + body);
    let root = workspace(&[("a.toml", a.as_str()), ("b.toml", b.as_str())]);
    let list = |arguments: &[&str]| {
        let output = thermobeam(root.path(), &[&["list"], arguments].concat());
        assert_eq!(
            output.status.code(),
            Some(0),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        String::from_utf8(output.stdout).unwrap()
    };
    let verdict = |id: &str| {
        let text = list(&[id]);
        text.lines()
            .nth(1)
            .unwrap()
            .split("  ")
            .filter(|cell| !cell.is_empty())
            .nth(3)
            .unwrap()
            .trim()
            .to_owned()
    };
    assert_eq!(
        (verdict("a"), verdict("b")),
        ("never run".to_owned(), "never run".to_owned())
    );
    let record = |path: &str, id: &str, verdict: &str| {
        let path = root.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let study = format!(
            r#"{{"id": "{id}", "claim": "c", "tier": "quick", "kind": "orders/frequencies", "verdict": "{verdict}", "summary": "s",
            "levels": [], "rates": [], "checks": [], "quantities": [], "failed_cases": [], "not_finite": []}}"#
        );
        let head = r#""schema": 1, "crate_version": "0", "scope": "quick", "verdict": "pass", "baseline_changes": []"#;
        fs::write(path, format!("{{{head}, \"studies\": [{study}]}}")).unwrap();
    };
    record("reports/results.json", "a", "pass");
    assert_eq!(
        (verdict("a"), verdict("b")),
        ("pass".to_owned(), "never run".to_owned())
    );
    record("reports/local/partial/results.json", "a", "fail");
    assert_eq!(verdict("a"), "fail");
    assert!(!list(&["a"]).contains("\u{1b}") && list(&["--tier", "quick"]).lines().count() == 3);
    assert_eq!(list(&["b*"]).lines().count(), 2);
    assert_eq!(
        thermobeam(root.path(), &["list", "c"]).status.code(),
        Some(2)
    );
    fs::write(root.path().join("reports/results.json"), "{").unwrap();
    let broken = thermobeam(root.path(), &["list"]);
    let error = String::from_utf8_lossy(&broken.stderr).into_owned();
    assert!(
        broken.status.code() == Some(2) && error.contains("results.json: "),
        "{error}"
    );
}

#[test]
fn a_thousand_million_steps_need_consent_or_a_limit() {
    const STEPS: &str = "dt = 1e-9\nt_end = 1.0\n";
    let beam = "[mesh]\nelements = 1\n[initial]\nu_t = \"x\"\n[time]\n";
    let exact = "[exact]\nu = [{ x = \"x^2\", t = \"t\" }]\nphi = [{ x = \"x\", t = \"t\" }]\ntheta = [{ x = \"x*(1-x)\", t = \"t\" }]\n";
    let refine =
        "[refine]\naxis = \"space\"\nelements = [1, 2, 4]\nsteps = 1000000000\nt_end = 1.0\n";
    let expect = "[[expect]]\nnorm = \"velocity\"\norder = 2.0\ntolerance = 0.1\n";
    let long = study("long", "orders/manufactured") + exact + refine + expect;
    let root = workspace(&[
        ("scenes/s.toml", &(beam.to_owned() + STEPS)),
        ("long.toml", &long),
    ]);
    // (1 + 4) elements, 1e9 steps, 20 ns: 100 s. The meshes of the study have 5 + 6 + 8 elements.
    let words = "found work for about 1.0e2 seconds on one thread; expected at most 60, or --yes, or --time-limit SECONDS";
    unusable(&root, &["run", "studies/scenes/s.toml"], words);
    unusable(
        &root,
        &["run", "studies/scenes/s.toml", "--out", "reports"],
        words,
    );
    let words = "long: found work for about 3.8e2 seconds on one thread; expected at most 60, or --yes, or --time-limit SECONDS";
    unusable(&root, &["study", "studies/long.toml"], words);
    unusable(&root, &["verify"], words);
    // With a limit both run, until it stops them.
    let ended = |arguments: &[&str]| thermobeam(root.path(), arguments).status.code();
    assert_eq!(
        ended(&["run", "studies/scenes/s.toml", "--time-limit", "0.1"]),
        Some(1)
    );
    assert_eq!(
        ended(&[
            "run",
            "studies/scenes/s.toml",
            "--time-limit",
            "0.1",
            "--yes"
        ]),
        Some(1)
    );
    assert_eq!(
        ended(&["study", "studies/long.toml", "--time-limit", "0.1"]),
        Some(1)
    );
}
