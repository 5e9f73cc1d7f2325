//! Full disks, and readers that stop early: a shell limits the size of files.

use super::*;

/// The program with a file size limit of a few kilobytes, as on a full disk.
fn on_a_full_disk(command: &Command) -> Command {
    let mut limited = Command::new("sh");
    limited.args(["-c", "trap '' XFSZ; ulimit -f 4; exec \"$@\"", "sh"]);
    limited.arg(command.get_program()).args(command.get_args());
    limited.current_dir(command.get_current_dir().expect("a folder"));
    limited
}

#[test]
fn on_a_full_disk_nothing_is_half_written() {
    foreign_tools::needs!(SHELL);
    let folder = Folder::new();
    // The second history is so short that it is written to disk only when the file is closed.
    for dt in ["dt = 1e-3", "dt = 5e-2"] {
        folder.file("scene.toml", &thrown(dt));
        let run = command(&folder.path(""), "run scene.toml --out out");
        ended(&mut on_a_full_disk(&run)).refuses("history.csv");
        assert!(all(&folder.path("out")).is_empty(), "{dt}");
    }

    let root = workspace(&folder, "w", &[("short", quick("short"))]);
    let reports = root.join("reports");
    let mut verify = verify(&root, "");
    ended(&mut verify).complains(1, "");
    let before = set(&reports);
    fs::write(root.join("studies/more.toml"), quick("more")).expect("a study");
    ended(&mut on_a_full_disk(&verify)).refuses("reports cannot be written");
    // A run without a result leaves none for programs; all else is as it was.
    let mut kept = before.clone();
    let newest = ["index.html", "junit.xml", "results.json", "summary.md"];
    kept.retain(|name, _| !newest.contains(&name.as_str()));
    assert_eq!(set(&reports), kept);
    ended(&mut verify).complains(1, "");
    assert_ne!(set(&reports), before);
}

// Other systems have no /dev/full.
#[cfg(target_os = "linux")]
#[test]
fn output_to_a_full_disk_is_said_and_output_to_nobody_is_no_error() {
    use convergence_study_tests::{Ended, finished};
    use std::process::Stdio;

    let folder = Folder::new();
    let root = super::flags::place(&folder);
    for (line, status) in [
        ("run scene.toml", 0),
        ("run scene.toml --format json", 0),
        ("equilibria scene.toml", 0),
        ("rates rates.csv --order 2", 0),
        ("sweep sweep.toml", 0),
        ("study studies/short.toml", 0),
        ("study studies/short.toml --format json", 0),
        ("verify short", 1),
        ("list", 0),
        ("completions bash", 0),
        ("schema", 0),
        ("schema scene", 0),
    ] {
        let mut command = command(&root, line);
        command.stderr(Stdio::piped());
        let full = fs::OpenOptions::new().write(true).open("/dev/full");
        command.stdout(full.expect("/dev/full"));
        let full = Ended::from(finished(command.spawn().expect("it starts")));
        full.complains(2, "space");
        assert!(full.stderr.starts_with("error: "), "{line}: {full:?}");

        let mut child = command.stdout(Stdio::piped()).spawn().expect("it starts");
        drop(child.stdout.take());
        let unread = Ended::from(finished(child));
        unread.complains(status, "");
        assert_eq!(unread.stderr, "", "{line}");
    }
}
