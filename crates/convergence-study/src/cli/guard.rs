//! `guard`: what the harness starts beside every program that it runs; not for users.

use crate::program::guard;

use super::exit::{Ended, Outcome};

/// End a process group when standard input ends (the harness starts this itself)
#[derive(Debug, clap::Args)]
#[command(hide = true)]
pub struct Arguments {
    /// What marks the processes of the group
    mark: String,
}

/// Guards the process group that it leads.
///
/// # Errors
/// None.
pub(super) fn run(arguments: &Arguments) -> Outcome {
    guard::serve(&arguments.mark);
    Ok(Ended::Well)
}
