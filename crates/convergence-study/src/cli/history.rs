//! `history`: the journal of runs as a page and a badge.

use std::path::PathBuf;

use super::exit::{Ended, Outcome};
use super::output;
use crate::cli::screen;
use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::report;
use crate::run::Finished;
use crate::store::journal::{self, JournalError, Run};
use crate::store::provenance::Provenance;
use crate::text::visible;

/// Write rates, errors and cost over the runs of a journal as a page
///
/// The journal is what `verify --journal FILE` and `study --journal FILE` append to. The page needs no network.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The journal
    journal: PathBuf,
    /// Where the page goes
    #[arg(long, value_name = "FILE", default_value = "history.html")]
    out: PathBuf,
    /// Also write the last verdict as a badge (SVG)
    #[arg(long, value_name = "FILE")]
    badge: Option<PathBuf>,
    /// Only the last runs
    #[arg(long, value_name = "N", value_parser = super::running::jobs)]
    last: Option<std::num::NonZeroUsize>,
}

/// Writes page and badge.
///
/// # Errors
/// A journal that cannot be read, with the line; files that cannot be written.
pub(super) fn run(project: &Project, Arguments { journal, out, badge, last }: &Arguments) -> Outcome {
    let runs = journal::read(journal)?;
    let shown = &runs[runs.len().saturating_sub(last.map_or(usize::MAX, usize::from))..];
    let verdict = runs.last().map_or(Verdict::Inconclusive, |run| run.verdict);
    journal::write(out, &report::history(project.name, shown))?;
    if let Some(badge) = badge {
        journal::write(badge, &report::badge(verdict))?;
    }
    output::print(&format!(
        "{}: {} runs, the last one {}\n",
        visible::path(out),
        shown.len(),
        screen::verdict(verdict)
    ))?;
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
        root: &std::path::Path,
        command: String,
        verdict: Verdict,
        finished: &[Finished],
    ) -> Result<(), JournalError> {
        let Some(path) = &self.path else { return Ok(()) };
        journal::append(path, &Run::new(Provenance::collect(root, command, 0, finished), verdict, finished))
    }
}
