//! The tests of the program, in one program.

mod command;
mod command_line;
mod transcripts;
