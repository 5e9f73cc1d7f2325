//! How a command ends: the exit status is part of the interface.

use std::error::Error;
use std::path::Path;

use crate::cli::output;
use crate::judge::verdict::Verdict;
use crate::text::visible;

/// For the end of `--help`.
pub const HELP: &str =
    "Exit status: 0 all is well; 1 something failed; 2 input or output that cannot be used; 130 interrupted.";

/// How a command with usable input ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// Exit status 0.
    Well,
    /// Exit status 1; the failure has been reported.
    Badly,
}

/// Input that cannot be read or makes no sense, or a place that cannot be written to: exit status 2.
#[derive(Debug)]
pub struct Unusable(String);

impl Unusable {
    /// An error that does not name the file it is about.
    pub fn file(path: &Path, error: &dyn Error) -> Self {
        Self(format!("{}: {error}", visible::path(path)))
    }

    /// A problem with the arguments.
    pub fn because(reason: &str) -> Self {
        Self(reason.to_owned())
    }

    /// The problem, in words.
    pub fn message(&self) -> &str {
        &self.0
    }
}

impl From<Verdict> for Ended {
    fn from(verdict: Verdict) -> Self {
        if verdict.is_pass() { Self::Well } else { Self::Badly }
    }
}

impl<E: Error> From<E> for Unusable {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

/// What a command returns.
pub type Outcome = Result<Ended, Unusable>;

/// Reports unusable input, and turns the outcome into the exit status.
pub fn status(outcome: Outcome) -> u8 {
    match outcome {
        Ok(Ended::Well) => 0,
        Ok(Ended::Badly) => 1,
        Err(Unusable(message)) => {
            output::complain(&message);
            2
        }
    }
}
