//! A program that answers with a text: sources that are compared with those of `manufacture`.

use std::io::Read;
use std::path::PathBuf;
use std::process::ChildStdout;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use super::command::{DRAIN, Ended, HELD_OPEN, Invocation};
use crate::study::CaseFailure;

/// Longest text that is kept, in bytes: a hundred times what a program answers at the points of
/// `--against`.
const LONGEST_TEXT: u64 = 64 << 20;

/// What a program prints about a text on its standard input, until it ends; none of its processes
/// outlives the call.
///
/// * `words`: the program, then its arguments.
///
/// # Errors
/// The program cannot be started, ended with a status other than 0, or took too long: in one line
/// that names it.
pub(crate) fn printed(
    words: Vec<String>,
    input: String,
    time_limit: Duration,
) -> Result<String, CaseFailure> {
    let invocation = Invocation {
        words,
        directory: PathBuf::from("."),
        variables: vec![],
        input,
        time_limit,
    };
    invocation.text()
}

impl Invocation {
    /// Runs the command, and returns all that it prints.
    ///
    /// # Errors
    /// As for an answer; also for bytes that are not UTF-8, and for more than [`LONGEST_TEXT`].
    fn text(&self) -> Result<String, CaseFailure> {
        let is_endless = Arc::new(AtomicBool::new(false));
        let found_endless = Arc::clone(&is_endless);
        let ended = self.end_of(move |stream: ChildStdout| {
            let mut text = String::new();
            let mut stream = stream.take(LONGEST_TEXT + 1);
            let read = stream.read_to_string(&mut text);
            found_endless.store(text.len() as u64 > LONGEST_TEXT, Ordering::Relaxed);
            // The pipe is closed behind this, which ends a program that goes on.
            read.map(|_| text)
        });
        if is_endless.load(Ordering::Relaxed) {
            return Err(self.failed(&format!("printed more than {} MB", LONGEST_TEXT >> 20)));
        }
        let Ended { printed, words } = ended?;
        match printed.recv_timeout(DRAIN) {
            Ok(Ok(text)) => Ok(text),
            Ok(Err(error)) => Err(self.failed(&format!("printed no text: {error}{words}"))),
            Err(_) => Err(self.failed(&format!("answered nothing: {HELD_OPEN}{words}"))),
        }
    }
}
