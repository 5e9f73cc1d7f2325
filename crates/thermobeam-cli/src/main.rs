//! The program `thermobeam`.

use std::process::ExitCode;

use thermobeam_cli::{GROUPS, PAGES, Thermobeam, project};

fn main() -> ExitCode {
    let project = project("thermobeam");
    project.run_program(&GROUPS, &PAGES, |program: Thermobeam, line| {
        program.command.run(&project, line)
    })
}
