//! The program `convergence-study`: the project is the folder that it runs in.

use std::process::ExitCode;

fn main() -> ExitCode {
    convergence_study::run_command_line(&convergence_study::PROGRAMS)
}
