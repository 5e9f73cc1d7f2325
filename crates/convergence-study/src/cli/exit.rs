//! How a command ends: the exit status is part of the interface.
//!
//! On Ctrl-C pending writes are finished, the work done so far is reported, and the process exits
//! with status 130. A separate thread answers, so that it exits within a second whatever the others
//! do. No file is left half-written: see [`atomic`].

use std::error::Error;
use std::path::Path;
use std::process;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use super::screen;
use crate::store::atomic;
use crate::text::visible;
use convergence_judge::verdict::Verdict;

/// For the end of `--help`.
pub(crate) const HELP: &str =
    "Exit status: 0 all is well; 1 something failed; 2 unusable input or output; 130 interrupted.";

/// Input that cannot be read or makes no sense, or a place that cannot be written to: exit
/// status 2.
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

impl<E: Error> From<E> for Unusable {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

/// What a command with usable input returns: exit status 0 for a pass, otherwise 1; the failure has
/// then been reported.
pub(crate) type CommandOutcome = Result<Verdict, Unusable>;

/// Reports unusable input, and turns the outcome into the exit status.
pub(crate) fn status(outcome: CommandOutcome) -> u8 {
    match outcome {
        Ok(verdict) => u8::from(!verdict.is_pass()),
        Err(Unusable(message)) => {
            screen::complain(&message);
            2
        }
    }
}

/// The exit status of a process that ended on request: 128 plus the number of SIGINT, as in shells.
const INTERRUPTED: i32 = 130;

/// Longest wait for pending writes.
const PATIENCE: Duration = Duration::from_millis(800);

static SAID: Mutex<Option<Box<dyn Fn() -> String + Send>>> = Mutex::new(None);

/// Installs the handler for Ctrl-C, if the operating system has one.
pub(crate) fn listen() {
    let _ = ctrlc::try_set_handler(|| {
        let said = SAID
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .as_ref()
            .map(|said| said());
        atomic::finish_writes(PATIENCE);
        let said = said.map_or(String::new(), |said| format!(": {said}"));
        screen::tell(&format!("\ninterrupted{said}"));
        process::exit(INTERRUPTED);
    });
}

/// Sets the report on the work done so far, printed on an interruption.
pub(super) fn say(said: impl Fn() -> String + Send + 'static) {
    *SAID.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(said));
}
