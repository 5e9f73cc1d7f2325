//! The program `thermobeam`.

use std::process::ExitCode;

use convergence_study::internal::cli::{command_line, ended};
use thermobeam_cli::{GROUPS, PAGES, Thermobeam, project};

fn main() -> ExitCode {
    let project = project("thermobeam");
    let line = command_line::<Thermobeam>(&project, &GROUPS, &PAGES);
    ended(line.clone(), |program: Thermobeam| {
        program.command.run(&project, line)
    })
}
