//! Ctrl-C, and a limit on the time of a case.

use std::process::Command;
use std::thread;
use std::time::Duration;

use convergence_study_tests::{PATIENCE, finished, interruptible, signal, started};

use super::workspace::{all, endless, quick, set, verify, workspace};
use super::{Ended, Folder, ended, thermobeam, thrown};

/// Starts a program, interrupts it like Ctrl-C while it is at work, and waits for its end.
///
/// * `command`: the same for every attempt.
/// * `is_at_work`: whether it had begun when it was interrupted; if not, it is started again and
///   interrupted later.
fn interrupted(command: impl Fn() -> Command, is_at_work: impl Fn(&Ended) -> bool) -> Ended {
    let mut after = Duration::from_millis(250);
    loop {
        let child = started(&mut interruptible(&command()));
        thread::sleep(after);
        signal(child.id(), "-INT");
        let ended = Ended::from(finished(child));
        if is_at_work(&ended) || after > PATIENCE {
            return ended;
        }
        after *= 2;
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_verify_says_what_had_run_and_writes_nothing() {
    let folder = Folder::new();
    let root = workspace(
        &folder,
        "w",
        &[("short", quick("short")), ("long", endless("long"))],
    );
    let before = all(&root);
    let message = "interrupted: 1 of 2 studies had run: short";
    let ended = interrupted(
        || verify(&root, &["--jobs", "2", "--yes"]),
        |ended| ended.stderr.contains(message),
    );
    assert_eq!((ended.status, ended.stdout.as_str()), (Some(130), ""));
    assert!(ended.stderr.contains(message), "{}", ended.stderr);
    assert_eq!(all(&root), before);
}

#[cfg(unix)]
#[test]
fn an_interrupted_sweep_is_gone_on_with_and_an_interrupted_run_says_how_far_it_was() {
    let folder = Folder::new();
    let scene = folder.file("long.toml", &thrown("dt = 1e-9"));
    let out = folder.path("out");
    let command = || {
        let mut command = thermobeam();
        command
            .args(["run", "--yes"])
            .arg(&scene)
            .arg("--out")
            .arg(&out);
        command
    };
    let message = " steps were done, 0";
    let run = interrupted(command, |ended| ended.stderr.contains(message));
    assert_eq!(run.status, Some(130));
    assert!(run.stderr.contains(message), "{}", run.stderr);
    assert!(all(&out).is_empty());

    folder.file("base.toml", &thrown("dt = 1e-4"));
    let text = "[sweep]\nscene = \"base.toml\"\n[grid]\nbeam.beta = { from = 0.0, to = 4.0, count = 4000 }\n";
    let file = folder.file("sweep.toml", text);
    let kept = folder.path("kept");
    let command = || {
        // Of an attempt that was interrupted before the program was at work.
        let _ = std::fs::remove_dir_all(&kept);
        let mut command = thermobeam();
        command.arg("sweep").arg(&file).arg("--out").arg(&kept);
        command
    };
    let sweep = interrupted(command, |ended| ended.status.is_some());
    assert_eq!(sweep.status, Some(130));
    assert!(
        sweep.stderr.contains(" of 4000 cases are saved in "),
        "{}",
        sweep.stderr
    );
    let journal = std::fs::read_to_string(kept.join("journal.jsonl")).expect("a journal");
    assert!(journal.ends_with('\n') || journal.is_empty(), "a torn line");
    let said = sweep
        .stderr
        .trim()
        .strip_prefix("interrupted: ")
        .and_then(|rest| rest.split(' ').next());
    let said: usize = said.and_then(|count| count.parse().ok()).expect("a count");
    // A case whose line exists may not be counted yet, at most one per thread.
    assert!(
        (said..said + 65).contains(&journal.lines().count()),
        "{said}: {}",
        journal.lines().count()
    );
}

#[test]
fn a_case_at_its_limit_fails_its_study_and_no_other() {
    let folder = Folder::new();
    let root = workspace(
        &folder,
        "w",
        &[("short", quick("short")), ("long", endless("long"))],
    );
    let ended = ended(&mut verify(&root, &["--case-limit", "1", "--verbose"]));
    assert_eq!((ended.status, ended.stderr.as_str()), (Some(1), ""));
    let line = |id: &str| {
        ended
            .stdout
            .lines()
            .find(|line| line.starts_with(&format!("{id} ")))
            .unwrap_or_default()
            .to_owned()
    };
    assert!(
        line("short").contains(" pass ") && line("long").contains(" fail "),
        "{}",
        ended.stdout
    );
    let page = std::fs::read_to_string(root.join("reports/README.md")).expect("a report");
    for piece in [
        "n = 8, 9000000000 steps: stopped at the limit of 1 s, after step ",
        "| every case completes, with finite numbers | fail",
    ] {
        assert!(page.contains(piece), "{piece}: {page}");
    }
}

#[test]
fn a_limit_that_is_not_reached_changes_no_bit() {
    let folder = Folder::new();
    let sets = ["plain", "limited"].map(|name| {
        let root = workspace(&folder, name, &[("short", quick("short"))]);
        let arguments = if name == "plain" {
            &[][..]
        } else {
            &["--case-limit", "3600"]
        };
        assert_eq!(ended(&mut verify(&root, arguments)).status, Some(1));
        set(&root.join("reports"))
    });
    assert_eq!(sets[0], sets[1]);
}

#[test]
fn a_limit_that_is_none_is_unusable() {
    let folder = Folder::new();
    let root = workspace(&folder, "w", &[("short", quick("short"))]);
    for limit in ["0", "-1", "nan", "inf", "1e300", "soon"] {
        let ended = ended(&mut verify(&root, &[&format!("--case-limit={limit}")]));
        assert_eq!(
            (ended.status, ended.stdout.as_str()),
            (Some(2), ""),
            "{limit}"
        );
        assert!(ended.stderr.contains("--case-limit"), "{}", ended.stderr);
    }
}
