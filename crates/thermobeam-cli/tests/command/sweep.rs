use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use convergence_study_tests::{finished, started};

use super::accuracy::UNSOLVED;
use super::{Ended, Folder, ended, thermobeam, thrown};

/// A sweep over its own small scene.
fn sweep(folder: &Folder, design: &str) -> PathBuf {
    folder.file("base.toml", &thrown("dt = 1e-2"));
    folder.file(
        "sweep.toml",
        &format!("[sweep]\nscene = \"base.toml\"\n{design}"),
    )
}

/// 48 cases; two of them are impossible.
const GRID: &str = "[grid]\nbeam.beta = { from = -0.6, to = 5.0, count = 8 }\nobstacles.epsilon = [1e-3, 1e-2]\n\
    time.dt = [0.01, 0.02, 0.03]\ntime.t_end = [0.06, 0.08]\n";

/// 200 samples, enough time to kill it.
const LATIN: &str = "[latin]\nsamples = 200\nseed = 3\nbeam.beta = { from = -0.6, to = 5.0 }\n\
    obstacles.epsilon = { from = 1e-4, to = 1e-2, scale = \"log\" }\ntime.dt = { from = 1e-3, to = 1e-2, scale = \"log\" }\n\
    mesh.elements = { from = 10, to = 60 }\n";

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

fn lines(text: &str) -> Vec<serde_json::Value> {
    text.lines()
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
    assert_eq!(
        names,
        ["results.jsonl", "sweep.json"].map(Into::into).into()
    );
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
            .args(["--case-limit", "1"]),
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
        reason.starts_with("stopped at the limit of 1 s, after step "),
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
fn killed_at_any_moment_and_resumed_it_ends_in_the_same_bytes() {
    let folder = Folder::new();
    let file = sweep(&folder, LATIN);
    let whole = folder.path("whole");
    let start = Instant::now();
    assert_eq!(run(&file, &whole, &[]).status, Some(0));
    let mut duration = start.elapsed();
    for round in 1..=4_u32 {
        let out = folder.path(&format!("killed-{round}"));
        let mut kills = 0;
        loop {
            let mut command = thermobeam();
            command
                .arg("sweep")
                .arg(&file)
                .arg("--out")
                .arg(&out)
                .args(["--resume", "--jobs", "2"]);
            let mut child = started(&mut command);
            // A moment that differs between kills and between machines.
            std::thread::sleep(
                duration * (1 + (7 * kills + 3 * round) % 11) / 40
                    + Duration::from_micros(u64::from(round)),
            );
            child.kill().expect("it can be killed");
            if finished(child).status.success() {
                if kills > 0 {
                    break;
                }
                // The machine was busier when the whole run was measured: once more, killed sooner.
                duration /= 2;
                std::fs::remove_dir_all(&out).expect("a folder");
                continue;
            }
            // Later each time, so that it gets on even if the machine has become busier.
            duration += duration / 10;
            kills += 1;
            let journal = std::fs::read_to_string(out.join("journal.jsonl")).unwrap_or_default();
            let cases: Vec<&str> = journal
                .split_inclusive('\n')
                .filter(|line| line.ends_with('\n'))
                .collect();
            assert_eq!(
                cases.len(),
                cases.iter().collect::<BTreeSet<_>>().len(),
                "nothing twice"
            );
            assert!(kills < 1000, "it never gets on");
        }
        assert_eq!(
            read(&whole.join("results.jsonl")),
            read(&out.join("results.jsonl"))
        );
    }
}

#[test]
fn a_torn_line_is_repaired_and_a_damaged_one_named() {
    let folder = Folder::new();
    let file = sweep(&folder, GRID);
    let whole = folder.path("whole");
    run(&file, &whole, &[]);
    let results = read(&whole.join("results.jsonl"));
    let torn = folder.path("torn");
    for end in [0, 1, results.len() / 3, results.len() - 1, results.len()] {
        let _ = std::fs::remove_dir_all(&torn);
        std::fs::create_dir(&torn).unwrap();
        std::fs::copy(whole.join("sweep.json"), torn.join("sweep.json")).unwrap();
        std::fs::write(torn.join("journal.jsonl"), &results[..end]).unwrap();
        assert_eq!(run(&file, &torn, &["--resume"]).status, Some(1), "{end}");
        assert_eq!(read(&torn.join("results.jsonl")), results, "{end}");
    }
    std::fs::remove_file(torn.join("results.jsonl")).unwrap();
    let damaged = results.replacen("\"case\":2,", "\"case\":x,", 1);
    std::fs::write(torn.join("journal.jsonl"), &damaged).unwrap();
    let ended = run(&file, &torn, &["--resume"]);
    assert_eq!(ended.status, Some(2));
    assert!(
        ended
            .stderr
            .contains("journal.jsonl:3: not a line of results"),
        "{}",
        ended.stderr
    );
}

#[test]
fn shares_are_disjoint_and_complete_and_merge_to_the_bytes_of_one_run() {
    let folder = Folder::new();
    let file = sweep(&folder, GRID);
    let whole = ended(thermobeam().arg("sweep").arg(&file)).stdout;
    // With 150 shares many have no cases.
    for n in [1, 2, 5, 150] {
        let shares: Vec<PathBuf> = (1..=n)
            .map(|k| folder.path(&format!("share-{k}-of-{n}")))
            .collect();
        let mut seen = BTreeSet::new();
        for (k, share) in shares.iter().enumerate() {
            run(&file, share, &["--partition", &format!("{}/{n}", k + 1)]);
            for line in lines(&read(&share.join("results.jsonl"))) {
                assert!(seen.insert(line["case"].as_u64()), "{line} twice");
            }
        }
        assert_eq!(seen.len(), whole.lines().count());
        let out = folder.path("merged");
        let merged = ended(
            thermobeam()
                .arg("merge")
                .args(&shares)
                .arg("--out")
                .arg(&out),
        );
        assert_eq!(
            (merged.status, read(&out.join("results.jsonl"))),
            (Some(1), whole.clone()),
            "{}",
            merged.stderr
        );
    }
}

#[test]
fn a_merge_names_what_is_missing_twice_or_foreign_and_writes_nothing() {
    let folder = Folder::new();
    let file = sweep(&folder, "[grid]\nbeam.beta = [0, 1, 2, 3, 4, 5, 6, 7]\n");
    let [first, second] = ["1/2", "2/2"].map(|share| {
        let out = folder.path(&share.replace('/', "-"));
        run(&file, &out, &["--partition", share]);
        out
    });
    let out = folder.path("merged");
    let merge = |folders: &[&PathBuf]| {
        let ended = ended(
            thermobeam()
                .arg("merge")
                .args(folders)
                .arg("--out")
                .arg(&out),
        );
        assert_eq!((ended.status, out.exists()), (Some(2), false));
        ended.stderr
    };
    let absent = lines(&read(&second.join("results.jsonl")))[0]["case"].clone();
    let missing = merge(&[&first]);
    assert!(
        missing.contains(&format!("missing: {absent}")) && missing.contains("shares 1/2"),
        "{missing}"
    );
    let twice = merge(&[&first, &second, &first]);
    assert!(
        twice.contains("expected each case once") && twice.contains("1-2/results.jsonl"),
        "{twice}"
    );
    let other = folder.path("other");
    run(&sweep(&folder, "[grid]\nbeam.beta = [0, 1]\n"), &other, &[]);
    let foreign = merge(&[&first, &second, &other]);
    assert!(
        foreign.contains("other: expected the hash of sweep file and scene"),
        "{foreign}"
    );
    let none = merge(&[&folder.path("nowhere")]);
    assert!(
        none.contains("nowhere: not the folder of a sweep"),
        "{none}"
    );
}

#[test]
fn a_folder_is_not_written_over_nor_mixed() {
    let folder = Folder::new();
    let (file, out) = (
        sweep(&folder, "[grid]\nbeam.beta = [0, 1]\n"),
        folder.path("out"),
    );
    assert_eq!(run(&file, &out, &[]).status, Some(0));
    let again = run(&file, &out, &[]);
    assert!(
        again.status == Some(2) && again.stderr.contains("--resume"),
        "{}",
        again.stderr
    );
    let share = run(&file, &out, &["--resume", "--partition", "1/2"]);
    assert!(
        share.status == Some(2) && share.stderr.contains("expected the share 1/2, found 1/1"),
        "{}",
        share.stderr
    );
    let before = read(&out.join("results.jsonl"));
    let changed = run(
        &sweep(&folder, "[grid]\nbeam.beta = [0, 2]\n"),
        &out,
        &["--resume"],
    );
    assert!(
        changed.status == Some(2) && changed.stderr.contains("hash"),
        "{}",
        changed.stderr
    );
    assert_eq!(read(&out.join("results.jsonl")), before);
    assert_eq!(
        ended(thermobeam().arg("sweep").arg(&file).arg("--resume")).status,
        Some(2)
    );
}

#[test]
fn a_bad_sweep_file_is_named_with_line_and_field_and_nothing_is_written() {
    let folder = Folder::new();
    for (design, pieces) in [
        ("", &["sweep.toml:1:1: grid: missing", "[latin]"][..]),
        ("[grid]\n", &["sweep.toml:3:1: grid", "beam.beta"]),
        (
            "[grid]\nbeam.betta = [1]",
            &["sweep.toml:4:6: grid.beam.betta", "`beta`"],
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
            &["grid.mesh.elements.count", "at most 3"],
        ),
        (
            "[latin]\nbeam.beta = { from = 0, to = 1 }",
            &["latin.samples: missing"],
        ),
        (
            "[latin]\nsamples = 4\nseed = 1\nbeam.beta = [0, 1]",
            &["sweep.toml:6:13: latin.beam.beta", "range"],
        ),
        (
            "[latin]\nsamples = 4\nseed = 1\nbeam.zeta = { from = -1, to = 1 }",
            &["sweep.toml:6:13: latin.beam.zeta"],
        ),
        (
            "[set]\ninitial.u = \"1+x\"\n[grid]\nbeam.beta = [1]",
            &["sweep.toml:4:13: set.initial.u", "u(0) = 1.0"],
        ),
        (
            "[set]\ninitial.u = \"{beam.rho}*x\"\n[grid]\nbeam.beta = [1]",
            &["set.initial.u", "{beam.beta}"],
        ),
        (
            "[set]\ntime.dt = 0.3\n[grid]\nbeam.beta = [1]",
            &["sweep.toml:4:11: set.time.dt", "divides t_end"],
        ),
        (
            "[grid]\nbeam.beta = [1]\n[latin]\nsamples = 4\nseed = 1",
            &["latin", "either [grid] or [latin]"],
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

#[test]
fn a_second_process_is_kept_out_of_a_folder() {
    let folder = Folder::new();
    let (file, out) = (sweep(&folder, GRID), folder.path("out"));
    std::fs::create_dir(&out).expect("a folder");
    let journal = std::fs::File::create(out.join("journal.jsonl")).expect("a journal");
    journal.lock().expect("a lock");
    let second = run(&file, &out, &["--resume"]);
    assert!(
        second.status == Some(2) && second.stderr.contains("another process"),
        "{}",
        second.stderr
    );
    drop(journal);
    assert_eq!(run(&file, &out, &["--resume"]).status, Some(1));
}
