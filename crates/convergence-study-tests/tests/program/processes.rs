//! Programs that misbehave: one line about each, and no process is left.

use convergence_study_tests::{PATIENCE, finished, interruptible, signal, started};
use std::fs;
use std::thread::sleep;
use std::time::{Duration, Instant};

use foreign_tools::Tool;

use super::{Place, SOLVER};

/// What starts programs that misbehave, and ends them.
const TOOLS: [Tool; 3] = [
    foreign_tools::ENV,
    foreign_tools::KILL,
    foreign_tools::SHELL,
];

/// Modes in which the program does not end by itself; the last one has a child, too.
const HANGING: [&str; 3] = ["hang", "ignore-term", "daemon-hang"];

/// Modes in which the program ends with status 0 and leaves a child.
const CHILDREN: [&str; 3] = ["fork", "leave", "daemon"];

/// The one line about the case n = 16.
#[track_caller]
fn complaint(place: &Place) -> String {
    let ran = place.study("--jobs 2");
    ran.says(1, "4 of 5 cases completed");
    let out = ran.stdout;
    assert!(
        !out.contains(|c: char| c.is_control() && c != '\n'),
        "{out:?}"
    );
    assert_eq!(place.running(), [""; 0]);
    let at = out.find("n = 16: ").unwrap_or_else(|| panic!("{out}"));
    out[at..].lines().next().unwrap().to_owned()
}

#[test]
fn every_misbehaviour_is_one_line_and_leaves_nothing() {
    if !foreign_tools::are_here(&TOOLS) {
        return;
    }
    for (mode, told) in [
        ("abort", "ended with signal 6 (SIGABRT)"),
        (
            "status",
            "ended with exit status 3; its last words: reading the mesh | \u{fffd}[31mno such file: mesh.msh",
        ),
        (
            "garbage",
            "answered nothing: no line of its standard output is a JSON object; the last line is `\u{fffd}\u{fffd}`",
        ),
        ("silent", "answered nothing: its standard output is empty"),
        (
            "nan",
            "`L2` of its errors is NaN, infinite or null; expected a finite number",
        ),
        ("missing", "its answer has no error `L2`; it has H1"),
        (
            "cut",
            "it does not end on its line: print it with json.dumps(...) on one line",
        ),
    ] {
        let line = complaint(&Place::new(mode, ""));
        assert!(
            line.contains(told) && line.contains(SOLVER),
            "{mode}: {line}"
        );
    }
    // Children that outlive their program, inside or outside its group, harm neither this case nor
    // the others.
    for mode in CHILDREN {
        let place = Place::new(mode, "");
        place.study("").says(0, "");
        assert_eq!(place.running(), [""; 0]);
    }
}

#[test]
fn a_program_that_hangs_is_stopped_and_leaves_nothing() {
    if !foreign_tools::are_here(&TOOLS) {
        return;
    }
    // Long enough for the programs that do not hang, on a busy machine.
    for mode in HANGING {
        let line = complaint(&Place::new(mode, "time_limit = 3"));
        assert!(
            line.contains("was stopped at its time limit of 3 s"),
            "{line}"
        );
    }
    let place = Place::new("hang", "");
    place
        .study("--time-limit 3")
        .says(1, "was stopped at its time limit of 3 s");
    assert_eq!(place.running(), [""; 0]);
}

#[test]
fn a_program_that_kills_its_guard_fails_and_leaves_nothing() {
    foreign_tools::needs!(KILL, SHELL);
    let place = Place::new("kill-guard", "");
    let message = "cannot be waited for: its guard has ended: signal: 9 (SIGKILL)";
    place.study("--jobs 2").says(1, message);
    // The harness is no parent of the program: it kills it, and cannot wait for it.
    place.wait_for(|running| running == 0);
}

#[test]
fn much_output_takes_little_memory() {
    let place = Place::new("flood", "");
    let mut harness = place.start();
    let peak = |pid: u32| {
        let status = fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
        let line = status
            .lines()
            .find_map(|line| line.strip_prefix("VmHWM:"))?;
        line.trim().trim_end_matches(" kB").parse::<u64>().ok()
    };
    let mut kilobytes = 0;
    let start = Instant::now();
    while harness.try_wait().unwrap().is_none() {
        assert!(start.elapsed() < PATIENCE, "the harness hangs");
        kilobytes = peak(harness.id()).map_or(kilobytes, |now| now.max(kilobytes));
        sleep(Duration::from_millis(2));
    }
    assert_eq!(finished(harness).status.code(), Some(0));
    assert!((1000..60_000).contains(&kilobytes), "{kilobytes} kB");
}

/// Processes of every kind end when this signal ends the harness.
fn nothing_is_left_after(name: &str) {
    for mode in HANGING.into_iter().chain(CHILDREN) {
        let mut place = Place::new(mode, "");
        // So that a program whose child hangs is still running, too.
        place.more = "time_limit = 100".to_owned();
        let hangs = HANGING.contains(&mode);
        let harness = place.start();
        if hangs {
            place.wait_for(|running| running > 0);
        }
        sleep(Duration::from_millis(50));
        signal(harness.id(), name);
        let status = finished(harness).status;
        assert!(!hangs || !status.success(), "{mode}: {status}");
        place.wait_for(|running| running == 0);
    }
}

#[test]
fn a_killed_harness_leaves_nothing() {
    if !foreign_tools::are_here(&TOOLS) {
        return;
    }
    nothing_is_left_after("-KILL");
    nothing_is_left_after("-TERM");
}

#[test]
fn an_interrupted_harness_leaves_nothing() {
    if !foreign_tools::are_here(&TOOLS) {
        return;
    }
    let place = Place::new("hang", "");
    let harness = started(&mut interruptible(&place.command("study s.toml --jobs 2")));
    place.wait_for(|running| running > 0);
    signal(harness.id(), "-INT");
    assert_eq!(finished(harness).status.code(), Some(130));
    place.wait_for(|running| running == 0);
}
