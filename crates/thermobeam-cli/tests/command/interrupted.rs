//! Ctrl-C, and a limit on the time of a case.

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::workspace::{all, endless, quick, set, verify, workspace};
use super::{Ended, Folder, ended, thermobeam, thrown};

/// How long an interrupted program may take to end: twice the promised time, for a busy machine.
const PROMPT: Duration = Duration::from_secs(2);

/// Starts a program, interrupts it like Ctrl-C, and waits for its end.
fn interrupted(command: &mut Command, after: Duration) -> Ended {
    let mut command = listening(command);
    let mut child: Child =
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    std::thread::sleep(after);
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().expect("kill").success());
    let start = Instant::now();
    while child.try_wait().expect("a child").is_none() {
        if start.elapsed() > PROMPT {
            child.kill().expect("it can be killed");
            panic!("still there {:?} after the interruption", start.elapsed());
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().expect("it has ended");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    Ended { status: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// The command, in whose process interruption is not ignored. Shells make background jobs ignore it, and processes
/// inherit that; a program started that way rightly ignores it.
fn listening(command: &Command) -> Command {
    let mut listening = Command::new("env");
    if is_deaf() {
        listening.arg("--default-signal=INT");
    }
    listening.arg(command.get_program()).args(command.get_args());
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => listening.env(name, value),
            None => listening.env_remove(name),
        };
    }
    if let Some(folder) = command.get_current_dir() {
        listening.current_dir(folder);
    }
    listening
}

/// Whether this process ignores interruptions: bit 1 of the mask reported by Linux.
fn is_deaf() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask & 2 != 0)
}

/// Long enough for the program to be working.
const AT_WORK: Duration = Duration::from_millis(1500);

#[cfg(unix)]
#[test]
fn an_interrupted_verify_says_what_had_run_and_writes_nothing() {
    let folder = Folder::new();
    let root = workspace(&folder, "w", &[("short", quick("short")), ("long", endless("long"))]);
    let before = all(&root);
    let ended = interrupted(&mut verify(&root, &["--jobs", "2"]), AT_WORK);
    assert_eq!((ended.status, ended.stdout.as_str()), (Some(130), ""));
    assert!(ended.stderr.contains("interrupted: 1 of 2 studies had run: short"), "{}", ended.stderr);
    assert_eq!(all(&root), before);
}

#[cfg(unix)]
#[test]
fn an_interrupted_sweep_is_gone_on_with_and_an_interrupted_run_says_how_far_it_was() {
    let folder = Folder::new();
    let scene = folder.file("long.toml", &thrown("dt = 1e-9"));
    let out = folder.path("out");
    let run = interrupted(thermobeam().arg("run").arg(&scene).arg("--out").arg(&out), AT_WORK);
    assert_eq!(run.status, Some(130));
    assert!(run.stderr.contains(" steps were done, 0"), "{}", run.stderr);
    assert!(all(&out).is_empty());

    folder.file("base.toml", &thrown("dt = 1e-4"));
    let text = "[sweep]\nscene = \"base.toml\"\n[grid]\nbeam.beta = { from = 0.0, to = 4.0, count = 4000 }\n";
    let file = folder.file("sweep.toml", text);
    let kept = folder.path("kept");
    let sweep = interrupted(thermobeam().arg("sweep").arg(&file).arg("--out").arg(&kept), AT_WORK);
    assert_eq!(sweep.status, Some(130));
    assert!(sweep.stderr.contains(" of 4000 cases are saved in "), "{}", sweep.stderr);
    let journal = std::fs::read_to_string(kept.join("journal.jsonl")).expect("a journal");
    assert!(journal.ends_with('\n') || journal.is_empty(), "a torn line");
    let said = sweep.stderr.trim().strip_prefix("interrupted: ").and_then(|rest| rest.split(' ').next());
    let said: usize = said.and_then(|count| count.parse().ok()).expect("a count");
    // A case whose line exists may not be counted yet, at most one per thread.
    assert!((said..said + 65).contains(&journal.lines().count()), "{said}: {}", journal.lines().count());
}

#[test]
fn a_case_at_its_limit_fails_its_study_and_no_other() {
    let folder = Folder::new();
    let root = workspace(&folder, "w", &[("short", quick("short")), ("long", endless("long"))]);
    let ended = ended(&mut verify(&root, &["--case-limit", "0.3", "--verbose"]));
    assert_eq!((ended.status, ended.stderr.as_str()), (Some(1), ""));
    let line =
        |id: &str| ended.stdout.lines().find(|line| line.starts_with(&format!("{id} "))).unwrap_or_default().to_owned();
    assert!(line("short").contains(" pass ") && line("long").contains(" fail "), "{}", ended.stdout);
    let page = std::fs::read_to_string(root.join("reports/README.md")).expect("a report");
    for piece in [
        "n = 8, 9000000000 steps: stopped at the limit of 0.3 s, after step ",
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
        let arguments = if name == "plain" { &[][..] } else { &["--case-limit", "3600"] };
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
        assert_eq!((ended.status, ended.stdout.as_str()), (Some(2), ""), "{limit}");
        assert!(ended.stderr.contains("--case-limit"), "{}", ended.stderr);
    }
}
