//! Reports made anew, and what is accepted into the baseline.

use std::fs;
use std::process::Stdio;

use convergence_study_tests::finished;

use super::{ORDER, command, read, run, study, texts, workspace};

/// What the system says of a file that is not there.
const NO_FILE: &str = if cfg!(windows) {
    "The system cannot find the file"
} else {
    "No such file"
};

/// The pages of a record equal those of the run, and come only from the record and its pictures.
#[test]
fn a_report_is_made_anew_from_its_record() {
    let root = workspace(true);
    let files = |folder: &str| {
        let names = [
            "README.md",
            "index.html",
            "summary.md",
            "junit.xml",
            "results.json",
        ];
        let figures = ["figures/one-errors.svg", "figures/rates.svg"];
        let read = |name: &&str| fs::read_to_string(root.path().join(folder).join(name)).unwrap();
        names.iter().chain(&figures).map(read).collect::<Vec<_>>()
    };
    run(&root, "verify").says(1, "");
    let written = files("reports/local/quick");
    let remove = |path: &str| fs::remove_file(root.path().join(path)).unwrap();
    [
        "studies/one.toml",
        "studies/two.toml",
        "reports/local/quick/README.md",
        "reports/local/quick/index.html",
    ]
    .iter()
    .for_each(|path| remove(path));
    let (status, out, err) = run(&root, "report reports/results.json").parts();
    assert_eq!((status, err.as_str()), (Some(1), ""), "{out}");
    assert!(
        out.starts_with("fail: 1 of 2 fail (two)")
            && out.ends_with("reports/local/quick/README.md\n"),
        "{out}"
    );
    assert_eq!(files("reports/local/quick"), written);
    assert!(!root.path().join("reports/README.md").exists());
    // Elsewhere a report needs a destination, and does without missing pictures.
    fs::copy(
        root.path().join("reports/results.json"),
        root.path().join("r.json"),
    )
    .unwrap();
    run(&root, "report r.json").complains(
        2,
        "r.json: found outside of a report's folder; expected --out DIR",
    );
    run(&root, "report r.json --out new").complains(1, "note: no picture figures/one-errors.svg");
    run(&root, "report studies/baseline.json --out new")
        .complains(2, &format!("studies/baseline.json: {NO_FILE}"));
}

#[test]
fn a_blessing_takes_what_moved_and_no_number_of_a_failing_study() {
    let root = workspace(false);
    run(&root, "verify --bless").says(0, "");
    let exponent = |exponent: f64| {
        let file = root.path().join("studies/one.toml");
        fs::write(file, study("one", "c", exponent)).unwrap();
    };
    let baseline = |path: &[&str]| {
        let text = read(&root, "studies/baseline.json");
        let object: serde_json::Value = serde_json::from_str(&text).unwrap();
        path.iter().fold(object, |object, key| object[key].clone())
    };
    let error = ["studies", "one", "numbers", "error error, n = 8"];
    assert_eq!(baseline(&error)[0], 0.125);
    exponent(1.01);
    run(&root, "verify").says(1, "  one: settings have changed: hash ");
    run(&root, "verify --loosened").says(2, "");
    let ran = run(&root, "verify --bless --loosened");
    ran.says(0, "loosened: one: settings have changed: hash ");
    ran.says(0, "baseline: blessed");
    let moved = baseline(&error);
    assert_eq!(moved[0], 8f64.powf(-1.01));
    run(&root, "verify").says(0, "");
    exponent(0.5);
    run(&root, "verify --bless").says(1, "not blessed: the verdict on `one` is fail");
    assert_eq!(baseline(&error), moved);
}

#[test]
fn a_run_fails_where_a_study_does_and_nothing_differs() {
    let root = workspace(false);
    run(&root, "verify --bless").says(0, "");
    let (status, out, _) =
        texts(command(root.path(), &["verify", "--quiet"]).env(ORDER, "2")).parts();
    assert_eq!(status, Some(1), "{out}");
    let failed = "one: fail\n  error: 1.0000 ± 0.00005, claimed 2 ± 0.05: too low (too-low)\n  too-low: The whole interval";
    assert!(out.contains(failed) && !out.contains("baseline: "), "{out}");
}

/// They all write the same baseline, wherever their reports go.
#[test]
fn blessings_at_once_are_all_kept() {
    let root = workspace(false);
    let ids: Vec<String> = (0..8).map(|k| format!("s{k}")).collect();
    for id in &ids {
        fs::write(
            root.path().join(format!("studies/{id}.toml")),
            study(id, "c", 1.0),
        )
        .unwrap();
    }
    let bless = |id: &String| {
        let mut command = command(
            root.path(),
            &["verify", "--bless", "--quiet", "--out", id, id],
        );
        command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    for run in ids.iter().map(bless).collect::<Vec<_>>() {
        assert_eq!(finished(run).status.code(), Some(0));
    }
    let text = read(&root, "studies/baseline.json");
    let baseline: serde_json::Value = serde_json::from_str(&text).unwrap();
    let missing: Vec<&String> = ids
        .iter()
        .filter(|id| baseline["studies"].get(id.as_str()).is_none())
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
    // Another name of the folder of the project's own reports: it has the same lock, which is taken
    // only once.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("reports", root.path().join("link")).unwrap();
        run(&root, "verify --bless --out link").says(0, "");
    }
}

#[test]
fn a_study_with_a_near_extension_is_named() {
    let root = workspace(false);
    let write =
        |name: &str, text: &str| fs::write(root.path().join("studies").join(name), text).unwrap();
    write("two.tml", &study("two", "c", 0.5));
    write("UP.TOML", &study("up", "c", 1.0));
    write("notes.tml", "# [study]\n");
    write("three.txt", &study("three", "c", 0.5));
    let message =
        "warning: studies/two.tml: a study that is not run; expected a name that ends in .toml\n";
    for line in ["verify --bless", "verify --quiet", "list"] {
        let ran = run(&root, line);
        assert_eq!(
            (ran.status, ran.stderr.as_str()),
            (Some(0), message),
            "{line}"
        );
    }
    // Some systems write names in capitals: the study is read.
    let listed = run(&root, "list").stdout;
    assert!(
        listed.lines().any(|line| line.starts_with("up ")),
        "{listed}"
    );
}
