//! The flags common to all commands, with one name and one meaning, defined here once, and how they
//! affect the output.

use std::io;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use serde_json::Value;

use super::screen::{self, Format, formats};
use crate::chart::without_title;
use crate::exchange::{self, BEGINNING, Printed};
use crate::run;
use crate::store::{self, atomic};
use convergence_judge::verdict::Verdict;

/// The flags that every command accepts.
#[derive(Debug, Clone, Args)]
pub struct Flags {
    /// Print only what went wrong, and the verdict: no progress bar, no tables
    #[arg(long, short)]
    pub quiet: bool,
    /// How the result is printed
    #[arg(long, value_parser = formats(&[Format::Text, Format::Json]), default_value = "text")]
    pub format: Format,
    /// Write the results to this folder, which is created if needed
    #[arg(long, short, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// The largest number of threads [default: all of the machine]
    #[arg(long, short, value_name = "N", value_parser = jobs, allow_hyphen_values = true)]
    pub jobs: Option<NonZeroUsize>,
}

/// The flag of the commands that write pictures.
#[derive(Debug, Clone, Copy, Args)]
pub struct Titles {
    /// Leave the titles of the pictures out, for papers, whose captions take their place
    #[arg(long)]
    no_title: bool,
}

impl Titles {
    /// The text of a file, without its title if it is a picture that is to have none.
    pub fn of(self, text: String) -> String {
        if self.are_kept() {
            text
        } else {
            without_title(&text)
        }
    }

    /// Whether pictures have titles.
    pub(super) fn are_kept(self) -> bool {
        !self.no_title
    }
}

/// Whether two names are of one file that exists.
fn is_same(one: &Path, other: &Path) -> bool {
    let [one, other] = [one, other].map(Path::canonicalize);
    one.is_ok_and(|one| other.is_ok_and(|other| one == other))
}

/// Refuses a place where a file would be lost: one that is read, or one that does not begin as the
/// one that would replace it.
///
/// # Errors
/// The file, and what to do.
pub(super) fn refuse_loss(place: &Path, beginning: &str, read: &[String]) -> io::Result<()> {
    let is_read = |file: &String| {
        let file = if file == "-" { "/dev/stdin" } else { file };
        is_same(Path::new(file), place)
    };
    if read.iter().any(is_read) {
        let words = "found what is read in the place of a result; expected --out of another folder";
        return Err(atomic::naming(place)(io::Error::other(words)));
    }
    atomic::refuse_other(place, beginning)
}

/// Where a command writes its object.
fn place_of(folder: &Path, command: &str) -> PathBuf {
    folder.join(command).with_extension("json")
}

/// A number of threads on the command line.
fn jobs(text: &str) -> Result<NonZeroUsize, String> {
    text.parse()
        .map_err(|_| "expected a whole number >= 1".to_owned())
}

/// A number on the command line; the command compares it with what it allows.
pub(super) fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "expected a number".to_owned())
}

impl Flags {
    /// How a picture begins.
    pub const SVG: &'static str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"";

    /// The number of threads: without one, all of the machine.
    pub fn threads(&self) -> NonZeroUsize {
        self.jobs.unwrap_or_else(run::available)
    }

    /// What a command found, for people: all of it, or the verdict in a sentence with `--quiet`.
    pub fn words(
        &self,
        verdict: Verdict,
        sentence: &str,
        whole: impl FnOnce() -> String,
    ) -> String {
        if self.quiet {
            format!("{}: {sentence}\n", screen::verdict(verdict))
        } else {
            whole()
        }
    }

    /// Prints what a command found, as words or as a JSON object.
    ///
    /// * `verdict`: [`Verdict::Pass`] if the command judges nothing and ended well.
    /// * Returns the verdict.
    pub fn print(
        &self,
        verdict: Verdict,
        found: &impl Serialize,
        words: &str,
    ) -> io::Result<Verdict> {
        if self.format == Format::Json {
            screen::print(&store::json(&Printed::new(verdict, found))?)?;
        } else {
            screen::print(words)?;
        }
        Ok(verdict)
    }

    /// Prints why a command has no result as a JSON object, for programs.
    pub(crate) fn print_refusal(&self, refusal: &Value) -> io::Result<()> {
        if self.format != Format::Json {
            return Ok(());
        }
        screen::print(&store::json(&exchange::refused(refusal))?)
    }

    /// Refuses an output folder where files would be lost: those that are read, and those that do
    /// not begin as the ones that would replace them.
    ///
    /// * `own`: the files beside `COMMAND.json`, each with how it begins.
    /// * `read`: what the command reads; `-` is standard input.
    ///
    /// # Errors
    /// The first of these files, and what to do.
    pub fn refuse_others(
        &self,
        command: &str,
        own: impl IntoIterator<Item = (impl AsRef<Path>, impl AsRef<str>)>,
        read: &[String],
    ) -> io::Result<()> {
        let Some(folder) = &self.out else {
            return Ok(());
        };
        for (name, beginning) in own {
            refuse_loss(&folder.join(name), beginning.as_ref(), read)?;
        }
        refuse_loss(&place_of(folder, command), BEGINNING, read)
    }

    /// As [`print`](Self::print); also writes the object as `COMMAND.json` to the folder given.
    pub fn show(
        &self,
        command: &str,
        verdict: Verdict,
        found: &impl Serialize,
        words: &str,
    ) -> io::Result<Verdict> {
        if let Some(folder) = &self.out {
            atomic::prepare_folder(folder)?;
            let place = place_of(folder, command);
            atomic::refuse_other(&place, BEGINNING)?;
            atomic::write(&place, store::json(&Printed::new(verdict, found))?)?;
        }
        self.print(verdict, found, words)
    }
}
