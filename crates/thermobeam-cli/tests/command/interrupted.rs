//! Ctrl-C, which Windows does not send to one process alone.

use convergence_study_tests::{PATIENCE, interruptible, signal};
use std::thread;

use super::workspace::endless;
use super::*;

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

#[test]
fn an_interrupted_verify_says_what_had_run_and_writes_nothing() {
    foreign_tools::needs!(ENV, KILL);
    let folder = Folder::new();
    let studies = [("short", quick("short")), ("long", endless("long"))];
    let root = workspace(&folder, "w", &studies);
    let before = set(&root);
    let message = "interrupted: 1 of 2 studies had run: short";
    let ended = interrupted(
        || verify(&root, "--jobs 2 --yes"),
        |ended| ended.stderr.contains(message),
    );
    ended.complains(130, message);
    assert_eq!(ended.stdout, "");
    assert_eq!(set(&root), before);
}

#[test]
fn an_interrupted_sweep_is_gone_on_with_and_an_interrupted_run_says_how_far_it_was() {
    foreign_tools::needs!(ENV, KILL);
    let folder = Folder::new();
    let here = folder.path("");
    folder.file("long.toml", &thrown("dt = 1e-9"));
    let message = " steps were done, 0";
    let run = interrupted(
        || command(&here, "run --yes long.toml --out out"),
        |ended| ended.stderr.contains(message),
    );
    run.complains(130, message);
    assert!(all(&folder.path("out")).is_empty());

    folder.file("base.toml", &thrown("dt = 1e-4"));
    let text = "[sweep]\nscene = \"base.toml\"\n[grid]\nbeam.beta = { from = 0.0, to = 4.0, count = 4000 }\n";
    folder.file("sweep.toml", text);
    let again = || {
        // Of an attempt that was interrupted before the program was at work.
        let _ = std::fs::remove_dir_all(folder.path("kept"));
        command(&here, "sweep sweep.toml --out kept")
    };
    let sweep = interrupted(again, |ended| ended.status.is_some());
    sweep.complains(130, "interrupted: … of 4000 cases are saved in ");
    let results = read(&folder.path("kept/results.jsonl"));
    assert!(results.ends_with('\n'), "a torn line");
    let said = sweep.stderr.split(' ').nth(1);
    let said: usize = said.and_then(|count| count.parse().ok()).expect("a count");
    // Lines that were written together, of a batch, may not be counted yet.
    let cases = results.lines().count() - 1;
    assert!((said..said + 65).contains(&cases), "{said}: {cases}");
}
