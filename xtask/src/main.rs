//! `cargo xtask`: the commands of the project. Here they are only told apart.
//!
//! Exit status: 0 where everything passes, 1 where something fails or is inconclusive, 2 where the input cannot be used.

mod github;
mod list;
mod screen;
mod selection;
mod study;
mod verify;
mod workspace;

use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Verification of the thermobeam solver.
#[derive(Parser)]
#[command(bin_name = "cargo xtask", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run the studies in `studies/` and write `reports/`
    Verify(verify::Arguments),
    /// Run study files from anywhere
    Study(study::Arguments),
    /// List the studies
    List(list::Arguments),
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Verify(arguments) => verify::verify(&arguments),
        Command::Study(arguments) => study::study(&arguments),
        Command::List(arguments) => list::list(&arguments),
    };
    result.unwrap_or_else(|error| {
        // Where standard error is closed there is nobody to tell.
        let _ = writeln!(io::stderr(), "error: {error}");
        ExitCode::from(2)
    })
}
