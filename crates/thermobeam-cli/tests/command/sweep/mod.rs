//! `sweep`: lines, failures, refusals.

mod merge;

use super::*;

/// Writes a sweep over its own small scene.
fn sweep(folder: &Folder, design: &str) {
    over(folder, &thrown("dt = 1e-2"), design);
}

/// Writes a sweep over this scene.
fn over(folder: &Folder, base: &str, design: &str) {
    folder.file("base.toml", base);
    let text = format!("[sweep]\nscene = \"base.toml\"\n{design}");
    folder.file("sweep.toml", &text);
}

/// 96 cases, of which some are impossible.
const GRID: &str = "[grid]\nbeam.beta = { from = -0.6, to = 5.0, count = 8 }\nobstacles.epsilon = [1e-3, 1e-2]\n\
    time.dt = [0.01, 0.02, 0.03]\ntime.t_end = [0.06, 0.08]\n";

/// 200 cases, enough time to kill it.
const LONG: &str = "[grid]\nbeam.beta = { from = -0.6, to = 5.0, count = 10 }\n\
    obstacles.epsilon = { from = 1e-4, to = 1e-2, count = 5, scale = \"log\" }\nmesh.elements = [10, 60]\n\
    time.dt = [5e-3, 1e-3]\n";

/// A sweep that some cases fail.
fn run(folder: &Folder, arguments: &str) -> Ended {
    let ended = folder.ended(&format!("sweep sweep.toml {arguments}"));
    ended.complains(1, "");
    ended
}

/// The results in a folder.
fn results(folder: &Folder, out: &str) -> String {
    read(&folder.path(&format!("{out}/results.jsonl")))
}

/// The lines of the cases, below the one that names the sweep.
fn lines(text: &str) -> Vec<Value> {
    let header = text.lines().next().expect("a first line");
    assert!(header.starts_with("{\"hash\":\""), "{header}");
    let value = |line| serde_json::from_str(line).expect("a line of JSON");
    text.lines().skip(1).map(value).collect()
}

/// A case that failed for this reason.
#[track_caller]
fn failed(line: &Value, reason: &str) {
    assert_eq!(line["status"], "failed", "{line}");
    let found = line["reason"].as_str().expect("a reason");
    assert!(says(found, reason), "{line}");
}

#[test]
fn any_number_of_threads_and_either_output_give_the_same_bytes() {
    let folder = Folder::new();
    sweep(&folder, GRID);
    let one = run(&folder, "--jobs 1").stdout;
    assert_eq!(one, run(&folder, "--jobs 3").stdout);
    run(&folder, "--out out");
    let files = super::workspace::all(&folder.path("out"));
    assert_eq!(files, [("results.jsonl".into(), one.into())].into());
}

#[test]
fn a_line_holds_parameters_and_the_summary_and_a_failure_its_reason() {
    let folder = Folder::new();
    sweep(&folder, GRID);
    let lines = lines(&run(&folder, "").stdout);
    assert_eq!(lines.len(), 8 * 2 * 3 * 2);
    for (index, line) in lines.iter().enumerate() {
        assert_eq!(line["case"], index);
        let [dt, t_end] =
            ["dt", "t_end"].map(|key| number(line, &format!("/parameters/time.{key}")));
        if (t_end / dt - (t_end / dt).round()).abs() < 1e-9 {
            assert_eq!(line["status"], "done");
            assert_eq!(line["result"]["t_end"], t_end);
            assert!(line["result"].get("wall_seconds").is_none() && line.get("reason").is_none());
        } else {
            failed(line, "time.dt: found");
        }
    }
}

#[test]
fn a_case_is_what_run_prints_for_the_same_scene() {
    let folder = Folder::new();
    sweep(
        &folder,
        "[grid]\nbeam.beta = [0.25]\nmesh.elements = [17]\n",
    );
    let case = lines(folder.ended("sweep sweep.toml").well()).remove(0)["result"].take();
    let text =
        thrown("dt = 1e-2").replace("elements = 20", "elements = 17") + "[beam]\nbeta = 0.25\n";
    folder.file("base.toml", &text);
    let (_, mut alone) = folder.json("run base.toml");
    let object = alone.as_object_mut().expect("an object");
    for key in ["schema", "verdict", "wall_seconds"] {
        assert!(object.remove(key).is_some(), "{key}");
    }
    assert_eq!(case, alone);
}

#[test]
fn a_bad_sweep_file_is_named_with_line_and_field_and_nothing_is_written() {
    let folder = Folder::new();
    each_is_refused(include_str!("refused.txt"), |case| {
        let base = match case.kind {
            "any order" => "scheme = \"dg\"\ndt = 0.02",
            _ => "dt = 1e-2",
        };
        over(&folder, &thrown(base), &case.new);
        let ended = folder.ended("sweep sweep.toml --out out");
        ended.refuses("");
        assert!(!folder.path("out").exists(), "{case:?}");
        ended.stderr
    });
}
