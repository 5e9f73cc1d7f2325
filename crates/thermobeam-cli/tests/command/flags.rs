//! The common flags, tested with every command.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use convergence_study::internal::{cli::command_line, program};
use serde_json::Value;
use thermobeam_cli::{GROUPS, PAGES, Thermobeam, project};

use super::workspace::{quick, workspace};
use super::{Ended, Folder, ended, thermobeam, thrown};

/// Each command with arguments that work in [`place`], its exit status there, and the file that
/// `--out out` produces.
const COMMANDS: [(&[&str], i32, &str); 11] = [
    // Every number is new.
    (&["verify"], 1, "results.json"),
    (&["study", "studies/short.toml"], 0, "results.json"),
    (&["list"], 0, "list.json"),
    (&["rates", "rates.csv", "--order", "2"], 0, "rates.json"),
    // Its object describes the report; the record is its input file.
    (&["report", "reported/results.json"], 0, "index.html"),
    (&["run", "scene.toml"], 0, "run.json"),
    (&["equilibria", "scene.toml"], 0, "equilibria.json"),
    (&["sweep", "sweep.toml"], 0, "results.jsonl"),
    (&["sweep", "--merge", "swept"], 0, "results.jsonl"),
    (&["new", "study", "begun"], 0, "begun.toml"),
    (&["manufacture", "heat.toml"], 0, "manufacture.json"),
];

/// Commands missing from [`COMMANDS`]: a script for a shell; the help; the schema.
const OTHERS: [&str; 3] = ["schema", "completions", "help"];

pub(super) fn place(folder: &Folder) -> PathBuf {
    let root = workspace(folder, "w", &[("short", quick("short"))]);
    let rates = "h,L2\n0.4,1.6e-1\n0.2,4e-2\n0.1,1e-2\n0.05,2.5e-3\n0.025,6.25e-4\n";
    let sweep = "[sweep]\nscene = \"scene.toml\"\n[grid]\nbeam.beta = [0, 1]\n";
    for (name, text) in [
        ("rates.csv", rates),
        ("scene.toml", &thrown("dt = 0.01")),
        ("sweep.toml", sweep),
        ("heat.toml", program::MANUFACTURE.files[0].1),
    ] {
        fs::write(root.join(name), text).expect("a file");
    }
    let swept = ended(
        thermobeam()
            .args(["sweep", "sweep.toml", "--out", "swept"])
            .current_dir(&root),
    );
    assert_eq!(swept.status, Some(0), "{}", swept.stderr);
    let arguments = ["study", "studies/short.toml", "--out", "reported"];
    let reported = ended(thermobeam().args(arguments).current_dir(&root));
    assert_eq!(reported.status, Some(0), "{}", reported.stderr);
    root
}

#[test]
fn every_command_is_tried() {
    let mut program = command_line::<Thermobeam>(&project("thermobeam"), &GROUPS, &PAGES);
    program.build();
    let tried = COMMANDS
        .iter()
        .map(|(arguments, ..)| arguments[0])
        .chain(OTHERS)
        .collect::<BTreeSet<_>>();
    let commands = program
        .get_subcommands()
        .filter(|command| !command.is_hide_set());
    assert_eq!(tried, commands.map(clap::Command::get_name).collect());
}

#[test]
fn every_json_has_a_schema_and_the_verdict_and_every_out_its_file() {
    for (arguments, status, file) in COMMANDS {
        let folder = Folder::new();
        let root = place(&folder);
        let mut command = thermobeam();
        let Ended {
            status: found,
            stdout,
            stderr,
        } = ended(
            command
                .args(arguments)
                .args(["--format", "json", "--out", "out", "--jobs", "1"])
                .current_dir(&root),
        );
        assert_eq!(
            (found, stderr.as_str()),
            (Some(status), ""),
            "{arguments:?}"
        );
        let object: Value = serde_json::from_str(&stdout)
            .unwrap_or_else(|error| panic!("{arguments:?}: {error}: {stdout}"));
        assert!(
            object["schema"].as_u64().is_some_and(|schema| schema >= 1),
            "{arguments:?}: {stdout}"
        );
        // The list contains a study that never ran; for all other commands verdict and exit status
        // agree.
        let verdict = match (arguments[0], status) {
            ("list", _) => "inconclusive",
            (_, 0) => "pass",
            _ => "fail",
        };
        assert_eq!(object["verdict"], verdict, "{arguments:?}");
        assert!(root.join("out").join(file).is_file(), "{arguments:?}");
        if let Some(text) = fs::read_to_string(root.join("out").join(file))
            .ok()
            .filter(|_| file.ends_with(".json"))
        {
            let written: Value = serde_json::from_str(&text).expect("JSON");
            assert_eq!(
                [&written["schema"], &written["verdict"]],
                [&object["schema"], &object["verdict"]],
                "{arguments:?}"
            );
        }
    }
}

#[test]
fn quiet_leaves_the_verdict_and_what_went_wrong() {
    for (arguments, status, _) in COMMANDS {
        let folder = Folder::new();
        let root = place(&folder);
        let out: &[&str] = if arguments[0] == "sweep" {
            &["--out", "out"]
        } else {
            &[]
        };
        let loud = ended(thermobeam().args(arguments).args(out).current_dir(&root)).stdout;
        let again = Folder::new();
        let root = place(&again);
        let quiet = ended(
            thermobeam()
                .args(arguments)
                .args(out)
                .arg("-q")
                .current_dir(&root),
        );
        assert_eq!(
            quiet.status,
            Some(status),
            "{arguments:?}: {}",
            quiet.stderr
        );
        // The verdict comes last if it passes and first if it fails, so that the cause is read at
        // once.
        let line = if status == 0 {
            quiet.stdout.lines().last()
        } else {
            quiet.stdout.lines().next()
        };
        let line = line.unwrap_or_default();
        let is_first = line.starts_with("the study passes; no baseline yet: ");
        assert!(
            ["pass: ", "fail: ", "inconclusive: "]
                .iter()
                .any(|word| line.starts_with(word))
                || is_first,
            "{arguments:?}: {line}"
        );
        let [few, many] = [&quiet.stdout, &loud].map(|text| text.lines().count());
        assert!(few < many || many == 1, "{arguments:?}: {}", quiet.stdout);
        let is_one_line = status == 0 || is_first;
        assert_eq!(is_one_line, few == 1, "{arguments:?}: {}", quiet.stdout);
    }
}
