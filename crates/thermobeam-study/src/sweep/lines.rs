//! Lines of results in files: finding, checking, sorting and copying.
//!
//! A line ends with the hash of the text before it, which reveals later changes.
//!
//! The lines stay on disk; memory holds their positions, 40 bytes per case.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Seek, Write};
use std::path::{Path, PathBuf};

use serde::Deserialize;
use thiserror::Error;

use super::SweepCase;
use convergence_study::internal::store::{atomic, content_hash};

/// The reason why a folder or a file of results cannot be used.
#[derive(Debug, Error)]
pub enum SweepError {
    /// An error of the operating system, prefixed with the path.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The folder holds results, and `--resume` was not given.
    #[error("{}: expected a folder without results, found those of a sweep; continue it with --resume, or choose another folder", .0.display())]
    Taken(PathBuf),
    /// The folder holds other results.
    #[error("{}: expected {what} {expected}, found {found}", .folder.display())]
    Other {
        /// The folder.
        folder: PathBuf,
        /// What differs.
        what: &'static str,
        /// The value in the folder.
        found: String,
        /// The expected value.
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
        /// The line number from 1, if it is about a line.
        line: Option<usize>,
        /// The expected and the found content.
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
    #[error(
        "expected {cases} cases, of which {count} are missing: {named}; found the shares {shares}"
    )]
    Missing {
        /// Number of missing cases.
        count: usize,
        /// Expected number of cases.
        cases: usize,
        /// The first missing cases.
        named: String,
        /// The shares found.
        shares: String,
    },
}

impl SweepError {
    /// About a whole file, or a folder.
    pub(super) fn damaged(file: &Path, reason: String) -> Self {
        Self::Damaged {
            file: file.to_owned(),
            line: None,
            reason,
        }
    }
}

/// The position of a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct LinePosition {
    pub(super) case: usize,
    pub(super) passed: bool,
    file: usize,
    offset: u64,
    bytes: u64,
}

/// The part of a line that is parsed.
#[derive(Deserialize)]
struct LineHead<'a> {
    case: usize,
    status: &'a str,
}

impl<'a> LineHead<'a> {
    /// * `cases`: the number of cases of the sweep.
    ///
    /// # Errors
    /// What is wrong with the line.
    fn read(line: &'a [u8], cases: usize) -> Result<Self, String> {
        let head: Self = serde_json::from_slice(line)
            .map_err(|error| format!("not a line of results: {error}"))?;
        if head.case < cases {
            return Ok(head);
        }
        let case = head.case;
        Err(format!(
            "expected a case below {cases}, the number of cases, found {case}"
        ))
    }
}

/// A JSON object with the hash of its text as the last key.
pub(super) fn sealed(object: &str) -> String {
    let content = object.strip_suffix('}').unwrap_or(object);
    format!(
        "{content},\"hash\":\"{:016x}\"}}",
        content_hash(content.as_bytes())
    )
}

/// Refuses a line whose hash does not match its content.
fn is_as_written(line: &[u8]) -> Result<(), String> {
    const BESIDES: usize = ",\"hash\":\"0123456789abcdef\"}\n".len();
    let content = &line[..line.len().saturating_sub(BESIDES)];
    let expected = format!("{:016x}", content_hash(content));
    if line[content.len()..] == *format!(",\"hash\":\"{expected}\"}}\n").as_bytes() {
        return Ok(());
    }
    Err(format!(
        "expected the hash {expected} of the line's content at its end, found another: the line was changed since it was \
         written; remove it, and --resume computes its case again"
    ))
}

impl LinePosition {
    /// Refuses a line of another case: its varied numbers must be those of the sweep.
    pub(super) fn is_of(&self, line: &[u8], case: &SweepCase<'_>) -> Result<(), String> {
        let parameters = serde_json::to_string(case).map_err(|error| error.to_string())?;
        let status = if self.passed { "done" } else { "failed" };
        let expected = format!(
            "{{\"case\":{},\"status\":\"{status}\",\"parameters\":{parameters}",
            case.index
        );
        match line.strip_prefix(expected.as_bytes()) {
            Some([b',', ..]) => Ok(()),
            _ => Err(format!(
                "expected a line that begins with {expected}, which is case {} of this sweep",
                case.index
            )),
        }
    }
}

/// The places of all complete lines of these files, in the order of their cases, and the offset at
/// which the lines of the last file end; an incomplete line may follow.
///
/// * `check`: an additional check of a line, which returns what is wrong with it.
///
/// # Errors
/// [`SweepError`]: a file that cannot be read, a line that has been changed, or a second line of a
/// case.
pub(super) fn places(
    files: &[PathBuf],
    cases: usize,
    check: impl Fn(&LinePosition, &[u8]) -> Result<(), String>,
) -> Result<(Vec<LinePosition>, u64), SweepError> {
    let (mut places, mut end) = (vec![], 0);
    for (index, file) in files.iter().enumerate() {
        end = read(file, index, cases, &check, &mut places)?;
    }
    places.sort_by_key(|place| place.case);
    if let Some(pair) = places.windows(2).find(|pair| pair[0].case == pair[1].case) {
        let [first, second] = [pair[0], pair[1]].map(|place| files[place.file].clone());
        return Err(SweepError::Duplicate {
            case: pair[0].case,
            first,
            second,
        });
    }
    Ok((places, end))
}

/// Adds the places of a file; returns the offset at which its complete lines end.
fn read(
    path: &Path,
    file: usize,
    cases: usize,
    check: impl Fn(&LinePosition, &[u8]) -> Result<(), String>,
    places: &mut Vec<LinePosition>,
) -> Result<u64, SweepError> {
    let mut reader = BufReader::new(File::open(path).map_err(atomic::naming(path))?);
    let (mut offset, mut line) = (0, vec![]);
    for number in 1.. {
        line.clear();
        let bytes = reader
            .read_until(b'\n', &mut line)
            .map_err(atomic::naming(path))? as u64;
        if line.last() != Some(&b'\n') {
            break;
        }
        let place = LineHead::read(&line, cases)
            .map(|head| LinePosition {
                case: head.case,
                passed: head.status == "done",
                file,
                offset,
                bytes,
            })
            .and_then(|place| {
                is_as_written(&line)?;
                check(&place, &line)?;
                Ok(place)
            })
            .map_err(|reason| SweepError::Damaged {
                file: path.to_owned(),
                line: Some(number),
                reason,
            })?;
        places.push(place);
        offset += bytes;
    }
    Ok(offset)
}

/// Writes the lines at `places` in that order.
pub(super) fn copy(places: &[LinePosition], files: &[PathBuf], out: &Path) -> io::Result<()> {
    let mut readers = vec![];
    for path in files {
        let file = File::open(path).map_err(atomic::naming(path))?;
        readers.push(BufReader::new(file));
    }
    atomic::write_with(out, |output: &mut BufWriter<File>| {
        for place in places {
            let reader = &mut readers[place.file];
            // Relative, so that adjacent lines come from the buffer.
            let here = reader.stream_position()?;
            reader.seek_relative(place.offset.wrapping_sub(here) as i64)?;
            let copied = io::copy(&mut reader.take(place.bytes), output)?;
            if copied < place.bytes {
                return Err(io::Error::new(
                    io::ErrorKind::UnexpectedEof,
                    "a file of results became shorter",
                ));
            }
        }
        output.flush()
    })
}
