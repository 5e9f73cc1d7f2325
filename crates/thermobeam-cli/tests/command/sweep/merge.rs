//! Sweeps that are interrupted, gone on with, shared and merged.

use convergence_study_tests::{finished, started};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::super::{Folder, ended, thermobeam};
use super::{GRID, LONG, lines, read, run, sweep};

#[test]
fn killed_at_any_moment_and_run_again_it_ends_in_the_same_bytes() {
    let folder = Folder::new();
    let file = sweep(&folder, LONG);
    let whole = folder.path("whole");
    let start = Instant::now();
    assert_eq!(run(&file, &whole, &[]).status, Some(0));
    let mut duration = start.elapsed();
    let result = read(&whole.join("results.jsonl"));
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
                .args(["--jobs", "2"]);
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
            let left = std::fs::read_to_string(out.join("results.jsonl")).unwrap_or_default();
            assert!(
                result.starts_with(&left),
                "other lines than those of the whole run"
            );
            assert!(kills < 1000, "it never gets on");
        }
        assert_eq!(result, read(&out.join("results.jsonl")));
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
        std::fs::write(torn.join("results.jsonl"), &results[..end]).unwrap();
        assert_eq!(run(&file, &torn, &[]).status, Some(1), "{end}");
        assert_eq!(read(&torn.join("results.jsonl")), results, "{end}");
    }
    let damaged = results.replacen("\"case\":2,", "\"case\":x,", 1);
    std::fs::write(torn.join("results.jsonl"), &damaged).unwrap();
    let ended = run(&file, &torn, &[]);
    assert_eq!(ended.status, Some(2));
    let words = "results.jsonl:4: expected the line of case 2, found another: ";
    assert!(ended.stderr.contains(words), "{}", ended.stderr);
    assert_eq!(read(&torn.join("results.jsonl")), damaged);
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
        assert_eq!(seen.len(), lines(&whole).len());
        let out = folder.path(&format!("merged-{n}"));
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
    let [first, second, third] = ["1/2", "2/2", "1/3"].map(|share| {
        let out = folder.path(&share.replace('/', "-"));
        run(&file, &out, &["--partition", share]);
        out
    });
    let other = folder.path("other");
    run(
        &sweep(&folder, "[grid]\nbeam.beta = [0, 1]\n"),
        &other,
        &["--partition", "2/2"],
    );
    let out = folder.path("merged");
    let refused = |folders: &[&PathBuf], words: &[&str]| {
        let mut command = thermobeam();
        command.args(["sweep", "--merge"]).args(folders);
        let ended = ended(command.arg("--out").arg(&out));
        assert_eq!((ended.status, out.exists()), (Some(2), false));
        for word in words {
            assert!(ended.stderr.contains(word), "{word}: {}", ended.stderr);
        }
    };
    refused(
        &[&first],
        &["1-2: expected beside it", "found none of the share 2/2"],
    );
    let twice = "1-2/results.jsonl:1: expected each share once, found the share 1/2 a second time";
    refused(&[&first, &second, &first], &[twice]);
    for (stranger, share) in [(&third, "1/3"), (&other, "2/2")] {
        let place = format!(
            "{}:1: expected {{",
            stranger.join("results.jsonl").display()
        );
        let found = format!("\"share\":\"{share}\"}}");
        refused(
            &[&first, stranger],
            &[
                &place,
                "of this sweep file, scene and version, found {",
                &found,
            ],
        );
    }
    refused(&[&folder.path("nowhere")], &["nowhere/results.jsonl: "]);
    // Lines of the second share: one taken out, one twice, one of the first share, one at the end
    // taken away, torn, and one too many.
    let results = second.join("results.jsonl");
    let whole = read(&results);
    let lines: Vec<&str> = whole.split_inclusive('\n').collect();
    let cases: Vec<u64> = super::lines(&whole)
        .iter()
        .map(|line| line["case"].as_u64().expect("a number"))
        .collect();
    let foreign = read(&first.join("results.jsonl"));
    let foreign = foreign.split_inclusive('\n').nth(2).expect("a line");
    let of = |case: u64| format!("the line of case {case}, found ");
    for (text, line, words) in [
        (
            [lines[0], lines[1], lines[3], lines[4]].concat(),
            3,
            of(cases[1]) + &format!("that of case {}", cases[2]),
        ),
        (
            [lines[0], lines[1], lines[1], lines[2]].concat(),
            3,
            of(cases[1]) + &format!("that of case {}", cases[0]),
        ),
        (
            [lines[0], lines[1], foreign, lines[3]].concat(),
            3,
            of(cases[1]) + "that of case ",
        ),
        (
            lines[..4].concat(),
            5,
            of(cases[3]) + "the end; run the share 2/2 again",
        ),
        (
            whole[..whole.len() - 1].to_owned(),
            5,
            of(cases[3]) + "the end; run the share 2/2 again",
        ),
        (
            whole.clone() + lines[4],
            6,
            "the end of the file, found another line".to_owned(),
        ),
    ] {
        std::fs::write(&results, &text).expect("a file");
        refused(
            &[&first, &second],
            &[&format!("2-2/results.jsonl:{line}: expected {words}")],
        );
        assert_eq!(read(&results), text);
    }
    std::fs::write(&results, whole).expect("a file");
    let mut command = thermobeam();
    command
        .args(["sweep", "--merge"])
        .args([&second, &first])
        .arg("--out")
        .arg(&out);
    assert_eq!(
        ended(&mut command).status,
        Some(0),
        "the shares are whole again"
    );
    let again = ended(&mut command);
    assert_eq!(again.status, Some(2));
    assert!(
        again
            .stderr
            .contains("merged/results.jsonl: expected no file there"),
        "{}",
        again.stderr
    );
}

#[test]
fn a_finished_folder_is_left_as_it_is_and_that_of_another_sweep_or_share_refused() {
    let folder = Folder::new();
    let (file, out) = (
        sweep(&folder, "[grid]\nbeam.beta = [0, 1]\n"),
        folder.path("out"),
    );
    assert_eq!(run(&file, &out, &[]).status, Some(0));
    let before = read(&out.join("results.jsonl"));
    let again = run(&file, &out, &[]);
    assert_eq!(again.status, Some(0), "{}", again.stderr);
    assert!(
        again.stdout.contains("0 run now, 2 were there"),
        "{}",
        again.stdout
    );
    let share = run(&file, &out, &["--partition", "1/2"]);
    assert!(
        share.status == Some(2)
            && share.stderr.contains("results.jsonl:1: expected {")
            && share.stderr.contains("\"share\":\"1/2\"} of this"),
        "{}",
        share.stderr
    );
    let changed = run(&sweep(&folder, "[grid]\nbeam.beta = [0, 2]\n"), &out, &[]);
    assert!(
        changed.status == Some(2)
            && changed
                .stderr
                .contains("results.jsonl:1: expected {\"hash\":\""),
        "{}",
        changed.stderr
    );
    assert_eq!(read(&out.join("results.jsonl")), before);
}

#[test]
fn a_second_process_is_kept_out_of_a_folder() {
    let folder = Folder::new();
    let (file, out) = (sweep(&folder, GRID), folder.path("out"));
    std::fs::create_dir(&out).expect("a folder");
    let results = std::fs::File::create(out.join("results.jsonl")).expect("a file");
    results.lock().expect("a lock");
    let second = run(&file, &out, &[]);
    assert!(
        second.status == Some(2)
            && second
                .stderr
                .contains("results.jsonl: expected no other process"),
        "{}",
        second.stderr
    );
    drop(results);
    assert_eq!(run(&file, &out, &[]).status, Some(1));
}
