//! `cargo xtask <command>`: the commands of the project.
//!
//! This file only dispatches. A command is a file of its own, with its `Arguments` and a function from them to the exit
//! status.

mod bench;
mod completions;
mod drift;
mod equilibria;
mod exit;
mod explain;
mod fuzz;
mod github;
mod history;
mod interrupt;
mod list;
mod merge;
mod moved;
mod mutants;
mod new;
mod output;
mod progress;
mod rates;
mod run;
mod running;
mod screen;
mod selection;
mod study;
mod sweep;
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
    Explain(explain::Arguments),
    New(new::Arguments),
    Rates(rates::Arguments),
    Run(run::Arguments),
    Equilibria(equilibria::Arguments),
    Sweep(sweep::Arguments),
    Merge(merge::Arguments),
    Bench(bench::Arguments),
    Drift(drift::Arguments),
    Mutants(mutants::Arguments),
    Fuzz(fuzz::Arguments),
    Completions(completions::Arguments),
}

fn main() -> ExitCode {
    let command = Xtask::parse().command;
    interrupt::listen();
    match command {
        Command::Verify(arguments) => exit::status(verify::verify(&arguments)),
        Command::Study(arguments) => exit::status(study::study(&arguments)),
        Command::List(arguments) => exit::status(list::list(&arguments)),
        Command::Explain(arguments) => exit::code(explain::run(&arguments)),
        Command::New(arguments) => exit::code(new::run(&arguments)),
        Command::Rates(arguments) => exit::code(rates::run(&arguments)),
        Command::Run(arguments) => exit::code(run::run(&arguments)),
        Command::Equilibria(arguments) => exit::code(equilibria::run(&arguments)),
        Command::Sweep(arguments) => exit::code(sweep::run(&arguments)),
        Command::Merge(arguments) => exit::code(merge::run(&arguments)),
        Command::Bench(arguments) => exit::status(bench::bench(&arguments)),
        Command::Drift(arguments) => exit::status(drift::drift(&arguments)),
        Command::Mutants(arguments) => exit::code(mutants::run(&arguments)),
        Command::Fuzz(arguments) => exit::code(fuzz::run(&arguments)),
        Command::Completions(arguments) => exit::code(completions::run(&arguments)),
    }
}
