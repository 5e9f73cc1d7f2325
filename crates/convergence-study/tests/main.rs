//! The tests of the program and of the pages that document it, in one program.

#[cfg(feature = "command-line")]
mod ci;
#[cfg(feature = "command-line")]
mod examples;
#[cfg(feature = "command-line")]
mod readme;
#[cfg(feature = "files")]
mod tables;
