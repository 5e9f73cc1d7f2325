//! `completions SHELL`: what a shell needs to complete the commands.

use clap::{Args, CommandFactory};
use clap_complete::{Shell, generate};

use crate::Xtask;
use crate::exit::{Outcome, Verdict};
use crate::output;

/// Print completions for a shell
///
/// A shell completes the program, not cargo's alias for it: put target/release on the PATH and call it `xtask`. For bash:
/// source <(cargo xtask completions bash)
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let mut script = vec![];
    generate(arguments.shell, &mut Xtask::command().bin_name("xtask"), "xtask", &mut script);
    output::print(&String::from_utf8_lossy(&script))?;
    Ok(Verdict::Pass)
}
