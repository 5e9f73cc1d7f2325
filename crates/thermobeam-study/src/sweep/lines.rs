//! Lines of results: a line of JSON for each case, below a line that names the sweep.
//!
//! Every file, and the standard output, has the lines of a share of the cases in the order of their
//! numbers. So a file that was left off holds the first lines of the finished one.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{RESULTS, Sweep, SweepShare};
use convergence_judge::text::visible;
use convergence_study::atomic;

/// The first line, in words.
const HEADER: &str = "the first line of a sweep, with its hash, cases and share";

/// For `map_err`: the same error, preceded by the name of the file.
fn naming(path: &Path) -> impl Fn(io::Error) -> io::Error {
    move |error| io::Error::new(error.kind(), format!("{}: {error}", visible::path(path)))
}

/// The reason why a folder or a file of results cannot be used.
#[derive(Debug, Error)]
pub enum SweepError {
    /// An error of the operating system, preceded by the path.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// Something else than what must be there.
    #[error("{place}: expected {expected}, found {found}")]
    Refused {
        /// A folder, or a file and a line.
        place: String,
        /// What must be there.
        expected: String,
        /// What is there, and what to do.
        found: String,
    },
}

/// The first line of a file of results.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// That of [`Sweep::hash`], in hexadecimal.
    pub hash: String,
    /// Cases of the whole sweep.
    pub cases: usize,
    /// The share of them that the file is for.
    pub share: SweepShare,
}

impl Header {
    /// The header of a share of a sweep.
    pub fn new(sweep: &Sweep, share: SweepShare) -> Self {
        Self {
            hash: sweep.hash.clone(),
            cases: sweep.cases,
            share,
        }
    }

    /// As a line of JSON, without its newline.
    pub fn line(&self) -> String {
        // A struct of numbers and texts always serialises.
        serde_json::to_string(self).unwrap_or_else(|error| unreachable!("{error}"))
    }
}

/// What is read of a line.
#[derive(Deserialize)]
struct LineHead<'a> {
    case: usize,
    status: &'a str,
}

/// Reads a file of results, and refuses every line but that of the next case.
pub(super) struct LineReader {
    path: PathBuf,
    input: BufReader<File>,
    /// The line that was read last; one without its newline is torn.
    pub(super) line: Vec<u8>,
    /// Its number, from 1.
    number: usize,
    /// Bytes of all whole lines.
    end: u64,
    /// Lines of cases that failed.
    pub(super) failed: usize,
}

impl LineReader {
    /// The reader of an open file.
    fn new(path: PathBuf, file: File) -> Self {
        Self {
            path,
            input: BufReader::new(file),
            line: vec![],
            number: 0,
            end: 0,
            failed: 0,
        }
    }

    /// Opens the file of a folder and reads its first line.
    pub(super) fn open(folder: &Path) -> Result<(Self, Header), SweepError> {
        let path = folder.join(RESULTS);
        let file = File::open(&path).map_err(naming(&path))?;
        let mut lines = Self::new(path, file);
        match lines.header()? {
            Some(header) => Ok((lines, header)),
            None => Err(lines.refuse(HEADER, "the end of the file")),
        }
    }

    /// The error about the last line.
    pub(super) fn refuse(&self, expected: &str, found: impl Into<String>) -> SweepError {
        SweepError::Refused {
            place: format!("{}:{}", self.path.display(), self.number),
            expected: expected.to_owned(),
            found: found.into(),
        }
    }

    /// Reads a line; `false` at the end, and at a torn line.
    fn advance(&mut self) -> Result<bool, SweepError> {
        self.line.clear();
        self.number += 1;
        let bytes = self.input.read_until(b'\n', &mut self.line);
        let bytes = bytes.map_err(naming(&self.path))?;
        let is_whole = self.line.ends_with(b"\n");
        self.end += if is_whole { bytes as u64 } else { 0 };
        Ok(is_whole)
    }

    fn header(&mut self) -> Result<Option<Header>, SweepError> {
        if !self.advance()? {
            return Ok(None);
        }
        let header = serde_json::from_slice(&self.line);
        header
            .map(Some)
            .map_err(|error| self.refuse(HEADER, format!("another line: {error}")))
    }

    /// Refuses the first line of another sweep, another version or another share.
    pub(super) fn check(&self, found: &Header, expected: &Header) -> Result<(), SweepError> {
        if found == expected {
            return Ok(());
        }
        let expected = format!("{} of this sweep file, scene and version", expected.line());
        Err(self.refuse(&expected, found.line()))
    }

    /// Reads the line of a case; `false` where the whole lines end.
    pub(super) fn read(&mut self, case: usize) -> Result<bool, SweepError> {
        if !self.advance()? {
            return Ok(false);
        }
        let found = match serde_json::from_slice::<LineHead<'_>>(&self.line) {
            Ok(head) if head.case == case => {
                self.failed += usize::from(head.status != "done");
                return Ok(true);
            }
            Ok(head) => format!("that of case {}", head.case),
            Err(error) => format!("another: {error}"),
        };
        let next = "remove it with those below it, and run the share again";
        Err(self.refuse(
            &format!("the line of case {case}"),
            format!("{found}; {next}"),
        ))
    }

    /// Refuses a line below that of the last case.
    pub(super) fn finish(&mut self) -> Result<(), SweepError> {
        if self.advance()? {
            return Err(self.refuse("the end of the file", "another line; remove it"));
        }
        Ok(())
    }
}

/// The file of a share, locked against other processes.
#[derive(Debug)]
pub struct ShareFile {
    /// Its path.
    pub path: PathBuf,
    /// The file, at its end.
    pub file: File,
    /// Cases without a line.
    pub pending: Vec<usize>,
    /// Cases with a line.
    pub done: usize,
    /// How many of them failed.
    pub failed: usize,
}

impl ShareFile {
    /// Opens the file in a folder, begins it if there is none, and drops a torn last line.
    ///
    /// # Errors
    /// [`SweepError`]: another process is at work on it, or it has another first line or other
    /// cases than the first ones of the share. It is then as it was.
    pub fn open(folder: &Path, sweep: &Sweep, share: SweepShare) -> Result<Self, SweepError> {
        atomic::prepare_folder(folder)?;
        let path = folder.join(RESULTS);
        let _writing = atomic::begin_write();
        let mut options = OpenOptions::new();
        options.create(true).truncate(false).read(true).write(true);
        let mut file = options.open(&path).map_err(naming(&path))?;
        // A file system without locks cannot keep a second process out.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(SweepError::Refused {
                place: path.display().to_string(),
                expected: "no other process at work on this file".to_owned(),
                found: "one; wait for it, or choose another folder".to_owned(),
            });
        }
        let mut lines = LineReader::new(path.clone(), file.try_clone()?);
        let header = Header::new(sweep, share);
        let mut cases = share.cases(sweep.cases).peekable();
        let mut done = 0;
        match lines.header()? {
            Some(found) => {
                lines.check(&found, &header)?;
                while let Some(&case) = cases.peek()
                    && lines.read(case)?
                {
                    cases.next();
                    done += 1;
                }
                if cases.peek().is_none() {
                    lines.finish()?;
                }
            }
            None if header.line().as_bytes().starts_with(&lines.line) => {}
            None => return Err(lines.refuse(HEADER, "another text; choose another folder")),
        }
        file.set_len(lines.end).map_err(naming(&path))?;
        file.seek(SeekFrom::End(0)).map_err(naming(&path))?;
        if lines.end == 0 {
            writeln!(file, "{}", header.line()).map_err(naming(&path))?;
        }
        Ok(Self {
            pending: cases.collect(),
            path,
            file,
            done,
            failed: lines.failed,
        })
    }
}
