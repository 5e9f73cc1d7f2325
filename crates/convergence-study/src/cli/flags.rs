//! The flags that all commands have in common: one name and one meaning, defined here once, and how a result is shown by them.

use std::io;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use serde::Serialize;

use super::output::{self, Format};
use super::screen;
use crate::judge::verdict::Verdict;
use crate::run::{self, Effort};
use crate::store::{atomic, json};

/// Number of the form of [`Printed`]: higher where a key of any command has changed its meaning or is gone.
const SCHEMA: u32 = 2;

/// What every command takes.
#[derive(Debug, Clone, Args)]
pub struct Flags {
    /// Say only what went wrong, and the verdict: no progress bar, no tables
    #[arg(long, short)]
    pub quiet: bool,
    /// How the result is printed
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Write what the command finds to this folder, which is made if need be
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// The largest number of threads [default: all of the machine]
    #[arg(long, value_name = "N", value_parser = jobs, allow_hyphen_values = true)]
    pub jobs: Option<NonZeroUsize>,
}

/// A number of threads, as it is given on the command line.
fn jobs(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| "expected a whole number >= 1".to_owned())
}

/// The JSON object of a command: its verdict before what it found.
#[derive(Serialize)]
struct Printed<'a, T> {
    schema: u32,
    verdict: &'static str,
    #[serde(flatten)]
    found: &'a T,
}

fn object(verdict: Verdict, found: &impl Serialize) -> io::Result<String> {
    json(&Printed { schema: SCHEMA, verdict: verdict.name(), found })
}

impl Flags {
    /// Threads and time of a run; as many threads as the machine has where no number is given.
    pub fn effort(&self, case_limit: Option<Duration>) -> Effort {
        Effort { jobs: self.jobs.unwrap_or_else(run::available), case_limit, fail_fast: false }
    }

    /// What a command found, for people: all of it, or with `--quiet` the verdict in a sentence.
    pub fn words(&self, verdict: Verdict, sentence: &str, whole: impl FnOnce() -> String) -> String {
        if self.quiet { format!("{}: {sentence}\n", screen::verdict(verdict)) } else { whole() }
    }

    /// Prints what a command found, as words or as JSON object.
    ///
    /// * `verdict`: [`Verdict::Pass`] where the command judges nothing and ended well.
    pub fn print(&self, verdict: Verdict, found: &impl Serialize, words: &str) -> io::Result<()> {
        match self.format {
            Format::Json => output::print(&object(verdict, found)?),
            Format::Text => output::print(words),
        }
    }

    /// The same, and writes the object as `COMMAND.json` to the folder that was named.
    pub fn show(&self, command: &str, verdict: Verdict, found: &impl Serialize, words: &str) -> io::Result<()> {
        if let Some(folder) = &self.out {
            atomic::prepare_folder(folder)?;
            atomic::write(&folder.join(command).with_extension("json"), object(verdict, found)?)?;
        }
        self.print(verdict, found, words)
    }
}
