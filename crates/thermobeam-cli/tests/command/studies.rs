//! `verify`, `study` and `list` with studies that cannot be used, and with those that were run
//! before or would take long.

use super::*;

fn study(id: &str, kind: &str) -> String {
    format!("[study]\nid = \"{id}\"\nclaim = \"c\"\ntier = \"quick\"\nkind = \"{kind}\"\n")
}

fn with(studies: &[(&str, &str)]) -> Folder {
    let folder = Folder::new();
    fs::create_dir_all(folder.path("studies/scenes")).expect("a folder");
    for (name, text) in studies {
        folder.file(&format!("studies/{name}"), text);
    }
    folder
}

/// Nothing was written.
#[track_caller]
fn refuses(folder: &Folder, line: &str, words: &str) {
    folder.ended(line).refuses(words);
    for path in ["reports", "studies/baseline.json"] {
        assert!(!folder.path(path).exists(), "{line}: {path}");
    }
}

#[test]
fn a_study_that_cannot_be_used_is_refused_with_its_line() {
    let unknown = "error: studies/a.toml:5:8: study.kind: found \"nonsense\"; expected ";
    let empty = "study.kind: found the text \"orders/\"; expected 1 to 100 lowercase letters, digits, `.` or `-`, the first a \
         letter or digit; a source like this may follow a `/`";
    for (text, line, words) in [
        (study("a", "nonsense"), "verify", unknown),
        (study("a", "nonsense"), "verify --bless", unknown),
        (study("a", "nonsense"), "study studies/a.toml", unknown),
        (study("a", "nonsense"), "list", unknown),
        (
            study("a", "vibration"),
            "verify",
            "studies/a.toml:5:8: study.kind: found \"vibration\"; expected \"orders/vibration\"\n",
        ),
        (
            study("a", "scenes"),
            "verify",
            "studies/a.toml:5:8: study.kind: found \"scenes\"; expected \"runs/scenes\"\n",
        ),
        (study("a", "orders/"), "verify", empty),
        (
            "[study]\nid = \"A b\"\n".to_owned(),
            "verify",
            "a.toml:2:6: study.id: found the text \"A b\"",
        ),
    ] {
        refuses(&with(&[("a.toml", &text)]), line, words);
    }
}

#[test]
fn where_no_study_is_meant_nothing_passes() {
    let none = with(&[]);
    refuses(&none, "verify", "no study in the tier quick");
    refuses(&none, "verify theorem*", "`theorem*` matches no study");
    let words = "expected a folder studies/, here or above; found none";
    refuses(&Folder::new(), "verify", words);
}

#[test]
fn the_list_tells_the_last_verdict() {
    let body = "[frequencies]\ncount = 1\nelements = [4, 8, 16]\norder = 2.0\ntolerance = 0.1\n";
    let [a, b] = ["a", "b"].map(|id| study(id, "orders/frequencies") + body);
    let folder = with(&[("a.toml", &a), ("b.toml", &b)]);
    let list = |words: &str| folder.ended(&format!("list {words}")).well().to_owned();
    let verdicts = || {
        ["a", "b"].map(|id| {
            let text = list(id);
            let line = text.lines().nth(1).expect("a study");
            let mut cells = line.split("  ").filter(|cell| !cell.is_empty());
            cells.nth(3).expect("a verdict").trim().to_owned()
        })
    };
    assert_eq!(verdicts(), ["never run"; 2]);
    let last_run = |verdict: &str| {
        let run = format!(
            r#"{{"id": "a", "verdict": "{verdict}", "busy_seconds": 1, "wall_seconds": 1}}"#
        );
        let head = r#""schema": 1, "crate_version": "0", "command": "c", "platform": "p", "threads_available": 1, "jobs": 1"#;
        let path = folder.path("reports/local/provenance.json");
        fs::create_dir_all(path.parent().unwrap_or(Path::new(""))).expect("a folder");
        fs::write(path, format!("{{{head}, \"studies\": [{run}]}}")).expect("a file");
    };
    for verdict in ["pass", "fail"] {
        last_run(verdict);
        assert_eq!(verdicts(), [verdict, "never run"]);
    }
    assert!(!list("a").contains("\u{1b}") && list("--tier quick").lines().count() == 5);
    assert_eq!(list("b*").lines().count(), 4);
    assert_eq!(folder.ended("list c").status, Some(2));
    folder.file("reports/local/provenance.json", "{");
    folder.ended("list").complains(2, "provenance.json: ");
}

#[test]
fn a_thousand_million_steps_need_consent_or_a_limit() {
    let beam = "[mesh]\nelements = 1\n[initial]\nu_t = \"x\"\n[time]\ndt = 1e-9\nt_end = 1.0\n";
    let exact = "[exact]\nu = [{ x = \"x^2\", t = \"t\" }]\nphi = [{ x = \"x\", t = \"t\" }]\ntheta = [{ x = \"x*(1-x)\", t = \"t\" }]\n";
    let refine =
        "[refine]\naxis = \"space\"\nelements = [1, 2, 4]\nsteps = 1000000000\nt_end = 1.0\n";
    let expect = "[[expect]]\nnorm = \"velocity\"\norder = 2.0\ntolerance = 0.1\n";
    let long = study("long", "orders/manufactured") + exact + refine + expect;
    let folder = with(&[("scenes/s.toml", beam), ("long.toml", &long)]);
    // (1 + 4) elements, 1e9 steps, 20 ns: 100 s. The meshes of the study have 5 + 6 + 8 elements.
    let ending = "on one thread; expected at most 60, or --yes, or --time-limit SECONDS";
    let scene = format!("found work for about 1.0e2 seconds {ending}");
    let all = format!("long: found work for about 3.8e2 seconds {ending}");
    for (line, words) in [
        ("run studies/scenes/s.toml", &scene),
        ("run studies/scenes/s.toml --out reports", &scene),
        ("study studies/long.toml", &all),
        ("verify", &all),
    ] {
        refuses(&folder, line, words);
    }
    // With a limit both run, until it stops them.
    for line in [
        "run studies/scenes/s.toml --time-limit 0.1",
        "run studies/scenes/s.toml --time-limit 0.1 --yes",
        "study studies/long.toml --time-limit 0.1",
    ] {
        assert_eq!(folder.ended(line).status, Some(1), "{line}");
    }
}
