mod merge;

use super::accuracy::UNSOLVED;
use super::{Ended, Folder, ended, thermobeam, thrown};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A sweep over its own small scene.
fn sweep(folder: &Folder, design: &str) -> PathBuf {
    folder.file("base.toml", &thrown("dt = 1e-2"));
    folder.file(
        "sweep.toml",
        &format!("[sweep]\nscene = \"base.toml\"\n{design}"),
    )
}

/// 96 cases, of which some are impossible.
const GRID: &str = "[grid]\nbeam.beta = { from = -0.6, to = 5.0, count = 8 }\nobstacles.epsilon = [1e-3, 1e-2]\n\
    time.dt = [0.01, 0.02, 0.03]\ntime.t_end = [0.06, 0.08]\n";

/// 200 cases, enough time to kill it.
const LONG: &str = "[grid]\nbeam.beta = { from = -0.6, to = 5.0, count = 10 }\n\
    obstacles.epsilon = { from = 1e-4, to = 1e-2, count = 5, scale = \"log\" }\nmesh.elements = [10, 60]\n\
    time.dt = [5e-3, 1e-3]\n";

fn run(file: &Path, out: &Path, arguments: &[&str]) -> Ended {
    ended(
        thermobeam()
            .arg("sweep")
            .arg(file)
            .arg("--out")
            .arg(out)
            .args(arguments),
    )
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The lines of the cases, below the one that names the sweep.
fn lines(text: &str) -> Vec<serde_json::Value> {
    let header = text.lines().next().expect("a first line");
    assert!(header.starts_with("{\"hash\":\""), "{header}");
    text.lines()
        .skip(1)
        .map(|line| serde_json::from_str(line).expect("a line of JSON"))
        .collect()
}

#[test]
fn any_number_of_threads_and_either_output_give_the_same_bytes() {
    let folder = Folder::new();
    let file = sweep(&folder, GRID);
    let one = ended(thermobeam().arg("sweep").arg(&file).args(["--jobs", "1"])).stdout;
    let three = ended(thermobeam().arg("sweep").arg(&file).args(["--jobs", "3"])).stdout;
    let out = folder.path("out");
    run(&file, &out, &[]);
    assert_eq!(one, three);
    assert_eq!(one, read(&out.join("results.jsonl")));
    let names: BTreeSet<_> = std::fs::read_dir(&out)
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert_eq!(names, ["results.jsonl"].map(Into::into).into());
}

#[test]
fn a_line_holds_parameters_and_the_summary_and_a_failure_its_reason() {
    let folder = Folder::new();
    let ended = ended(thermobeam().arg("sweep").arg(sweep(&folder, GRID)));
    let lines = lines(&ended.stdout);
    assert_eq!((lines.len(), ended.status), (8 * 2 * 3 * 2, Some(1)));
    for (index, line) in lines.iter().enumerate() {
        assert_eq!(line["case"], index);
        let [dt, t_end] = ["time.dt", "time.t_end"]
            .map(|key| line["parameters"][key].as_f64().expect("a number"));
        let possible = (t_end / dt - (t_end / dt).round()).abs() < 1e-9;
        assert_eq!(line["status"], if possible { "done" } else { "failed" });
        if possible {
            assert_eq!(line["result"]["t_end"], t_end);
            assert!(line["result"].get("wall_seconds").is_none() && line.get("reason").is_none());
        } else {
            assert!(
                line["reason"]
                    .as_str()
                    .is_some_and(|reason| reason.starts_with("time.dt: found")),
                "{line}"
            );
        }
    }
}

#[test]
fn a_case_is_what_run_prints_for_the_same_scene() {
    let folder = Folder::new();
    let file = sweep(
        &folder,
        "[grid]\nbeam.beta = [0.25]\nmesh.elements = [17]\n",
    );
    let case = lines(&ended(thermobeam().arg("sweep").arg(file)).stdout).remove(0)["result"].take();
    let text =
        thrown("dt = 1e-2").replace("elements = 20", "elements = 17") + "[beam]\nbeta = 0.25\n";
    let (_, mut alone) = super::run_json(&folder.file("base.toml", &text));
    for key in ["schema", "verdict", "wall_seconds"] {
        assert!(
            alone
                .as_object_mut()
                .expect("an object")
                .remove(key)
                .is_some(),
            "{key}"
        );
    }
    assert_eq!(case, alone);
}

#[test]
fn a_step_that_fails_is_a_line_too() {
    let folder = Folder::new();
    folder.file("base.toml", &thrown("dt = 1e-2\nsolver = \"fixed-point\""));
    let text = "[sweep]\nscene = \"base.toml\"\n[grid]\nobstacles.epsilon = [1e-3, 1.0]\n";
    let ended = ended(
        thermobeam()
            .arg("sweep")
            .arg(folder.file("sweep.toml", text)),
    );
    let lines = lines(&ended.stdout);
    assert_eq!(
        (&lines[0]["status"], &lines[1]["status"]),
        (&"failed".into(), &"done".into())
    );
    assert!(
        lines[0]["reason"]
            .as_str()
            .is_some_and(|reason| reason.contains("diverge")),
        "{}",
        lines[0]
    );
    assert_eq!(lines[0]["result"]["failure"]["kind"], "diverged");
    assert_eq!(ended.status, Some(1));
}

#[test]
fn a_case_out_of_balance_fails_by_every_scheme() {
    let folder = Folder::new();
    for (base, reason) in UNSOLVED {
        folder.file("base.toml", base);
        let file = folder.file(
            "sweep.toml",
            "[sweep]\nscene = \"base.toml\"\n[grid]\nbeam.zeta = [0.1]\n",
        );
        let ended = ended(thermobeam().arg("sweep").arg(&file));
        let line = &lines(&ended.stdout)[0];
        assert_eq!(
            (ended.status, &line["status"]),
            (Some(1), &"failed".into()),
            "{}",
            ended.stdout
        );
        assert!(
            line["reason"]
                .as_str()
                .is_some_and(|found| found.contains(reason)),
            "{line}"
        );
    }
}

#[test]
fn a_case_that_takes_too_long_is_stopped_and_the_others_go_on() {
    let folder = Folder::new();
    // The first of them would take hours.
    let file = sweep(
        &folder,
        "[grid]\ntime.dt = [1e-8, 1e-2]\ntime.t_end = [10.0]\n",
    );
    let ended = ended(
        thermobeam()
            .arg("sweep")
            .arg(&file)
            .args(["--time-limit", "1"]),
    );
    let lines = lines(&ended.stdout);
    assert_eq!(
        (ended.status, lines.len()),
        (Some(1), 2),
        "{}",
        ended.stderr
    );
    assert_eq!(
        (&lines[0]["status"], &lines[1]["status"]),
        (&"failed".into(), &"done".into())
    );
    let reason = lines[0]["reason"].as_str().unwrap();
    assert!(
        reason.starts_with("stopped at the time limit of 1 s, after step "),
        "{reason}"
    );
    let failure = &lines[0]["result"]["failure"];
    assert_eq!(
        (&failure["kind"], &failure["limit_seconds"]),
        (&"time-limit".into(), &1.0.into())
    );
    assert!(failure["step"].as_u64() > Some(0) && lines[0]["result"]["steps"] == failure["step"]);
}

#[test]
fn a_heated_end_takes_its_temperature_along() {
    let folder = Folder::new();
    let set = "[set]\ninitial.theta = \"{beam.theta_a}*(1-x)\"\n";
    let axis = "[grid]\nbeam.theta_a = [0.0, -5.0, 20.0]\n";
    let ended = ended(
        thermobeam()
            .arg("sweep")
            .arg(sweep(&folder, &format!("{set}{axis}"))),
    );
    assert_eq!(ended.status, Some(0), "{}", ended.stderr);
    assert_eq!(lines(&ended.stdout).len(), 3);
    let without = super::ended(thermobeam().arg("sweep").arg(sweep(&folder, axis)));
    assert_eq!(without.status, Some(2));
    assert!(
        without
            .stderr
            .contains("sweep.toml:4:22: grid.beam.theta_a[1]"),
        "{}",
        without.stderr
    );
}

#[test]
fn a_bad_sweep_file_is_named_with_line_and_field_and_nothing_is_written() {
    let folder = Folder::new();
    for (design, pieces) in [
        ("", &["sweep.toml:1:1: grid: missing", "[list]"][..]),
        ("[grid]\n", &["sweep.toml:3:1: grid", "beam.beta"]),
        (
            "[grid]\nbeam.betta = [1]",
            &["sweep.toml:4:14: grid.beam.betta", "`beta`"],
        ),
        (
            "[grid]\nbeam.beta = 1",
            &["sweep.toml:4:13: grid.beam.beta", "a list"],
        ),
        (
            "[grid]\nbeam.beta = [1, \"2\"]",
            &["sweep.toml:4:17: grid.beam.beta[1]"],
        ),
        (
            "[grid]\nbeam.beta = [1, 2, 1.0]",
            &["sweep.toml:4:20: grid.beam.beta[2]", "a second time"],
        ),
        (
            "[grid]\nbeam.zeta = [0.1, -1]",
            &["sweep.toml:4:19: grid.beam.zeta[1]", "-1", ">= 0"],
        ),
        (
            "[grid]\nmesh.elements = [2.5]",
            &["sweep.toml:4:18: grid.mesh.elements[0]", "whole number"],
        ),
        (
            "[grid]\ntime.dt = [0.01, 0.3]",
            &["sweep.toml:4:18: grid.time.dt[1]", "divides t_end"],
        ),
        (
            "[grid]\nbeam.beta = { from = 1, to = 0, count = 3 }",
            &["grid.beam.beta.to", "> 1.0"],
        ),
        (
            "[grid]\nbeam.beta = { from = 0, to = 1, count = 3, scale = \"log\" }",
            &["grid.beam.beta.from", "> 0"],
        ),
        (
            "[grid]\nmesh.elements = { from = 2, to = 4, count = 9 }",
            &["grid.mesh.elements", "a second time"],
        ),
        (
            "[list]\nbeam.beta = [0, 1]\nbeam.rho = [1]",
            &[
                "sweep.toml:5:13: list.beam.rho[0]",
                "as many as of beam.beta",
            ],
        ),
        (
            "[list]\nbeam.beta = [0, 1]\nbeam.zeta = [1, -1]",
            &["sweep.toml:5:17: list.beam.zeta[1]", "-1", ">= 0"],
        ),
        (
            "[set]\nbeam.beta = 1\n[grid]\nbeam.beta = [1]",
            &["sweep.toml:6:13: grid.beam.beta", "[set], too"],
        ),
        (
            "[set]\nbeam.betta = 1\n[grid]\nbeam.beta = [1]",
            &["sweep.toml:4:14: set.beam.betta", "`beta`"],
        ),
        (
            "[set]\ninitial.u = \"1+x\"\n[grid]\nbeam.beta = [1]",
            &["sweep.toml:4:13: set.initial.u", "u(0) = 1.0"],
        ),
        (
            "[set]\ninitial.u = \"{beam.rho}*x\"\n[grid]\nbeam.beta = [1]",
            &["sweep.toml:4:13: set.initial.u", "{beam.rho}"],
        ),
        (
            "[set]\ntime.dt = 0.3\n[grid]\nbeam.beta = [1]",
            &["sweep.toml:4:11: set.time.dt", "divides t_end"],
        ),
        (
            "[grid]\nbeam.beta = [1]\n[list]\nbeam.beta = [1]",
            &["list", "either [grid] or [list]"],
        ),
    ] {
        let out = folder.path("out");
        let ended = run(&sweep(&folder, design), &out, &[]);
        assert_eq!(
            (ended.status, ended.stdout.as_str(), out.exists()),
            (Some(2), "", false),
            "{design}"
        );
        for piece in pieces {
            assert!(
                ended.stderr.contains(piece),
                "{design}\n{piece}: {}",
                ended.stderr
            );
        }
    }
    let file = sweep(&folder, GRID);
    for share in ["0/2", "3/2", "x"] {
        assert_eq!(
            ended(
                thermobeam()
                    .arg("sweep")
                    .arg(&file)
                    .args(["--partition", share])
            )
            .status,
            Some(2)
        );
    }
}
