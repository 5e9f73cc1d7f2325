//! `cargo xtask <command>`: the commands of the project.
//!
//! This file only dispatches. A command is a file of its own, with its `Arguments` and a function from them to the exit
//! status.

mod bench;
mod equilibria;
mod exit;
mod github;
mod list;
mod output;
mod progress;
mod run;
mod screen;
mod selection;
mod study;
mod verify;
mod workspace;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Simulate the beam between its obstacles, and verify the scheme that does.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version, after_help = exit::HELP)]
struct Xtask {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Verify(verify::Arguments),
    Study(study::Arguments),
    List(list::Arguments),
    Run(run::Arguments),
    Equilibria(equilibria::Arguments),
    Bench(bench::Arguments),
}

fn main() -> ExitCode {
    match Xtask::parse().command {
        Command::Verify(arguments) => exit::status(verify::verify(&arguments)),
        Command::Study(arguments) => exit::status(study::study(&arguments)),
        Command::List(arguments) => exit::status(list::list(&arguments)),
        Command::Bench(arguments) => exit::status(bench::bench(&arguments)),
        Command::Run(arguments) => exit::code(run::run(&arguments)),
        Command::Equilibria(arguments) => exit::code(equilibria::run(&arguments)),
    }
}
