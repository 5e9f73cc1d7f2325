//! The developers' tools as scripts use them, with programs that only pretend.
#![cfg(unix)]

#[path = "../../../crates/thermobeam-cli/tests/command/ended.rs"]
mod ended;
mod regressions;

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

use ended::{Ended, ended};

/// Writes a program of the test's own.
fn program(path: &Path, text: &str) {
    std::fs::write(path, text).expect("a file");
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755)).expect("permissions");
}

/// The program, to be given arguments.
fn xtask() -> Command {
    Command::new(env!("CARGO_BIN_EXE_xtask"))
}
