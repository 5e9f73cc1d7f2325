//! The program `convergence-study`: the project is the folder that it runs in.

use std::process::ExitCode;

fn main() -> ExitCode {
    convergence_study::Project::PROGRAMS.run_command_line()
}
