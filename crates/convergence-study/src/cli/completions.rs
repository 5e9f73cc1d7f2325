//! `completions SHELL`: what a shell needs to complete the commands.

use clap::{Args, Command};
use clap_complete::{Shell, generate};

use super::exit::{Ended, Outcome};
use crate::cli::output;

/// Print completions for a shell
///
/// A shell completes a program of that name on the PATH, not an alias such as cargo's. For bash: source <(PROGRAM completions bash)
#[derive(Debug, Args)]
pub struct Arguments {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Prints the script for the program of that command line.
pub(super) fn run(program: Command, name: &str, arguments: &Arguments) -> Outcome {
    let mut script = vec![];
    generate(arguments.shell, &mut program.clone().bin_name(name), name, &mut script);
    output::print(&String::from_utf8_lossy(&script))?;
    Ok(Ended::Well)
}
