//! Ctrl-C: pending writes are finished, the work done so far is reported, and the process exits with status 130.
//!
//! A separate thread answers, so that the process exits within a second whatever the others do. No file is left
//! half-written: see [`writing`].

use std::process;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crate::program::guard;
use crate::store::writing;

use crate::cli::output;

/// The exit status of a process that ended on request: 128 plus the number of SIGINT, as in shells.
const STATUS: i32 = 130;

/// Longest wait for pending writes.
const PATIENCE: Duration = Duration::from_millis(800);

type Said = Box<dyn Fn() -> String + Send>;

static SAID: Mutex<Option<Said>> = Mutex::new(None);

/// Installs the handler for Ctrl-C, if the operating system has one. A guard needs none: it has no work of its own to
/// finish, and signals would end its thread.
pub fn listen() {
    if guard::is_guard() {
        return;
    }
    let _ = ctrlc::try_set_handler(|| {
        let said = SAID.lock().unwrap_or_else(PoisonError::into_inner).as_ref().map(|said| said());
        writing::close(PATIENCE);
        let said = said.map_or(String::new(), |said| format!(": {said}"));
        output::tell(&format!("\ninterrupted{said}"));
        process::exit(STATUS);
    });
}

/// Sets the report on the work done so far, printed on an interruption.
pub fn say(said: impl Fn() -> String + Send + 'static) {
    *SAID.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(said));
}
