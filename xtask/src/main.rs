//! `cargo xtask <command>`: the commands of the project.
//!
//! This file only dispatches. A command is a file of its own, with its `Arguments` and a function `run` from them to an
//! [`exit::Outcome`].

mod completions;
mod equilibria;
mod exit;
mod explain;
mod merge;
mod new;
mod output;
mod progress;
mod rates;
mod run;
mod sweep;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Simulate the beam between its obstacles, and verify the scheme that does.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", after_help = exit::HELP)]
struct Xtask {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Arguments),
    Equilibria(equilibria::Arguments),
    Sweep(sweep::Arguments),
    Merge(merge::Arguments),
    Rates(rates::Arguments),
    New(new::Arguments),
    Explain(explain::Arguments),
    Completions(completions::Arguments),
}

fn main() -> ExitCode {
    let outcome = match Xtask::parse().command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Equilibria(arguments) => equilibria::run(&arguments),
        Command::Sweep(arguments) => sweep::run(&arguments),
        Command::Merge(arguments) => merge::run(&arguments),
        Command::Rates(arguments) => rates::run(&arguments),
        Command::New(arguments) => new::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments),
    };
    exit::code(outcome)
}
