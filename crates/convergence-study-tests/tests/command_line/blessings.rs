//! Blessings at the same time, and on a full disk.

use std::process::Stdio;

#[cfg(target_os = "linux")]
use convergence_study_tests::Ended;
use convergence_study_tests::finished;

#[cfg(unix)]
use super::{Command, texts};
use super::{command, read, run, study, workspace, write};

/// A shell limits the size of files: the baseline would have room.
#[cfg(unix)]
#[test]
fn a_blessing_whose_report_has_no_room_does_not_happen() {
    foreign_tools::needs!(SHELL);
    let root = workspace();
    run(&root, "verify --bless").says(0, "blessed");
    let before = read(&root, "studies/baseline.json");
    write(&root, "studies/one.toml", study("one", "d", 1.0));
    let mut limited = Command::new("sh");
    let limit = "trap '' XFSZ; ulimit -f 4; exec \"$@\"";
    limited.args(["-c", limit, "sh", env!("CARGO_BIN_EXE_powers")]);
    limited.args(["verify", "--bless", "--loosened"]);
    limited.current_dir(root.path());
    let ended = texts(&mut limited);
    ended.refuses("the reports cannot be written");
    assert!(!ended.stderr.contains("blessed"), "{ended:?}");
    assert_eq!(read(&root, "studies/baseline.json"), before);
}

// Other systems have no /dev/full.
#[cfg(target_os = "linux")]
#[test]
fn a_blessing_that_cannot_be_printed_says_that_it_has_happened() {
    let root = workspace();
    let full = std::fs::File::options().write(true).open("/dev/full");
    let mut bless = command(root.path(), &["verify", "--bless"]);
    let bless = bless.stdout(full.unwrap()).stderr(Stdio::piped()).spawn();
    let ended = Ended::from(finished(bless.unwrap()));
    ended.refuses("standard output cannot be written");
    ended.refuses("; the baseline is blessed all the same");
    run(&root, "verify").says(0, "baseline values unchanged");
}

/// They all write the same baseline, wherever their reports go.
#[test]
fn blessings_at_once_are_all_kept() {
    let root = workspace();
    let ids: Vec<String> = (0..8).map(|k| format!("s{k}")).collect();
    for id in &ids {
        write(&root, &format!("studies/{id}.toml"), study(id, "c", 1.0));
    }
    let bless = |id: &String| {
        let mut command = command(
            root.path(),
            &["verify", "--bless", "--quiet", "--out", id, id],
        );
        command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    for run in ids.iter().map(bless).collect::<Vec<_>>() {
        assert_eq!(finished(run).status.code(), Some(0));
    }
    let baseline = read(&root, "studies/baseline.json");
    for id in ids {
        assert!(
            baseline.contains(&format!("\"{id}\": {{")),
            "{id}: {baseline}"
        );
    }
}
