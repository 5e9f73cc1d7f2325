//! The developers' tools as used by scripts, with fake programs.
#![cfg(unix)]

mod regressions;

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

use convergence_study_tests::{Ended, ended};

/// Writes a program for the test.
fn program(path: &Path, text: &str) {
    std::fs::write(path, text).expect("a file");
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755)).expect("permissions");
}

/// The program, ready for arguments.
fn xtask() -> Command {
    Command::new(env!("CARGO_BIN_EXE_xtask"))
}
