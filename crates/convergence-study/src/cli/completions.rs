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
    // `cargo` cannot complete its aliases: the name is `xtask` for `cargo xtask`.
    let name = project
        .command
        .rsplit(' ')
        .next()
        .unwrap_or(project.command)
        .to_owned();
    let mut script = vec![];
    generate(
        arguments.shell,
        &mut whole.bin_name(&name),
        &name,
        &mut script,
    );
    screen::print(&String::from_utf8_lossy(&script))?;
    Ok(Verdict::Pass)
}
