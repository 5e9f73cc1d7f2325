//! Standard output and error, which may be closed at any time.

use std::io::{self, ErrorKind, Write};

use clap::ValueEnum;

use crate::text::visible;

/// How results are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Format {
    /// For people
    #[default]
    Text,
    /// For programs: one JSON object
    Json,
}

/// Prints to standard output. A reader that closes it early, as `head` does, causes no error.
///
/// No line is a command to GitHub Actions, whatever names and claims it contains.
pub fn print(text: &str) -> io::Result<()> {
    print_as_is(&visible::without_commands(text))
}

/// Prints to standard output, commands to GitHub Actions included.
pub(super) fn print_as_is(text: &str) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        outcome => outcome,
    }
}

/// Prints an error to standard error.
pub fn complain(message: &str) {
    tell(&format!("error: {message}"));
}

/// Prints a message to standard error, without control characters other than line ends.
pub fn tell(message: &str) {
    // If standard error is closed, the message cannot be shown.
    let _ = writeln!(io::stderr(), "{}", visible::without_commands(&visible::lines(message)));
}
