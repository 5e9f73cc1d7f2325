//! `history`: the journal of runs as a page and a badge.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::exit::{Ended, Outcome};
use super::flags::Flags;
use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::report;
use crate::run::Finished;
use crate::store::atomic;
use crate::store::journal::{self, JournalError, Run};
use crate::store::provenance::Provenance;
use crate::text::visible;

/// Write rates, errors and cost over the runs of a journal as a page, and a badge
///
/// The journal is what `verify --journal FILE` and `study --journal FILE` append to. `history.html` and `badge.svg`, the last verdict, go to the folder of --out,
/// else to the current one. They need no network.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The journal
    journal: PathBuf,
    /// Only the last runs
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    last: Option<NonZeroUsize>,
    #[command(flatten)]
    flags: Flags,
}

/// What `--format json` prints.
#[derive(Serialize)]
struct Object<'a> {
    /// Of the last run.
    last: &'static str,
    runs: &'a [Run],
}

/// Writes page and badge.
///
/// # Errors
/// A journal that cannot be read, with the line; files that cannot be written.
pub(super) fn run(project: &Project, Arguments { journal, last, flags }: &Arguments) -> Outcome {
    let runs = journal::read(journal)?;
    let shown = &runs[runs.len().saturating_sub(last.map_or(usize::MAX, usize::from))..];
    let verdict = runs.last().map_or(Verdict::Inconclusive, |run| run.verdict);
    let folder = flags.out.clone().unwrap_or_default();
    let [page, badge] = ["history.html", "badge.svg"].map(|name| folder.join(name));
    atomic::write(&page, report::history(project.name, shown))?;
    atomic::write(&badge, report::badge(verdict))?;
    let sentence = format!("{} runs, the last one {}", shown.len(), verdict.name());
    let whole = || format!("{}, {}: {sentence}\n", visible::path(&page), visible::path(&badge));
    // The command judges nothing: the last verdict is what it found.
    let words = flags.words(Verdict::Pass, &sentence, whole);
    flags.show("history", Verdict::Pass, &Object { last: verdict.name(), runs: shown }, &words)?;
    Ok(Ended::Well)
}

/// The journal of commands that run studies.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct Journal {
    /// Append a line on this run to a journal, for `history`
    #[arg(long = "journal", value_name = "FILE")]
    path: Option<PathBuf>,
}

impl Journal {
    /// Whether a line could be appended; to be asked before anything is run.
    ///
    /// # Errors
    /// [`JournalError`].
    pub(super) fn check(&self) -> Result<(), JournalError> {
        self.path.as_deref().map_or(Ok(()), journal::check)
    }

    /// Appends the line of a run, where one is wanted.
    ///
    /// * `root`: a folder of the working tree.
    ///
    /// # Errors
    /// [`JournalError`].
    pub(super) fn append(
        &self,
        root: &Path,
        command: String,
        verdict: Verdict,
        finished: &[Finished],
    ) -> Result<(), JournalError> {
        let Some(path) = &self.path else { return Ok(()) };
        journal::append(path, &Run::new(Provenance::collect(root, command, 0, finished), verdict, finished))
    }
}
