//! The commands of the beam, for the program `thermobeam` and for `cargo xtask` in a checkout.
//!
//! The harness's commands come from `convergence_study`, with the beam's kinds of
//! study registered in [`project()`]. This file adds the beam's own commands and dispatches.

mod equilibria;
mod project;
mod run;
mod sweep;

use clap::{Parser, Subcommand};
use convergence_study::{
    Project, Verdict,
    command_line::{self, HelpPage, Unusable},
};

pub use project::project;

/// The command line of `thermobeam`.
#[derive(Debug, Parser)]
pub struct Thermobeam {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands. Each is documented at its arguments, where `--help` finds the text.
#[allow(missing_docs)]
#[derive(Debug, Subcommand)]
pub enum Command {
    #[command(flatten)]
    Harness(command_line::Command),
    Run(run::Arguments),
    Equilibria(equilibria::Arguments),
    Sweep(sweep::Arguments),
}

/// The commands, grouped by the user's purpose.
pub const GROUPS: [(&str, &[&str]); 5] = [
    ("Simulate a scene", &["run", "equilibria"]),
    (
        "Verify",
        &["verify", "study", "list", "report", "new", "manufacture"],
    ),
    ("Errors of other codes", &["rates"]),
    ("Many scenes", &["sweep"]),
    ("Everything else", OTHERS),
];

/// The commands of no other group.
const OTHERS: &[&str] = if cfg!(feature = "completions") {
    &["schema", "completions"]
} else {
    &["schema"]
};

/// The pages of the beam's commands. Each example works as it is in the folder that a test fills.
pub const PAGES: [HelpPage; 3] = [
    HelpPage {
        command: "run",
        without: &["jobs"],
        examples: &[
            ("The result", "PROGRAM run scene.toml"),
            (
                "The time history and pictures, too",
                "PROGRAM run scene.toml --out beam",
            ),
            (
                "A run with at most this error",
                "PROGRAM run scene.toml --target-error 1e-6",
            ),
        ],
    },
    HelpPage {
        command: "equilibria",
        without: &["jobs"],
        examples: &[
            ("A table", "PROGRAM equilibria scene.toml"),
            (
                "For a program",
                "PROGRAM equilibria scene.toml --format json",
            ),
        ],
    },
    HelpPage {
        command: "sweep",
        without: &[],
        examples: &[
            ("All cases, a line each", "PROGRAM sweep sweep.toml"),
            (
                "Into a folder; the same line goes on after an interruption",
                "PROGRAM sweep sweep.toml --out swept",
            ),
            (
                "The first of two shares",
                "PROGRAM sweep sweep.toml --out first --partition 1/2",
            ),
            (
                "Two shares joined",
                "PROGRAM sweep --merge share-1 share-2 --out joined",
            ),
        ],
    },
];

impl Command {
    /// Runs the command; `program` is the whole command line, for completions.
    ///
    /// # Errors
    /// [`Unusable`]: exit status 2.
    pub fn run(&self, project: &Project, program: clap::Command) -> Result<Verdict, Unusable> {
        match self {
            Self::Harness(command) => command.run(project, program),
            Self::Run(arguments) => run::run(arguments),
            Self::Equilibria(arguments) => equilibria::run(arguments),
            Self::Sweep(arguments) => sweep::run(arguments),
        }
    }
}
