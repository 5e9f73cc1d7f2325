//! `completions`: what an installed program has, and `cargo xtask` needs not compile.

use clap_complete::{Shell, generate};

use super::{exit, screen};
use crate::project::Project;
use convergence_judge::verdict::Verdict;

/// Print completions for a shell
///
/// A shell completes a program of that name on the PATH, not an alias such as cargo's. What is
/// printed belongs where the shell looks for completions; for one session, bash reads it by `source
/// FILE`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Prints what a shell needs to complete the commands of the whole command line.
pub(super) fn run(
    project: &Project,
    arguments: &Arguments,
    whole: clap::Command,
) -> exit::CommandOutcome {
    screen::print(&script(project, arguments.shell, whole))?;
    Ok(Verdict::Pass)
}

/// What a shell reads.
fn script(project: &Project, shell: Shell, whole: clap::Command) -> String {
    // `cargo` cannot complete its aliases: the name is `xtask` for `cargo xtask`.
    let name = project.command.rsplit(' ').next();
    let name = name.unwrap_or(project.command).to_owned();
    // With a hyphen in the name, `clap_complete` 4.6 calls a command of a program by two names in
    // the script for bash, which then completes none of its options.
    let plain = match shell {
        Shell::Bash => name.replace('-', "_"),
        _ => name.clone(),
    };
    let mut script = vec![];
    generate(shell, &mut whole.bin_name(&plain), &plain, &mut script);
    let script = String::from_utf8_lossy(&script);
    script.replace(&format!(" {plain}\n"), &format!(" {name}\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bash_completes_the_options_of_each_command_of_a_program_with_a_hyphen() {
        let project = Project::new("studies", "own-studies");
        let script = script(&project, Shell::Bash, project.own_command_line());
        let lines: Vec<&str> = script.lines().map(str::trim).collect();
        let named = lines.iter().filter_map(|line| line.strip_prefix("cmd=\""));
        let named: Vec<&str> = named.map(|name| name.trim_end_matches('"')).collect();
        assert!(named.len() > 10, "{script}");
        for name in named.into_iter().filter(|name| !name.is_empty()) {
            assert!(lines.contains(&&*format!("{name})")), "{name}");
        }
        assert!(script.contains("-o default own-studies\n"), "{script}");
    }
}
