//! Full disks, and readers that stop early: a shell limits the size of files.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::workspace::{all, quick, set, verify, workspace};
use super::{Folder, ended, thermobeam, thrown};

/// The program with a file size limit of a few kilobytes, as on a full disk.
fn on_a_full_disk(command: &Command, folder: &Path) -> Command {
    let mut limited = Command::new("sh");
    limited
        .args(["-c", "trap '' XFSZ; ulimit -f 4; exec \"$@\"", "sh"])
        .current_dir(folder);
    limited.arg(command.get_program()).args(command.get_args());
    limited
}

#[test]
fn on_a_full_disk_nothing_is_half_written() {
    if !foreign_tools::are_here(&[foreign_tools::SHELL]) {
        return;
    }
    let folder = Folder::new();
    // The second history is so short that it is written to disk only when the file is closed.
    for dt in ["dt = 1e-3", "dt = 5e-2"] {
        let scene = folder.file("scene.toml", &thrown(dt));
        let out = folder.path("out");
        let run = ended(&mut on_a_full_disk(
            thermobeam().arg("run").arg(&scene).arg("--out").arg(&out),
            &folder.path(""),
        ));
        assert_eq!(
            (run.status, run.stdout.as_str()),
            (Some(2), ""),
            "{dt}: {}",
            run.stderr
        );
        assert!(run.stderr.contains("history.csv"), "{dt}: {}", run.stderr);
        assert!(all(&out).is_empty(), "{dt}: {:?}", all(&out).keys());
    }

    let root = workspace(&folder, "w", &[("short", quick("short"))]);
    assert_eq!(ended(&mut verify(&root, &[])).status, Some(1));
    let before = set(&root.join("reports"));
    fs::write(root.join("studies/more.toml"), quick("more")).expect("a study");
    let full = ended(&mut on_a_full_disk(&verify(&root, &[]), &root));
    assert_eq!(
        (full.status, full.stdout.as_str()),
        (Some(2), ""),
        "{}",
        full.stderr
    );
    assert!(
        full.stderr.contains("reports cannot be written"),
        "{}",
        full.stderr
    );
    assert_eq!(set(&root.join("reports")), before);
    assert_eq!(ended(&mut verify(&root, &[])).status, Some(1));
    assert_ne!(set(&root.join("reports")), before);
}

// Other systems have no /dev/full.
#[cfg(target_os = "linux")]
#[test]
fn output_to_a_full_disk_is_said_and_output_to_nobody_is_no_error() {
    use std::process::Stdio;

    use convergence_study_tests::finished;

    let folder = Folder::new();
    let scene = folder
        .file("scene.toml", &thrown("dt = 1e-2"))
        .display()
        .to_string();
    let table = folder
        .file("t.csv", "h,e\n1,1\n0.5,0.5\n0.25,0.25\n0.125,0.125\n")
        .display()
        .to_string();
    folder.file("base.toml", &thrown("dt = 1e-2"));
    let sweep = folder.file(
        "sweep.toml",
        "[sweep]\nscene = \"base.toml\"\n[grid]\nbeam.beta = [0, 1, 2]\n",
    );
    let sweep = sweep.display().to_string();
    let root = workspace(&folder, "w", &[("short", quick("short"))]);
    for (arguments, status) in [
        (&["run", &scene][..], 0),
        (&["run", &scene, "--format", "json"], 0),
        (&["equilibria", &scene], 0),
        (&["rates", &table, "--order", "1"], 0),
        (&["sweep", &sweep], 0),
        (&["study", "studies/short.toml"], 0),
        (&["study", "studies/short.toml", "--format", "json"], 0),
        (&["verify", "short"], 1),
        (&["list"], 0),
        (&["completions", "bash"], 0),
        (&["schema"], 0),
        (&["schema", "scene"], 0),
    ] {
        let mut command = thermobeam();
        command
            .args(arguments)
            .current_dir(&root)
            .stderr(Stdio::piped());
        let full = fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .expect("/dev/full");
        let output = finished(command.stdout(full).spawn().expect("it starts"));
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(
            said.starts_with("error: ") && said.contains("space"),
            "{arguments:?}: {said}"
        );

        let mut child = command.stdout(Stdio::piped()).spawn().expect("it starts");
        drop(child.stdout.take());
        let output = finished(child);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(
            (output.status.code(), said.as_str()),
            (Some(status), ""),
            "{arguments:?}"
        );
    }
}
