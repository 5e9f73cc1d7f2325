//! The benchmark refuses what it cannot use, and its report comes from its record.

use std::path::Path;
use std::process::{Command, Output};

fn bench(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xtask"))
        .arg("bench")
        .args(arguments)
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."))
        .output()
        .unwrap()
}

fn unusable(arguments: &[&str], message: &str) {
    let output = bench(arguments);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains(message), "{message}: {text}");
}

#[test]
fn mistakes_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cvode.json");
    std::fs::write(&path, "{\"runs\": [{\"elements\": 1}]}").unwrap();
    let path = path.to_str().unwrap();
    unusable(
        &["--beside", path],
        "cvode.json: missing field `degree` at line 1 column",
    );
    unusable(&["--beside", "none.json"], "none.json: cannot be read");
    unusable(
        &["--only", "midpont"],
        "--only midpont: expected fixed-point, fixed-point-once, euler-crank-nicolson, richardson, midpoint, dg, CVODE,",
    );
    unusable(&["--limit", "0"], "--limit 0: expected a number above 0");
}

/// A run over the limit, and an error that the reference cannot judge, are in no table.
#[test]
fn the_report_is_that_of_the_record() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    std::fs::create_dir(out.join("bench")).unwrap();
    let run = |method: &str, resolution: &str, tip: f64, seconds: f64| {
        serde_json::json!({
            "problem": "work-precision-paper", "method": method, "resolution": resolution,
            "norm": 10.0 * tip, "tip": tip, "work": 1e3 * seconds, "seconds": seconds,
        })
    };
    let record = serde_json::json!({
        "limit": 60.0,
        "references": {"work-precision-paper": [1e-4, 1e-9]},
        "runs": [
            run("midpoint", "8 x 128", 2e-3, 0.001),
            run("midpoint", "16 x 256", 5e-4, 0.25),
            run("midpoint", "32 x 512", 4e-4, 0.5),
            run("midpoint", "64 x 999", 1e-6, 61.0),
            run("dg", "p = 8", 1e-9, 0.5),
        ],
        "tables": [],
    });
    std::fs::write(out.join("bench/runs.json"), record.to_string()).unwrap();
    let output = bench(&["--only", "CVODE", "--out", out.to_str().unwrap()]);
    assert!(output.status.success(), "{output:?}");
    let page = std::fs::read_to_string(out.join("bench.md")).unwrap();
    let (_, table) = page.split_once("## Error in u(1, t), the paper").unwrap();
    let rows: Vec<String> = table
        .split("![")
        .next()
        .unwrap()
        .lines()
        .filter(|line| line.starts_with('|'))
        .map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "))
        .collect();
    assert_eq!(rows[0], "| error | midpoint | dG(q), degree p |");
    let expected = [
        "| 1e-2 | 0.0010 (8 x 128) | 0.50 (p = 8) |",
        "| 1e-3 | 0.25 (16 x 256) | 0.50 (p = 8) |",
        "| 1e-4 | - | 0.50 (p = 8) |",
    ];
    assert_eq!(rows[2..5], expected);
    assert_eq!(rows.last().unwrap(), "| 1e-8 | - | 0.50 (p = 8) |");
    assert!(page.contains("A run may take 60 seconds of CPU time"));
    assert!(
        out.join("bench/work-precision-paper-tip-seconds.svg")
            .exists()
    );
}
