//! `cargo xtask <command>`: the commands of the project.
//!
//! The harness's commands come from `convergence_study::cli`, with the beam's kinds of study registered in [`project`]. This
//! file adds the beam's own commands and the tools for developing the project, and only dispatches.

mod bench;
mod drift;
mod equilibria;
mod fuzz;
mod merge;
mod mutants;
mod new;
mod project;
mod regressions;
mod run;
mod sweep;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use convergence_study::cli::{self, exit, grouped, interrupt};

use project::PROJECT;

/// Simulate the beam between its obstacles, and verify the scheme that does
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version)]
struct Xtask {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    #[command(flatten)]
    Harness(cli::Command),
    Run(run::Arguments),
    Equilibria(equilibria::Arguments),
    Sweep(sweep::Arguments),
    Merge(merge::Arguments),
    New(new::Arguments),
    Bench(bench::Arguments),
    /// Tools for developing this project
    #[command(subcommand)]
    Dev(Dev),
}

#[derive(Debug, Subcommand)]
enum Dev {
    Drift(drift::Arguments),
    Mutants(mutants::Arguments),
    Regressions(regressions::Arguments),
    Fuzz(fuzz::Arguments),
}

/// The commands by what a user wants to do.
const GROUPS: [(&str, &[&str]); 5] = [
    ("Simulate a scene", &["run", "equilibria"]),
    ("Verify", &["verify", "study", "list", "explain", "new"]),
    ("Errors of other codes", &["rates"]),
    ("Many scenes", &["sweep", "merge"]),
    ("Everything else", &["bench", "completions", "dev"]),
];

/// The command line, its help in groups.
fn program() -> clap::Command {
    grouped(Xtask::command(), &GROUPS)
}

fn main() -> ExitCode {
    let parsed = Xtask::from_arg_matches(&program().get_matches());
    let command = parsed.unwrap_or_else(|error| error.exit()).command;
    interrupt::listen();
    exit::code(match command {
        Command::Harness(command) => command.run(&PROJECT, program()),
        Command::Run(arguments) => run::run(&arguments),
        Command::Equilibria(arguments) => equilibria::run(&arguments),
        Command::Sweep(arguments) => sweep::run(&arguments),
        Command::Merge(arguments) => merge::run(&arguments),
        Command::New(arguments) => new::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Dev(Dev::Drift(arguments)) => drift::run(&arguments),
        Command::Dev(Dev::Mutants(arguments)) => mutants::run(&arguments),
        Command::Dev(Dev::Regressions(arguments)) => regressions::run(&arguments),
        Command::Dev(Dev::Fuzz(arguments)) => fuzz::run(&arguments),
    })
}
