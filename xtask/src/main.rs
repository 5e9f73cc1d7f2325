//! `cargo xtask <command>`: the commands of `thermobeam`, and tools for developing the project.

mod bench;
mod regressions;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use convergence_study::cli::{command_line, ended};
use convergence_study::project::Project;
use thermobeam_cli::{GROUPS, project};

/// The beam, under this command.
const PROJECT: Project = project("cargo xtask");

#[derive(Debug, Parser)]
struct Xtask {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
#[expect(
    clippy::large_enum_variant,
    reason = "there is one value of it in a run"
)]
enum Command {
    #[command(flatten)]
    Thermobeam(thermobeam_cli::Command),
    Bench(bench::Arguments),
    /// Tools for developing this project
    #[command(subcommand)]
    Dev(Dev),
}

#[derive(Debug, Subcommand)]
enum Dev {
    Regressions(regressions::Arguments),
}

fn main() -> ExitCode {
    let groups = [&GROUPS[..], &[("This project", &["bench", "dev"])]].concat();
    let line = command_line::<Xtask>(&PROJECT, &groups);
    ended(line.clone(), |asked: Xtask| match asked.command {
        Command::Thermobeam(command) => command.run(&PROJECT, line),
        Command::Bench(arguments) => bench::run(&PROJECT, &arguments),
        Command::Dev(Dev::Regressions(arguments)) => regressions::run(&arguments),
    })
}
