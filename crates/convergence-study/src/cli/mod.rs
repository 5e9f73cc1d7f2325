//! The command line: `new`, `manufacture`, `verify`, `study`, `list`, `rates`, `report`,
//! `schema`, `completions`, for any project.
//!
//! A project without commands of its own calls [`Project::run_command_line`]; one with commands
//! puts [`Command`] among them with `#[command(flatten)]`, and calls [`Project::run_program`].
//! Results go to standard output, everything else to standard error. Exit status: [`exit::HELP`].

#[cfg(feature = "completions")]
mod completions;
pub(crate) mod exit;
pub(crate) mod flags;
mod github;
pub(crate) mod help;
mod list;
#[cfg(feature = "manufacture")]
mod manufacture;
mod new;
pub(crate) mod rates;
mod report;
pub(crate) mod running;
pub(crate) mod schema;
pub(crate) mod screen;
mod study;
mod verify;
mod where_lost;
pub(crate) mod workspace;

use std::env;
use std::ffi::OsString;
use std::fmt::Write;
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Parser, Subcommand};

use crate::program::guard;
use crate::project::Project;
use convergence_judge::verdict::Verdict;

/// The commands of the harness. `--help` takes their descriptions from their arguments.
#[allow(missing_docs)]
#[derive(Debug, Subcommand)]
pub enum Command {
    Verify(verify::Arguments),
    Study(study::Arguments),
    List(list::Arguments),
    Rates(Box<rates::Arguments>),
    Report(report::Arguments),
    Schema(schema::Arguments),
    New(new::Arguments),
    #[cfg(feature = "manufacture")]
    Manufacture(manufacture::Arguments),
    #[cfg(feature = "completions")]
    Completions(completions::Arguments),
}

impl Command {
    /// Their names in the order of `--help`.
    pub const NAMES: &'static [&'static str] = &[
        "new",
        #[cfg(feature = "manufacture")]
        "manufacture",
        "verify",
        "study",
        "list",
        "rates",
        "report",
        "schema",
        #[cfg(feature = "completions")]
        "completions",
    ];

    /// Runs the command for a project; `whole` is the whole command line, for completions.
    ///
    /// # Errors
    /// [`exit::Unusable`]: exit status 2.
    #[cfg_attr(not(feature = "completions"), expect(unused_variables))]
    pub fn run(&self, project: &Project, whole: clap::Command) -> exit::CommandOutcome {
        guard::enable();
        match self {
            Self::Verify(arguments) => verify::run(project, arguments),
            Self::Study(arguments) => study::run(project, arguments),
            Self::List(arguments) => list::run(project, arguments),
            Self::Rates(arguments) => rates::run(project, arguments),
            Self::Report(arguments) => report::run(project, arguments),
            Self::Schema(arguments) => schema::run(project, arguments),
            Self::New(arguments) => new::run(project, arguments),
            #[cfg(feature = "manufacture")]
            Self::Manufacture(arguments) => manufacture::run(arguments),
            #[cfg(feature = "completions")]
            Self::Completions(arguments) => completions::run(project, arguments, whole),
        }
    }
}

/// The names of the commands for users.
fn visible_commands(line: &clap::Command) -> Vec<&str> {
    let commands = line
        .get_subcommands()
        .filter(|command| !command.is_hide_set());
    let names = commands.map(clap::Command::get_name);
    let mut names: Vec<&str> = names.filter(|name| *name != "help").collect();
    names.sort_unstable();
    names
}

/// The exit status of this process, if it was started as a guard. It then needs no command line,
/// which takes longer to build than a small program runs.
fn status_of_guard() -> Option<u8> {
    let outcome = || Ok(guard::serve().map(|()| Verdict::Pass)?);
    guard::is_guard().then(|| exit::status(outcome()))
}

impl Project {
    /// The command line of the program `P`, under the name that its users type, its commands in
    /// groups.
    ///
    /// * `groups`: heading, and names of commands. `--help` does not list a command outside all
    ///   groups.
    /// * `pages`: what the help of the commands that are not the harness's says.
    pub fn command_line<P: Parser>(
        &self,
        groups: &[(&str, &[&str])],
        pages: &[help::HelpPage],
    ) -> clap::Command {
        let command = P::command()
            .name(self.command)
            .bin_name(self.command)
            .about(self.about);
        grouped(
            help::completed(new::with_templates(command, self), self, pages)
                .version(env!("CARGO_PKG_VERSION")),
            groups,
        )
    }

    /// The `main` of a program with commands of its own: parses the arguments of the process, runs
    /// the command, and turns the outcome into the exit status.
    ///
    /// * `groups`, `pages`: as for [`command_line`](Self::command_line).
    /// * `run`: also receives the whole command line, which [`Command::run`] asks for.
    pub fn run_program<P: Parser>(
        &self,
        groups: &[(&str, &[&str])],
        pages: &[help::HelpPage],
        run: impl FnOnce(P, clap::Command) -> exit::CommandOutcome,
    ) -> ExitCode {
        let status = status_of_guard().unwrap_or_else(|| {
            let line = self.command_line::<P>(groups, pages);
            status(line.clone(), env::args_os(), |program| run(program, line))
        });
        ExitCode::from(status)
    }

    /// The command line of a project that adds no commands of its own.
    pub fn own_command_line(&self) -> clap::Command {
        self.command_line::<CommandLine>(&[("Commands", Command::NAMES)], &[])
    }

    /// The whole `main` of a project that adds no commands of its own.
    pub fn run_command_line(&self) -> ExitCode {
        ExitCode::from(self.status_of(env::args_os()))
    }

    /// Says that this process is an interpreter, which this command makes run
    /// [`status_of`](Self::status_of) with the arguments behind it: the harness starts itself
    /// again, to end what programs leave behind. Call it first.
    pub fn is_run_by(mut command: Vec<OsString>) {
        command.push(guard::COMMAND.into());
        guard::enable_by(command);
    }

    /// The same with these arguments, starting with the program; returns the exit status.
    pub fn status_of(&self, arguments: impl Iterator<Item = OsString>) -> u8 {
        status_of_guard().unwrap_or_else(|| {
            let line = self.own_command_line();
            status(line.clone(), arguments, |asked: CommandLine| {
                asked.command.run(self, line)
            })
        })
    }
}

/// The command line with its subcommands listed under headings, and the exit status explained.
///
/// * `groups`: heading, and names of subcommands. A subcommand outside all groups is not listed.
fn grouped(command: clap::Command, groups: &[(&str, &[&str])]) -> clap::Command {
    let mut text = String::new();
    let width = groups
        .iter()
        .flat_map(|(_, names)| names.iter())
        .map(|name| name.len())
        .max()
        .unwrap_or(0);
    for (heading, names) in groups {
        let _ = writeln!(text, "{heading}:");
        for name in *names {
            let found = command
                .get_subcommands()
                .find(|known| known.get_name() == *name);
            let about = found
                .and_then(clap::Command::get_about)
                .map(ToString::to_string)
                .unwrap_or_default();
            let _ = writeln!(text, "  {name:width$}  {about}");
        }
        text.push('\n');
    }
    let template = format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{text}Options:\n{{options}}\n\n{}",
        exit::HELP
    );
    command.help_template(template)
}

fn status<P: Parser>(
    line: clap::Command,
    arguments: impl Iterator<Item = OsString>,
    run: impl FnOnce(P) -> exit::CommandOutcome,
) -> u8 {
    let arguments: Vec<OsString> = arguments.collect();
    if let Some(colour) = screen::colour_in(&arguments) {
        screen::set_colour(colour);
    }
    let line = line.color(screen::choice());
    let parsed = line.clone().try_get_matches_from(arguments);
    let matches = parsed.unwrap_or_else(|error| with_commands(error, &line).exit());
    let program = P::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    exit::listen();
    exit::status(run(program))
}

/// An error of the command line; if the command is unknown, it lists those that exist.
fn with_commands(mut error: clap::Error, line: &clap::Command) -> clap::Error {
    // That of a command of a command, such as `dev` of a project, has another usage.
    let usage = format!("{} [OPTIONS] <COMMAND>", line.get_name());
    let shown = error.get(ContextKind::Usage).map(ToString::to_string);
    let is_topmost = shown.is_some_and(|shown| shown.contains(&usage));
    if error.kind() == ErrorKind::InvalidSubcommand && is_topmost {
        let known = format!("the commands are {}", visible_commands(line).join(", "));
        let advice = ContextValue::StyledStrs(vec![known.into()]);
        error.insert(ContextKind::Suggested, advice);
    }
    error
}

#[derive(Debug, Parser)]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}
