//! The program `convergence-study`: the project is the folder that it runs in.

use std::process::ExitCode;

use convergence_study::cli;
use convergence_study::project::Project;

/// Studies of any code: no kind of its own beside those of the harness.
const PROJECT: Project = Project::new("convergence-study", "convergence-study");

fn main() -> ExitCode {
    cli::main(&PROJECT)
}
