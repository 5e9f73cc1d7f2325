//! The tests of programs as seen by a shell: `powers`, a project's command line, and the program
//! `solver` that its studies run.

mod command_line;
// Process groups exist only on Unix.
#[cfg(unix)]
mod program;
mod transcripts;

/// Whether programs in awk, and scripts that start them, can be run here.
fn awk_is_here() -> bool {
    foreign_tools::are_here(&[foreign_tools::AWK, foreign_tools::SHELL])
}
