//! `completions` and `man`: what an installed program has, and `cargo xtask` needs not compile.

use clap::Subcommand;
use clap_complete::{Shell, generate};

use super::{exit, screen, visible_commands};
use crate::judge::verdict::Verdict;
use crate::project::Project;

/// The commands.
#[allow(missing_docs)]
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Print completions for a shell
    ///
    /// A shell completes a program of that name on the PATH, not an alias such as cargo's. What is
    /// printed belongs where the shell looks for completions; for one session, bash reads it by
    /// `source FILE`.
    Completions {
        /// The shell
        #[arg(value_enum)]
        shell: Shell,
    },
    /// Print a man page
    Man {
        /// The command; without it the page of the program
        command: Option<String>,
    },
}

impl Command {
    /// Runs the command; `whole` is the whole command line.
    pub(super) fn run(&self, project: &Project, whole: clap::Command) -> exit::CommandOutcome {
        match self {
            Self::Completions { shell } => complete(whole, project, *shell),
            Self::Man { command } => man(whole, command.as_deref()),
        }
    }
}

/// Prints what a shell needs to complete the commands of that command line.
fn complete(whole: clap::Command, project: &Project, shell: Shell) -> exit::CommandOutcome {
    // `cargo` cannot complete its aliases: the name is `xtask` for `cargo xtask`.
    let name = project
        .command
        .rsplit(' ')
        .next()
        .unwrap_or(project.command)
        .to_owned();
    let mut script = vec![];
    generate(shell, &mut whole.bin_name(&name), &name, &mut script);
    screen::print(&String::from_utf8_lossy(&script))?;
    Ok(Verdict::Pass)
}

/// Prints the man page of the program, or of one of its commands.
///
/// # Errors
/// An unknown command.
fn man(mut whole: clap::Command, name: Option<&str>) -> exit::CommandOutcome {
    whole.build();
    let known = visible_commands(&whole);
    let page = match name {
        None => whole.clone(),
        Some(name) if known.contains(&name) => {
            let command = whole.get_subcommands().find(|one| one.get_name() == name);
            command.unwrap_or(&whole).clone()
        }
        Some(name) => {
            let known = known.join(", ");
            let message = format!("man: found `{name}`; expected one of {known}");
            return Err(exit::Unusable::because(&message));
        }
    };
    let mut text = vec![];
    clap_mangen::Man::new(page).render(&mut text)?;
    screen::print(&String::from_utf8_lossy(&text))?;
    Ok(Verdict::Pass)
}
