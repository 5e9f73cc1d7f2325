//! What can go wrong with the folder of a sweep.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// A folder or a file of results that cannot be used.
#[derive(Debug, Error)]
pub enum SweepError {
    /// The operating system's, with the path named in front of it.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The folder holds results, and nobody asked to resume.
    #[error("{}: holds a sweep already; go on with --resume, or choose another folder", .0.display())]
    Taken(PathBuf),
    /// The folder holds results of something else.
    #[error("{}: {what} is {found}; here it is {expected}", .folder.display())]
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
    /// Another process is at work there.
    #[error("{}: another process is at work in this folder", .0.display())]
    Busy(PathBuf),
    /// A file that is not what it should be.
    #[error("{}{}: {reason}", .file.display(), .line.map(|line| format!(":{line}")).unwrap_or_default())]
    Damaged {
        /// The file.
        file: PathBuf,
        /// The line, from 1, where it is one.
        line: Option<usize>,
        /// What is wrong.
        reason: String,
    },
    /// A case is there twice.
    #[error("{}: case {case} is there twice: here and in {}", .second.display(), .first.display())]
    Duplicate {
        /// Its number.
        case: usize,
        /// Where it was found first.
        first: PathBuf,
        /// Where it was found again.
        second: PathBuf,
    },
    /// Cases are missing.
    #[error("{count} of {cases} cases are missing: {named}; found were the shares {shares}")]
    Missing {
        /// How many.
        count: usize,
        /// How many there should be.
        cases: usize,
        /// The first of them.
        named: String,
        /// The shares that were there.
        shares: String,
    },
}
