//! The tests of programs as seen by a shell: `powers`, a project's command line, and the program
//! `solver` that its studies run.

mod command_line;
// Process groups exist only on Unix.
#[cfg(unix)]
mod program;
