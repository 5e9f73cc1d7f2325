//! The examples of the help texts of the beam's commands work as they stand.

use convergence_study::command_line::Command;

use super::*;

/// The lines below `Examples:` that are commands, without the name of the program.
fn examples(help: &str) -> Vec<&str> {
    let (_, lines) = help.split_once("\nExamples:\n").unwrap_or_default();
    let lines = lines.lines();
    lines
        .filter_map(|line| line.strip_prefix("  thermobeam "))
        .collect()
}

#[test]
fn every_example_of_the_commands_of_the_beam_ends_well() {
    for name in GROUPS.iter().flat_map(|(_, names)| names.iter()) {
        let help = Folder::new().ended(&format!("{name} --help")).stdout;
        let lines = examples(&help);
        assert!((2..=4).contains(&lines.len()), "{name}: {help}");
        if Command::NAMES.contains(name) {
            continue;
        }
        for line in lines {
            assert!(line.starts_with(name), "{line}");
            let folder = Folder::new();
            let root = place(&folder);
            for share in [1, 2] {
                let line = format!("sweep sweep.toml --out share-{share} --partition {share}/2");
                ended(&mut command(&root, &line)).well();
            }
            let ran = ended(&mut command(&root, line));
            assert!(!ran.well().is_empty(), "{line}");
        }
    }
    assert_eq!(PAGES.len(), 3);
}
