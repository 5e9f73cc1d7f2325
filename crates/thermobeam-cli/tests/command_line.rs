//! Laws of the whole command line, for every command.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use convergence_study_tests::files::files_below;
use thermobeam_cli::{GROUPS, PAGES, Thermobeam, project};

/// The name of the program that exists only in a checkout.
const ELSEWHERE: &str = "xtask";

/// Columns of a help text.
const WIDEST: usize = 100;

fn program() -> clap::Command {
    // As on a wide terminal, and in a file.
    let mut program = project("thermobeam")
        .command_line::<Thermobeam>(&GROUPS, &PAGES)
        .term_width(WIDEST);
    program.build();
    program
}

/// The commands for users: the program's internal commands are hidden.
fn commands(program: &clap::Command) -> impl Iterator<Item = &clap::Command> {
    program
        .get_subcommands()
        .filter(|command| !command.is_hide_set())
}

#[test]
fn every_command_is_in_one_group_of_the_help() {
    let program = program();
    let mut commands: Vec<&str> = commands(&program).map(clap::Command::get_name).collect();
    let groups = GROUPS.iter().flat_map(|(_, names)| names.iter().copied());
    let mut listed: Vec<&str> = groups.chain(["help"]).collect();
    commands.sort_unstable();
    listed.sort_unstable();
    assert_eq!(listed, commands);
}

/// All help texts, short and long.
fn help_texts() -> Vec<String> {
    let mut program = program();
    let both = |command: &mut clap::Command| {
        [command.render_help(), command.render_long_help()].map(|text| text.to_string())
    };
    let mut texts = both(&mut program).to_vec();
    texts.extend(program.get_subcommands_mut().flat_map(both));
    assert!(texts.len() > 20);
    texts
}

#[test]
fn every_help_fits_its_columns_and_has_no_word_or_program_that_stands_for_another() {
    for text in help_texts() {
        assert!(text.contains("Usage: thermobeam"), "{text}");
        for word in [ELSEWHERE, "PROGRAM", "TEMPLATE"] {
            assert!(!text.contains(word), "{word}: {text}");
        }
        for line in text.lines() {
            assert!(line.chars().count() <= WIDEST, "{line}");
        }
    }
    // clap prints `{n}` as the end of a line.
    for command in program().get_subcommands() {
        for argument in command.get_arguments() {
            let helps = [argument.get_help(), argument.get_long_help()];
            for help in helps.into_iter().flatten() {
                assert!(!help.to_string().contains("{n}"), "{help}");
            }
        }
    }
}

/// Lines of code, or of a file that is printed or written, that name the program.
fn naming(text: &str) -> Vec<String> {
    let code = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or(""));
    code.filter(|line| line.contains(ELSEWHERE))
        .map(|line| line.trim().to_owned())
        .collect()
}

#[test]
fn no_text_of_an_installed_program_names_one_that_is_not_there() {
    let mut read = 0;
    for name in [
        "convergence-judge",
        "convergence-study",
        "thermobeam",
        "thermobeam-exact",
        "thermobeam-study",
        "thermobeam-cli",
    ] {
        let source = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("..")
            .join(name)
            .join("src");
        let tests = source.join("tests");
        let mut files = files_below(&source);
        files.retain(|path| !path.starts_with(&tests));
        for path in files {
            // A file that is not UTF-8 counts as empty.
            let text = fs::read_to_string(&path).unwrap_or_default();
            let found = naming(&text);
            assert!(found.is_empty(), "{}: {}", path.display(), found.join("\n"));
            read += 1;
        }
    }
    assert!(read > 250, "{read}");
    assert_eq!(
        naming("let a = \"now  cargo xtask run\"; // or cargo xtask\n/// as `cargo xtask`\n").len(),
        1
    );
}

/// Commands whose answer is not a result, and why.
const WITHOUT_FLAGS: [&str; 3] = ["schema", "completions", "help"];

#[test]
fn every_command_has_the_same_flags() {
    let program = program();
    let seen = |command: &clap::Command, name: &str| {
        let mut flags = command.get_arguments();
        let flag = flags.find(|argument| argument.get_long() == Some(name))?;
        let values = flag.get_value_names().map(|names| format!("{names:?}"));
        let help = flag.get_help()?.to_string();
        Some((help, values, flag.get_short(), flag.is_required_set()))
    };
    for name in ["quiet", "format", "out", "jobs"] {
        let expected = seen(program.find_subcommand("verify").unwrap(), name);
        assert!(expected.is_some(), "{name}");
        for command in commands(&program) {
            let is_without = WITHOUT_FLAGS.contains(&command.get_name());
            // `new` writes files and no results.
            if command.get_name() != "new" || name != "out" {
                let wanted = expected.clone().filter(|_| !is_without);
                assert_eq!(seen(command, name), wanted, "{command} --{name}");
            }
        }
    }
    let shorts = commands(&program)
        .flat_map(clap::Command::get_arguments)
        .filter_map(clap::Arg::get_short);
    let expected = ['V', 'h', 'j', 'n', 'o', 'q', 'v'];
    assert_eq!(shorts.collect::<BTreeSet<char>>(), expected.into());
}
