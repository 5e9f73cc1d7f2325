//! `cargo xtask <command>`: the commands of `thermobeam`, and tools for developing the project.
//!
//! A library, so that tests see the project and the files that it writes.

mod bench;
pub mod references;
mod tables;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use convergence_calibration::studies as calibration;
use convergence_study::{Project, Study};
use thermobeam_cli::{GROUPS, PAGES, project};
use thermobeam_study::studies;

/// The beam under this command, its studies in code, and the calibration of the rule.
pub const PROJECT: Project = Project {
    studies: &STUDIES,
    about: "Two programs in one repository: `thermobeam` simulates a beam between obstacles, `convergence-study` verifies it, and \
            any other code",
    ..project("cargo xtask")
};

/// The studies in code: none of them is published.
const STUDIES: [fn() -> Box<dyn Study>; studies::STUDIES.len() + calibration::STUDIES.len()] = {
    let mut all = [calibration::STUDIES[0]; studies::STUDIES.len() + calibration::STUDIES.len()];
    let mut place = 0;
    while place < all.len() {
        all[place] = if place < studies::STUDIES.len() {
            studies::STUDIES[place]
        } else {
            calibration::STUDIES[place - studies::STUDIES.len()]
        };
        place += 1;
    }
    all
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
    PROJECT.run_program(&groups, &PAGES, |program: Xtask, line| {
        match program.command {
            Command::Thermobeam(command) => command.run(&PROJECT, line),
            Command::Bench(arguments) => bench::run(&PROJECT, &arguments),
            Command::Dev(Dev::References(arguments)) => references::run(&arguments),
            Command::Dev(Dev::Tables(arguments)) => tables::run(&arguments),
        }
    })
}
