//! The tests of the harness, of its program and of the pages that document both, in one program.

mod asserted;
#[cfg(feature = "command-line")]
mod ci;
#[cfg(all(feature = "tables", feature = "reports"))]
mod doubted;
#[cfg(feature = "command-line")]
mod examples;
#[cfg(feature = "command-line")]
mod fit;
mod grid;
#[cfg(feature = "command-line")]
mod readme;
mod richardson;
#[path = "../../convergence-study-tests/src/rows.rs"]
#[allow(unreachable_pub, reason = "it is a library's")]
mod rows;
#[cfg(feature = "tables")]
mod table_attacks;
mod verdict_laws;
mod verdict_rule;
mod verdict_tables;

#[cfg(feature = "command-line")]
use std::{
    env,
    path::Path,
    process::{Command, Output},
};

/// Runs commands in a shell that finds the program.
#[cfg(feature = "command-line")]
fn shell(folder: &Path, commands: &str) -> Output {
    let own = Path::new(env!("CARGO_BIN_EXE_convergence-study")).parent();
    let own = own.expect("a folder").to_owned();
    let others = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths([own].into_iter().chain(env::split_paths(&others)));
    let mut shell = Command::new("sh");
    shell.args(["-ec", commands]).current_dir(folder);
    shell.env("PATH", path.expect("a path"));
    for name in ["GITHUB_ACTIONS", "GITHUB_STEP_SUMMARY"] {
        shell.env_remove(name);
    }
    shell.output().expect("a shell")
}
