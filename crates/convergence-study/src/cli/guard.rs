//! `guard`: the harness starts it next to every program that it runs; not for users.

use crate::program::guard;

use super::exit::{Ended, Outcome, Unusable};

/// End a process group when standard input ends (the harness starts this itself)
#[derive(Debug, clap::Args)]
#[command(hide = true)]
pub struct Arguments {
    /// The mark of the processes of the group
    mark: String,
}

/// Guards the process group that it leads.
///
/// # Errors
/// Started by anyone except the harness: it would end the process group of its caller.
pub(super) fn run(arguments: &Arguments) -> Outcome {
    if !guard::is_guard() {
        return Err(Unusable::because(
            "found the command guard; expected another: the harness starts its guards itself",
        ));
    }
    guard::serve(&arguments.mark);
    Ok(Ended::Well)
}
