//! `cargo xtask <command>`: the commands of `thermobeam`, and tools for developing the project.
//!
//! A library, so that tests see the project and the files that it writes.

mod bench;
pub mod references;
mod tables;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use convergence_calibration::kind;
use convergence_study::{
    KindRow, Project,
    internal::cli::{command_line, ended},
};
use thermobeam_cli::{GROUPS, PAGES, project};
use thermobeam_study::{kinds::KINDS, studies::STUDIES};

/// The beam under this command, and the calibration of the rule.
pub const PROJECT: Project = Project {
    kinds: &WITH_CALIBRATION,
    studies: &STUDIES,
    about: "Two programs in one repository: `thermobeam` simulates a beam between obstacles, `convergence-study` verifies it, and \
            any other code",
    ..project("cargo xtask")
};

/// The kinds of the beam, and that which counts how often the rule errs: it is not published.
const WITH_CALIBRATION: [KindRow; KINDS.len() + 1] = {
    let mut kinds = [kind::ROW; KINDS.len() + 1];
    let mut place = 0;
    while place < KINDS.len() {
        kinds[place] = KINDS[place];
        place += 1;
    }
    kinds
};

#[derive(Debug, Parser)]
struct Xtask {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    #[command(flatten)]
    Thermobeam(thermobeam_cli::Command),
    Bench(bench::Arguments),
    /// Tools for developing this project
    #[command(subcommand, hide = true)]
    Dev(Dev),
}

#[derive(Debug, Subcommand)]
enum Dev {
    References(references::Arguments),
    Tables(tables::Arguments),
}

/// Runs the command line.
pub fn run() -> ExitCode {
    let groups = [&GROUPS[..], &[("This project", &["bench"])]].concat();
    let line = command_line::<Xtask>(&PROJECT, &groups, &PAGES);
    ended(line.clone(), |program: Xtask| match program.command {
        Command::Thermobeam(command) => command.run(&PROJECT, line),
        Command::Bench(arguments) => bench::run(&PROJECT, &arguments),
        Command::Dev(Dev::References(arguments)) => references::run(&arguments),
        Command::Dev(Dev::Tables(arguments)) => tables::run(&arguments),
    })
}
