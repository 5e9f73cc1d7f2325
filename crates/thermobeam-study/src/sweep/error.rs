//! Errors of the folder of a sweep.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// A folder or a file of results that cannot be used.
#[derive(Debug, Error)]
pub enum SweepError {
    /// The operating system's, with the path named in front of it.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The folder holds results, and `--resume` was not given.
    #[error("{}: expected a folder without results, found those of a sweep; continue it with --resume, or choose another folder", .0.display())]
    Taken(PathBuf),
    /// The folder holds results of something else.
    #[error("{}: expected {what} {expected}, found {found}", .folder.display())]
    Other {
        /// The folder.
        folder: PathBuf,
        /// What differs.
        what: &'static str,
        /// What the folder has.
        found: String,
        /// What was asked for.
        expected: String,
    },
    /// Another process writes to the folder.
    #[error("{}: another process writes to this folder; wait for it, or choose another folder", .0.display())]
    Busy(PathBuf),
    /// A file with unexpected content.
    #[error("{}{}: {reason}", .file.display(), .line.map(|line| format!(":{line}")).unwrap_or_default())]
    Damaged {
        /// The file.
        file: PathBuf,
        /// The line, from 1, where it is one.
        line: Option<usize>,
        /// What was expected and found.
        reason: String,
    },
    /// A case has two lines.
    #[error("{}: expected each case once, found case {case} here and in {}", .second.display(), .first.display())]
    Duplicate {
        /// Its number.
        case: usize,
        /// Where it was found first.
        first: PathBuf,
        /// Where it was found again.
        second: PathBuf,
    },
    /// Cases are missing.
    #[error("expected {cases} cases, of which {count} are missing: {named}; found the shares {shares}")]
    Missing {
        /// How many.
        count: usize,
        /// How many there should be.
        cases: usize,
        /// The first of them.
        named: String,
        /// The shares found.
        shares: String,
    },
}
