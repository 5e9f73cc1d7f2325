//! Blessings at the same time.

use std::process::Stdio;

use convergence_study_tests::finished;

use super::{command, read, study, workspace, write};

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
