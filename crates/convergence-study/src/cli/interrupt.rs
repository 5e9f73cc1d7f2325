//! Ctrl-C: what is being written is finished, what has been done is said, and the process ends with status 130.
//!
//! The request is served by a thread of its own, so that it ends within a second whatever the others are at. Nothing is
//! half-written then: see [`writing`].

use std::process;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crate::store::writing;

use crate::cli::output;

/// The status of a process that ended on request: 128 and the number of SIGINT, as shells have it.
const STATUS: i32 = 130;

/// How long a disk may take for what is being written.
const PATIENCE: Duration = Duration::from_millis(800);

type Said = Box<dyn Fn() -> String + Send>;

static SAID: Mutex<Option<Said>> = Mutex::new(None);

/// From now on Ctrl-C is answered. Where the system has no such request, it is not.
pub fn listen() {
    let _ = ctrlc::try_set_handler(|| {
        let said = SAID.lock().unwrap_or_else(PoisonError::into_inner).as_ref().map(|said| said());
        writing::close(PATIENCE);
        let said = said.map_or(String::new(), |said| format!(": {said}"));
        output::tell(&format!("\ninterrupted{said}"));
        process::exit(STATUS);
    });
}

/// What to say of the work done so far, should it be interrupted.
pub fn say(said: impl Fn() -> String + Send + 'static) {
    *SAID.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(said));
}
