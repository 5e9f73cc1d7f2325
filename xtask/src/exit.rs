//! How a command ends: the exit status is part of the interface.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use crate::output;

/// For the end of `--help`.
pub(crate) const HELP: &str =
    "Exit status: 0 all is well; 1 something failed; 2 input or output that cannot be used; 130 interrupted.";

/// A command that had usable input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Exit status 0.
    Pass,
    /// Exit status 1; what failed has been said.
    Fail,
}

/// Input that cannot be read or makes no sense, or a place that cannot be written to: exit status 2.
#[derive(Debug)]
pub(crate) struct Unusable(String);

impl Unusable {
    /// An error that does not name the file it is about.
    pub(crate) fn file(path: &Path, error: &dyn Error) -> Self {
        Self(format!("{}: {error}", path.display()))
    }

    /// Something that is wrong with the arguments.
    pub(crate) fn because(reason: &str) -> Self {
        Self(reason.to_owned())
    }
}

impl<E: Error> From<E> for Unusable {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

/// What a command returns.
pub(crate) type Outcome = Result<Verdict, Unusable>;

/// Says what is unusable, and turns the outcome into the exit status.
pub(crate) fn code(outcome: Outcome) -> ExitCode {
    match outcome {
        Ok(Verdict::Pass) => ExitCode::SUCCESS,
        Ok(Verdict::Fail) => ExitCode::from(1),
        Err(Unusable(message)) => {
            output::complain(&message);
            ExitCode::from(2)
        }
    }
}

/// The same for a command that knows its exit status: whatever error it returns is input that cannot be used.
pub(crate) fn status(result: Result<ExitCode, Box<dyn Error>>) -> ExitCode {
    result.unwrap_or_else(|error| {
        output::complain(&error.to_string());
        ExitCode::from(2)
    })
}
