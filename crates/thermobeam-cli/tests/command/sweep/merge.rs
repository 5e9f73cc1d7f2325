//! Sweeps that are interrupted, resumed, shared and merged.

use convergence_study_tests::{finished, started};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::super::{Folder, ended, thermobeam};
use super::{GRID, LATIN, lines, read, run, sweep};

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
                .args(["sweep", "--merge"])
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
                .args(["sweep", "--merge"])
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
