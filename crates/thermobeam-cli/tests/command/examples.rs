//! The examples of the help texts of the beam's commands work as they stand.

use convergence_study::internal::cli;
use thermobeam_cli::{GROUPS, PAGES};

use super::flags::place;
use super::{Folder, ended, thermobeam};

/// The lines below `Examples:` that are commands.
fn examples(help: &str) -> Vec<&str> {
    let (_, lines) = help.split_once("\nExamples:\n").unwrap_or_default();
    let is_line = |line: &&str| line.starts_with("  thermobeam ");
    lines.lines().filter(is_line).map(str::trim).collect()
}

#[test]
fn every_example_of_the_commands_of_the_beam_ends_well() {
    let names = GROUPS.iter().flat_map(|(_, names)| names.iter());
    for name in names {
        let help = ended(thermobeam().args([name, "--help"])).stdout;
        let lines = examples(&help);
        assert!((2..=4).contains(&lines.len()), "{name}: {help}");
        if cli::COMMANDS.contains(name) {
            continue;
        }
        for line in lines {
            let (program, arguments) = line.split_once(' ').expect("arguments");
            assert_eq!(program, "thermobeam", "{line}");
            assert!(arguments.starts_with(name), "{line}");
            let folder = Folder::new();
            let root = place(&folder);
            for share in ["1", "2"] {
                let out = format!("share-{share}");
                let share = format!("{share}/2");
                let arguments = ["sweep", "sweep.toml", "--out", &out, "--partition", &share];
                let swept = ended(thermobeam().args(arguments).current_dir(&root));
                assert_eq!(swept.status, Some(0), "{}", swept.stderr);
            }
            let arguments = arguments.split_whitespace();
            let ran = ended(thermobeam().args(arguments).current_dir(&root));
            assert_eq!((ran.status, ran.stderr.as_str()), (Some(0), ""), "{line}");
            assert!(!ran.stdout.is_empty(), "{line}");
        }
    }
    assert_eq!(PAGES.len(), 3);
}
