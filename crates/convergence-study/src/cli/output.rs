//! Standard output and error, which may be closed at any time.

use std::io::{self, ErrorKind, Write};

use clap::ValueEnum;
use serde::Serialize;

/// How results are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Format {
    /// For people
    #[default]
    Text,
    /// For programs: one JSON object
    Json,
}

/// Prints to standard output. A reader who has seen enough, such as `head`, is no error.
pub fn print(text: &str) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        outcome => outcome,
    }
}

/// Prints one JSON object; a number that is not finite becomes `null`, for JSON has none.
pub fn print_json(object: &impl Serialize) -> io::Result<()> {
    print(&(serde_json::to_string_pretty(object)? + "\n"))
}

/// Prints an error to standard error.
pub fn complain(message: &str) {
    tell(&format!("error: {message}"));
}

/// Prints something that is no result to standard error.
pub fn tell(message: &str) {
    // Where standard error is closed there is nobody left to tell.
    let _ = writeln!(io::stderr(), "{message}");
}
