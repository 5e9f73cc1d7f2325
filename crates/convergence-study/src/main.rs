//! The program `convergence-study`: the project is the folder that it runs in.

use std::process::ExitCode;

use convergence_study::cli;
use convergence_study::program;

fn main() -> ExitCode {
    cli::main(&program::PROJECT)
}
