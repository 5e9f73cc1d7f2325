//! Sweeps that are interrupted, gone on with, shared and merged.

use super::*;
use super::{GRID, LONG, lines, results, run, sweep};

#[test]
fn killed_at_any_moment_and_run_again_it_ends_in_the_same_bytes() {
    let folder = Folder::new();
    sweep(&folder, LONG);
    let start = Instant::now();
    folder.ended("sweep sweep.toml --out whole").well();
    let mut duration = start.elapsed();
    let result = results(&folder, "whole");
    for round in 1..=4_u32 {
        let name = format!("killed-{round}");
        let out = folder.path(&name);
        let line = format!("sweep sweep.toml --jobs 2 --out {name}");
        let mut kills = 0;
        loop {
            let mut child = started(&mut super::super::command(&folder.path(""), &line));
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
        assert_eq!(result, results(&folder, &name));
    }
}

#[test]
fn shares_are_disjoint_and_complete_and_merge_to_the_bytes_of_one_run() {
    let folder = Folder::new();
    sweep(&folder, GRID);
    let whole = run(&folder, "").stdout;
    // With 150 shares many have no cases.
    for n in [1, 2, 5, 150] {
        let mut seen = BTreeSet::new();
        let mut merge = "sweep --merge".to_owned();
        for k in 1..=n {
            let share = format!("share-{k}-of-{n}");
            folder.ended(&format!(
                "sweep sweep.toml --out {share} --partition {k}/{n}"
            ));
            for line in lines(&results(&folder, &share)) {
                assert!(seen.insert(line["case"].as_u64()), "{line} twice");
            }
            merge += &format!(" {share}");
        }
        assert_eq!(seen.len(), lines(&whole).len());
        let out = format!("merged-{n}");
        folder
            .ended(&format!("{merge} --out {out}"))
            .complains(1, "");
        assert_eq!(results(&folder, &out), whole);
    }
}

#[test]
fn a_merge_names_the_line_of_a_share_that_is_wrong_and_writes_nothing() {
    let folder = Folder::new();
    sweep(&folder, "[grid]\nbeam.beta = [0, 1, 2, 3, 4, 5, 6, 7]\n");
    for (out, share) in [("first", "1/2"), ("second", "2/2")] {
        let line = format!("sweep sweep.toml --out {out} --partition {share}");
        folder.ended(&line).well();
    }
    let merge = "sweep --merge first second --out merged";
    // Lines of the second share: one taken out, one twice, one at the end taken away, torn, and one
    // too many.
    let whole = results(&folder, "second");
    let parts: Vec<&str> = whole.split_inclusive('\n').collect();
    let cases: Vec<u64> = lines(&whole)
        .iter()
        .map(|line| line["case"].as_u64().expect("a number"))
        .collect();
    let file = folder.path("second/results.jsonl");
    let of = |case: u64, found: &str| format!("the line of case {case}, found {found}");
    let that = |case: u64| format!("that of case {case}");
    let end = "the end; run the share 2/2 again";
    for (text, line, words) in [
        (
            [parts[0], parts[1], parts[3], parts[4]].concat(),
            3,
            of(cases[1], &that(cases[2])),
        ),
        (
            [parts[0], parts[1], parts[1], parts[2]].concat(),
            3,
            of(cases[1], &that(cases[0])),
        ),
        (parts[..4].concat(), 5, of(cases[3], end)),
        (whole[..whole.len() - 1].to_owned(), 5, of(cases[3], end)),
        (
            whole.clone() + parts[4],
            6,
            "the end of the file, found another line".to_owned(),
        ),
    ] {
        std::fs::write(&file, &text).expect("a file");
        let words = format!("second/results.jsonl:{line}: expected {words}");
        folder.ended(merge).refuses(&words);
        assert!(!folder.path("merged").exists());
        assert_eq!(read(&file), text);
    }
    std::fs::write(&file, whole).expect("a file");
    // The shares are whole again.
    folder.ended(merge).well();
}

#[test]
fn a_second_process_is_kept_out_of_a_folder() {
    let folder = Folder::new();
    sweep(&folder, GRID);
    std::fs::create_dir(folder.path("out")).expect("a folder");
    let file = folder.path("out/results.jsonl");
    let file = std::fs::File::create(file).expect("a file");
    file.lock().expect("a lock");
    let second = folder.ended("sweep sweep.toml --out out");
    second.refuses("results.jsonl: expected no other process");
    drop(file);
    run(&folder, "--out out");
}
