//! The program `convergence-study`: the project is the folder that it runs in.

use std::process::ExitCode;

use convergence_study::cli;
use convergence_study::program;
use convergence_study::project::Project;

/// Studies of any program.
const PROJECT: Project = Project {
    kinds: &[program::ROW],
    templates: &[program::TEMPLATE],
    ..Project::new("convergence-study", "convergence-study")
};

fn main() -> ExitCode {
    cli::main(&PROJECT)
}
